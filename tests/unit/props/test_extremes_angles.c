/* SPDX-License-Identifier: MIT
 *
 * Tests extreme angles of lights: on the axis and 1e-6 degrees off it; at the
 * borders of angular zones, which have polynomials of their own; at the angles
 * at which a ghost appears or vanishes; at the largest angles, at all azimuths,
 * and at pixel borders.
 */
#include "support/extreme.h"
#include "support/stage.h"
#include "support/test.h"

enum { W = 240, H = 160, SIDE = 192 };

static struct stage heliar;
static float test[3 * W * H], exact[3 * W * H];
static uint8_t codes[3][3 * W * H];

#define DEGREE 0.017453292519943295

/* Max difference, codes, between the means of 8 x 8 pixels in two images of the
 * same light with different grids. Grids for images of pixel codes have 3/4 of
 * the cells in each direction, so an outline may be displaced by 0.1 / (3/4)^2
 * = 0.18 pixel. Along one side of a block, this changes the mean by 255 * 0.18
 * / 8 codes. */
#define GRID_CODES 5.7

TEST_OPEN
{
    assert_true(stage_load_lens(&heliar, "heliar-tronnier") &&
                stage_set_up_lens(&heliar, 8) &&
                stage_bake_or_load_model(&heliar, 1, 60));
}

static void draw_lamp_codes(struct stage *s, const struct glint_lamp *lamp,
                            uint8_t *to)
{
    memset(to, 0, sizeof codes[0]);
    assert_true(stage_draw_codes(s, lamp, 1, to));
}

static double compare_model_with_exact(struct stage *s,
                                       const struct glint_lamp *lamp)
{
    assert_true(stage_draw_linear(s, lamp, 1, test));
    assert_true(stage_draw_exact(s, lamp, 1, 192, exact));
    return stage_compare_images(s, exact, test).psnr_db;
}

/* ---------------------------------------------------- lights near the axis */

/* Checks that an image with a light on the axis has a PSNR of at least 45 dB,
 * as elsewhere at this size. A light 1e-6 degrees off the axis must give the
 * same image, as its ghosts move by 1e-6 pixel only. Cells whose irradiance is
 * half-way between two steps of 1 % (1.2 codes in bright parts) may be rounded
 * to the other step. */
TEST(lights_near_the_axis_match_exact_rays)
{
    static const double theta[] = {0, 1e-9, 1e-6, 1e-3, 0.1};
    struct glint_lamp lamp = stage_make_lamp(0, 0, 1);
    double worst = 999, jump = 0;

    stage_set_view(&heliar, W, H, 0);
    for (int i = 0; i < 5; i++) {
        lamp = stage_make_lamp(theta[i], 77, 1);
        worst = fmin(worst, compare_model_with_exact(&heliar, &lamp));
    }
    lamp.theta_deg = 0;
    lamp.power = stage_find_exposed_power(&heliar, &lamp);
    draw_lamp_codes(&heliar, &lamp, codes[0]);
    for (int i = 1; i < 3; i++) {
        lamp.theta_deg = theta[i];
        draw_lamp_codes(&heliar, &lamp, codes[1]);
        jump =
            fmax(jump, stage_max_block_difference(&heliar, codes[0], codes[1]));
    }
    assert_at_least("angles: on the axis, and up to 0.1 deg beside", worst, 45,
                    "dB");
    assert_at_most("angles: 1e-6 deg against 0, block mean", jump, 1.2,
                   "codes");
}

/* Checks that for a light on the axis the azimuth changes only the orientation
 * of the grid. */
TEST(azimuth_on_the_axis_rotates_the_grid_only)
{
    struct glint_lamp lamp = stage_make_lamp(0, 0, 1);
    double jump = 0;

    stage_set_view(&heliar, W, H, 0);
    lamp.power = stage_find_exposed_power(&heliar, &lamp);
    draw_lamp_codes(&heliar, &lamp, codes[0]);
    for (int phi = 5; phi < 360; phi += 5) {
        lamp.phi_deg = phi;
        draw_lamp_codes(&heliar, &lamp, codes[1]);
        jump =
            fmax(jump, stage_max_block_difference(&heliar, codes[0], codes[1]));
    }
    assert_at_most("angles: azimuths of a light on the axis", jump, GRID_CODES,
                   "codes");
}

/* ---------------------------------------------------------------- azimuths */

/* Checks that if all light falls inside the image, its sum is the same at all
 * azimuths within 0.5 %: irradiance is rounded to steps, and the outlines of
 * ghosts ten pixels wide are chords. */
TEST(flux_does_not_depend_on_azimuth)
{
    double least = HUGE_VAL, most = 0;

    stage_set_view(&heliar, SIDE, SIDE, 400);
    for (int k = 0; k < 4 * 24; k++) {
        /* includes azimuths close to multiples of 90 degrees */
        const double phi = k % 4 == 0 ? 15.0 * k / 4
                           : k % 4 == 1
                               ? 15.0 * (k / 4) + 1e-9 * (k & 8 ? 1 : -1)
                           : k % 4 == 2 ? 15.0 * (k / 4) + 1e-6
                                        : -15.0 * (k / 4) - 7.3;
        const struct glint_lamp lamp = stage_make_lamp(7.5, phi, 1);
        double flux;

        assert_true(stage_draw_linear(&heliar, &lamp, 1, test));
        flux = stage_sum_image(&heliar, test);
        least = fmin(least, flux);
        most = fmax(most, flux);
    }
    assert_at_most("angles: flux over all azimuths", most / least - 1, 0.005,
                   "");
}

