/* SPDX-License-Identifier: MIT
 *
 * Tests caustics: the total light and the brightness of folds must be right,
 * for ghosts that are in focus, are points, or are a hundred times larger than
 * the frame.
 */
#include "support/extreme.h"
#include "support/stage.h"
#include "support/test.h"

enum { W = 144, H = 96, N = 3 * W * H };

static struct stage stage;
static float test[N], exact[N];

static double find_peak_light(const float *rgb)
{
    double most = 0;

    for (int i = 0; i < N; i++)
        most = fmax(most, (double)rgb[i]);
    return most;
}

/* Checks that the total light of all ghosts, including folds and foci, equals
 * that of the exact image within 1 %, as outlines are displaced by 0.1 pixel
 * and ghosts are about twenty pixels wide. The irradiance at the edge of a fold
 * is unbounded. Pixels average it; there the grid may deviate by 10 %. */
TEST(folded_ghosts_keep_their_light)
{
    double flux = 0, high = 0;

    assert_true(stage_load_lens(&stage, "heliar-tronnier"));
    assert_true(stage_set_up_lens(&stage, 8) &&
                stage_bake_or_load_model(&stage, 1, 60));
    stage_set_view(&stage, W, H, 0);
    for (int k = 0; k < 4; k++) {
        const struct glint_lamp lamp = stage_make_lamp(3.1 * k, 40 * k, 1);

        assert_true(stage_draw_linear(&stage, &lamp, 1, test));
        assert_true(stage_draw_exact(&stage, &lamp, 1, 192, exact));
        flux = fmax(flux, fabs(stage_sum_image(&stage, test) /
                                   stage_sum_image(&stage, exact) -
                               1));
        high = fmax(high, find_peak_light(test) / find_peak_light(exact) - 1);
    }
    assert_at_most("caustics: all ghosts of the Heliar, flux", flux, 0.01, "");
    assert_at_most("caustics: brightest pixel, above the exact one", high, 0.1,
                   "");
}

/* Makes a lens that has a single ghost, with its sensor GAP_MM behind the
 * stop. */
static void open_singlet_with_gap(double gap_mm, double f_number)
{
    char text[300];

    snprintf(text, sizeof text,
             "name singlet\nf-number %g\nfilm 36 24\n"
             "surface 60 4 9 1.5168 64.17\n"
             "surface -60 1 9 air\n"
             "stop 50 8\n",
             f_number);
    stage_free(&stage);
    assert_true(stage_parse_lens(&stage, text));
    stage.lens.stop_thickness_mm = gap_mm;
    assert_true(stage_set_up_lens(&stage, 0));
}

/* Returns the distance behind the stop, mm, at which paraxial rays of the ghost
 * meet; behind the stop rays are straight. */
static double compute_ghost_focus_mm(void)
{
    const struct glint_ghost ghost = {0, 1};
    const double along[3] = {0, 0, 1};
    double x[2];

    for (int k = 0; k < 2; k++) {
        struct glint_path path;
        struct glint_ray ray;

        open_singlet_with_gap(5 + k, 16);
        glint_path_init(&path, &stage.lens, &ghost, 532);
        assert_int_equal(glint_trace(&path, 0.1, 0, along, &ray, NULL),
                         GLINT_RAY_OK);
        x[k] = ray.sensor_x_mm;
    }
    return 5 + x[0] / (x[0] - x[1]);
}

/* Checks a ghost whose paraxial rays meet on the sensor: a point with a halo of
 * aberrations. 6 % of the light may be missing: next to the outermost part of
 * the halo, rays are totally reflected, and cells with two invalid
 * corners are not drawn. */
TEST(focused_ghost_keeps_its_light)
{
    double flux = 0;

    open_singlet_with_gap(compute_ghost_focus_mm(), 16);
    stage_set_view(&stage, W, H, 36);
    for (int k = 0; k < 6; k++) {
        const struct glint_lamp lamp = stage_make_lamp(1 + 0.11 * k, 31 * k, 1);

        assert_true(stage_draw_linear(&stage, &lamp, 1, test));
        assert_true(stage_draw_exact(&stage, &lamp, 1, 256, exact));
        assert_true(stage_sum_image(&stage, exact) > 0);
        flux = fmax(flux, fabs(stage_sum_image(&stage, test) /
                                   stage_sum_image(&stage, exact) -
                               1));
    }
    assert_at_most("caustics: a ghost in focus, flux", flux, 0.06, "");
}

