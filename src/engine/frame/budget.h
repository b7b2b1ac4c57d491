/* SPDX-License-Identifier: MIT
 *
 * Holds a frame time: chooses the best quality of the table whose frame is
 * predicted, from its plan, to fit.
 *
 *     glint_budget_init(&frame.budget, 5.0);
 *     glint_frame_calibrate_budget(&frame);              once, draws some
 * frames glint_frame_draw(&frame, ...);              chooses, and learns */
#ifndef GLINT_ENGINE_FRAME_BUDGET_H
#define GLINT_ENGINE_FRAME_BUDGET_H

#include <stdbool.h>

#include "engine/frame/cost.h"
#include "glint/quality.h"

enum { GLINT_BUDGET_STEPS = 64 }; /* number of steps of quality */

struct glint_budget {
    double ms;               /* milliseconds per frame; 0: no budget */
    double calibrated_minsn; /* millions of instructions of the calibration
                                frame; 0: not calibrated */
    double ms_per_minsn;     /* milliseconds per million instructions on this
                                machine with this lens */
    double octaves[GLINT_QUALITY_LEVELS]; /* log2 of measured over predicted
                                             time, as learned, by quality */
    struct glint_dials asked;             /* requested dials of this frame */
    int step;     /* quality of the last frame, 0 .. GLINT_BUDGET_STEPS */
    int cut;      /* steps by which other dials were reduced, 0: none */
    int n_tries;  /* number of plans tried for this frame */
    int n_frames; /* number of frames begun, at most 2 */
    int n_trials; /* number of frames drawn although predicted to exceed the
                     budget */
    double predicted_ms; /* milliseconds predicted by the last plan of the last
                            frame */
};

void glint_budget_init(struct glint_budget *budget, double ms);

/* Begins a frame with the requested dials ASKED; only those that do not
 * depend on quality are used. */
void glint_budget_begin_frame(struct glint_budget *budget,
                              const struct glint_dials *asked);

/* Adjusts DIALS, with which PLAN was made, if the plan misses the budget or
 * leaves much of it unused. Returns whether it did; the frame must then be
 * planned again. */
bool glint_budget_choose_dials(struct glint_budget *budget,
                               const struct glint_cost_plan *plan,
                               struct glint_dials *dials);

/* Returns the dials of the present quality; those that do not depend on quality
 * are taken from ASKED. */
struct glint_dials glint_budget_current_dials(const struct glint_budget *budget,
                                              const struct glint_dials *asked);

/* Corrects the predictions by MS, the time of the whole frame in
 * milliseconds. */
void glint_budget_learn_from_frame(struct glint_budget *budget, double ms);

double glint_budget_quality(const struct glint_budget *budget);

#endif
