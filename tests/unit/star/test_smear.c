/* SPDX-License-Identifier: MIT
 *
 * Tests starbursts of a stop with dust or a mask. They must equal a direct
 * summation over the stop, have the right total light, and be bit-identical for
 * any tiles and workers. A white mask must equal no mask; a black mask must
 * give no light.
 */
#include "engine/setup/dirt.h"
#include "engine/setup/spectrum.h"
#include "engine/star/smear_table.h"
#include "engine/star/star_tables.h"
#include "glint/view.h"
#include "support/canvas.h"
#include "support/stars/canvas.h"
#include "support/test.h"

enum { SIDE = 301, FINE = 150, WAVES = 13, POINTS = 3 };

static int32_t linear[3 * SIDE * SIDE], again[3 * SIDE * SIDE];
static double amplitude[2 * FINE][2 * FINE], all_light;

/* A stop of eight blades, and its dirt. */
struct stop {
    struct glint_setup setup;
    struct glint_dirt *dirt;
    struct glint_smear smear;
    struct glint_star_tables *tables;
};

static void open_stop_with_iris(struct stop *s, const struct glint_iris *iris,
                                double airy_px)
{
    struct glint_star_optics o = {.n_blades = 8,
                                  .has_core = true,
                                  .rotation_deg = 10,
                                  .f_number = airy_px / 0.55,
                                  .pixel_um = 1};
    struct glint_error error;

    memset(s, 0, sizeof *s);
    s->setup.opening = s->setup.clear = 1;
    s->setup.n_blades = 8;
    s->setup.blade_rotation_deg = 10;
    s->setup.n_wavelengths = 1;
    s->setup.direct_flux[0] = 1;
    assert_ok(glint_setup_iris(&s->setup, iris, &s->dirt, &error));
    assert_ok(glint_smear_init(&s->smear, &s->setup));
    o.smear = s->smear.sum ? &s->smear : NULL;
    assert_ok(glint_star_tables_make(&s->tables, &o));
}

static void free_stop(struct stop *s)
{
    glint_star_tables_free(s->tables);
    glint_smear_finish(&s->smear);
    glint_dirt_free(s->dirt);
}

static void draw_star_of_stop(const struct stop *s, double power_log2,
                              int32_t *to)
{
    struct star_canvas canvas;
    const struct glint_star_light light =
        star_canvas_make_light(150.3, 150.6, power_log2);

    star_canvas_open(&canvas, SIDE, SIDE, 5, 1, 0);
    star_canvas_draw_light(&canvas, s->tables, &light, 1, glint_real_of(0),
                           GLINT_LINEAR_Q20, to);
    star_canvas_close(&canvas);
}

/* -------------------------------------------------------- direct summation */

/* Samples the amplitudes of the stop, and integrates their squares. */
static void set_stop_amplitudes(const struct stop *s)
{
    all_light = 0;
    for (int j = 0; j < 2 * FINE; j++)
        for (int i = 0; i < 2 * FINE; i++) {
            double in = 0, light = 0;

            for (int k = 0; k < 16; k++) {
                const double x = (i + (k % 4 + 0.5) / 4 - FINE) / FINE;
                const double row = k / 4;
                const double y = (j + (row + 0.5) / 4 - FINE) / FINE;

                if (glint_iris_compute_edge_distance(&s->dirt->sides, x, y) < 0)
                    continue;
                in += 1.0 / 16;
                light += sqrt(glint_dirt_light(s->dirt, x, y)) / 16;
            }
            amplitude[j][i] = light;
            all_light += light * light / (in > 0 ? in : 1) / (FINE * FINE);
        }
}

/* Returns the power spectrum |G|^2 of the stop's amplitudes at the frequency
 * (QX, QY). */
static double compute_power_spectrum(double qx, double qy)
{
    const double step = -2 * GLINT_PI / FINE;
    double re = 0, im = 0;

    for (int j = 0; j < 2 * FINE; j++) {
        const double c = cos(step * qx), s = sin(step * qx);
        const double phase = step * qy * (j + 0.5 - FINE);
        double wave_re = cos(-step * qx * (FINE - 0.5)), row_re = 0;
        double wave_im = sin(-step * qx * (FINE - 0.5)), row_im = 0;

        for (int i = 0; i < 2 * FINE; i++) {
            const double next = wave_re * c - wave_im * s;

            row_re += amplitude[j][i] * wave_re;
            row_im += amplitude[j][i] * wave_im;
            wave_im = wave_re * s + wave_im * c;
            wave_re = next;
        }
        re += row_re * cos(phase) - row_im * sin(phase);
        im += row_re * sin(phase) + row_im * cos(phase);
    }
    return (re * re + im * im) / pow(FINE, 4);
}

/* Returns the green light, by direct summation, of the pixel at the offset (X,
 * Y) from the light; y points down. */
static double sum_pixel_directly(double x, double y, double airy_px)
{
    double sum = 0, weights = 0;

    for (int w = 0; w < WAVES; w++) {
        const double nm = 400 + 300 * (w + 0.5) / WAVES;
        const double a = airy_px * nm / 550;
        double rgb[3];

        glint_observer_compute_rgb(nm, rgb);
        weights += rgb[1];
        for (int k = 0; k < POINTS * POINTS; k++) {
            const int row = k / POINTS;
            const double at_x = x + (k % POINTS + 0.5) / POINTS - 0.5;
            const double at_y = y + (row + 0.5) / POINTS - 0.5;

            sum += rgb[1] *
                   compute_power_spectrum(at_x / (2 * a), -at_y / (2 * a)) /
                   (4 * a * a * all_light * POINTS * POINTS);
        }
    }
    return sum / weights;
}

