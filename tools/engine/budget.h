/* SPDX-License-Identifier: MIT
 *
 * Holds frames to a time: the best quality of the ladder whose frame, as its
 * plan tells, will not take longer.
 *
 *     budget_init(&frame.budget, 5.0);
 *     scene_calibrate(tool, &scene, &frame.budget);      once, some frames
 *     frame_draw(&frame, ...);          chooses, and learns from what it took
 */
#ifndef GLINT_TOOLS_ENGINE_BUDGET_H
#define GLINT_TOOLS_ENGINE_BUDGET_H

#include <stdbool.h>

struct frame;

enum { BUDGET_STEPS = 64, BUDGET_RUNGS = 10 }; /* of quality; the ladder's */

struct budget {
    double ms;                    /* of a frame; 0: none is kept to */
    double calibrated_minsn;      /* of a frame that told; 0: none did */
    double ms_per_minsn;          /* of this machine, this lens; */
    double octaves[BUDGET_RUNGS]; /* learned beyond that, by quality */
    int step;     /* quality of the last frame, of BUDGET_STEPS */
    int n_tries;  /* of the frame being planned */
    int n_frames; /* begun, 2 at most */
    int n_trials; /* frames drawn though they were told to take too long */
    double predicted_ms; /* of the last frame, by its last plan */
};

void budget_init(struct budget *budget, double ms);

/* Begins a frame. */
void budget_begin(struct budget *budget);

/* After a plan: whether FRAME's dials were turned and it has to plan anew. */
bool budget_choose(struct budget *budget, struct frame *frame);

/* Notes what the frame took in all. */
void budget_note(struct budget *budget, double ms);

double budget_quality(const struct budget *budget);

#endif
