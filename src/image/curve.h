/* SPDX-License-Identifier: MIT
 *
 * Converts the codes of a picture to linear light, and between Y'CbCr and
 * R'G'B'.
 *
 *   curve  from a full-range code of R', G', B' or Y' to linear light, by the
 *          curve of sRGB or BT.709
 *   ycc    between 8-bit codes of Y, Cb, Cr and full-range R', G', B'
 *
 * Full-range codes have 7 fraction bits (_q7: 255 << 7 is white), linear light
 * has 20 (1 << 20 is white). A curve is within 2^-21 of the standard's curve at
 * the 256 codes, and linear between them. kernels/tone.h converts light to
 * codes.
 *
 * Integers only, the same on every CPU; only init divides. */
#ifndef GLINT_IMAGE_CURVE_H
#define GLINT_IMAGE_CURVE_H

#include <stdint.h>

#include "glint/image.h"

#define CODE_WHITE_Q7    (255 << 7)
#define LINEAR_WHITE_Q20 (1 << 20)

struct glint_curve {
    int32_t decode_q20[257]; /* linear light of integer codes; entry 256 is the
                                end of the last interval */
};

/* Fills the table CURVE for the transfer function TRANSFER. Computes 256 roots
 * by bisection, bit by bit. */
void glint_curve_init(struct glint_curve *curve, enum glint_tone transfer);

/* Returns the linear light of CODE_Q7, which must be in 0 .. CODE_WHITE_Q7. */
static inline int32_t curve_decode_to_light(const struct glint_curve *curve,
                                            int32_t code_q7)
{
    const int32_t *at_q20 = curve->decode_q20 + (code_q7 >> 7);

    return at_q20[0] + (((at_q20[1] - at_q20[0]) * (code_q7 & 127) + 64) >> 7);
}

/* Matrices between Y'CbCr and R'G'B'. The sums of the rows are exact, so that
 * equal R', G', B' give exactly Cb = Cr = 128. */
struct glint_ycc {
    int black;                /* code of Y' = 0 */
    int32_t to_rgb_q16[3][3]; /* change of R', G', B' per code of Y - black, Cb
                                 - 128 and Cr - 128 */
    int32_t to_ycc_q15[3][3]; /* change of Y, Cb, Cr per code of R', G', B' */
};

/* Fills YCC for MATRIX and RANGE. Grey pictures use only the first columns of
 * the matrices. */
void glint_ycc_init(struct glint_ycc *ycc, enum glint_matrix matrix,
                    enum glint_range range);

/* Sets RGB to R', G', B' of the 8-bit codes Y, CB and CR. The result is not
 * clamped; its range is -293 .. 551 codes, reached with BT.2020. */
static inline void convert_ycc_to_rgb(const struct glint_ycc *ycc, int y,
                                      int cb, int cr, int32_t rgb_q7[3])
{
    for (int i = 0; i < 3; i++)
        rgb_q7[i] = ((y - ycc->black) * ycc->to_rgb_q16[i][0] +
                     (cb - 128) * ycc->to_rgb_q16[i][1] +
                     (cr - 128) * ycc->to_rgb_q16[i][2] + (1 << 8)) >>
                    9;
}

#endif
