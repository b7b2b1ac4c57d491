/* SPDX-License-Identifier: MIT
 *
 * Finds the small parts of a front element through which a ghost is seen.
 *
 *   in   the light's plane, y = 0, across all of the front
 *   out  where on it rays get through, however short that is
 *
 * A lens of 180 degrees has a front of 80 mm, and ghosts that enter by a spot
 * of 1/20 mm: no grid over the front has a ray in it. But between a ray that
 * passes a barrel far on one side of its axis and one that passes it far on the
 * other there is one that passes it in the middle. So pairs of neighbouring
 * rays are kept where that may be so for the stop and all barrels, and looked
 * at again, ever closer, until a ray gets through. Limits: a spot that lies off
 * the light's plane, or within 1/256 of the front beside another. */
#ifndef GLINT_BAKE_TRACE_SPOT_H
#define GLINT_BAKE_TRACE_SPOT_H

#include "glint/trace.h"

/* What a ray has to pass. */
struct glint_openings {
    const struct glint_path *path;
    double direction[3];
    double stop_mm, field_mm;
};

/* Sets X_MM to the widest range of the line from FRONT's left to its right on
 * which rays get through, and a little more; returns whether there is one. */
bool glint_spot_find(const struct glint_openings *o,
                     const struct glint_pupil *front, double x_mm[2]);

/* Moves every side of P outwards past which rays get through, as far as they
 * do; returns whether any was. */
bool glint_spot_grow(const struct glint_openings *o, struct glint_pupil *p);

#endif
