/* SPDX-License-Identifier: MIT
 *
 * Which barrels cut a path, out of all the surfaces it meets.
 *
 *   in   a path, a light in the x-z plane, the part of the pupil that counts
 *   out  the events whose barrel stops a ray that everything else lets pass,
 *        with a margin for what lies between the rays that were asked
 *
 * Most surfaces are wider than the light that the stop lets through: of dozens,
 * none, one or two really cut.
 */
#ifndef GLINT_BAKE_CUTS_H
#define GLINT_BAKE_CUTS_H

#include "glint/bake.h"

struct glint_cuts {
    int n;
    int event[GLINT_MAX_EVENTS]; /* index into the path, rising */
    int rays[GLINT_MAX_EVENTS];  /* that this barrel alone stops */
};

/* Asks a grid of SURVEY cells a side (even) over PUPIL. */
void glint_cuts_find(struct glint_cuts *cuts, const struct glint_path *path,
                     const struct glint_pupil *pupil, const double direction[3],
                     double stop_radius_mm, int survey);

#endif
