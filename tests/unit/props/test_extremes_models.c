/* SPDX-License-Identifier: MIT
 *
 * Tests a hundred hostile models (tests/support/models/hostile.h): each is
 * drawn or rejected, within the limits of work and memory of a frame. Work is
 * counted, not timed.
 */
#include "support/extreme.h"
#include "support/models/hostile.h"
#include "support/stage.h"
#include "support/test.h"

static struct stage stage;

/* Returns whether a model of FAMILY has thousands of ghosts, so that drawing it
 * takes seconds. */
static bool is_slow_family(int family)
{
    return family == HOSTILE_WHOLE || family == HOSTILE_FOLDS ||
           family == HOSTILE_COLOURS;
}

static bool is_model_drawn(int family, int number)
{
    return extreme_is_long_run() || number == 8 ||
           (number == 3 && !is_slow_family(family));
}

/* Work may exceed its limit by this factor: plans only estimate it, and
 * planning again (coarser or with more memory) is work as well. */
#define MOST_WORK 1.5

TEST(hostile_models_stay_within_their_bounds)
{
    double work = 0, memory = 0;
    int n_of[HOSTILE_OUTCOMES] = {0}, n_failed = 0;

    assert_true(stage_open_lens(&stage, "heliar-tronnier", 96, 64));
    for (int family = 0; family < HOSTILE_FAMILIES; family++)
        for (int number = 0; number < HOSTILE_EACH; number++) {
            struct hostile_scene scene;
            struct hostile_result r;

            if (!is_model_drawn(family, number))
                continue;
            hostile_make_scene(&scene, (enum hostile_family)family, number,
                               &stage.file.lens);
            n_failed += !hostile_draw_scene(&scene, &r);
            n_of[r.outcome]++;
            if (r.outcome == HOSTILE_REFUSED)
                continue;
            work = fmax(work, r.minsn / r.most_minsn);
            memory = fmax(memory, r.bytes / r.most_bytes);
        }
    stage_free(&stage);
    /* enough models must be valid, so that drawing them is tested */
    assert_true(n_of[HOSTILE_COARSER] >= 2);
    assert_true(n_of[HOSTILE_DRAWN] >= 5);
    assert_at_most("models: hostile ones, frames that failed", n_failed, 0,
                   "frames");
    assert_at_most("models: hostile ones, work", work, MOST_WORK,
                   "of the bound");
    assert_at_most("models: hostile ones, memory", memory, 1, "of the bound");
}
