/* SPDX-License-Identifier: MIT
 *
 * Where a ghost of a lens that is not round is visible: through which part of
 * the pupil, for light from a direction.
 *
 *   in   a ghost, its paths in the lens's own frame, a patch of directions
 *   out  boxes of visible light at a few directions of it and wavelengths; a
 *        zone whose box follows them
 *
 * Directions are patches of their x and y components, -1 .. 1. */
#ifndef GLINT_BAKE_SKEW_DIRECTIONS_H
#define GLINT_BAKE_SKEW_DIRECTIONS_H

#include "bake/fit/zone.h"

struct glint_directions {
    double x0, x1, y0, y1;
};

/* Returns the min sine of the angle off the axis in PATCH. */
double glint_directions_nearest(const struct glint_directions *patch);

enum {
    GLINT_PATCH_SIDE = 4, /* number of directions along a side of a patch */
    GLINT_PATCH_WAVES = 3 /* ends and middle of the band */
};

/* A box of visible light at one direction and wavelength of a patch. */
struct glint_sight {
    double x[GLINT_VARIABLES]; /* coordinates of the zone: s, w and p count */
    struct glint_pupil box;
};

struct glint_sights {
    int n;
    struct glint_sight
        at[GLINT_PATCH_SIDE * GLINT_PATCH_SIDE * GLINT_PATCH_WAVES];
};

/* Looks for light from PATCH, at directions of at most SINE_HI: everywhere if
 * WITHIN is NULL, else in the box of that, a zone of the same band that covers
 * the patch. */
void glint_sights_find(const struct glint_visible *visible,
                       const struct glint_directions *patch, double sine_hi,
                       const struct glint_zone *within,
                       struct glint_sights *sights);

/* Sets ZONE to PATCH, with a box that contains all SIGHTS, one or more. */
void glint_sights_zone(const struct glint_sights *sights,
                       const struct glint_directions *patch,
                       struct glint_zone *zone);

#endif
