/* SPDX-License-Identifier: MIT
 *
 * Hides the background where objects cover it, before light is added.
 *
 *   in the fraction of each pixel that is hidden; light to add afterwards
 *   out the picture's own codes, changed in place
 *
 *   code = encode(decode(code) (1 - cover) + light)
 *
 * A fully hidden pixel becomes the light alone. The code of a pixel that is not
 * hidden does not change until light is added (resolve.h). If several pixels
 * share a chroma sample, it becomes the mean of their new chroma values. The
 * background that remains is rounded to codes before light is added. */
#ifndef GLINT_IMAGE_COVER_H
#define GLINT_IMAGE_COVER_H

#include "image/resolve.h"

enum { GLINT_COVER_ALL = 256 };

/* The cover of the pixels of a run, in two rows. */
struct glint_cover_rows {
    /* Hidden fraction of each pixel, [row][pixel], 0 .. 256. */
    ALIGNED(32) uint16_t cover_q8[2][GLINT_CODES_WIDTH];
};

/* Hides the fraction COVER of each pixel of a run, then adds LIGHT unless
 * LIGHT is NULL. The run and its limits are those of
 * glint_resolve_add_to_run(): pixels X .. X + N_X - 1 of rows Y .. Y + N_Y -
 * 1. */
void glint_hide_background_of_run(const struct glint_resolve *resolve,
                                  const struct glint_image *image, int x, int y,
                                  int n_x, int n_y,
                                  const struct glint_cover_rows *cover,
                                  struct glint_light_rows *light,
                                  struct glint_resolve_rows *rows);

/* Hides the fraction COVER of each of N pixels of a LINEAR_Q20 picture, from
 * (X, Y) to the right. */
void glint_hide_background_of_linear_run(const struct glint_image *image, int x,
                                         int y, int n,
                                         const uint16_t *cover_q8);

#endif
