/* SPDX-License-Identifier: MIT
 *
 * The grid of a sun's shadows: what making it (frame/shadow_grid.c) and asking
 * it (shadow.c) share. */
#ifndef GLINT_SCENE_SHADOW_GRID_H
#define GLINT_SCENE_SHADOW_GRID_H

#include "scene/state.h"

enum {
    GLINT_SHADOW_CELLS = 1 << GLINT_SHADOW_CELLS_LOG2,
    GLINT_SHADOW_SLACK = 4,  /* steps, for rounding */
    GLINT_SHADOW_SORTED = 64 /* things of a list that is sorted, at most */
};

/* Returns how far rays lean over a height, below 2^32. */
static inline int64_t glint_shadow_lean(const struct glint_shadow *shadow,
                                        int64_t height)
{
    return q_shift(height * shadow->lean_q30, 30);
}

/* Returns where X, within +-2^33, is along AXIS of the grid, in 256ths of a
 * cell, which is GLINT_SHADOW_SLACK steps at least; within +-2^15. */
static inline int32_t glint_shadow_across_q8(const struct glint_shadow *shadow,
                                             int64_t x, int axis)
{
    return q_clamp_sat((x - shadow->lo[axis]) * shadow->cells_q32[axis] >> 24,
                       INT16_MIN, INT16_MAX);
}

#endif
