/* SPDX-License-Identifier: MIT
 *
 * Finds the region of the pupil through which a ghost is visible, for patches
 * of light directions, in lenses without rotational symmetry.
 *
 *   in   a ghost, its paths in the lens's own frame, a patch of directions
 *   out  the pupil box of the visible rays at each sampled direction and
 *        wavelength; a zone whose box contains all of these boxes
 *
 * A patch is a rectangle of x and y components of directions, each -1 .. 1.
 */
#ifndef GLINT_BAKE_SKEW_DIRECTIONS_H
#define GLINT_BAKE_SKEW_DIRECTIONS_H

#include "bake/fit/zone.h"

struct glint_directions {
    double x0, x1, y0, y1;
};

/* Returns the min sine of the angle between the lens axis and any direction of
 * PATCH. */
double glint_directions_get_min_sine(const struct glint_directions *patch);

enum {
    GLINT_PATCH_SIDE = 4, /* number of directions along each side of a patch */
    /* number of wavelengths: both ends and the middle of the band */
    GLINT_PATCH_WAVES = 3
};

/* The box of visible rays at one direction and wavelength of a patch. */
struct glint_sight {
    /* zone coordinates of the box: s and p for the direction, w for the
     * wavelength; the others are 0 */
    double x[GLINT_VARIABLES];
    struct glint_pupil box;
};

struct glint_sights {
    int n;
    struct glint_sight
        at[GLINT_PATCH_SIDE * GLINT_PATCH_SIDE * GLINT_PATCH_WAVES];
};

/* Finds the boxes of visible light for those directions of PATCH whose angle
 * has a sine of at most SINE_HI. Searches the whole pupil if WITHIN is NULL,
 * else only the box of WITHIN, a zone of the same band that covers the
 * patch. */
void glint_sights_find_boxes(const struct glint_visible *visible,
                             const struct glint_directions *patch,
                             double sine_hi, const struct glint_zone *within,
                             struct glint_sights *sights);

/* Initialises ZONE for the directions of PATCH, with a box that contains all
 * boxes in SIGHTS (at least one). */
void glint_sights_fit_zone(const struct glint_sights *sights,
                           const struct glint_directions *patch,
                           struct glint_zone *zone);

#endif
