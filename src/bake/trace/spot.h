/* SPDX-License-Identifier: MIT
 *
 * Finds small parts of a front element through which a ghost enters.
 *
 *   in   the light's plane, y = 0, across all of the front
 *   out the range on it where rays get through, however small
 *
 * A lens of 180 degrees has a front of 80 mm, and ghosts that enter by a spot
 * of 1/20 mm: no grid over the front has a ray in it. But between a ray that
 * passes a barrel far on one side of its axis and one that passes it far on the
 * other there is one that passes it in the middle. So pairs of neighbouring
 * rays are refined where that may be the case for the stop and all barrels,
 * until a ray gets through. Limits: a spot that lies off the light's plane, or
 * within 1/256 of the front beside another. */
#ifndef GLINT_BAKE_TRACE_SPOT_H
#define GLINT_BAKE_TRACE_SPOT_H

#include "glint/trace.h"

/* Limits that a ray must pass. */
struct glint_openings {
    const struct glint_path *path;
    double direction[3];
    double stop_mm, field_mm;
};

/* Sets X_MM to the widest range of the line from left to right of FRONT on
 * which rays get through, and a little more. Returns false if no ray gets
 * through. */
bool glint_spot_find(const struct glint_openings *o,
                     const struct glint_pupil *front, double x_mm[2]);

/* Moves every side of P outwards past which rays get through, as far as they
 * do; returns whether any was. */
bool glint_spot_grow(const struct glint_openings *o, struct glint_pupil *p);

#endif
