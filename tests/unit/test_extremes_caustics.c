/* SPDX-License-Identifier: MIT
 *
 * Caustics and sizes: all light of a lens arrives, folds are as bright as they
 * are, a ghost may be in focus or a hundred times larger than the
 * frame.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/extreme.h"
#include "support/stage.h"

enum { W = 144, H = 96, N = 3 * W * H };

static struct stage stage;
static float test[N], exact[N];

static int close_stage(void **state)
{
    (void)state;
    stage_close(&stage);
    return 0;
}

static double peak(const float *rgb)
{
    double most = 0;

    for (int i = 0; i < N; i++)
        most = fmax(most, (double)rgb[i]);
    return most;
}

/* The light of all ghosts, folds and foci among them, adds up to the exact
 * picture's: 1 %, as outlines are 0.1 pixel off and ghosts some twenty pixels
 * wide. A fold's light grows without bound towards
 * its edge, but a pixel has a mean of it, which a grid may miss by a tenth. */
static void test_folds(void **state)
{
    double flux = 0, high = 0;

    (void)state;
    assert_true(stage_load(&stage, "heliar-tronnier"));
    assert_true(stage_prepare(&stage, 8) && stage_model(&stage, 1, 60));
    stage_view(&stage, W, H, 0);
    for (int k = 0; k < 4; k++) {
        const struct glint_lamp lamp = stage_lamp(3.1 * k, 40 * k, 1);

        assert_true(stage_linear(&stage, &lamp, 1, test));
        assert_true(stage_exact(&stage, &lamp, 1, 192, exact));
        flux = fmax(
            flux,
            fabs(stage_flux(&stage, test) / stage_flux(&stage, exact) - 1));
        high = fmax(high, peak(test) / peak(exact) - 1);
    }
    assert_true(extreme_at_most("caustics: all ghosts of the Heliar, flux",
                                flux, 0.01, ""));
    assert_true(extreme_at_most(
        "caustics: brightest pixel, above the exact one", high, 0.1, ""));
}

/* A lens whose one ghost comes to a focus on the sensor, GAP_MM behind it. */
static void open_singlet(double gap_mm)
{
    stage_close(&stage);
    assert_true(stage_parse(&stage, "name singlet\nf-number 16\nfilm 36 24\n"
                                    "surface 60 4 9 1.5168 64.17\n"
                                    "surface -60 1 9 air\n"
                                    "stop 50 8\n"));
    stage.lens.stop_thickness_mm = gap_mm;
    assert_true(stage_prepare(&stage, 0));
}

/* Where rays near the axis meet: they run straight behind the stop. */
static double focus_mm(void)
{
    const struct glint_ghost ghost = {0, 1};
    const double along[3] = {0, 0, 1};
    double x[2];

    for (int k = 0; k < 2; k++) {
        struct glint_path path;
        struct glint_ray ray;

        open_singlet(5 + k);
        glint_path_init(&path, &stage.lens, &ghost, 532);
        assert_int_equal(glint_trace(&path, 0.1, 0, along, &ray, NULL),
                         GLINT_RAY_OK);
        x[k] = ray.sensor_x_mm;
    }
    return 5 + x[0] / (x[0] - x[1]);
}

/* Where rays near the axis meet on the sensor, the middle of the ghost is a
 * point and the rest a halo of its aberrations. 4 to 5 % of the light is
 * missing: cells about the point are smaller than the 1/256 pixel that corners
 * are rounded to, and what has no height has no edges. The bound holds it
 * there. Rays are exact, so that this is the rasteriser's own. */
static void test_focus(void **state)
{
    double flux = 0;

    (void)state;
    open_singlet(focus_mm());
    stage_view(&stage, W, H, 36);
    for (int k = 0; k < 6; k++) {
        const struct glint_lamp lamp = stage_lamp(1 + 0.11 * k, 31 * k, 1);

        assert_true(stage_linear(&stage, &lamp, 1, test));
        assert_true(stage_exact(&stage, &lamp, 1, 128, exact));
        assert_true(stage_flux(&stage, exact) > 0);
        flux = fmax(
            flux,
            fabs(stage_flux(&stage, test) / stage_flux(&stage, exact) - 1));
    }
    assert_true(
        extreme_at_most("caustics: a ghost in focus, flux", flux, 0.06, ""));
}

/* The frame shows a hundredth of the ghost, or nothing: the light of a few
 * cells, drawn thousands of pixels wide, is that of the exact picture. */
static void test_huge(void **state)
{
    const struct glint_lamp lamp = stage_lamp(2, 33, 1);
    struct measure m;

    (void)state;
    open_singlet(90);
    assert_true(stage_model(&stage, 4, 3));
    stage_view(&stage, W, H, 0.15);
    assert_true(stage_linear(&stage, &lamp, 1, test));
    assert_true(stage_exact(&stage, &lamp, 1, 192, exact));
    m = stage_compare(&stage, exact, test);
    assert_true(stage_flux(&stage, exact) > 0);
    assert_true(extreme_at_most("caustics: a ghost 100 times the frame, flux",
                                fabs(m.flux - 1), 0.03, ""));
    assert_true(extreme_at_least("caustics: a ghost 100 times the frame, "
                                 "against exact",
                                 m.psnr_db, 40, "dB"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_folds),
        cmocka_unit_test(test_focus),
        cmocka_unit_test(test_huge),
    };

    return cmocka_run_group_tests_name("extremes: caustics", tests, NULL,
                                       close_stage);
}
