/* SPDX-License-Identifier: MIT
 *
 * Draws a flare in front of other passes, such as veil and starburst, in one
 * traversal of the tiles. */
#ifndef GLINT_FLARE_DRAW_OVER_H
#define GLINT_FLARE_DRAW_OVER_H

#include "glint/flare.h"
#include "tile/blend.h"

struct glint_flare_under {
    const struct glint_pass *pass; /* [n]: the passes, from back to front */
    int n;                         /* 0 .. GLINT_MAX_PASSES - 1 */
    const struct glint_blend *blend;
    struct glint_blend_rows *rows; /* [number of workers of the flare] */
};

/* Draws FLARE onto IMAGE like glint_flare_draw(), with the passes of UNDER
 * behind it. The passes get the tiles of the flare. At half resolution each
 * pixel of a tile covers 2 x 2 pixels of the picture. */
void glint_flare_draw_over_passes(struct glint_flare *flare,
                                  const struct glint_image *image,
                                  const struct glint_flare_under *under);

#endif
