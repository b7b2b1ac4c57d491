/* SPDX-License-Identifier: MIT
 *
 * Quality of a scene that keeps a time per frame: one level coarser after two
 * frames that took too long, and one finer after some that took much less. */
#ifndef GLINT_TOOLS_SCENES_BUDGET_H
#define GLINT_TOOLS_SCENES_BUDGET_H

#include "scenes/scene_frame.h"

/* Levels from the finest, the requested dials, to the coarsest. */
enum { SCENE_BUDGET_LEVELS = 5 };

struct scene_budget {
    struct scene_dials asked;
    int level;

    /* Private. */
    int n_frames;   /* drawn with LEVEL */
    double last_ms; /* of the last frame */
    int hold;       /* frames with a level before a finer one is tried */
    bool is_try;    /* LEVEL is one that is tried */
};

void scene_budget_init(struct scene_budget *budget,
                       const struct scene_dials *asked);

/* Returns the dials of LEVEL. */
struct scene_dials scene_budget_dials(const struct scene_budget *budget,
                                      int level);

/* Sets budget->level for the next frame, after one that took MS and should take
 * at most LIMIT_MS. Returns whether it is another level. */
bool scene_budget_follow(struct scene_budget *budget, double ms,
                         double limit_ms);

/* Returns the milliseconds of ALL_MS that a scene may take beside a flare that
 * took FLARE_MS at QUALITY, as of --quality. Both are 0 before the first. */
double scene_budget_limit(double all_ms, double flare_ms, double quality);

/* Sets those of DIALS that are 0 by QUALITY, as of --quality; at 0.5 they stay
 * 0. */
void scene_dials_be(struct scene_dials *dials, double quality);

/* Returns the quality, as of --quality, than which the dials of budget->level
 * are nowhere coarser. */
double scene_budget_quality(const struct scene_budget *budget);

/* Returns the finest level that is no finer than QUALITY, as of --quality. */
int scene_budget_level(double quality);

#endif
