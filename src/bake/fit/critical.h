/* SPDX-License-Identifier: MIT
 *
 * Barrels for rays that no rim blocks: those that end by total reflection or
 * because they miss a surface.
 *
 *   in   a zone, the rays that its polynomials transmit although they end
 *   out  the event at which they end, and a radius there for all rays
 *
 * The outputs have a singularity where rays end, so their polynomials continue
 * the ghost beyond it. The margin of the angle, a squared cosine, is smooth and
 * changes its sign there. The root of 1 - margin serves as the relative radius
 * of a barrel, so the run time needs no other test.
 */
#ifndef GLINT_BAKE_FIT_CRITICAL_H
#define GLINT_BAKE_FIT_CRITICAL_H

#include "bake/fit/zone_rays.h"

struct glint_critical {
    int event; /* index among the path's events; -1: none */
    /* true: rays miss the surface; false: they are totally reflected there, or
     * refracted so far that they run back along the axis */
    bool misses;
};

/* Returns where most of the N rays end. INDEX[N]: indices among the invalid
 * rays of RAYS. */
struct glint_critical glint_critical_find(const struct glint_zone *zone,
                                          const struct glint_visible *visible,
                                          const struct glint_zone_rays *rays,
                                          const int *index, int n);

/* Sets OUT to the rays of RAYS, invalid ones included, that reach C. radius[0]
 * exceeds 1 for rays that end there. RAY_EXCESS is that up to C; the other
 * channels are undefined. */
void glint_critical_trace_rays(const struct glint_zone *zone,
                               const struct glint_visible *visible,
                               const struct glint_zone_rays *rays,
                               struct glint_critical c,
                               struct glint_zone_rays *out);

#endif
