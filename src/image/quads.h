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

/* Adds LIGHT to N_X x N_Y pixels of IMAGE from (X, Y) on: X is a multiple of 8
 * and Y even, N_X at most GLINT_CODES_WIDTH and even but at the right edge, N_Y
 * 2 but at the lower edge. LIGHT: R, G, B of (N_X + 1) / 2 quads, at 32-byte
 * boundaries, and as long as a multiple of GLINT_LANES. */
typedef void glint_resolve_quads_fn(const struct glint_resolve *resolve,
                                    const struct glint_image *image, int x,
                                    int y, int n_x, int n_y,
                                    const uint16_t *const light_q16[3],
                                    struct glint_quads_rows *rows);
glint_resolve_quads_fn glint_resolve_quads;

/* Half resolution as an object, so that drawing links it only where it is
 * named. */
struct glint_half {
    glint_resolve_quads_fn *resolve;
};

#endif
