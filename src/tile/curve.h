/* SPDX-License-Identifier: MIT
 *
 * Between the codes of a picture and linear light.
 *
 *   curve  a full-range code R', G', B' or Y' <-> linear light, sRGB or BT.709
 *   ycc    Y, Cb, Cr codes of 8 bits <-> full-range R', G', B'
 *
 * Full-range codes have 7 fraction bits (_q7: 255 << 7 is white), linear light
 * has 20 (1 << 20 is white). A curve is straight between the 256 codes, and
 * odd: the light of -v is minus the light of v, because sharp Y'CbCr edges hold
 * R'G'B' below black. Encode is the exact inverse of decode: the code of the
 * light of a code is that code, of all 2 * 32640 + 1 codes, and both rise.
 *
 * Against the true curve: decode is within 2^-21 at the codes. Encode, over all
 * steps of light, is within 0.0125 code for sRGB (chords just above the toe)
 * and 0.009 for BT.709, but 0.05 at its toe, where the two pieces of the
 * standard miss each other by 0.06.
 *
 * Integers only, the same on every CPU; no division but in init.
 */
#ifndef GLINT_TILE_CURVE_H
#define GLINT_TILE_CURVE_H

#include <stdint.h>

#include "glint/image.h"

#define CODE_WHITE_Q7    (255 << 7)
#define LINEAR_WHITE_Q20 (1 << 20)

/* 6.0 KiB. The light of neighbouring codes differs by 318 steps at least, so
 * that of 256 consecutive steps at most one is the light of a code. */
struct glint_curve {
    int32_t decode_q20[257]; /* of whole codes; [256] only ends the last */
    uint32_t slope_q24[256]; /* _q7 codes per step of light, above a code */
    uint8_t below[4096 + 1]; /* whole code at or below light n * 256 */
};

/* Fills CURVE for TRANSFER: 256 roots by bit search. */
void glint_curve_init(struct glint_curve *curve, enum glint_tone transfer);

/* Light of CODE_Q7, +-CODE_WHITE_Q7. */
static inline int32_t curve_decode(const struct glint_curve *curve,
                                   int32_t code_q7)
{
    const int32_t size_q7 = code_q7 < 0 ? -code_q7 : code_q7;
    const int32_t *at_q20 = curve->decode_q20 + (size_q7 >> 7);
    const int32_t light_q20 =
        at_q20[0] + (((at_q20[1] - at_q20[0]) * (size_q7 & 127) + 64) >> 7);

    return code_q7 < 0 ? -light_q20 : light_q20;
}

/* Code of LIGHT_Q20, 0 .. LINEAR_WHITE_Q20. A slope is at most 128 * 2^24 over
 * its segment's steps, so no product exceeds 2^31. */
static inline int32_t curve_encode_positive(const struct glint_curve *curve,
                                            int32_t light_q20)
{
    int code = curve->below[light_q20 >> 8];

    code += light_q20 >= curve->decode_q20[code + 1];
    return code * 128 +
           (int32_t)(((uint32_t)(light_q20 - curve->decode_q20[code]) *
                          curve->slope_q24[code] +
                      (UINT32_C(1) << 23)) >>
                     24);
}

/* Code of LIGHT_Q20, held to +-LINEAR_WHITE_Q20. */
static inline int32_t curve_encode(const struct glint_curve *curve,
                                   int32_t light_q20)
{
    const int32_t size_q20 = light_q20 < 0 ? -light_q20 : light_q20;
    const int32_t code_q7 = curve_encode_positive(
        curve, size_q20 < LINEAR_WHITE_Q20 ? size_q20 : LINEAR_WHITE_Q20);

    return light_q20 < 0 ? -code_q7 : code_q7;
}

/* Equal R'G'B' have Cb = Cr = 128 to the last bit: the sums of the rows hold
 * exactly. */
struct glint_ycc {
    int black;                /* code of Y' = 0 */
    int32_t to_rgb_q16[3][3]; /* R'G'B' per step of Y - black, Cb - 128, ... */
    int32_t to_ycc_q15[3][3]; /* Y, Cb, Cr per code of R', G', B' */
};

/* Fills YCC for MATRIX and RANGE; the first columns serve grey pictures. */
void glint_ycc_init(struct glint_ycc *ycc, enum glint_matrix matrix,
                    enum glint_range range);

/* R'G'B' of 8-bit codes. Not clamped: -290 .. 550 codes may come out. */
static inline void ycc_to_rgb(const struct glint_ycc *ycc, int y, int cb,
                              int cr, int32_t rgb_q7[3])
{
    for (int i = 0; i < 3; i++)
        rgb_q7[i] = ((y - ycc->black) * ycc->to_rgb_q16[i][0] +
                     (cb - 128) * ycc->to_rgb_q16[i][1] +
                     (cr - 128) * ycc->to_rgb_q16[i][2] + (1 << 8)) >>
                    9;
}

#endif
