/* SPDX-License-Identifier: MIT
 *
 * The samples of a run of pixels, in one or two rows of a picture. A picture of
 * any format is converted to one byte per sample, as the kernels require. */
#ifndef GLINT_IMAGE_CODES_H
#define GLINT_IMAGE_CODES_H

#include <stdint.h>

#include "image/layout.h"

/* Max pixels per run, a multiple of GLINT_LANES. */
enum { GLINT_CODES_WIDTH = 64 };

struct glint_codes {
    /* Samples of each pixel, [channel][row]. Channels are R, G, B, or Y, Cb,
     * Cr; in grey pictures Cb and Cr are 128. */
    uint8_t sample[3][2][GLINT_CODES_WIDTH];
    /* Chroma of pairs of pixels, Cb and Cr interleaved, [row]. In 4:2:0 both
     * rows use row 0. */
    uint8_t chroma[2][GLINT_CODES_WIDTH];
};

/* Read and write pixels X .. X + N_X - 1 of rows Y .. Y + N_Y - 1. X must be
 * even; if N_Y is 2, Y must be even, too. After the end of a row, reading
 * repeats the row's last pixel. */
void glint_codes_read_pixels(struct glint_codes *codes,
                             const struct glint_image *image, int x, int y,
                             int n_x, int n_y);
void glint_codes_write_pixels(const struct glint_codes *codes,
                              const struct glint_image *image, int x, int y,
                              int n_x, int n_y);

#endif
