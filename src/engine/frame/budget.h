/* SPDX-License-Identifier: MIT
 *
 * Keeps frames within a time budget: predicts from the plan of a frame how long
 * drawing takes, and chooses the best quality that fits.
 *
 *     glint_budget_init(&frame.budget, 5.0);
 *     glint_frame_calibrate_budget(&frame);     once; draws a few frames
 *     glint_frame_draw(&frame, ...);            chooses the quality; learns */
#ifndef GLINT_ENGINE_FRAME_BUDGET_H
#define GLINT_ENGINE_FRAME_BUDGET_H

#include <stdbool.h>

#include "engine/frame/cost.h"
#include "glint/quality.h"

enum { GLINT_BUDGET_STEPS = 64 }; /* number of quality steps */

struct glint_budget {
    double ms;               /* budget, milliseconds per frame; 0: no budget */
    double calibrated_minsn; /* predicted cost of the calibration frame,
                                millions of instructions; 0: the budget is not
                                calibrated */
    double ms_per_minsn;     /* milliseconds per million predicted instructions,
                                measured on this machine with this lens */
    /* [level]: learned correction of predictions for a quality level, log2 of
     * (measured time / predicted time) */
    double octaves[GLINT_QUALITY_LEVELS];
    struct glint_dials asked; /* quality parameters that the caller
                                 requested for this frame */
    int step;     /* quality step of the last frame, 0 .. GLINT_BUDGET_STEPS */
    int cut;      /* index of the cut in use (a reduction of work below the
                     lowest quality); 0: no cut */
    int n_tries;  /* number of plans made for this frame */
    int n_frames; /* number of frames begun, clamped to 2 */
    int n_trials; /* number of trial frames so far, which are drawn although
                     they are predicted to exceed the budget */
    double predicted_ms; /* time that the last plan predicted, milliseconds */
};

void glint_budget_init(struct glint_budget *budget, double ms);

/* Begins a frame with the requested quality parameters ASKED. The budget
 * replaces those that quality levels define. */
void glint_budget_begin_frame(struct glint_budget *budget,
                              const struct glint_dials *asked);

/* Changes DIALS, the quality parameters with which PLAN was made, if the
 * predicted time exceeds the budget or leaves much of it unused. Returns
 * whether DIALS changed. If so, the frame must be planned again. */
bool glint_budget_choose_quality_parameters(struct glint_budget *budget,
                                            const struct glint_cost_plan *plan,
                                            struct glint_dials *dials);

/* Returns the quality parameters of the current quality step. Parameters that
 * do not depend on quality are taken from ASKED. */
struct glint_dials
glint_budget_get_quality_parameters(const struct glint_budget *budget,
                                    const struct glint_dials *asked);

/* Corrects later predictions by MS, the measured time of the last frame in
 * milliseconds. Ignores the first frame, which allocates memory. */
void glint_budget_learn_from_frame(struct glint_budget *budget, double ms);

double glint_budget_get_quality(const struct glint_budget *budget);

#endif
