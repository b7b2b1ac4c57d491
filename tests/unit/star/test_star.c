/* SPDX-License-Identifier: MIT
 *
 * Compares the tables of the starburst with direct summation in double
 * precision, and checks that the star changes continuously as it moves and
 * rotates.
 */
#include "engine/setup/spectrum.h"
#include "engine/star/core_table.h"
#include "engine/star/psf.h"
#include "engine/star/star_tables.h"
#include "glint/view.h"
#include "support/canvas.h"
#include "support/stars/canvas.h"
#include "support/test.h"

enum { WIDTH = 97, HEIGHT = 83, N = 3 * WIDTH * HEIGHT };

/* Draws N lights into LINEAR_Q20, linear light, leaving out light below
 * FAINTEST. Returns the reported number of lit pixels. */
static double draw_down_to_faintest_light(const struct glint_star_tables *t,
                                          const struct glint_star_light *lights,
                                          int n, struct glint_real faintest,
                                          int32_t *linear_q20)
{
    struct star_canvas c;
    double pixels;

    star_canvas_open(&c, WIDTH, HEIGHT, 5, 1, 1);
    pixels = (double)star_canvas_draw_light(&c, t, lights, n, faintest,
                                            GLINT_LINEAR_Q20, linear_q20);
    star_canvas_close(&c);
    return pixels;
}

static void draw_lights_linear(const struct glint_star_tables *t,
                               const struct glint_star_light *lights, int n,
                               int32_t *linear_q20)
{
    draw_down_to_faintest_light(t, lights, n, glint_real_of(0), linear_q20);
}

static int32_t linear_q20[N];
static uint8_t codes[N];

/* Returns the sum of channel C over all pixels, divided by 2^10, the power of
 * the light. */
static double sum_channel_of_pixels(const int32_t *q20, int c)
{
    double sum = 0;

    for (int i = c; i < N; i += 3)
        sum += q20[i] * 0x1p-30;
    return sum;
}

static double read_green_light_at(double x, double y)
{
    return star_canvas_green(linear_q20, WIDTH, x, y);
}

/* ---------------------------------------------- spikes, rings, total light */

/* Returns the number of peaks on a circle of RADIUS pixels that are brighter
 * than twice the mean of the circle. */
static int count_spikes_on_circle(double radius)
{
    enum { STEPS = 720 };
    double ring[STEPS], mean = 0;
    int n = 0, is_in = 0;

    for (int i = 0; i < STEPS; i++) {
        const double a = 2 * GLINT_PI * (i + 0.5) / STEPS;

        ring[i] =
            read_green_light_at(48.5 + radius * cos(a), 41.5 + radius * sin(a));
        mean += ring[i] / STEPS;
    }
    for (int i = 0; i < 2 * STEPS; i++) {
        const int above = ring[i % STEPS] > 2 * mean;

        n += i >= STEPS && above && !is_in;
        is_in = above;
    }
    return n;
}

TEST(even_and_odd_blades_give_their_spikes)
{
    static const int blades[] = {3, 5, 6, 7, 8, 9};

    for (int i = 0; i < 6; i++) {
        const int n = blades[i];
        struct glint_star_tables *t = star_canvas_make_tables(n, 11, 0.3);
        const struct glint_star_light light =
            star_canvas_make_light(48.5, 41.5, 10);

        draw_lights_linear(t, &light, 1, linear_q20);
        assert_int_equal(count_spikes_on_circle(32), n % 2 ? 2 * n : n);
        glint_star_tables_free(t);
    }
}

/* Checks that the first dark ring of a round stop has a radius of 1.21967 times
 * wavelength times f-number. */
TEST(first_dark_ring_of_a_circle)
{
    double dark = 0, least = 1;

    for (double x = 0.9; x < 1.5; x += 1e-4) {
        const double light = glint_psf_compute_pattern(0, 0, x / 2, 0);

        dark = light < least ? x : dark;
        least = fmin(least, light);
    }
    assert_true(fabs(dark / 1.21967 - 1) < 1e-3);
}