/* Compares stars with direct summation, near the light and further out. */
TEST(stars_match_direct_summation)
{
    const struct glint_iris iris = {.dust = 0.1, .dust_seed = 4};
    const double airy_px = 1, power_log2 = 9;
    const int n = 24;
    struct stop s;
    double squares = 0, most = 0;

    open_stop_with_iris(&s, &iris, airy_px);
    set_stop_amplitudes(&s);
    draw_star_of_stop(&s, power_log2, linear);
    for (int k = 0; k < n; k++) {
        const double r = 6 * exp2(k * 2.5 / n), phi = 2.4 * k;
        const int x = (int)(150.3 + r * cos(phi));
        const int y = (int)(150.6 + r * sin(phi));
        const double light =
            exp2(power_log2) *
            sum_pixel_directly(x + 0.5 - 150.3, y + 0.5 - 150.6, airy_px);
        const double off = canvas_encode_srgb_exactly(
                               linear[3 * (y * SIDE + x) + 1] * 0x1p-20) -
                           canvas_encode_srgb_exactly(light);

        squares += off * off / n;
        most = fmax(most, fabs(off));
    }
    printf("smear: %.1f dB against direct summation, %.1f codes at most\n",
           10 * log10(255 * 255 / squares), most);
    assert_true(10 * log10(255 * 255 / squares) > 40);
    free_stop(&s);
}

/* Checks that the total light of the star does not depend on the size of the
 * pattern. */
TEST(total_light_does_not_depend_on_size)
{
    const struct glint_iris iris = {.dust = 0.2, .dust_seed = 7};

    for (int k = 0; k < 3; k++) {
        const double airy_px = 0.1 * (1 << 2 * k);
        struct glint_psf psf;
        struct stop s;
        double sum = 0, beyond;

        open_stop_with_iris(&s, &iris, airy_px);
        draw_star_of_stop(&s, 10, linear);
        for (int i = 1; i < 3 * SIDE * SIDE; i += 3)
            sum += linear[i] * 0x1p-30;
        assert_ok(glint_psf_init(&psf, 8, 10, airy_px));
        /* The circle outside which light counts here has the area of the
         * image. */
        beyond = s.smear.clear *
                     glint_psf_compute_light_beyond(&psf, 0.564 * SIDE, 1) +
                 glint_smear_compute_light_beyond(&s.smear, &psf, airy_px,
                                                  0.564 * SIDE, 1);
        printf("smear: %.4f of the light, %.4f of it beyond the picture\n",
               sum + beyond, beyond);
        assert_true(fabs(sum + beyond - 1) < 0.01);
        glint_psf_finish(&psf);
        free_stop(&s);
    }
}

TEST(image_is_bit_identical)
{
    const struct glint_iris iris = {.dust = 0.05, .dust_seed = 3};
    const struct glint_star_light light =
        star_canvas_make_light(80.2, 33.9, 14);
    struct stop s;

    open_stop_with_iris(&s, &iris, 0.5);
    for (int k = 3; k <= 6; k++) {
        struct star_canvas canvas;

        star_canvas_open(&canvas, SIDE, SIDE, k, 1 + k % 3, (uint32_t)k);
        star_canvas_draw_light(&canvas, s.tables, &light, 1,
                               glint_real_of(1e-5), GLINT_LINEAR_Q20,
                               k == 3 ? linear : again);
        star_canvas_close(&canvas);
        if (k > 3)
            assert_memory_equal(again, linear, sizeof linear);
    }
    free_stop(&s);
}

/* Checks that a white mask gives the same star as no mask, and that a black
 * mask gives no smear. */
TEST(white_mask_is_no_mask)
{
    uint8_t mask[4] = {255, 255, 255, 255};
    const struct glint_iris iris = {
        .mask = mask, .mask_width = 2, .mask_height = 2};
    struct stop s;

    open_stop_with_iris(&s, &iris, 0.5);
    assert_true(fabs(s.smear.clear - 1) < 1e-9);
    assert_true(fabs(glint_smear_integrate_within(&s.smear, 100)) < 1e-9);
    free_stop(&s);
    memset(mask, 0, sizeof mask);
    open_stop_with_iris(&s, &iris, 0.5);
    assert_null(s.smear.sum);
    free_stop(&s);
}

/* Checks that a mask with a hole gives the diffraction pattern of the hole: the
 * smaller the hole, the larger the first dark ring. */
TEST(smaller_hole_gives_a_wider_ring)
{
    enum { N = 128 };
    uint8_t mask[N * N];
    const struct glint_iris iris = {
        .mask = mask, .mask_width = N, .mask_height = N};
    struct stop s;
    double least = 1, dark = 0;

    for (int i = 0; i < N * N; i++)
        mask[i] = hypot(i % N - 63.5, i / N - 63.5) < N / 8.0 ? 255 : 0;
    open_stop_with_iris(&s, &iris, 3);
    assert_true(s.smear.clear < 1e-6);
    draw_star_of_stop(&s, 12, linear);
    for (int r = 4; r < 25; r++) {
        const double light =
            star_canvas_green(linear, SIDE, 150.3 + r, 150.6) * r * r;

        if (light < least || r == 4) {
            least = light;
            dark = r;
        }
    }
    printf("smear: dark at %.0f px\n", dark);
    /* radius of the first dark ring: 1.22 * 3 px * 4 */
    assert_true(fabs(dark - 14.64) < 1.6);
    free_stop(&s);
}
