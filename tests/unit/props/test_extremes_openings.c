/* SPDX-License-Identifier: MIT
 *
 * Tests one model at all f-numbers. It is baked for the full aperture, stopped
 * down, and compared with exact images and with models baked at that f-number.
 * While the stop closes to an eleventh of its diameter, as from f/2 to f/22,
 * the image must change continuously.
 */
#include "support/canvas.h"
#include "support/extreme.h"
#include "support/stage.h"
#include "support/test.h"

enum { W = 216, H = 144, BLOCKS = W / 8 * (H / 8) };

#define OPEN_F 5.1

static struct stage stage;
static float drawn[3 * W * H], exact[3 * W * H], native[3 * W * H];

/* A cemented doublet with the stop behind it: three surfaces, three ghosts. */
static const char doublet[] = "name doublet\nf-number 5.1\nfilm 36 24\n"
                              "surface 61.47 6 13 1.5168 64.17\n"
                              "surface -44.64 2.5 13 1.6727 32.21\n"
                              "surface -129.94 2 13 air\n"
                              "stop 93 10\n";

static void open_doublet_wide_open(int n_blades)
{
    stage_free(&stage);
    assert_true(stage_parse_lens(&stage, doublet));
    assert_true(stage_set_up_lens(&stage, n_blades));
    assert_true(stage_bake_or_load_model(&stage, 1, 12));
    stage_set_view(&stage, W, H, 0);
}

/* Draws the lens by a model that was baked at F_NUMBER. */
static void draw_by_model_of_f_number(double f_number, int n_blades,
                                      const struct glint_lamp *lamp)
{
    struct glint_error error;

    stage_free(&stage);
    assert_true(stage_parse_lens(&stage, doublet));
    assert_ok(glint_prescription_set_f_number(&stage.lens, f_number, &error));
    assert_true(stage_set_up_lens(&stage, n_blades));
    assert_true(stage_bake_or_load_model(&stage, 1, 12));
    stage_set_view(&stage, W, H, 0);
    assert_true(stage_draw_linear(&stage, lamp, 1, native));
}

TEST(stopped_down_model_matches_exact_rays)
{
    static const double f[] = {OPEN_F, 5.3, 5.6, 8, 11, 16, 22, 45, 128};
    static const double angle[][2] = {{0.1, 10}, {6, 25}, {11, 80}};
    double worst = 999, flux = 0;
    bool is_near;

    for (int blades = 0; blades <= 8; blades += 8) {
        open_doublet_wide_open(blades);
        for (int k = 0; k < 9; k++) {
            assert_true(stage_stop_down(&stage, f[k]));
            for (int i = 0; i < 3; i++) {
                const struct glint_lamp lamp =
                    stage_make_lamp(angle[i][0], angle[i][1], 1);
                struct glint_measure m;

                assert_true(stage_draw_linear(&stage, &lamp, 1, drawn));
                assert_true(stage_draw_exact(&stage, &lamp, 1, 192, exact));
                m = stage_compare_images(&stage, exact, drawn);
                if (m.psnr_db < 50)
                    print_message("  f/%g at %g: %.1f dB, flux x %.4f\n", f[k],
                                  angle[i][0], m.psnr_db, m.flux);
                worst = fmin(worst, m.psnr_db);
                flux = fmax(flux, fabs(m.flux - 1));
            }
        }
    }
    is_near = extreme_check_at_least(
        "openings: f/5.1 to f/128 of one model, against exact", worst, 50,
        "dB");
    assert_true(
        extreme_check_at_most("openings: the same, flux", flux, 0.01, "") &&
        is_near);
}

/* Checks that a model stopped down to an f-number gives the image of a model
 * baked at that f-number, with at most a third more edges. */
TEST(stopped_down_model_equals_a_native_one)
{
    static const double f[] = {8, 22};
    const struct glint_lamp lamp = stage_make_lamp(6, 25, 1);
    double worst = 999, more = 0;
    bool is_near;

    for (int k = 0; k < 2; k++) {
        int n;

        open_doublet_wide_open(8);
        assert_true(stage_stop_down(&stage, f[k]));
        assert_true(stage_draw_linear(&stage, &lamp, 1, drawn));
        n = stage.drawn.stats.primitives;
        draw_by_model_of_f_number(f[k], 8, &lamp);
        more = fmax(more, (double)n / stage.drawn.stats.primitives);
        worst =
            fmin(worst, stage_compare_images(&stage, native, drawn).psnr_db);
    }
    is_near = extreme_check_at_least(
        "openings: f/8 and f/22 of one model, against one baked there", worst,
        50, "dB");
    assert_true(extreme_check_at_most("openings: the same, edges", more, 1.33,
                                      "times") &&
                is_near);
}

/* Sets MEAN to the means of the green codes over blocks of 8 x 8 pixels. */
static void compute_block_means(const float *rgb, double exposure, double *mean)
{
    memset(mean, 0, BLOCKS * sizeof *mean);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            mean[y / 8 * (W / 8) + x / 8] +=
                canvas_encode_srgb_exactly(exposure *
                                           (double)rgb[3 * (y * W + x) + 1]) /
                64;
}

/* Checks, while the stop closes and ghosts shrink, the error of each block of
 * pixels against the exact image. From frame to frame it may change by at most
 * 1.5 codes, while the blocks of the exact image change by tens of codes. */
TEST(closing_stop_causes_no_jump)
{
    const int frames = extreme_is_long_run() ? 100 : 34;
    const struct glint_lamp lamp = stage_make_lamp(6, 25, 1);
    static double got[2][BLOCKS], want[2][BLOCKS];
    double pop = 0, own = 0, exposure = 1;

    open_doublet_wide_open(8);
    for (int k = 0; k < frames; k++) {
        const double f = OPEN_F * pow(11, k / (frames - 1.0));
        double *now = got[k & 1], *then = got[~k & 1];
        double *exactly = want[k & 1], *before = want[~k & 1];

        assert_true(stage_stop_down(&stage, f));
        assert_true(stage_draw_linear(&stage, &lamp, 1, drawn));
        assert_true(stage_draw_exact(&stage, &lamp, 1, 128, exact));
        if (k == 0)
            exposure = stage_find_exposed_power(&stage, &lamp);
        /* The irradiance of ghosts stays constant while the direct image gets
         * darker. */
        compute_block_means(drawn, exposure * pow(OPEN_F / f, 2), now);
        compute_block_means(exact, exposure * pow(OPEN_F / f, 2), exactly);
        for (int b = 0; k > 0 && b < BLOCKS; b++) {
            const double step = exactly[b] - before[b];

            own = fmax(own, fabs(step));
            pop = fmax(pop, fabs(now[b] - then[b] - step));
        }
    }
    print_message("  largest step of a block: %.2f codes, exactly\n", own);
    assert_at_most("openings: closing to an eleventh, step of a block beside "
                   "the exact one",
                   pop, 1.5, "codes");
}

TEST_CLOSE
{
    stage_free(&stage);
}
