/* SPDX-License-Identifier: MIT
 *
 * Holds frames to a time: the best quality of the table whose frame, as its
 * plan predicts, will not take longer.
 *
 *     budget_init(&frame.budget, 5.0);
 *     scene_calibrate(tool, &scene, &frame.budget);      once, some frames
 *     frame_draw(&frame, ...);          chooses, and learns from what it took
 */
#ifndef GLINT_TOOLS_ENGINE_BUDGET_H
#define GLINT_TOOLS_ENGINE_BUDGET_H

#include <stdbool.h>

#include "engine/cost.h"
#include "engine/quality.h"

enum { BUDGET_STEPS = 64 }; /* of quality */

struct budget {
    double ms;               /* of a frame; 0: none is kept to */
    double calibrated_minsn; /* of a frame that told; 0: none did */
    double ms_per_minsn;     /* of this machine, this lens; */
    double octaves[GLINT_QUALITY_LEVELS]; /* learned beyond that, by quality */
    int step;     /* quality of the last frame, of BUDGET_STEPS */
    int n_tries;  /* of the frame being planned */
    int n_frames; /* begun, 2 at most */
    int n_trials; /* frames drawn though they were told to take too long */
    double predicted_ms; /* of the last frame, by its last plan */
};

void budget_init(struct budget *budget, double ms);

/* Begins a frame. */
void budget_begin(struct budget *budget);

/* After PLAN, with DIALS: whether these were turned and a new plan is needed.
 */
bool budget_choose(struct budget *budget, const struct cost_plan *plan,
                   struct glint_dials *dials);

/* Its dials now; what is no matter of quality, as ASKED has it. */
struct glint_dials budget_dials(const struct budget *budget,
                                const struct glint_dials *asked);

/* Notes what the frame took in all. */
void budget_note(struct budget *budget, double ms);

double budget_quality(const struct budget *budget);

#endif
