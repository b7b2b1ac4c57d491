/* SPDX-License-Identifier: MIT
 *
 * Draws a flare over other passes of the same frame. */
#ifndef GLINT_FLARE_DRAW_OVER_H
#define GLINT_FLARE_DRAW_OVER_H

#include "glint/flare.h"
#include "tile/blend.h"

struct glint_flare_under {
    const struct glint_pass *pass; /* [n], from back to front */
    int n;                         /* 0 .. GLINT_MAX_PASSES - 1 */
    const struct glint_blend *blend;
    struct glint_blend_rows *rows; /* [number of workers of the flare] */
};

/* Like glint_flare_draw(), over the passes of UNDER. The passes are called
 * with the flare's tiles: at half resolution these have pixels twice as wide
 * and high; if cells are drawn in two levels, a row of tiles ends at the
 * side of each large tile. */
void glint_flare_draw_over_passes(struct glint_flare *flare,
                                  const struct glint_image *image,
                                  const struct glint_flare_under *under);

#endif
