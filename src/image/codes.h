/* SPDX-License-Identifier: MIT
 *
 * A run of pixels of one or two rows of a picture of any format, with one byte
 * per sample as the kernels require. */
#ifndef GLINT_IMAGE_CODES_H
#define GLINT_IMAGE_CODES_H

#include <stdint.h>

#include "image/layout.h"

/* Max pixels per run, a multiple of GLINT_LANES. */
enum { GLINT_CODES_WIDTH = 64 };

struct glint_codes {
    /* [channel][row]: R, G, B, or Y, Cb, Cr of each pixel. Cb and Cr are 128
     * in grey pictures. */
    uint8_t sample[3][2][GLINT_CODES_WIDTH];
    /* Chroma of pairs of pixels, Cb and Cr interleaved. In 4:2:0 both rows
     * share row 0. */
    uint8_t chroma[2][GLINT_CODES_WIDTH];
};

/* Read and write pixels X .. X + N_X - 1 of the N_Y rows from Y on. X must
 * be even; if N_Y is 2, Y must be even, too. Reading repeats the last pixel
 * beyond the end of the row. */
void glint_codes_read(struct glint_codes *codes,
                      const struct glint_image *image, int x, int y, int n_x,
                      int n_y);
void glint_codes_write(const struct glint_codes *codes,
                       const struct glint_image *image, int x, int y, int n_x,
                       int n_y);

#endif