/* Checks the dark ring in an image, which sums all wavelengths: measured in
 * green, it must be that of 550 nm. */
TEST(drawn_dark_ring_is_that_of_550_nm)
{
    struct glint_star_tables *t = star_canvas_make_tables(0, 0, 5);
    const struct glint_star_light light =
        star_canvas_make_light(48.5, 41.5, 10);
    double dark = 0, least = 1e9;

    draw_lights_linear(t, &light, 1, linear_q20);
    for (double r = 4; r < 9; r += 0.01) {
        double here = 0;

        for (int i = 0; i < 64; i++) {
            const double a = 2 * GLINT_PI * i / 64;

            here +=
                read_green_light_at(48.5 + r * cos(a), 41.5 + r * sin(a)) / 64;
        }
        dark = here < least ? r : dark;
        least = fmin(least, here);
    }
    print_message("first dark ring at %.3f px\n", dark);
    assert_true(fabs(dark / (1.22 * 5) - 1) < 0.01);
    glint_star_tables_free(t);
}

/* Checks that the light inside the image and the computed light outside it sum
 * to the total. */
TEST(light_sums_to_the_total)
{
    static const int blades[] = {0, 3, 5, 8, 64};
    static const double airy_px[] = {0.03, 0.12, 0.4, 1.1, 2.5};

    for (int i = 0; i < 25; i++) {
        struct glint_star_tables *t =
            star_canvas_make_tables(blades[i % 5], 5, airy_px[i / 5]);
        const struct glint_star_light light =
            star_canvas_make_light(48.3, 41.7, 10);
        struct glint_psf psf;

        assert_ok(glint_psf_init(&psf, blades[i % 5], 5, airy_px[i / 5]));
        draw_lights_linear(t, &light, 1, linear_q20);
        for (int c = 0; c < 3; c++) {
            /* The light outside the image is about the light outside a circle
             * of 48 pixels. */
            const double beyond = glint_psf_compute_light_beyond(&psf, 48, c);

            assert_true(
                fabs(sum_channel_of_pixels(linear_q20, c) + beyond - 1) < 0.01);
        }
        glint_psf_finish(&psf);
        glint_star_tables_free(t);
    }
}

/* -------------------------------------------------------- direct summation */

enum { WAVES = 48 };

/* Sets RGB to the light of a pixel at the offset (X, Y) from the lamp, averaged
 * over POINTS x POINTS points. */
static void sum_pixel_directly(int n_blades, double rotation_deg,
                               double airy_px, double x, double y, int points,
                               double rgb[3])
{
    const double area =
        n_blades ? 0.5 * n_blades * sin(2 * GLINT_PI / n_blades) : GLINT_PI;
    double weight[WAVES][3], sum[3] = {0, 0, 0};

    for (int i = 0; i < WAVES; i++) {
        glint_observer_compute_rgb(400 + 300 * (i + 0.5) / WAVES, weight[i]);
        for (int c = 0; c < 3; c++)
            sum[c] += weight[i][c];
    }
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int p = 0; p < points * points; p++) {
        const double px = x + (p % points + 0.5) / points - 0.5;
        const double py = y + (p / points + 0.5) / points - 0.5;

        for (int i = 0; i < WAVES; i++) {
            const double a = airy_px * (400 + 300 * (i + 0.5) / WAVES) / 550;
            const double light =
                glint_psf_compute_pattern(n_blades, rotation_deg, px / (2 * a),
                                          -py / (2 * a)) *
                area / (4 * a * a) / (points * points);

            for (int c = 0; c < 3; c++)
                rgb[c] += weight[i][c] / sum[c] * light;
        }
    }
}

/* Returns whether pixel I is summed directly: every second pixel is, in a
 * chessboard pattern; the others stay 0. */
static bool is_pixel_summed_directly(int i)
{
    return (i % WIDTH + i / WIDTH) % 2 == 0;
}

