/* SPDX-License-Identifier: MIT */
#include "live/live_adapt.h"

#include <math.h>

#include "glint/quality.h"

/* drawing time / frame period above which quality is reduced */
#define TIGHT 0.9
/* drawing time / frame period below which quality may rise after HOLD_S */
#define SPARE      0.55
#define SETTLE_S   0.3 /* min seconds between two steps down */
#define HOLD_S     2.0 /* seconds below SPARE before a step up, at first */
#define MAX_HOLD_S 60.0
#define SMOOTHING  0.2

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
    *a = (struct live_adapt){.hold_s = HOLD_S, .busy_ms = -1};
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
    a->busy_ms = -1;
    return true;
}

/* Returns the number of steps by which to reduce quality at once if a frame
 * takes PERIODS frame periods. Each step saves about a third of the time. */
static int count_steps_down(const struct live_adapt *a, double periods)
{
    const int wanted = periods > 8 ? 4 : periods > 4 ? 3 : periods > 2 ? 2 : 1;
    const int left = LIVE_MAX_STEP - a->step;

    return left > 0 && left < wanted ? left : wanted;
}

bool live_adapt_add_frame(struct live_adapt *a, double busy_ms,
                          double period_ms, int n_missed)
{
    const double elapsed_s = 1e-3 * period_ms * (1 + n_missed);

    a->busy_ms = a->busy_ms < 0
                     ? busy_ms
                     : a->busy_ms + SMOOTHING * (busy_ms - a->busy_ms);
    a->since_s += elapsed_s;
    if (n_missed > 0 || a->busy_ms > TIGHT * period_ms)
        return a->since_s >= SETTLE_S &&
               change_quality_step(a,
                                   count_steps_down(a, a->busy_ms / period_ms));
    a->below_s = a->busy_ms < SPARE * period_ms ? a->below_s + elapsed_s : 0;
    return a->below_s >= a->hold_s && change_quality_step(a, -1);
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
