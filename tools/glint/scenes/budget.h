/* SPDX-License-Identifier: MIT
 *
 * Adapts the quality of a scene to a time limit per frame. After two frames
 * above the limit the next coarser level is used. After some frames far below
 * the limit the next finer level is tried.
 */
#ifndef GLINT_TOOLS_SCENES_BUDGET_H
#define GLINT_TOOLS_SCENES_BUDGET_H

#include "scenes/scene_frame.h"

/* number of quality levels; level 0 has the requested quality, the last level
 * is the coarsest */
enum { SCENE_BUDGET_LEVELS = 5 };

struct scene_budget {
    struct scene_dials asked;
    int level;

    /* Private. */
    int n_frames;   /* number of frames drawn with LEVEL */
    double last_ms; /* time of the last frame, ms */
    /* number of frames to draw before a finer level is tried */
    int hold;
    bool is_try; /* whether LEVEL is on trial, as a finer level than before */
};

void scene_budget_init(struct scene_budget *budget,
                       const struct scene_dials *asked);

struct scene_dials
scene_budget_get_parameters(const struct scene_budget *budget, int level);

/* Sets budget->level for the next frame. MS is the time of the previous frame,
 * LIMIT_MS is the limit. Returns whether the level changed. */
bool scene_budget_update_level(struct scene_budget *budget, double ms,
                               double limit_ms);

/* Returns how much of ALL_MS, the time limit of a frame, the scene may use, ms.
 * FLARE_MS is the time of the last flare, and QUALITY its --quality; both are 0
 * before the first frame. */
double scene_budget_limit_flare(double all_ms, double flare_ms, double quality);

/* Sets the members of DIALS that are 0 to the values of the level for --quality
 * QUALITY. For the default quality, 0.5, they remain 0. */
void scene_dials_set_quality(struct scene_dials *dials, double quality);

/* Returns the highest --quality at which no parameter is finer than at
 * budget->level. */
double scene_budget_get_flare_quality(const struct scene_budget *budget);

/* Returns the finest level that --quality QUALITY allows. */
int scene_budget_find_level_of_quality(double quality);

#endif
