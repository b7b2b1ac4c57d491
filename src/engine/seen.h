/* SPDX-License-Identifier: MIT
 *
 * Visibility of a flare on the picture under it.
 *
 *   in   a picture of codes; the flare on it, small, in linear light
 *   out the light, at scale 1 / the least visible light, and / the light that
 *       turns the picture white
 *
 * A flare is visible on a night sky but not on a lit wall: light that is added
 * to a pixel of light b is visible if it raises its 8-bit code by
 * GLINT_SEEN_CODES. That needs more light for brighter b, and is impossible on
 * clipped pixels. A flare with few visible pixels counts as invisible, one with
 * a quarter as a veil. A ghost that turns a bright sky white has lost its
 * colour and shape: it is a flat disc. */
#ifndef GLINT_ENGINE_SEEN_H
#define GLINT_ENGINE_SEEN_H

#include "glint/image.h"

enum {
    GLINT_GROUND_COLUMNS = 320,
    GLINT_GROUND_ROWS = 180,
    GLINT_SEEN_CODES = 32,
    /* Codes of bright ground: darker ground does not turn white, and on
     * brighter one a white disc has no edge. */
    GLINT_SEEN_BRIGHT = 160,
    GLINT_SEEN_WHITE = 248,
    GLINT_SEEN_FEW = 50, /* one pixel in 50 is few, one in 4 is many */
    GLINT_SEEN_MANY = 4,
    GLINT_SEEN_DISC = 1000 /* one pixel in 1000 is a small ghost */
};

/* The picture under the flare: full-range codes. */
struct glint_ground {
    uint8_t rgb[GLINT_GROUND_ROWS][GLINT_GROUND_COLUMNS][3];
};

/* The light, over the least that can be seen, that one pixel in GLINT_SEEN_FEW,
 * or GLINT_SEEN_MANY, reaches, to an eighth of a stop; 0 if fewer have any. A
 * flare scaled by 1 / few is seen in few pixels. WHITE: the light, over that
 * which makes all channels white, that one pixel in GLINT_SEEN_DISC reaches,
 * of those with no channel below GLINT_SEEN_BRIGHT. Channels from
 * GLINT_SEEN_WHITE on do not count. */
struct glint_seen {
    double few, many, white;
};

void glint_ground_take(struct glint_ground *ground,
                       const struct glint_image *image);

/* Sets SEEN for the flare RGB, [height][width][3], on the whole of GROUND. */
void glint_seen_on(struct glint_seen *seen, const struct glint_ground *ground,
                   const float *rgb, int width, int height);

#endif
