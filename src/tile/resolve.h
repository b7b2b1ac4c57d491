/* SPDX-License-Identifier: MIT
 *
 * From one tile's accumulators to pixels of the picture.
 *
 *   in   linear light to add, int32 _q20 per channel, 1 = display white;
 *        negative sums (colours outside the gamut) count as 0
 *   out  the picture's own codes, changed in place: decode to linear, add,
 *        encode. A pixel whose sums are 0 keeps its code exactly, whatever the
 *        format; light saturates at the code range.
 *
 * Y'CbCr pictures: the change of R'G'B' is carried over to Y' per pixel, and to
 * Cb and Cr as the mean change over the pixels that share the sample; samples
 * that change by less than half a code stay. Codes outside the R'G'B' cube:
 * what is above white is held to white for the sum only, and what is below
 * black has negative light, so that nothing jumps where the first light
 * arrives.
 *
 * Grey pictures: what is added is the luminance of the sums, with the weights
 * of BT.709, the primaries of linear light here; the matrix has no say.
 *
 * All tables are integers made from integers at init: the same on every CPU.
 * Before rounding to codes, the error is below 0.02 code, but 0.05 at the toe
 * of BT.709 (transfer.h).
 */
#ifndef GLINT_TILE_RESOLVE_H
#define GLINT_TILE_RESOLVE_H

#include <stdint.h>

#include "glint/image.h"
#include "tile/curve.h"

struct glint_resolve { /* 6.4 KiB: too much for a stack */
    struct glint_curve curve;
    struct glint_ycc ycc;
    /* Added before rounding down, in codes: 1/2, or an 8 x 8 pattern of that
     * mean below 1, which leaves whole codes whole. */
    int32_t round_q7[8][8];
};

/* Tables for pictures that are coded as IMAGE is. DITHER: add an ordered
 * pattern of less than a code before rounding, the same for every run. */
void glint_resolve_init(struct glint_resolve *resolve,
                        const struct glint_image *image, int dither);

/* Light to add, pixel (x0, y0) first, row by row. */
struct glint_resolve_light {
    const int32_t *rgb_q20[3]; /* R, G, B */
    int stride;                /* values */
};

/* Adds LIGHT to the pixels X0 .. X1 - 1, Y0 .. Y1 - 1 of IMAGE.
 * X0 and Y0 are even, X1 and Y1 too but at the picture's edges; then tiles
 * share no sample and may be resolved in any order, or at once.
 * GLINT_LINEAR_Q20 pictures (4-byte aligned) get the sums added as they are,
 * saturating at the int32 range, negative ones too. */
void glint_resolve_tile(const struct glint_resolve *resolve,
                        const struct glint_image *image, int x0, int y0, int x1,
                        int y1, const struct glint_resolve_light *light);

#endif