/* The stop, an octagon, and the square image are symmetric. Checks that
 * rotating a light by 90 degrees rotates the image. The rotation exchanges rows
 * and columns, which changes the rounding of edges. */
TEST(quarter_turn_of_the_light_rotates_the_image)
{
    double worst = 0;

    stage_set_view(&heliar, 160, 160, 24);
    for (int k = 0; k < 6; k++) {
        struct glint_lamp lamp = stage_make_lamp(3 + 2 * k, 61 * k, 1);

        lamp.power = stage_find_exposed_power(&heliar, &lamp);
        memset(codes[0], 0, sizeof codes[0]);
        assert_true(stage_draw_codes(&heliar, &lamp, 1, codes[0]));
        for (int turn = 1; turn < 4; turn++) {
            lamp.phi_deg += 90;
            memset(codes[1], 0, sizeof codes[1]);
            assert_true(stage_draw_codes(&heliar, &lamp, 1, codes[1]));
            for (int y = 0; y < 160; y++)
                for (int x = 0; x < 160; x++) {
                    const int to[4][2] = {
                        {x, y}, {y, 159 - x}, {159 - x, 159 - y}, {159 - y, x}};
                    const int at = 3 * (to[turn][1] * 160 + to[turn][0]);

                    memcpy(codes[2] + 3 * (y * 160 + x), codes[1] + at, 3);
                }
            worst = fmax(
                worst, stage_max_block_difference(&heliar, codes[0], codes[2]));
        }
    }
    assert_at_most("angles: quarter turns of the light, block mean", worst, 2,
                   "codes");
}

/* -------------------------------------------------------- borders of zones */

/* Returns a lamp of power POWER at the angle whose sine is SINE_Q30. */
static struct glint_lamp make_light_at_sine(int32_t sine_q30, double power)
{
    return stage_make_lamp(asin(sine_q30 * 0x1p-30) / DEGREE, 33, power);
}

/* Returns whether the angle of sine SINE_Q30 is a border between two zones
 * (ranges of angles) of ghost G. */
static int is_border_between_zones(const struct glint_lens *lens,
                                   const struct glint_model_ghost *g,
                                   int32_t sine_q30)
{
    int ends = 0, begins = 0;

    for (uint32_t k = 0; k < g->n_systems; k++) {
        const struct glint_model_system *s = &lens->system[g->first_system + k];

        ends |= s->sine_hi_q30 == sine_q30;
        begins |= s->sine_lo_q30 == sine_q30;
    }
    return ends && begins;
}

/* Returns the max change of block means, codes, between a light at SINE_Q30 and
 * lights whose sines are 2^-29 smaller and larger. Raises *FLUX to the max
 * relative change of the sum of codes. */
static double measure_jump_of_block_means(int32_t sine_q30, double *flux)
{
    const struct glint_lamp middle = make_light_at_sine(sine_q30, 1);
    const double power = fmin(1e9, stage_find_exposed_power(&heliar, &middle));
    double sum[3], jump = 0;

    for (int k = 0; k < 3; k++) {
        const int32_t at = sine_q30 + 2 * (k - 1);
        const struct glint_lamp lamp =
            make_light_at_sine(at < 0 ? 0 : at, power);

        draw_lamp_codes(&heliar, &lamp, codes[k]);
        sum[k] = 1e-9;
        for (int i = 0; i < 3 * W * H; i++)
            sum[k] += codes[k][i];
        if (k > 0) {
            jump = fmax(jump, stage_max_block_difference(&heliar, codes[k],
                                                         codes[k - 1]));
            *flux = fmax(*flux, fabs(sum[k] / sum[k - 1] - 1));
        }
    }
    return jump;
}

/* Checks the borders of zones, ranges of angles with polynomials of their own.
 * Neighbouring zones are fitted separately (energy within 0.6 %, interpolation
 * between rays 1 %), so an almost white flat part of a ghost may change by 2
 * codes at the border, and by 2 more if one side rounds to the next irradiance
 * step. A ghost appears or vanishes outside the image, so such a border must be
 * invisible. */
