/* SPDX-License-Identifier: MIT
 *
 * Tests how exactly --error, in pixels, limits the error of outlines. It
 * compares the position of each ghost's outline, drawn with the grid that is
 * chosen for that error, with the position in the finest grid.
 */
#include "support/extreme.h"
#include "support/stage.h"
#include "support/test.h"

enum { W = 640, H = 360, N = 3 * W * H, ERRORS = 5, INSIDE = 5, OUTSIDE = 3 };

static const double error_px[ERRORS] = {0.05, 0.1, 0.25, 0.5, 1};

static struct stage stage;
static float finest[N], drawn[N];

/* Statistics of the offsets of all measured outline positions, pixels. */
struct offsets {
    int n;
    double sum, squares, most;
};

/* Returns the position of an outline, pixels from the start of a window of
 * pixels across it: the sum of light in the window divided by the light of the
 * last pixel before the window. AT is the last pixel inside the outline; STEP
 * is the offset to the next pixel outwards. */
static double find_outline_position(const float *rgb, int at, int step)
{
    double sum = 0;

    for (int k = -2; k <= OUTSIDE; k++)
        sum += (double)rgb[at + k * step];
    return sum / (double)rgb[at - 3 * step];
}

/* Returns whether the outline at AT can be measured: the light inside is even,
 * and there is no light outside. */
static bool is_measurable_outline(const float *rgb, int at, int step)
{
    const double first = (double)rgb[at - INSIDE * step];

    for (int k = 2; k < INSIDE; k++)
        if (fabs((double)rgb[at - k * step] - first) > 0.02 * first)
            return false;
    for (int k = 2; k <= OUTSIDE; k++)
        if (rgb[at + k * step] > 0)
            return false;
    return first > 0 && (double)rgb[at] < 0.98 * first;
}

/* Returns the squared cosine of the angle between STEP and the gradient of the
 * light. */
static double compute_gradient_cosine2(const float *rgb, int at, int step)
{
    const int aside = step == 3 || step == -3 ? 3 * W : 3;
    const double a = (double)rgb[at - step] - (double)rgb[at + step];
    const double b = (double)rgb[at - aside] - (double)rgb[at + aside];

    return a * a / (a * a + b * b + 1e-300);
}

static void add_outline_offset(struct offsets *o, int at, int step)
{
    const double cos2 = compute_gradient_cosine2(finest, at, step);
    double off;

    if (cos2 < 0.5 || !is_measurable_outline(finest, at, step) ||
        !(drawn[at - 3 * step] > 0))
        return;
    off = fabs(find_outline_position(drawn, at, step) -
               find_outline_position(finest, at, step)) *
          sqrt(cos2);
    o->n++;
    o->sum += off;
    o->squares += off * off;
    o->most = fmax(o->most, off);
}

static void add_outline_offsets_of_ghost(struct offsets *o)
{
    for (int y = INSIDE; y < H - INSIDE; y++)
        for (int x = INSIDE; x < W - INSIDE; x++)
            for (int c = 0; c < 3; c++) {
                const int at = 3 * (y * W + x) + c;

                if (!(finest[at] > 0))
                    continue;
                add_outline_offset(o, at, 3);
                add_outline_offset(o, at, -3);
                add_outline_offset(o, at, 3 * W);
                add_outline_offset(o, at, -3 * W);
            }
}

static void add_offsets_at_light_angle(double theta_deg, struct offsets *o)
{
    const struct glint_lamp lamp = stage_make_lamp(theta_deg, 33, 1);
    struct glint_frame *f = &stage.frame;

    for (int ghost = 0; ghost < stage.of_model.n_ghosts; ghost++) {
        f->only_ghost = ghost;
        f->picture.uniform = true;
        f->dials.fineness = 256;
        f->dials.irradiance_steps = 0;
        assert_true(stage_draw_linear(&stage, &lamp, 1, finest));
        if (stage.drawn.stats.primitives == 0)
            continue;
        f->picture.uniform = false;
        for (int k = 0; k < ERRORS; k++) {
            f->dials =
                glint_quality_at(glint_quality_for_error(error_px[k])).dials;
            /* Rounding irradiance to steps does not affect outlines, so it is
             * switched off. */
            f->dials.irradiance_steps = 0;
            assert_true(stage_draw_linear(&stage, &lamp, 1, drawn));
            add_outline_offsets_of_ghost(&o[k]);
        }
    }
}

/* Checks the errors of all outlines. Grids are chosen for the mean bend of a
 * ghost, so an outline may be displaced by up to 1.5 times --error plus 1/20
 * pixel. Most outlines are far more exact: the mean offset must be at most a
 * fifth of --error. */
static void check_outline_offsets(const char *lens)
{
    struct offsets o[ERRORS] = {{0, 0, 0, 0}};
    bool ok = true;

    stage_free(&stage);
    assert_true(stage_load_lens(&stage, lens));
    assert_true(stage_set_up_lens(&stage, 8) &&
                stage_bake_or_load_model(&stage, 1, 60));
    stage_set_view(&stage, W, H, 0);
    add_offsets_at_light_angle(5, o);
    add_offsets_at_light_angle(12, o);
    for (int k = 0; k < ERRORS; k++) {
        char name[100];

        assert_true(o[k].n > 100);
        print_message("  %s, --error %g: mean %.4f, rms %.4f, most %.2f of "
                      "%d\n",
                      lens, error_px[k], o[k].sum / o[k].n,
                      sqrt(o[k].squares / o[k].n), o[k].most, o[k].n);
        snprintf(name, sizeof name, "outlines: %s, --error %g, mean", lens,
                 error_px[k]);
        ok &= extreme_check_at_most(name, o[k].sum / o[k].n, 0.2 * error_px[k],
                                    "px");
        snprintf(name, sizeof name, "outlines: %s, --error %g, anywhere", lens,
                 error_px[k]);
        ok &= extreme_check_at_most(name, o[k].most, 1.5 * error_px[k] + 0.05,
                                    "px");
    }
    assert_true(ok);
}

TEST(outlines_stay_within_the_error_limit)
{
    check_outline_offsets("heliar-tronnier");
    if (!extreme_is_long_run())
        return;
    check_outline_offsets("double-gauss-angenieux");
    check_outline_offsets("nikon-zoom-mid");
}

TEST_CLOSE
{
    stage_free(&stage);
}
