/* SPDX-License-Identifier: MIT
 *
 * Adapts the quality of a scene to a time limit per frame: one level coarser
 * after two frames above the limit, one level finer after some frames far below
 * it.
 */
#ifndef GLINT_TOOLS_SCENES_BUDGET_H
#define GLINT_TOOLS_SCENES_BUDGET_H

#include "scenes/scene_frame.h"

/* Number of levels, from the finest, which has the requested quality, to the
 * coarsest */
enum { SCENE_BUDGET_LEVELS = 5 };

struct scene_budget {
    struct scene_dials asked;
    int level;

    /* Private. */
    int n_frames;   /* number of frames drawn with LEVEL */
    double last_ms; /* time of the last frame, ms */
    int hold;    /* number of frames to draw with a level before a finer one is
                    tried */
    bool is_try; /* whether LEVEL is a finer level on trial */
};

void scene_budget_init(struct scene_budget *budget,
                       const struct scene_dials *asked);

/* Returns the drawing parameters of LEVEL. */
struct scene_dials
scene_budget_get_parameters(const struct scene_budget *budget, int level);

/* Sets budget->level for the next frame, after a frame that took MS with a
 * limit of LIMIT_MS. Returns whether the level changed. */
bool scene_budget_update_level(struct scene_budget *budget, double ms,
                               double limit_ms);

/* Returns the time, ms, that the scene may use of ALL_MS, the time limit of a
 * frame. FLARE_MS: time of the flare, drawn at QUALITY of --quality. Both are 0
 * before the first frame. */
double scene_budget_limit_flare(double all_ms, double flare_ms, double quality);

/* Sets the members of DIALS that are 0 to the values for QUALITY, a --quality.
 * At the default of 0.5 they stay 0. */
void scene_dials_set_quality(struct scene_dials *dials, double quality);

/* Returns the highest --quality none of whose parameters is finer than that of
 * budget->level. */
double scene_budget_get_flare_quality(const struct scene_budget *budget);

/* Returns the finest level that is not finer than --quality QUALITY. */
int scene_budget_find_level_of_quality(double quality);

#endif
