/* SPDX-License-Identifier: MIT
 *
 * Measures how visible a flare is on the picture onto which it is drawn.
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
 * a flat disc. */
#ifndef GLINT_ENGINE_SEEN_H
#define GLINT_ENGINE_SEEN_H

#include "glint/image.h"

enum {
    GLINT_GROUND_COLUMNS = 320,
    GLINT_GROUND_ROWS = 180,
    GLINT_SEEN_CODES = 32,
    /* Range of the picture's codes on which white discs (ghosts that turn the
     * picture white) are searched. On brighter codes such a disc has no visible
     * edge. */
    GLINT_SEEN_BRIGHT = 160,
    GLINT_SEEN_WHITE = 248,
    GLINT_SEEN_FEW = 50, /* A flare that is visible in fewer than 1/50 of the
                            pixels counts as invisible. A flare that is visible
                            in 1/4 or more of them counts as a veil. */
    GLINT_SEEN_MANY = 4,
    GLINT_SEEN_DISC = 1000 /* a small ghost covers 1/1000 of the picture */
};

/* The picture under the flare, sampled to a small size: full-range R'G'B'
 * codes. */
struct glint_ground {
    uint8_t rgb[GLINT_GROUND_ROWS][GLINT_GROUND_COLUMNS][3];
};

/* Max ratios of light that more than a given fraction of the pixels reach,
 * rounded down to an eighth of a stop; 0: fewer pixels have a ratio above 0. */
struct glint_seen {
    /* Light that the flare adds / min visible light. few: in 1/GLINT_SEEN_FEW
     * of the pixels; a flare scaled by 1 / few is just visible. many: in
     * 1/GLINT_SEEN_MANY of them. */
    double few, many;
    /* Light that the flare adds / light that turns all channels white, in
     * 1/GLINT_SEEN_DISC of the pixels. The ratio of a pixel with a channel
     * below GLINT_SEEN_BRIGHT is 0. */
    double white;
};

void glint_ground_sample_picture(struct glint_ground *ground,
                                 const struct glint_image *image);

/* Sets SEEN to the visibility of the flare RGB, [height][width][3], linear
 * light, on GROUND, which shows the same field of view. */
void glint_seen_measure_visibility(struct glint_seen *seen,
                                   const struct glint_ground *ground,
                                   const float *rgb, int width, int height);

#endif
