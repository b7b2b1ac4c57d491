/* SPDX-License-Identifier: MIT
 *
 * From light to pixels of the picture.
 *
 *   in   linear light to add, _q16, 65535 = display white, which saturates
 *   out  the picture's own codes, changed in place: decode to linear, add,
 *        encode. A pixel without light keeps its code exactly, whatever the
 *        format, and none gets darker.
 *
 * Y'CbCr pictures: the change of R'G'B' is carried over to Y' per pixel, and to
 * Cb and Cr as the mean change over the pixels that share the sample; samples
 * that change by less than half a code stay. Codes outside the R'G'B' cube are
 * held to it for the sum only, so that nothing jumps where the first light
 * arrives.
 *
 * Grey pictures: what is added is the luminance of the light, with the weights
 * of BT.709, the primaries of linear light here; the matrix has no say.
 *
 * Before rounding to codes, the error of R', G', B' is below 0.11 code
 * (kernels/tone.h); light counts in steps that are worth 0.1 code at most.
 */
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
    /* Added before rounding down, in codes: 1/2, or an 8 x 8 pattern of that
     * mean below 1, which leaves whole codes whole. */
    int16_t round_q7[8][8];
};

/* Two rows of a tile, for resolve, which may write past the last pixel. */
struct glint_light_rows {
    ALIGNED(32) uint16_t rgb_q16[3][2][GLINT_CODES_WIDTH];
};

/* Scratch of a worker. */
struct glint_resolve_rows {
    ALIGNED(32) struct glint_codes codes;
    ALIGNED(32)
    int16_t change[3][GLINT_CODES_WIDTH]; /* changes of codes as kernels have
                                             them */
    ALIGNED(32) uint16_t grey_q16[GLINT_CODES_WIDTH];
};

/* Tables for pictures that are coded as IMAGE is. DITHER: add an ordered
 * pattern of less than a code before rounding, the same for every run. */
void glint_resolve_init(struct glint_resolve *resolve,
                        const struct glint_image *image, int dither,
                        unsigned sets);

/* Adds LIGHT to the pixels X .. X + N_X - 1 of the N_Y (1 or 2) rows from Y on
 * of IMAGE, which is not LINEAR_Q20. X is a multiple of 8 and Y even, and N_X
 * is even but at the picture's right edge; there is one row only at its lower
 * edge. Then stretches share no sample and may be resolved in any order, or at
 * once. */
void glint_resolve_stretch(const struct glint_resolve *resolve,
                           const struct glint_image *image, int x, int y,
                           int n_x, int n_y, struct glint_light_rows *light,
                           struct glint_resolve_rows *rows);

/* The same of a stretch that has been read to rows->codes, and is not yet
 * written. */
void glint_resolve_codes(const struct glint_resolve *resolve,
                         const struct glint_image *image, int y, int n_x,
                         int n_y, struct glint_light_rows *light,
                         struct glint_resolve_rows *rows);

/* Adds N values of LIGHT, R, G, B by themselves, to a row of a LINEAR_Q20
 * picture (4-byte aligned) from (X, Y) on, as they are, saturating at the int32
 * range; returns how many came to an end of it. */
int glint_resolve_linear(const struct glint_image *image, int x, int y, int n,
                         const int32_t *const light_q20[3]);

#endif
