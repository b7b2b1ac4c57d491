/* SPDX-License-Identifier: MIT */
#include "engine/frame/budget.h"

#include <math.h>

#include "glint/light.h"

/* log2 of (time of the first frame / time of later frames); the first frame
 * also allocates memory */
#define FIRST 1
/* predicted time of a planned frame / budget, at most */
#define ROOM 0.98
/* max (predicted time / budget) at which the next finer quality is tried */
#define SPARE 0.9
/* max predicted time of a trial frame / budget */
#define TRY 1.15
/* fraction of a prediction's error, in octaves, that is corrected after a
 * frame */
#define LEARNING 0.5
/* limit to which errors of predictions are clamped, octaves */
#define MOST_WRONG 0.8
/* min fraction of a quality level's correction that other levels get */
#define SPREAD 0.1
/* fraction by which the corrections of other quality levels decay per frame */
#define FORGETTING 0.01

/* max number of plans per frame; the cost that a plan predicts is inaccurate
 * for a fineness far from its own, so that a second plan may be needed */
enum { MAX_TRIES = 3 };

/* max number of trial frames, which are drawn at a quality that is predicted to
 * be too slow */
enum { TRIALS = 4 };

void glint_budget_init(struct glint_budget *b, double ms)
{
    *b = (struct glint_budget){
        .ms = ms, .ms_per_minsn = 0.1, .step = GLINT_BUDGET_STEPS / 2};
}

double glint_budget_get_quality(const struct glint_budget *b)
{
    return (double)b->step / GLINT_BUDGET_STEPS;
}

void glint_budget_begin_frame(struct glint_budget *b,
                              const struct glint_dials *asked)
{
    b->asked = *asked;
    b->n_tries = 0;
    b->n_frames += b->n_frames < 2;
}

/* Cuts reduce the work of a frame below that of the lowest quality level. They
 * are ordered by visibility, and each cut includes the cuts before it. LOSS:
 * PSNR against a frame without cuts, dB; an estimate, as glint sweep has not
 * measured dust and veil. */
static const struct cut {
    double dim;    /* min value of the quality parameter dim_codes */
    int dust_log2; /* value of the quality parameter dust_log2 */
    bool no_veil;
    double loss;
} cuts[] = {{0, GLINT_SHADE_MOST_LOG2, false, 90},
            {0.25, GLINT_SHADE_MOST_LOG2, false, 62},
            {1, GLINT_SHADE_MOST_LOG2, false, 57},
            {1, 8, false, 54},
            {1, 7, false, 51},
            {1, 6, false, 48},
            {1, 5, false, 45},
            {1, 3, false, 42},
            {1, 3, true, 34}};

enum { N_CUTS = sizeof cuts / sizeof *cuts, BUNDLES = 256 };

/* PSNR of the quality levels, dB: the mean over five lenses (glint sweep at
 * revision a3db91ca) */
static const double level_db[GLINT_QUALITY_LEVELS] = {39, 44, 49, 53.5, 54.5,
                                                      56, 59, 62, 64,   65};

/* Returns the quality parameters at quality step STEP, reduced by cut CUT (an
 * entry of the table above). Parameters that do not depend on quality are those
 * of ASKED. Frames with a budget are drawn with three wavelengths, as the cost
 * model does not cover sets of wavelengths. */
static struct glint_dials
make_quality_parameters_at_step(int step, int cut,
                                const struct glint_dials *asked)
{
    struct glint_dials d =
        glint_quality_at((double)step / GLINT_BUDGET_STEPS).dials;

    d.dispersion_q8 = 0;
    d.dim_codes = fmax(fmax(d.dim_codes, asked->dim_codes), cuts[cut].dim);
    d.dust_log2 = cuts[cut].dust_log2;
    d.max_lights = asked->max_lights;
    d.still_px = asked->still_px;
    d.flags |= asked->flags & GLINT_DIAL_ALWAYS_HALF;
    d.flags |= cuts[cut].no_veil ? GLINT_DIAL_NO_VEIL : 0;
    return d;
}

struct glint_dials
glint_budget_get_quality_parameters(const struct glint_budget *b,
                                    const struct glint_dials *asked)
{
    return make_quality_parameters_at_step(b->step, b->cut, asked);
}

static double convert_quality_step_to_level(int step)
{
    return glint_quality_place((double)step / GLINT_BUDGET_STEPS);
}

static double interpolate_learned_correction(const struct glint_budget *b,
                                             int step)
{
    const double at = convert_quality_step_to_level(step);
    const int below =
        at < GLINT_QUALITY_LEVELS - 1 ? (int)at : GLINT_QUALITY_LEVELS - 2;

    return b->octaves[below] +
           (at - below) * (b->octaves[below + 1] - b->octaves[below]);
}

/* Predicts the time of drawing PLAN at quality step STEP with cut CUT, ms. */
static double predict_frame_ms(const struct glint_budget *b,
                               const struct glint_cost_plan *plan, int step,
                               int cut)
{
    const struct glint_dials then =
        make_quality_parameters_at_step(step, cut, &b->asked);
    const struct glint_cost cost = glint_cost_of(plan, &then);

    return b->ms_per_minsn * glint_cost_convert_to_minsn(&cost) *
           exp2(interpolate_learned_correction(b, step) +
                (b->n_frames > 1 ? 0 : FIRST));
}

/* Returns the best quality step that is predicted to fit the budget with cut
 * CUT. Returns 0 if no step fits. It is a binary search. */
