/* SPDX-License-Identifier: MIT
 *
 * As resolve.h, of light that four pixels have in common.
 *
 *   in   linear light, _q16, one value for 2 x 2 pixels
 *   out  the picture's own codes, changed in place
 *
 * Y'CbCr whose chroma is shared by pairs: what light changes is worked out
 * once, for the mean of four pixels, which is a quarter of the work; each of
 * them changes by it, in proportion to what it lacks to white. Where the
 * picture is even over the four it makes no difference. Other pictures: pixel
 * by pixel.
 */
#ifndef GLINT_TILE_QUADS_H
#define GLINT_TILE_QUADS_H

#include "glint/flare.h"
#include "tile/resolve.h"

/* Scratch of a worker. */
struct glint_quads_rows {
    ALIGNED(32) uint16_t quads_q16[3][GLINT_CODES_WIDTH / 2];
    struct glint_light_rows light;
    struct glint_resolve_rows rows;
};

/* As resolve_stretch, by quads: N_X x N_Y pixels of IMAGE from (X, Y) on: X is
 * a multiple of 8 and Y even, N_X at most GLINT_CODES_WIDTH and even but at the
 * right edge, N_Y 2 but at the lower edge. LIGHT: R, G, B of (N_X + 1) / 2
 * quads, at 32-byte boundaries, and as long as a multiple of GLINT_LANES. */
typedef void glint_resolve_quads_fn(const struct glint_resolve *resolve,
                                    const struct glint_image *image, int x,
                                    int y, int n_x, int n_y,
                                    const uint16_t *const light_q16[3],
                                    struct glint_quads_rows *rows);
glint_resolve_quads_fn glint_resolve_quads;

/* What differs by less than so many codes, 0 .. 2^13, in every channel, as
 * light on black; on anything brighter codes differ by less. A code is worth 20
 * steps of light or more where codes are linear, and above that 1/106 of white,
 * which shrinks less than light does. */
static inline struct glint_even glint_even_of(int codes_q8)
{
    const struct glint_even even = {(int16_t)(codes_q8 * 10 >> 8),
                                    (int16_t)codes_q8};

    return even;
}

/* As resolve_stretch, of N_Y rows of LIGHT, but units of 32 x 2 pixels that are
 * EVEN are lit by quads. X is a multiple of 32. */
typedef void glint_resolve_even_fn(const struct glint_resolve *resolve,
                                   const struct glint_even *even,
                                   const struct glint_image *image, int x,
                                   int y, int n_x, int n_y,
                                   struct glint_light_rows *light,
                                   struct glint_quads_rows *rows);
glint_resolve_even_fn glint_resolve_even;

/* Both, so that drawing links neither by itself. */
struct glint_quads {
    glint_resolve_quads_fn *all;
    glint_resolve_even_fn *even;
};

#endif