TEST(zone_borders_cause_no_jump)
{
    const struct glint_lens *lens;
    double inner = 0, outer = 0, flux = 0, flux_outer = 0;
    int n = 0;

    stage_set_view(&heliar, W, H, 0);
    lens = &heliar.file.lens;
    for (uint32_t g = 0; g < lens->header->n_ghosts; g++)
        for (uint32_t k = 0; k < lens->ghost[g].n_systems; k++) {
            const struct glint_model_ghost *ghost = &lens->ghost[g];
            const struct glint_model_system *s =
                &lens->system[ghost->first_system + k];
            const int32_t border[2] = {s->sine_lo_q30, s->sine_hi_q30};

            for (int e = 0; e < 2; e++) {
                /* the axis is not a border; angles above 30 degrees are not
                 * tested */
                if (border[e] == 0 || border[e] > 0.5 * 0x1p30)
                    continue;
                if (is_border_between_zones(lens, ghost, border[e])) {
                    if (e == 0)
                        /* The zone below this border measures it, as its upper
                         * border. */
                        continue;
                    inner = fmax(inner,
                                 measure_jump_of_block_means(border[e], &flux));
                } else
                    outer = fmax(outer, measure_jump_of_block_means(
                                            border[e], &flux_outer));
                n++;
            }
        }
    print_message("%d borders\n", n);
    assert_true(n > 20);
    assert_at_most("angles: across a zone's border, block mean", inner, 4,
                   "codes");
    assert_at_most("angles: across a zone's border, all codes", flux, 0.002,
                   "");
    assert_at_most("angles: where a ghost begins or ends, block mean", outer,
                   0.5, "codes");
    assert_at_most("angles: where a ghost begins or ends, all codes",
                   flux_outer, 0.001, "");
}

/* ------------------------------------------------------------- wide angles */

/* Checks that the model draws lights up to 60 degrees, that a light at a larger
 * angle is counted but not drawn, and that all pixels up to the horizon are
 * defined. */
TEST(wide_angles_up_to_60_degrees_are_drawn)
{
    static const double theta[] = {59.9, 60, 60.0001, 89, 89.9, 90};
    double worst = 999;

    stage_set_view(&heliar, W, H, 0);
    for (int i = 0; i < 6; i++) {
        const struct glint_lamp lamp = stage_make_lamp(theta[i], 20, 1e6);

        worst = fmin(worst, compare_model_with_exact(&heliar, &lamp));
        assert_int_equal(heliar.drawn.beyond_lights, theta[i] > 60);
        for (int k = 0; k < 3 * W * H; k++)
            assert_true(isfinite(exact[k]) && exact[k] >= 0);
    }
    assert_at_least("angles: 60 to 90 deg, behind a dark field", worst, 60,
                    "dB");
}

/* Checks that images of a ball lens, which sees in all directions, also have a
 * PSNR of 45 dB. */
TEST(ball_lens_matches_exact_rays)
{
    static struct stage ball;
    double worst = 999;
    int lit = 0;

    assert_true(stage_parse_lens(&ball, "name ball\nf-number 4\nfilm 40 30\n"
                                        "surface 6 6 5.9 1.5168 64.17\n"
                                        "stop 6 1.2\n"
                                        "surface -6 2.8 5.9 1.62 36.4\n"
                                        "surface -9 3.2 8.5 air\n"));
    assert_true(stage_set_up_lens(&ball, 8));
    assert_true(stage_bake_or_load_model(&ball, 1, 89));
    stage_set_view(&ball, W, H, 0);
    for (int deg = 10; deg < 90; deg += 13) {
        const struct glint_lamp lamp = stage_make_lamp(deg, 140, 1);
        const double db = compare_model_with_exact(&ball, &lamp);

        lit += stage_sum_image(&ball, exact) > 0;
        worst = fmin(worst, db);
    }
    print_message("%d angles with light\n", lit);
    assert_true(lit >= 3);
    assert_at_least("angles: a ball lens up to 88 deg", worst, 45, "dB");
    stage_free(&ball);
}

/* ----------------------------------------------------------- pixel borders */

/* Checks that a light imaged to the corner of a pixel or tile is drawn as
 * exactly as other lights, and that crossing the corner causes no jump. */
TEST(lights_on_pixel_borders_cause_no_jump)
{
    static const double at[][2] = {{120, 80},  {64, 64},   {128, 64},  {0, 0},
                                   {240, 160}, {64.5, 64}, {63.5, 0.5}};
    const double step = 1.0 / 512;
    double worst = 999, jump = 0;

    stage_set_view(&heliar, W, H, 0);
    for (int i = 0; i < 7; i++) {
        struct glint_lamp lamp = stage_make_lamp(0, 0, 1);

        glint_view_to_angles(&heliar.view, heliar.setup.optics.focal_mm,
                             at[i][0], at[i][1], &lamp);
        worst = fmin(worst, compare_model_with_exact(&heliar, &lamp));
        lamp.power = stage_find_exposed_power(&heliar, &lamp);
        for (int k = 0; k < 2; k++) {
            glint_view_to_angles(&heliar.view, heliar.setup.optics.focal_mm,
                                 at[i][0] + (k ? step : -step),
                                 at[i][1] + (k ? step : -step), &lamp);
            draw_lamp_codes(&heliar, &lamp, codes[k]);
        }
        jump =
            fmax(jump, stage_max_block_difference(&heliar, codes[0], codes[1]));
    }
    assert_at_least("angles: lights on borders of pixels and tiles", worst, 45,
                    "dB");
    /* when a lamp passes the axis, the orientation of the grid changes, too */
    assert_at_most("angles: across the border of a pixel", jump, GRID_CODES,
                   "codes");
}

TEST_CLOSE
{
    stage_free(&heliar);
}
