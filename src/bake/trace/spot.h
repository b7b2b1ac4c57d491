/* SPDX-License-Identifier: MIT
 *
 * Finds small parts of a front element through which a ghost enters.
 *
 *   in   the light's plane, y = 0, across the whole front
 *   out  the range in this plane where rays pass, however small
 *
 * Example: a lens of 180 degrees has a front of 80 mm, and ghosts that enter
 * through a spot of 1/20 mm; no ray of a grid over the front hits it. Therefore
 * pairs of neighbouring rays are examined. If one ray crosses a barrel left of
 * its centre and the other one right of it, a ray between them crosses the
 * centre. If this may hold for the stop and all barrels, the interval between
 * the two rays is searched with more rays, until a ray passes. Limits: misses
 * spots off the light's plane, and spots closer to another one than 1/256 of
 * the front.
 */
#ifndef GLINT_BAKE_TRACE_SPOT_H
#define GLINT_BAKE_TRACE_SPOT_H

#include "glint/trace.h"

/* limits that a ray must pass: the barrels of path, and the radii of the stop
 * and of the field */
struct glint_openings {
    const struct glint_path *path; /* energies are not used */
    double direction[3];
    double stop_mm, field_mm;
};

/* Sets X_MM to the widest range in which rays pass, with a margin. Searches the
 * line across FRONT in the light's plane. Returns false if no ray passes. */
bool glint_spot_find_passing_range(const struct glint_openings *o,
                                   const struct glint_pupil *front,
                                   double x_mm[2]);

/* Moves each side of P outwards until no ray that starts on this side passes.
 * Returns whether a side was moved. */
bool glint_spot_grow_pupil(const struct glint_openings *o,
                           struct glint_pupil *p);

#endif
