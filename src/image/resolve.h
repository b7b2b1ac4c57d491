/* SPDX-License-Identifier: MIT
 *
 * Adds light to the pixels of a picture.
 *
 *   in   linear light to add, _q16, 65535 = display white, which saturates
 *   out  the picture's own codes, changed in place: decode to linear, add,
 *        encode. In every format a pixel without light preserves its code
 *        exactly, and no pixel gets darker.
 *
 * Y'CbCr pictures: the change of R'G'B' is added to Y' per pixel. Cb and Cr
 * change by the mean over the pixels that share the sample. Samples that would
 * change by less than half a code stay unchanged. Codes outside the R'G'B' cube
 * are clamped to it only to compute the change, so that pixels change
 * continuously as light rises from 0.
 *
 * Grey pictures: the luminance of the light is added, with the weights of
 * BT.709, because linear light has the primaries of BT.709. The picture's
 * matrix is not used.
 *
 * Before rounding to codes, the error of R', G', B' is below 0.11 code
 * (kernels/tone.h); light is quantised to steps of 0.1 code at most. */
#ifndef GLINT_IMAGE_RESOLVE_H
#define GLINT_IMAGE_RESOLVE_H

#include <stdint.h>

#include "base/compiler.h"
#include "glint/image.h"
#include "kernels/kernels.h"
#include "image/codes.h"

struct glint_resolve {
    struct glint_mix mix;
    const struct glint_kernels *kernels;
    unsigned sets;
    /* Fraction of a code that is added before rounding down. It is 1/2 for all
     * pixels, or an 8 x 8 dither pattern whose mean is 1/2. Values are below 1,
     * so that codes without light do not change. */
    int16_t round_q7[8][8];
};

/* Light of two rows of a run of pixels; functions may write past the last
 * pixel. */
struct glint_light_rows {
    ALIGNED(32) uint16_t rgb_q16[3][2][GLINT_CODES_WIDTH];
};

/* Scratch memory of one worker. */
struct glint_resolve_rows {
    ALIGNED(32) struct glint_codes codes;
    ALIGNED(32)
    int16_t change[3][GLINT_CODES_WIDTH]; /* changes of R', B' and Y', in the
                                             number formats of the kernels */
    ALIGNED(32) uint16_t grey_q16[GLINT_CODES_WIDTH];
};

/* Prepares tables for pictures with the format, range, matrix and transfer of
 * IMAGE. If DITHER is 1, an ordered dither pattern below one code is added
 * before rounding. SETS: instruction sets that may be used. */
void glint_resolve_init(struct glint_resolve *resolve,
                        const struct glint_image *image, int dither,
                        unsigned sets);

/* Adds LIGHT to pixels X .. X + N_X - 1 of N_Y rows (1 or 2) of IMAGE, from row
 * Y down. IMAGE must not be LINEAR_Q20. X must be a multiple of 8 and Y even.
 * N_X must be even except at the picture's right side; N_Y must be 2 except in
 * its last row. So no two calls change the same sample, and calls may run in
 * any order or concurrently. */
void glint_resolve_add_to_run(const struct glint_resolve *resolve,
                              const struct glint_image *image, int x, int y,
                              int n_x, int n_y, struct glint_light_rows *light,
                              struct glint_resolve_rows *rows);

/* Adds LIGHT to the pixels in rows->codes, which the caller has read, without
 * writing them to IMAGE. */
void glint_resolve_add_to_codes(const struct glint_resolve *resolve,
                                const struct glint_image *image, int y, int n_x,
                                int n_y, struct glint_light_rows *light,
                                struct glint_resolve_rows *rows);

/* Adds LIGHT, N values per channel, to a row of a LINEAR_Q20 picture (4-byte
 * aligned) from (X, Y) to the right. Sums are clamped to int32; returns the
 * number of samples at these limits. */
int glint_resolve_add_to_linear(const struct glint_image *image, int x, int y,
                                int n, const int32_t *const light_q20[3]);

#endif
