/* SPDX-License-Identifier: MIT
 *
 * Tells where an edge is at a height, for the code that sorts edges into tiles
 * and the code that adds their light. */
#ifndef GLINT_FLARE_EDGE_AT_H
#define GLINT_FLARE_EDGE_AT_H

#include "base/q.h"
#include "flare/edges/edge.h"

/* Returns x of EDGE at height Y between its ends: below 2^29 pixels _q8, so
 * below 2^61. Slopes are rounded towards 0, so x never lies beyond the ends. */
static inline int64_t edge_x_at_q40(const struct glint_edge *e, int32_t y_q8)
{
    return e->x_q8 * (INT64_C(1) << 32) + e->slope_q40 * (y_q8 - e->y_q8);
}

#endif