static void sum_picture_directly(int n_blades, double rotation_deg,
                                 double airy_px, int points,
                                 double (*direct)[3])
{
    for (int i = 0; i < N / 3; i++) {
        const double x = i % WIDTH + 0.5 - 30.3, y = i / WIDTH + 0.5 - 25.6;
        const double r = hypot(x, y);
        const int times = r < 2 ? 8 : r < 6 ? 2 : 1;

        if (is_pixel_summed_directly(i))
            sum_pixel_directly(n_blades, rotation_deg, airy_px, x, y,
                               points * times, direct[i]);
    }
}

/* Checks that images of three stops at three powers have a PSNR of at least 50
 * dB. In these small images all pixels are near the light. In 1080p, the same
 * errors would give a PSNR 24 dB higher. */
TEST(images_match_direct_summation)
{
    static const struct {
        int n_blades;
        double rotation_deg, airy_px;
    } stop[] = {{8, 10, 0.65}, {5, 7, 0.9}, {0, 0, 0.3}};
    static const double power_log2[] = {4, 8, 12};
    const struct glint_real least = glint_real_of(1 / 255.0 / 12.92 / 8);
    double(*direct)[3] = malloc(N / 3 * sizeof *direct);
    const int points = getenv("GLINT_QUICK") ? 2 : 4;
    struct star_canvas c;

    assert_non_null(direct);
    star_canvas_open(&c, WIDTH, HEIGHT, 4, 1, 1);
    for (int k = 0; k < 9; k++) {
        const int s = k / 3, p = k % 3, n = stop[s].n_blades;
        struct glint_star_tables *t =
            star_canvas_make_tables(n, stop[s].rotation_deg, stop[s].airy_px);
        const struct glint_star_light light =
            star_canvas_make_light(30.3, 25.6, power_log2[p]);
        double square = 0, db;

        if (p == 0)
            sum_picture_directly(n, stop[s].rotation_deg, stop[s].airy_px,
                                 points, direct);
        star_canvas_draw_light(&c, t, &light, 1, least, GLINT_RGB24, codes);
        for (int i = 0; i < N; i++)
            square +=
                is_pixel_summed_directly(i / 3)
                    ? pow(codes[i] - canvas_encode_srgb(direct[i / 3][i % 3] *
                                                        exp2(power_log2[p])),
                          2)
                    : 0;
        db = 10 * log10(255.0 * 255 * N / 2 / square);
        print_message("%d blades, %g px, 2^%g: %.1f dB\n", n, stop[s].airy_px,
                      power_log2[p], db);
        assert_true(db > (points == 4 ? 50 : 45));
        glint_star_tables_free(t);
    }
    star_canvas_close(&c);
    free(direct);
}

/* Measures a line across the spike, 30 px right of the lamp. Returns the total
 * light of the line. Sets *WIDTH to the number of its pixels that are at least
 * half as bright as its middle. */
static double measure_spike_profile(double *width)
{
    double sum = 0;

    *width = 0;
    for (int i = -140; i <= 140; i++) {
        const double light = read_green_light_at(60.5, 41.5 + 0.1 * i);

        sum += light * 0.1;
        *width += light > 0.5 * read_green_light_at(60.5, 41.5) ? 0.1 : 0;
    }
    return sum;
}

/* Checks that a lamp that is a disc has a spike as wide as the disc, with as
 * much light as the spike of a point lamp. */
TEST(wide_lamp_widens_its_spikes)
{
    struct glint_star_tables *t = star_canvas_make_tables(4, 45, 0.5);
    struct glint_star_light light = star_canvas_make_light(30.5, 41.5, 10);
    double width[2], sum[2];

    for (int i = 0; i < 2; i++) {
        light.radius_q8 = i * 4 * 256;
        draw_lights_linear(t, &light, 1, linear_q20);
        sum[i] = measure_spike_profile(&width[i]);
    }
    print_message("a spike is %.1f px wide, of a disc %.1f, with %.3f times "
                  "the light\n",
                  width[0], width[1], sum[1] / sum[0]);
    assert_true(width[0] > 0.8 && width[0] < 2);
    assert_true(fabs(width[1] / (1.73 * 4) - 1) < 0.12);
    assert_true(fabs(sum[1] / sum[0] - 1) < 0.12);
    glint_star_tables_free(t);
}

