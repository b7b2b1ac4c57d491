/* SPDX-License-Identifier: MIT
 *
 * panel/row_rgb.h - a stretch of a row of a picture as R', G', B' bytes.
 *
 *     in   picture of 8-bit codes, any format but GLINT_LINEAR_Q20
 *     out  three arrays of codes of full range, one for each channel
 *
 * R' = Y' ky + Cr k and so on, in integers: constants have 13 fraction bits
 * (_q13), one rounding to the nearest code, ties up, then a clamp to 0 .. 255.
 * Over all codes that is within 1 of the same sum in exact arithmetic, equal to
 * it for 99.6 % of them and for all greys. Chroma of subsampled formats is
 * repeated, as where flares are drawn (src/image/codes.c).
 *
 * Channels may point into the picture itself where nothing has to be computed.
 */
#ifndef GLINT_PLATFORM_PANEL_ROW_RGB_H
#define GLINT_PLATFORM_PANEL_ROW_RGB_H

#include "glint/image.h"

struct glint_row_rgb {
    const uint8_t *channel[3]; /* R', G', B' of the last read */

    /* Private. */
    uint8_t *rgb[3], *luma, *cb, *cr; /* rows in the caller's memory */
};

/* Splits N pairs of bytes. Arrays do not overlap. */
void glint_split_pairs(uint8_t *restrict a, uint8_t *restrict b,
                       const uint8_t *restrict from, int n);

/* Splits N pairs of pixels of FORMAT, GLINT_YUYV or GLINT_UYVY, each with two
 * samples of luma and one of Cb and Cr. */
void glint_split_packed(enum glint_pixel_format format, uint8_t *luma,
                        uint8_t *cb, uint8_t *cr, const uint8_t *from, int n);

/* Returns the bytes of memory that rows of up to WIDTH pixels take. */
size_t glint_row_rgb_bytes(int width);

/* Prepares ROW for up to WIDTH pixels. It keeps using
 * MEM[glint_row_rgb_bytes(width)]. */
void glint_row_rgb_init(struct glint_row_rgb *row, void *mem, int width);

/* Sets row->channel to the pixels X .. X + N - 1 of row Y of IMAGE. X is
 * even. */
void glint_row_rgb_read(struct glint_row_rgb *row,
                        const struct glint_image *image, int x, int y, int n);

#endif
