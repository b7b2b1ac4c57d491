/* SPDX-License-Identifier: MIT
 *
 * Adapts the quality of a scene to a time limit per frame: one level coarser
 * after two frames above the limit, one level finer after some frames far below
 * it.
 */
#ifndef GLINT_TOOLS_SCENES_BUDGET_H
#define GLINT_TOOLS_SCENES_BUDGET_H

#include "scenes/scene_frame.h"

/* Levels from the finest, as requested, to the coarsest. */
enum { SCENE_BUDGET_LEVELS = 5 };

struct scene_budget {
    struct scene_dials asked;
    int level;

    /* Private. */
    int n_frames;   /* frames drawn with LEVEL */
    double last_ms; /* time of the last frame */
    int hold;       /* frames to draw with a level before a finer level is
                       tried */
    bool is_try;    /* LEVEL is a finer level on trial */
};

void scene_budget_init(struct scene_budget *budget,
                       const struct scene_dials *asked);

/* Returns the drawing parameters of LEVEL. */
struct scene_dials scene_budget_set_dials(const struct scene_budget *budget,
                                          int level);

/* Sets budget->level for the next frame, after a frame that took MS with a
 * limit of LIMIT_MS. Returns whether the level changed. */
bool scene_budget_update_level(struct scene_budget *budget, double ms,
                               double limit_ms);

/* Returns how much of ALL_MS, the time of a frame, the scene may use, ms.
 * FLARE_MS: time of the flare, at QUALITY of --quality. Both are 0 before
 * the first frame. */
double scene_budget_limit_flare(double all_ms, double flare_ms, double quality);

/* Sets those members of DIALS that are 0 by QUALITY, the --quality. At the
 * default of 0.5 they stay 0. */
void scene_dials_set_quality(struct scene_dials *dials, double quality);

/* Returns the highest --quality whose parameters are nowhere finer than
 * those of budget->level. */
double scene_budget_flare_quality(const struct scene_budget *budget);

/* Returns the finest level that is not finer than the --quality QUALITY. */
int scene_budget_level_of_quality(double quality);

#endif