/* Returns the sum of the 7 x 7 pixels centred at pixel AT. */
static double sum_pixels_around(const float *rgb, int at)
{
    double sum = 0;

    for (int y = at / W - 3; y <= at / W + 3; y++)
        for (int x = at % W - 3; x <= at % W + 3; x++)
            for (int c = 0; c < 3; c++)
                sum += (double)rgb[3 * (y * W + x) + c];
    return sum;
}

static int find_brightest_pixel(const float *rgb)
{
    int most = 0;

    for (int i = 0; i < N; i++)
        most = rgb[i] > rgb[most] ? i : most;
    return most / 3;
}

/* Checks the light of a ghost that is a point when stopped down, with cells
 * smaller than 1/256 pixel, the precision of cell corners. Compares only the
 * light around the point: rays near total reflection scatter faint light far
 * away, for which the exact image would need a grid of a thousand cells. Allows
 * 2 %, as at f/400 the exact grid has only six rays across the stop. Images by
 * exact rays, which are interpolated, lose up to 6.3 % there. */
TEST(ghost_smaller_than_corner_precision_keeps_its_light)
{
    static const double f_number[] = {80, 150, 400};
    const double focus = compute_ghost_focus_mm();
    /* max errors of: exact rays; models; exact rays at f/400 */
    double apart[3] = {0, 0, 0};

    for (int k = 0; k < 6; k++) {
        const int modelled = k & 1;
        const int which = k == 4 ? 2 : modelled;

        open_singlet_with_gap(focus, f_number[k / 2]);
        assert_true(!modelled || stage_bake_or_load_model(&stage, 1, 3));
        stage_set_view(&stage, W, H, 36);
        for (int i = 0; i < 3; i++) {
            const struct glint_lamp lamp =
                stage_make_lamp(1 + 0.11 * i, 31 * i, 1);
            double want;
            int at;

            assert_true(stage_draw_linear(&stage, &lamp, 1, test));
            assert_true(stage_draw_exact(&stage, &lamp, 1, 512, exact));
            at = find_brightest_pixel(exact);
            want = sum_pixels_around(exact, at);
            assert_true(want > 0);
            apart[which] = fmax(apart[which],
                                fabs(sum_pixels_around(test, at) / want - 1));
        }
    }
    assert_at_most("caustics: a ghost that is a point, exact rays, flux",
                   apart[0], 0.02, "");
    assert_at_most("caustics: the same at f/400, flux", apart[2], 0.07, "");
    assert_at_most("caustics: a ghost that is a point, model, flux", apart[1],
                   0.02, "");
}

/* Checks a frame that shows a hundredth of a ghost: a few cells that are
 * thousands of pixels wide have the light of the exact image. */
TEST(huge_ghost_has_the_light_of_exact_rays)
{
    const struct glint_lamp lamp = stage_make_lamp(2, 33, 1);
    struct glint_measure m;

    open_singlet_with_gap(90, 16);
    assert_true(stage_bake_or_load_model(&stage, 4, 3));
    stage_set_view(&stage, W, H, 0.15);
    assert_true(stage_draw_linear(&stage, &lamp, 1, test));
    assert_true(stage_draw_exact(&stage, &lamp, 1, 192, exact));
    m = stage_compare_images(&stage, exact, test);
    assert_true(stage_sum_image(&stage, exact) > 0);
    assert_at_most("caustics: a ghost 100 times the frame, flux",
                   fabs(m.flux - 1), 0.03, "");
    assert_at_least("caustics: a ghost 100 times the frame, against exact",
                    m.psnr_db, 40, "dB");
}

TEST_CLOSE
{
    stage_free(&stage);
}
