/* SPDX-License-Identifier: MIT */
#include "live/live_adapt.h"

#include <math.h>
#include <string.h>

#include "glint/quality.h"

/* drawing time / frame period above which quality is reduced */
#define TIGHT 0.9
/* drawing time / frame period below which quality may rise after HOLD_S */
#define SPARE 0.55
/* min seconds and frames between two steps down */
#define SETTLE_S   0.3
#define MIN_FRAMES 3
#define HOLD_S     2.0 /* seconds below SPARE before a step up, at first */
#define MAX_HOLD_S 60.0
#define SMOOTHING  0.2
/* max ratio of a frame's time to the smoothed time; more is clamped, as a
 * single slow frame is no load */
#define OUTLIER 3.0
/* Times of a frame with at most this ratio count as equal. */
#define EQUAL 1.25
/* ratio of times of a frame from which on the load has changed */
#define CHANGED 1.5

/* Quality and max number of lights at each step. Quality falls from the middle
 * of the --quality scale to 0, and never exceeds the requested quality. The
 * last steps only reduce the number of lights. */
static const struct {
    double quality;
    int max_lights;
} step_of[LIVE_MAX_STEP + 1] = {
    {0.5, 1 << 20}, {0.375, 64}, {0.25, 32}, {0.125, 16},
    {0, 12},        {0, 8},      {0, 4},     {0, 2},
};

void live_adapt_init(struct live_adapt *a)
{
    *a = (struct live_adapt){.hold_s = HOLD_S, .n_frames = -1, .busy_ms = -1};
}

static bool change_quality_step(struct live_adapt *a, int by)
{
    const int step = a->step + by;

    a->below_s = 0;
    if (step < 0 || step > LIVE_MAX_STEP)
        return false;
    /* A step down soon after a step up shows that there was too little time for
     * the better quality. So the next step up waits longer. */
    if (by > 0 && a->rose && a->since_s < 2 * HOLD_S)
        a->hold_s = fmin(MAX_HOLD_S, 2 * a->hold_s);
    /* The last step up has lasted, so the wait becomes short again. */
    if (by < 0 && a->rose)
        a->hold_s = HOLD_S;
    a->rose = by < 0;
    a->step = step;
    a->since_s = 0;
    a->n_frames = 0;
    a->busy_ms = -1;
    return true;
}

/* Returns the number of steps, at most LEFT, by which to change quality at once
 * to change the time of a frame by the factor RATIO. A step changes it by about
 * a third. */
static int count_steps(double ratio, int left)
{
    const int wanted = ratio > 8 ? 4 : ratio > 4 ? 3 : ratio > 2 ? 2 : 1;

    return left > 0 && left < wanted ? left : wanted;
}

static void forget_times_of_steps(struct live_adapt *a)
{
    memset(a->min_ms, 0, sizeof a->min_ms);
}

/* At the last step, which leaves too little time, returns to the finest step
 * that is as fast. Returns whether the step has changed. */
static bool return_to_finest_equal_step(struct live_adapt *a)
{
    const double most_ms = EQUAL * a->min_ms[LIVE_MAX_STEP];
    int step = 0;

    while (step < LIVE_MAX_STEP &&
           (a->min_ms[step] <= 0 || a->min_ms[step] > most_ms))
        step++;
    if (step == LIVE_MAX_STEP)
        return false;
    a->futile_ms = a->min_ms[step];
    a->futile_s = a->hold_s;
    a->hold_s = fmin(MAX_HOLD_S, 2 * a->hold_s);
    forget_times_of_steps(a);
    a->rose = false; /* Otherwise the step would change hold_s. */
    change_quality_step(a, step - LIVE_MAX_STEP);
    a->rose = false;
    return true;
}

/* Lowers quality, unless that has saved no time at the present load. Returns
 * whether the step has changed. */
static bool lower_quality(struct live_adapt *a, double period_ms)
{
    if (a->futile_s <= 0 || a->busy_ms > CHANGED * a->futile_ms ||
        CHANGED * a->busy_ms < a->futile_ms)
        a->futile_ms = 0;
    if (a->futile_ms > 0 || a->since_s < SETTLE_S || a->n_frames < MIN_FRAMES)
        return false;
    if (a->step == LIVE_MAX_STEP)
        return return_to_finest_equal_step(a);
    return change_quality_step(
        a, count_steps(a->busy_ms / period_ms, LIVE_MAX_STEP - a->step));
}

bool live_adapt_add_frame(struct live_adapt *a, double busy_ms,
                          double period_ms, int n_missed)
{
    const double elapsed_s = 1e-3 * period_ms * (1 + n_missed);

    if (a->n_frames++ < 0)
        return false;
    a->busy_ms =
        a->busy_ms < 0
            ? busy_ms
            : a->busy_ms +
                  SMOOTHING * (fmin(busy_ms, OUTLIER * fmax(a->busy_ms, 0.1)) -
                               a->busy_ms);
    a->since_s += elapsed_s;
    a->futile_s -= elapsed_s;
    if (a->busy_ms > TIGHT * period_ms ||
        (n_missed > 0 && a->busy_ms > SPARE * period_ms)) {
        double *const min_ms = &a->min_ms[a->step];

        a->below_s = 0;
        *min_ms = *min_ms > 0 ? fmin(*min_ms, busy_ms) : busy_ms;
        return lower_quality(a, period_ms);
    }
    forget_times_of_steps(a);
    a->below_s = a->busy_ms < SPARE * period_ms ? a->below_s + elapsed_s : 0;
    return a->below_s >= a->hold_s &&
           change_quality_step(
               a, -count_steps(SPARE * period_ms / a->busy_ms, a->step));
}

double live_adapt_get_max_scene_quality(const struct live_adapt *a)
{
    return a->step > 0 ? step_of[a->step].quality : 1;
}

struct glint_dials live_adapt_coarsen_parameters(const struct live_adapt *a,
                                                 struct glint_dials asked)
{
    struct glint_dials d = asked;

    if (a->step > 0)
        d = glint_dials_coarser(
            asked, glint_quality_at(step_of[a->step].quality).dials);
    if (d.max_lights > step_of[a->step].max_lights)
        d.max_lights = step_of[a->step].max_lights;
    return d;
}
