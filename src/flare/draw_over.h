/* SPDX-License-Identifier: MIT
 *
 * Drawing a flare over what other passes draw of the same frame.
 */
#ifndef GLINT_FLARE_DRAW_OVER_H
#define GLINT_FLARE_DRAW_OVER_H

#include "glint/flare.h"
#include "tile/blend.h"

struct glint_flare_under {
    const struct glint_pass *pass; /* the hindmost first */
    int n;                         /* 0 .. GLINT_MAX_PASSES - 1 */
    const struct glint_blend *blend;
    struct glint_blend_rows *rows; /* one for each worker of the flare */
};

/* Does as glint_flare_draw(), but draws over UNDER. Passes see the flare's
 * tiles: at half resolution in pixels of twice the size, and by cells in two
 * levels in rows that end at each large tile. */
void glint_flare_draw_over(struct glint_flare *flare,
                           const struct glint_image *image,
                           const struct glint_flare_under *under);

#endif