/* Returns the max relative difference between the drawn light of a lamp of
 * power 2^25 at PLACE and the star's tables. */
static double measure_max_relative_difference(const struct glint_star_tables *t,
                                              const double place[2])
{
    double most = 0;

    for (int k = 0; k < N / 3; k++) {
        double rgb[3];

        glint_star_evaluate_far_tables(t, k % WIDTH + 0.5 - place[0],
                                       k / WIDTH + 0.5 - place[1], rgb);
        for (int c = 0; c < 3; c++) {
            const double want = fmin(rgb[c] * 0x1p45, 0x1p31);

            most =
                fmax(most, fabs(linear_q20[3 * k + c] - want) / (want + 256));
        }
    }
    return most;
}

/* Checks that pixels far from the light, which are interpolated, are within 3 %
 * of the tables. */
TEST(distant_pixels_match_the_tables)
{
    static const double place[][2] = {
        {-60, 41}, {-250.3, 20}, {48, -180}, {300, 400}, {-2000, 900}};
    double most = 0;

    for (int n = 3; n <= 8; n += 5) {
        struct glint_star_tables *t = star_canvas_make_tables(n, 13 * n, 0.4);

        for (int i = 0; i < 5; i++) {
            const struct glint_star_light light =
                star_canvas_make_light(place[i][0], place[i][1], 25);

            draw_lights_linear(t, &light, 1, linear_q20);
            most = fmax(most, measure_max_relative_difference(t, place[i]));
        }
        glint_star_tables_free(t);
    }
    print_message("light far out is off by %.4f at most\n", most);
    assert_true(most < 0.03);
}

/* Returns the number of pixels with a channel of at least LEAST. */
static int count_lit_pixels(int32_t least_q20)
{
    int n = 0;

    for (int i = 0; i < N; i += 3)
        n += linear_q20[i] >= least_q20 || linear_q20[i + 1] >= least_q20 ||
             linear_q20[i + 2] >= least_q20;
    return n;
}

/* Checks the predicted number of pixels of a star: for a round stop, 0.75 to
 * 1.2 times the number of pixels that are as bright as LEAST; for six blades,
 * 0.9 to 2 times the number of lit pixels, as those of spikes are counted
 * twice. */
TEST(predicts_the_number_of_pixels)
{
    static const double place[][2] = {{48, 41}, {0, 0}, {-6, 60}};
    const struct glint_real least = {1 << 30, -30 - 12};

    for (int n = 0; n <= 6; n += 6) {
        struct glint_star_tables *t = star_canvas_make_tables(n, 11, 0.3);

        for (int i = 0; i < 3; i++) {
            struct glint_star_light light =
                star_canvas_make_light(place[i][0], place[i][1], 8);
            double times;

            light.radius_q8 = 0;
            times =
                draw_down_to_faintest_light(t, &light, 1, least, linear_q20);
            times /= count_lit_pixels(n ? 1 : 1 << 8);
            print_message("%d blades: %.2f times the pixels that are lit\n", n,
                          times);
            assert_true(n ? times > 0.9 && times < 2
                          : times > 0.75 && times < 1.2);
        }
        glint_star_tables_free(t);
    }
}

/* Checks the prediction for a light that is so far away and so strong that its
 * halo covers all pixels. */
TEST(predicts_the_pixels_of_a_distant_light)
{
    const struct glint_real least = {1 << 30, -30 - 20};
    struct glint_star_tables *t = star_canvas_make_tables(0, 0, 4);
    struct glint_star_light light = star_canvas_make_light(-12000, 41, 30);
    double predicted;

    light.radius_q8 = 0;
    predicted = draw_down_to_faintest_light(t, &light, 1, least, linear_q20);
    assert_true(count_lit_pixels(1) == WIDTH * HEIGHT);
    assert_true(predicted > 0.5 * WIDTH * HEIGHT);
    glint_star_tables_free(t);
}

