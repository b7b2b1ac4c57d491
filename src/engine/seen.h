/* SPDX-License-Identifier: MIT
 *
 * How much of a flare the picture under it lets see.
 *
 *   in   a picture of codes; the flare on it, small, in linear light
 *   out  the light, at scale 1, over what it would take to be seen
 *
 * The same light shows on a night sky and not on a lit wall: added to light b
 * it is seen where it lifts a code of 8 bits by GLINT_SEEN_CODES, which takes
 * the more the brighter b is, and all that a clipped lamp covers shows nothing
 * of it. A flare of which few pixels are seen is taken for none, one of which
 * a quarter is for a veil.
 */
#ifndef GLINT_ENGINE_SEEN_H
#define GLINT_ENGINE_SEEN_H

#include "glint/image.h"

enum {
    GLINT_GROUND_COLUMNS = 320,
    GLINT_GROUND_ROWS = 180,
    GLINT_SEEN_CODES = 32,
    GLINT_SEEN_FEW = 50, /* one of so many pixels */
    GLINT_SEEN_MANY = 4
};

/* What is behind the flare: full-range codes. */
struct glint_ground {
    uint8_t rgb[GLINT_GROUND_ROWS][GLINT_GROUND_COLUMNS][3];
};

/* Light over what is seen, that one pixel in GLINT_SEEN_FEW and in
 * GLINT_SEEN_MANY reaches, to an eighth of a stop: times 1 / few, few are seen.
 * 0: fewer get any. */
struct glint_seen {
    double few, many;
};

void glint_ground_take(struct glint_ground *ground,
                       const struct glint_image *image);

/* RGB: the flare on all of the picture, at any size. */
void glint_seen_on(struct glint_seen *seen, const struct glint_ground *ground,
                   const float *rgb, int width, int height);

#endif
