/* SPDX-License-Identifier: MIT */
#include "engine/frame/budget.h"

#include <math.h>

/* octaves that a first frame takes longer, as it takes memory */
#define FIRST 1
/* share of the budget that frames are planned for */
#define ROOM 0.98
/* share of the budget below which a finer quality is tried */
#define SPARE 0.9
/* share of the budget that a quality may be predicted to take for a trial */
#define TRY 1.15
/* share of an error, in octaves, that one frame teaches */
#define LEARNING 0.5
/* largest error, in octaves, that one frame can teach */
#define MOST_WRONG 0.8
/* least share of an error that other qualities learn */
#define SPREAD 0.1
/* share of what other qualities learned that is forgotten each frame */
#define FORGETTING 0.01

/* Most plans of one frame. A plan tells little about fineness far from its own,
 * so that one more may be needed. */
enum { MAX_TRIES = 3 };

/* most frames drawn at a quality that is predicted to take too long */
enum { TRIALS = 4 };

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

/* Returns the dials at STEP. The cost model does not cover sets of wavelengths,
 * so a budget draws with three. */
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

/* Returns the milliseconds that PLAN would take at quality STEP, as predicted.
 */
static double predict(const struct glint_budget *b,
                      const struct glint_cost_plan *plan, int step)
{
    const struct glint_dials then = dials_at(step, &plan->dials);
    const struct glint_cost cost = glint_cost_of(plan, &then);

    return b->ms_per_minsn * glint_cost_minsn(&cost) *
           exp2(octaves_at(b, step) + (b->n_frames > 1 ? 0 : FIRST));
}

/* Returns the best quality within the budget, or the coarsest. */
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

/* Returns STEP + 1 for a few frames in all if no level lies between STEP, which
 * leaves much of the budget, and STEP + 1, which is predicted to miss it by
 * little: the prediction may be too high. Else returns STEP. */
static int try_next(struct glint_budget *b, const struct glint_cost_plan *plan,
                    int step)
{
    const int is_gap = place_of(step + 1) - place_of(step) >= 1;

    if (step == GLINT_BUDGET_STEPS || !is_gap || b->n_trials == TRIALS ||
        predict(b, plan, step) >= SPARE * b->ms ||
        predict(b, plan, step + 1) > TRY * b->ms)
        return step;
    b->n_trials++;
    b->n_tries = MAX_TRIES; /* no more plans, as their prediction would reject
                               this quality again */
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

/* Learns from a frame that took MS, so that the same prediction would be less
 * wrong by LEARNING. Neighbouring qualities learn, too, and all qualities learn
 * more the more wrong the prediction was, as when the machine has become
 * slower. What other qualities learned long ago is forgotten, or one slow frame
 * could keep a level from ever being tried again. */
void glint_budget_note(struct glint_budget *b, double ms)
{
    const double at = place_of(b->step);
    const double part = at - floor(at);
    const double both = part * part + (1 - part) * (1 - part);
    /* A frame that waited for other programs says little. */
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