/* Checks that what is left out is not much brighter than LEAST, also near
 * lines, from which the halo first rises and then falls. */
TEST(only_faint_light_is_left_out)
{
    const struct glint_real least = {1 << 30, -30 - 15};
    static int32_t all_q20[N];
    int32_t most_q20 = 0;
    int n_left_out = 0;

    for (int i = 0; i < 36; i++) {
        struct glint_star_tables *t = star_canvas_make_tables(
            i % 2 ? 8 : 5, 13, (const double[]){0.6, 2, 6}[i / 2 % 3]);
        struct glint_star_light light =
            star_canvas_make_light(10.3, 12.8, 8 + i / 6 * 3);

        light.radius_q8 = i % 4 ? 300 : 2000;
        draw_lights_linear(t, &light, 1, all_q20);
        draw_down_to_faintest_light(t, &light, 1, least, linear_q20);
        for (int k = 0; k < N; k++) {
            const int32_t less = all_q20[k] - linear_q20[k];

            n_left_out += less > 0;
            most_q20 = less > most_q20 ? less : most_q20;
        }
        glint_star_tables_free(t);
    }
    print_message("%d samples lack light, at most %d / 2^20\n", n_left_out,
                  most_q20);
    assert_true(n_left_out > 1000 && most_q20 <= 80);
}

/* ------------------------------------------------------------------ motion */

/* Moves a light by 0.05 pixels per frame. Checks that neither the total light
 * nor any pixel changes abruptly. */
TEST(moving_light_causes_no_jump)
{
    struct glint_star_tables *t = star_canvas_make_tables(7, 3, 0.2);
    static int32_t last_q20[N];
    double least = 2, most = 0, jump = 0, peak = 0;

    for (int frame = 0; frame < 200; frame++) {
        const struct glint_star_light light =
            star_canvas_make_light(40 + 0.05 * frame, 41.2 + 0.013 * frame, 10);
        double sum;

        draw_lights_linear(t, &light, 1, linear_q20);
        sum = sum_channel_of_pixels(linear_q20, 1);
        least = fmin(least, sum);
        most = fmax(most, sum);
        for (int i = 0; i < N; i++) {
            peak = fmax(peak, linear_q20[i]);
            if (frame)
                jump = fmax(jump, abs(linear_q20[i] - last_q20[i]));
        }
        memcpy(last_q20, linear_q20, sizeof last_q20);
    }
    print_message("light of a star that moves: %.4f to %.4f; a pixel by %.3f "
                  "of the brightest at most\n",
                  least, most, jump / peak);
    assert_true(most - least < 0.002);
    /* The core of the star is 0.3 px wide: a sixth of its light may move from
     * one pixel to the next. */
    assert_true(jump / peak < 0.16);
    glint_star_tables_free(t);
}

/* Returns the angle of the spike nearest to ANGLE_DEG, degrees; y points up. */
static double find_spike_angle_deg(double angle_deg)
{
    double sum = 0, turn = 0;

    for (double d = -8; d <= 8; d += 0.05) {
        const double a = (angle_deg + d) * GLINT_PI / 180;
        double light = 0;

        for (double r = 20; r < 36; r += 0.25)
            light += read_green_light_at(48.5 + r * cos(a), 41.5 - r * sin(a));
        sum += light;
        turn += d * light;
    }
    return angle_deg + turn / sum;
}

TEST(spikes_rotate_with_the_stop)
{
    const struct glint_star_light light =
        star_canvas_make_light(48.5, 41.5, 10);

    for (int n = 5; n <= 8; n++) {
        double angle[2];

        for (int i = 0; i < 2; i++) {
            struct glint_star_tables *t =
                star_canvas_make_tables(n, 20 + i, 0.3);

            draw_lights_linear(t, &light, 1, linear_q20);
            angle[i] = find_spike_angle_deg(20.5 + 180.0 / n);
            glint_star_tables_free(t);
        }
        assert_true(fabs(angle[0] - 20 - 180.0 / n) < 0.1);
        assert_true(fabs(angle[1] - angle[0] - 1) < 0.1);
    }
}
