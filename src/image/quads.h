/* SPDX-License-Identifier: MIT
 *
 * Adds light that has one value per 2 x 2 pixels; resolve.h adds light that has
 * one value per pixel.
 *
 *    in linear light, _q16, one value per 2 x 2 pixels
 *    out the picture's own codes, changed in place
 *
 * In Y'CbCr formats whose pixel pairs share chroma, the change is computed
 * once, for the mean of the 2 x 2 pixels. This is a quarter of the work. Each
 * pixel then changes in proportion to its distance from white. If the four
 * pixels are equal, the result equals that of resolve.h. In other formats light
 * is added pixel by pixel. */
#ifndef GLINT_IMAGE_QUADS_H
#define GLINT_IMAGE_QUADS_H

#include "glint/half.h"
#include "glint/image.h"
#include "image/resolve.h"

/* Scratch memory of one worker. */
struct glint_quads_rows {
    struct glint_light_rows light;
    struct glint_resolve_rows rows;
};

/* Adds LIGHT to N_X x N_Y pixels of IMAGE from (X, Y) to the right and down. X
 * must be a multiple of 8 and Y even. N_X is at most GLINT_CODES_WIDTH, and may
 * be odd only at the right side of the picture. N_Y is 2, or 1 in the picture's
 * last row. LIGHT[c] has channel c of (N_X + 1) / 2 quads (2 x 2 pixels),
 * aligned to 32 bytes, in memory for a multiple of GLINT_LANES quads. */
typedef void glint_resolve_quads_fn(const struct glint_resolve *resolve,
                                    const struct glint_image *image, int x,
                                    int y, int n_x, int n_y,
                                    const uint16_t *const light_q16[3],
                                    struct glint_quads_rows *rows);
glint_resolve_quads_fn glint_resolve_add_to_quads;

/* The functions for light at half resolution, called through pointers so that
 * only programs that use them link them. */
struct glint_half {
    glint_resolve_quads_fn *resolve;
};

#endif
