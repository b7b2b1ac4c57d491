/* SPDX-License-Identifier: MIT
 *
 * Holds frames to a time: the best quality of the table whose frame, as its
 * plan predicts, will not take longer.
 *
 *     glint_budget_init(&frame.budget, 5.0);
 *     settings_calibrate(tool, &settings, &frame.budget);      once, some
 * frames glint_frame_draw(&frame, ...);          chooses, and learns from what
 * it took
 */
#ifndef GLINT_ENGINE_FRAME_BUDGET_H
#define GLINT_ENGINE_FRAME_BUDGET_H

#include <stdbool.h>

#include "engine/frame/cost.h"
#include "engine/frame/quality.h"

enum { GLINT_BUDGET_STEPS = 64 }; /* steps of quality */

struct glint_budget {
    double ms; /* milliseconds that a frame may take; 0: there is no budget */
    double calibrated_minsn; /* million instructions of the frame that the speed
                                was measured with; 0: none was */
    double ms_per_minsn; /* milliseconds a million instructions on this machine
                            with this lens */
    double octaves[GLINT_QUALITY_LEVELS]; /* learned beyond that, by quality */
    int step;            /* quality of the last frame, of GLINT_BUDGET_STEPS */
    int n_tries;         /* plans tried for the present frame */
    int n_frames;        /* begun, 2 at most */
    int n_trials;        /* frames drawn though predicted to take too long */
    double predicted_ms; /* milliseconds that its last plan predicted for the
                            last frame */
};

void glint_budget_init(struct glint_budget *budget, double ms);

/* Begins a frame. */
void glint_budget_begin(struct glint_budget *budget);

/* After PLAN, with DIALS: whether these were turned and a new plan is needed.
 */
bool glint_budget_choose(struct glint_budget *budget,
                         const struct glint_cost_plan *plan,
                         struct glint_dials *dials);

/* Returns the dials of the present quality; those that are no matter of quality
 * are taken from ASKED. */
struct glint_dials glint_budget_dials(const struct glint_budget *budget,
                                      const struct glint_dials *asked);

/* Notes what the frame took in all. */
void glint_budget_note(struct glint_budget *budget, double ms);

double glint_budget_quality(const struct glint_budget *budget);

#endif