static int find_best_affordable_quality_step(const struct glint_budget *b,
                                             const struct glint_cost_plan *plan,
                                             int cut)
{
    int low = 0, high = GLINT_BUDGET_STEPS;

    while (low < high) {
        const int middle = (low + high + 1) / 2;

        if (predict_frame_ms(b, plan, middle, cut) <= ROOM * b->ms)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

/* Converts a PSNR, dB, to the mean square error, 1 = white. */
static double convert_db_to_mse(double db)
{
    return pow(10, -db / 10);
}

/* Estimates the mean square error of a frame at quality step STEP with cut CUT.
 * If even step 0 exceeds the budget, the result is above 1 and rises with the
 * predicted time. */
static double estimate_picture_error(const struct glint_budget *b,
                                     const struct glint_cost_plan *plan,
                                     int step, int cut)
{
    const double at = convert_quality_step_to_level(step);
    const int below =
        at < GLINT_QUALITY_LEVELS - 1 ? (int)at : GLINT_QUALITY_LEVELS - 2;
    const double db = level_db[below] +
                      (at - below) * (level_db[below + 1] - level_db[below]);
    const double over =
        step > 0 ? 0 : predict_frame_ms(b, plan, 0, cut) / b->ms;

    return convert_db_to_mse(db) + convert_db_to_mse(cuts[cut].loss) +
           (over > 1 ? over : 0);
}

/* Returns whether CUT reduces the work of PLAN more than the previous cut. */
static bool does_cut_reduce_work(const struct glint_cost_plan *plan, int cut)
{
    const struct cut *c = &cuts[cut];

    return (plan->can_dim && c->dim > c[-1].dim) ||
           (plan->shade && c->dust_log2 < plan->shade->log2 &&
            c->dust_log2 < c[-1].dust_log2) ||
           (plan->n_veil > 0 && c->no_veil);
}

/* Chooses the cut and the quality step with the smallest estimated error that
 * fit the budget. Sets b->cut and returns the step. If there are many ray
 * bundles, only a sample of them is evaluated. */
static int choose_quality_step_and_cut(struct glint_budget *b,
                                       const struct glint_cost_plan *plan)
{
    struct glint_cost_plan some = *plan;
    struct glint_planned last;
    double least = HUGE_VAL;
    int n = 1, step = 0;

    while (glint_flare_planned(plan->flare, n * BUNDLES, &last))
        n++;
    some.every = n;
    for (int cut = 0; cut < N_CUTS; cut++) {
        const int here = cut == 0 || does_cut_reduce_work(plan, cut)
                             ? find_best_affordable_quality_step(b, &some, cut)
                             : -1;
        const double error =
            here < 0 ? HUGE_VAL : estimate_picture_error(b, &some, here, cut);

        if (error < least) {
            least = error;
            b->cut = cut;
            step = here;
        }
    }
    return step;
}

/* Returns the quality step of this frame, either STEP or STEP + 1. The higher
 * step is tried, at most TRIALS times in total, if it is one quality level or
 * more above STEP, STEP leaves much of the budget unused, and STEP + 1 is
 * predicted to exceed it by little. The prediction for STEP + 1 may be too
 * high. */
static int try_next_quality_step(struct glint_budget *b,
                                 const struct glint_cost_plan *plan, int step)
{
    const int is_gap = convert_quality_step_to_level(step + 1) -
                           convert_quality_step_to_level(step) >=
                       1;

    if (step == GLINT_BUDGET_STEPS || !is_gap || b->n_trials == TRIALS ||
        predict_frame_ms(b, plan, step, b->cut) >= SPARE * b->ms ||
        predict_frame_ms(b, plan, step + 1, b->cut) > TRY * b->ms)
        return step;
    b->n_trials++;
    b->n_tries = MAX_TRIES; /* This frame is not planned again, as the
                               prediction of a further plan would reject the
                               trial. */
    return step + 1;
}

bool glint_budget_choose_quality_parameters(struct glint_budget *b,
                                            const struct glint_cost_plan *plan,
                                            struct glint_dials *dials)
{
    const int cut = b->cut;
    int step;

    b->predicted_ms = predict_frame_ms(b, plan, b->step, cut);
    if (++b->n_tries >= MAX_TRIES ||
        (b->predicted_ms <= b->ms &&
         (b->predicted_ms >= SPARE * b->ms ||
          (b->step == GLINT_BUDGET_STEPS && cut == 0))))
        return false;
    step = try_next_quality_step(b, plan, choose_quality_step_and_cut(b, plan));
    if (step == b->step && cut == b->cut)
        return false;
    b->step = step;
    *dials = make_quality_parameters_at_step(step, b->cut, &b->asked);
    return true;
}

/* Corrects later predictions by the fraction LEARNING of the last prediction's
 * error, in octaves; MS is the measured time. Neighbouring quality levels are
 * corrected, too, and all levels if the error is large, as the machine may have
 * become slower. Corrections of other levels decay, so that one slow frame does
 * not exclude a quality forever. */
void glint_budget_learn_from_frame(struct glint_budget *b, double ms)
{
    const double at = convert_quality_step_to_level(b->step);
    const double part = at - floor(at);
    const double both = part * part + (1 - part) * (1 - part);
    /* The error is clamped, as the frame may have waited for other programs. */
    const double wrong =
        fmax(-MOST_WRONG, fmin(MOST_WRONG, log2(ms / b->predicted_ms)));
    const double spread = fmin(1, fmax(SPREAD, 2 * fabs(wrong)));
    const double here = interpolate_learned_correction(b, b->step);

    for (int i = 0; i < GLINT_QUALITY_LEVELS && ms > 0 && b->n_frames > 1;
         i++) {
        const double near = fmax(0, 1 - fabs(at - i)) / both;

        if (near <= 0)
            b->octaves[i] += FORGETTING * (here - b->octaves[i]);
        b->octaves[i] += LEARNING * wrong * fmax(spread, near);
    }
}
