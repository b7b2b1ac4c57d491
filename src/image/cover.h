/* SPDX-License-Identifier: MIT
 *
 * Hides the background before light is added.
 *
 *   in   the fraction of each pixel that is hidden; light to add afterwards
 *   out  the picture's own codes, changed in place
 *
 *   code = encode(decode(code) (1 - cover) + light)
 *
 * A fully hidden pixel becomes the light alone. A pixel that is not hidden
 * preserves its code until light is added (resolve.h). Shared chroma is the
 * mean of the chroma of its pixels. The visible background is rounded to codes
 * before light is added. */
#ifndef GLINT_IMAGE_COVER_H
#define GLINT_IMAGE_COVER_H

#include "image/resolve.h"

enum { GLINT_COVER_ALL = 256 };

/* The cover of two rows. */
struct glint_cover_rows {
    /* hidden fraction of the pixel, 0 .. 256 */
    ALIGNED(32) uint16_t cover_q8[2][GLINT_CODES_WIDTH];
};

/* Hides COVER of a run of pixels, then adds LIGHT to it unless LIGHT is NULL.
 * X, Y, N_X and N_Y are as for glint_resolve_stretch(). */
void glint_cover_stretch(const struct glint_resolve *resolve,
                         const struct glint_image *image, int x, int y, int n_x,
                         int n_y, const struct glint_cover_rows *cover,
                         struct glint_light_rows *light,
                         struct glint_resolve_rows *rows);

/* Hides COVER of N pixels from (X, Y) on in a LINEAR_Q20 picture. */
void glint_cover_linear(const struct glint_image *image, int x, int y, int n,
                        const uint16_t *cover_q8);

#endif
