/* SPDX-License-Identifier: MIT
 *
 * A stretch of one or two rows of a picture, one byte a sample, as the kernels
 * want it, whatever the format.
 */
#ifndef GLINT_IMAGE_CODES_H
#define GLINT_IMAGE_CODES_H

#include <stdint.h>

#include "image/layout.h"

enum { GLINT_CODES_WIDTH = 64 }; /* pixels, a multiple of GLINT_LANES */

struct glint_codes {
    /* [channel][row]: R, G, B, or Y, Cb, Cr, one for each pixel; of pictures of
     * luma alone Cb and Cr are 128 */
    uint8_t sample[3][2][GLINT_CODES_WIDTH];
    /* Chroma of pixels that share it in pairs, Cb and Cr by turns; in 4:2:0 the
     * first row serves both. */
    uint8_t chroma[2][GLINT_CODES_WIDTH];
};

/* Reads the pixels X .. X + N_X - 1 of N_Y rows from Y on; X is even, and so is
 * Y where there are two rows. Pixels past the end repeat the last one. */
void glint_codes_read(struct glint_codes *codes,
                      const struct glint_image *image, int x, int y, int n_x,
                      int n_y);
void glint_codes_write(const struct glint_codes *codes,
                       const struct glint_image *image, int x, int y, int n_x,
                       int n_y);

#endif
