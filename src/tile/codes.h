/* SPDX-License-Identifier: MIT
 *
 * A stretch of one or two rows of a picture, one byte a sample and every
 * channel by itself, whatever the format: what the kernels work on.
 */
#ifndef GLINT_TILE_CODES_H
#define GLINT_TILE_CODES_H

#include <stdint.h>

#include "base/layout.h"

enum { GLINT_CODES_WIDTH = 64 }; /* pixels, a multiple of GLINT_LANES */

struct glint_codes {
    /* [channel][row]: Y, Cb, Cr as they are, or R, G, B */
    uint8_t sample[3][2][GLINT_CODES_WIDTH];
    /* Cb, Cr of one row, one for each pixel */
    uint8_t spread[2][GLINT_CODES_WIDTH];
};

/* Reads the pixels X .. X + N_X - 1 of N_Y rows from Y on; X is even, and so is
 * Y where there are two rows. Samples past the end repeat the last one. */
void glint_codes_read(struct glint_codes *codes,
                      const struct glint_image *image, int x, int y, int n_x,
                      int n_y);
void glint_codes_write(const struct glint_codes *codes,
                       const struct glint_image *image, int x, int y, int n_x,
                       int n_y);

/* Fills spread for row ROW, of a picture of luma alone with 128. */
void glint_codes_spread(struct glint_codes *codes,
                        enum glint_pixel_format format, int row);

#endif
