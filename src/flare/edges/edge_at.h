/* SPDX-License-Identifier: MIT
 *
 * Where an edge is at a height: for who sorts edges into tiles and who adds
 * their light.
 */
#ifndef GLINT_FLARE_EDGE_AT_H
#define GLINT_FLARE_EDGE_AT_H

#include "base/q.h"
#include "flare/edges/edge.h"

/* Returns x of EDGE at height Y, within its own: below 2^29 q8 pixels, so 2^61.
 * The slope is never too large, so it never lies beyond its ends. */
static inline int64_t edge_x_at_q40(const struct glint_edge *e, int32_t y_q8)
{
    return e->x_q8 * (INT64_C(1) << 32) + e->slope_q40 * (y_q8 - e->y_q8);
}

#endif
