/* SPDX-License-Identifier: MIT
 *
 * Adds light that four pixels share, as resolve.h does for single pixels.
 *
 *   in   linear light, _q16, one value for 2 x 2 pixels
 *   out  the picture's own codes, changed in place
 *
 * In Y'CbCr whose chroma is shared by pairs, the change by light is worked out
 * once, for the mean of four pixels, which is a quarter of the work. Each of
 * them then changes in proportion to how far it is below white. If the four are
 * equal, the result is that of single pixels. In other pictures light is added
 * pixel by pixel. */
#ifndef GLINT_IMAGE_QUADS_H
#define GLINT_IMAGE_QUADS_H

#include "glint/half.h"
#include "glint/image.h"
#include "image/resolve.h"

/* Scratch of a worker. */
struct glint_quads_rows {
    struct glint_light_rows light;
    struct glint_resolve_rows rows;
};

/* Adds LIGHT to N_X x N_Y pixels of IMAGE from (X, Y) on. X is a multiple of 8,
 * Y is even. N_X is at most GLINT_CODES_WIDTH, and odd only at the right side
 * of the picture; N_Y is 2, or 1 at its lower side. A quad is 2 x 2 pixels:
 * LIGHT[c] holds channel c of the (N_X + 1) / 2 quads of the row. It begins at
 * a 32-byte boundary and has room for that number rounded up to a multiple of
 * GLINT_LANES. */
typedef void glint_resolve_quads_fn(const struct glint_resolve *resolve,
                                    const struct glint_image *image, int x,
                                    int y, int n_x, int n_y,
                                    const uint16_t *const light_q16[3],
                                    struct glint_quads_rows *rows);
glint_resolve_quads_fn glint_resolve_quads;

/* Half resolution as an object, linked only by programs that name it.
 */
struct glint_half {
    glint_resolve_quads_fn *resolve;
};

#endif
