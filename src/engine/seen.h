/* SPDX-License-Identifier: MIT
 *
 * Visibility of a flare on the picture under it.
 *
 *    in   the picture, as codes; its flare at reduced size, in linear light
 *    out  the flare's light divided by the min visible light, and divided by
 *         the light that turns the picture white; both for a flare at scale 1
 *
 * A flare is visible on a night sky but not on a lit wall: light that is added
 * to a pixel is visible if it raises the pixel's 8-bit code by
 * GLINT_SEEN_CODES. Brighter pixels need more light for that, and clipped
 * pixels cannot get brighter. A flare with few visible pixels counts as
 * invisible; a flare that is visible in a quarter of the picture counts as a
 * veil. A ghost that turns a bright sky white loses its colour and shape: it is
 * a flat disc.
 */
#ifndef GLINT_ENGINE_SEEN_H
#define GLINT_ENGINE_SEEN_H

#include "glint/image.h"

enum {
    GLINT_GROUND_COLUMNS = 320,
    GLINT_GROUND_ROWS = 180,
    GLINT_SEEN_CODES = 32,
    /* Range of codes of bright ground. Light does not turn darker ground
     * white; on brighter ground a white disc has no visible edge. */
    GLINT_SEEN_BRIGHT = 160,
    GLINT_SEEN_WHITE = 248,
    GLINT_SEEN_FEW = 50, /* one pixel in 50 is few, one in 4 is many */
    GLINT_SEEN_MANY = 4,
    GLINT_SEEN_DISC = 1000 /* one pixel in 1000 is the size of a small ghost */
};

/* The picture under the flare, sampled: full-range R'G'B' codes. */
struct glint_ground {
    uint8_t rgb[GLINT_GROUND_ROWS][GLINT_GROUND_COLUMNS][3];
};

/* FEW and MANY: the ratio of added light to the min visible light that one
 * pixel in GLINT_SEEN_FEW, or GLINT_SEEN_MANY, reaches, to an eighth of a
 * stop; 0 if fewer pixels have light. A flare scaled by 1 / few is just
 * visible in few pixels. WHITE: the ratio of added light to the light that
 * makes all channels white, which one pixel in GLINT_SEEN_DISC reaches;
 * counts only pixels whose channels are all in GLINT_SEEN_BRIGHT ..
 * GLINT_SEEN_WHITE - 1. */
struct glint_seen {
    double few, many, white;
};

void glint_ground_sample_picture(struct glint_ground *ground,
                                 const struct glint_image *image);

/* Sets SEEN for the flare RGB, [height][width][3], which covers all of
 * GROUND. */
void glint_seen_measure_visibility(struct glint_seen *seen,
                                   const struct glint_ground *ground,
                                   const float *rgb, int width, int height);

#endif
