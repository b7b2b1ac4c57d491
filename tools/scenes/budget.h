/* SPDX-License-Identifier: MIT
 *
 * Dials of a scene that hold a time a frame, by what the frame is told to cost
 * and how long frames have taken. */
#ifndef GLINT_TOOLS_SCENES_BUDGET_H
#define GLINT_TOOLS_SCENES_BUDGET_H

#include "scenes/account.h"

/* Levels from the finest, as the dials are asked for, to the coarsest. */
enum { SCENE_BUDGET_LEVELS = 6 };

struct scene_budget {
    struct scene_dials asked;
    int level;
    double predicted_ms; /* of the frame; 0: there is no budget */
    double ms_per_minsn; /* what a million instructions is thought to take */

    /* Private. */
    double minsn[SCENE_BUDGET_LEVELS]; /* told for each level */
    int n_frames;
};

void scene_budget_init(struct scene_budget *budget,
                       const struct scene_dials *asked);

/* Returns the dials of LEVEL. */
struct scene_dials scene_budget_dials(const struct scene_budget *budget,
                                      int level);

/* Returns whether FRAME is to be looked at before the next choice: the first
 * and some of those that follow. */
bool scene_budget_looks(const struct scene_budget *budget);

/* Takes what FRAME, which has begun with the dials of budget->level, is told to
 * cost. GLINT_E_MEMORY. */
enum glint_status scene_budget_look(struct scene_budget *budget,
                                    const struct scene_frame *frame);

/* Sets budget->level to that with which scene and flare together are told to
 * have the least error within MS: the finest that fits, if FLARE_MS is 0. That
 * is what the flare takes at its default quality. Returns whether it is another
 * level. */
bool scene_budget_choose(struct scene_budget *budget, double ms,
                         double flare_ms);

/* Returns what a flare is told to take at its default quality, which took MS at
 * QUALITY. */
double scene_budget_flare_ms(double ms, double quality);

/* Turns those of DIALS that are 0 to QUALITY, as of --quality; at 0.5 they stay
 * so. */
void scene_dials_be(struct scene_dials *dials, double quality);

/* Learns from a frame that took MS. */
void scene_budget_note(struct scene_budget *budget, double ms);

/* Returns the quality, as of --quality, than which the dials of budget->level
 * are nowhere coarser. */
double scene_budget_quality(const struct scene_budget *budget);

/* Returns the finest level that is no finer than QUALITY, as of --quality. */
int scene_budget_level(double quality);

#endif
