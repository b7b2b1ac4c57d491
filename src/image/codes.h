/* SPDX-License-Identifier: MIT
 *
 * A stretch of one or two rows of a picture, with one byte per sample as the
 * kernels require, for every format. */
#ifndef GLINT_IMAGE_CODES_H
#define GLINT_IMAGE_CODES_H

#include <stdint.h>

#include "image/layout.h"

/* Pixels of a stretch, a multiple of GLINT_LANES. */
enum { GLINT_CODES_WIDTH = 64 };

struct glint_codes {
    /* [channel][row]: R, G, B, or Y, Cb, Cr, one for each pixel; Cb and Cr are
     * 128 for pictures of luma alone */
    uint8_t sample[3][2][GLINT_CODES_WIDTH];
    /* Chroma that pairs of pixels share, Cb and Cr in turn; in 4:2:0 the first
     * row serves both rows. */
    uint8_t chroma[2][GLINT_CODES_WIDTH];
};

/* Read and write pixels X .. X + N_X - 1 of the N_Y rows from Y on. X is even,
 * and so is Y if there are two rows. Reading repeats the last pixel past the
 * end. */
void glint_codes_read(struct glint_codes *codes,
                      const struct glint_image *image, int x, int y, int n_x,
                      int n_y);
void glint_codes_write(const struct glint_codes *codes,
                       const struct glint_image *image, int x, int y, int n_x,
                       int n_y);

#endif
