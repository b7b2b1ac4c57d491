/* SPDX-License-Identifier: MIT */
#include "engine/frame/budget.h"

#include <math.h>

#define FIRST      1    /* octaves that a first frame takes more, for memory */
#define ROOM       0.98 /* share of the budget that is planned for */
#define SPARE      0.9  /* less than so much of it: finer */
#define TRY        1.15 /* share that is tried now and then, to learn more */
#define LEARNING   0.5  /* share of an error that is learned, in octaves */
#define MOST_WRONG 0.8  /* octaves that one frame can say */
#define SPREAD     0.1  /* share of that for other qualities, at least */
#define FORGETTING 0.01 /* share of what those learned, a frame */

/* Plans of one frame; of fineness far from the one that is chosen they tell
 * little, so one more may be needed. */
enum { MAX_TRIES = 3 };

enum {
    TRIALS = 4
}; /* frames of a quality that is predicted to take too long */

void glint_budget_init(struct glint_budget *b, double ms)
{
    *b = (struct glint_budget){
        .ms = ms, .ms_per_minsn = 0.1, .step = GLINT_BUDGET_STEPS / 2};
}

double glint_budget_quality(const struct glint_budget *b)
{
    return (double)b->step / GLINT_BUDGET_STEPS;
}

void glint_budget_begin(struct glint_budget *b)
{
    b->n_tries = 0;
    b->n_frames += b->n_frames < 2;
}

/* No cost model covers sets of wavelengths, so a budget draws with three. */
static struct glint_dials dials_at(int step, const struct glint_dials *asked)
{
    struct glint_dials d =
        glint_quality_at((double)step / GLINT_BUDGET_STEPS).dials;

    d.dispersion_q8 = 0;
    d.max_lights = asked->max_lights;
    d.flags |= asked->flags & GLINT_DIAL_ALWAYS_HALF;
    return d;
}

struct glint_dials glint_budget_dials(const struct glint_budget *b,
                                      const struct glint_dials *asked)
{
    return dials_at(b->step, asked);
}

static double place_of(int step)
{
    return glint_quality_place((double)step / GLINT_BUDGET_STEPS);
}

static double octaves_at(const struct glint_budget *b, int step)
{
    const double at = place_of(step);
    const int below =
        at < GLINT_QUALITY_LEVELS - 1 ? (int)at : GLINT_QUALITY_LEVELS - 2;

    return b->octaves[below] +
           (at - below) * (b->octaves[below + 1] - b->octaves[below]);
}

/* Predicts the milliseconds that PLAN would take at another quality. */
static double predict(const struct glint_budget *b,
                      const struct glint_cost_plan *plan, int step)
{
    const struct glint_dials then = dials_at(step, &plan->dials);
    const struct glint_cost cost = glint_cost_of(plan, &then);

    return b->ms_per_minsn * glint_cost_minsn(&cost) *
           exp2(octaves_at(b, step) + (b->n_frames > 1 ? 0 : FIRST));
}

/* The best within the budget, or the coarsest. */
static int best_step(const struct glint_budget *b,
                     const struct glint_cost_plan *plan)
{
    int low = 0, high = GLINT_BUDGET_STEPS;

    while (low < high) {
        const int middle = (low + high + 1) / 2;

        if (predict(b, plan, middle) <= ROOM * b->ms)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

/* If no level lies between STEP, which leaves much of the budget, and the next,
 * which is predicted to miss it by little, takes the latter for a few frames in
 * all: the prediction may be too high. */
static int try_next(struct glint_budget *b, const struct glint_cost_plan *plan,
                    int step)
{
    const int is_gap = place_of(step + 1) - place_of(step) >= 1;

    if (step == GLINT_BUDGET_STEPS || !is_gap || b->n_trials == TRIALS ||
        predict(b, plan, step) >= SPARE * b->ms ||
        predict(b, plan, step + 1) > TRY * b->ms)
        return step;
    b->n_trials++;
    b->n_tries = MAX_TRIES; /* the prediction says that the level is too slow */
    return step + 1;
}

bool glint_budget_choose(struct glint_budget *b,
                         const struct glint_cost_plan *plan,
                         struct glint_dials *dials)
{
    int step;

    b->predicted_ms = predict(b, plan, b->step);
    if (++b->n_tries >= MAX_TRIES ||
        (b->predicted_ms <= b->ms &&
         (b->predicted_ms >= SPARE * b->ms || b->step == GLINT_BUDGET_STEPS)))
        return false;
    step = try_next(b, plan, best_step(b, plan));
    if (step == b->step)
        return false;
    b->step = step;
    *dials = dials_at(step, dials);
    return true;
}

/* Learns from a frame that took MS. The same prediction would be less wrong by
 * LEARNING. Qualities beside this one learn with it; the more the prediction
 * was wrong, the more do all, as when the machine has become slower. What other
 * qualities learned long ago is forgotten, lest one slow frame keeps a level
 * from ever being tried again. */
void glint_budget_note(struct glint_budget *b, double ms)
{
    const double at = place_of(b->step);
    const double part = at - floor(at);
    const double both = part * part + (1 - part) * (1 - part);
    /* a frame that waited for other programs says little */
    const double wrong =
        fmax(-MOST_WRONG, fmin(MOST_WRONG, log2(ms / b->predicted_ms)));
    const double spread = fmin(1, fmax(SPREAD, 2 * fabs(wrong)));
    const double here = octaves_at(b, b->step);

    for (int i = 0; i < GLINT_QUALITY_LEVELS && ms > 0 && b->n_frames > 1;
         i++) {
        const double near = fmax(0, 1 - fabs(at - i)) / both;

        if (near <= 0)
            b->octaves[i] += FORGETTING * (here - b->octaves[i]);
        b->octaves[i] += LEARNING * wrong * fmax(spread, near);
    }
}
