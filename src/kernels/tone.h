/* SPDX-License-Identifier: MIT
 *
 * Between codes and linear light in 16 bits, for the kernels.
 *
 * A full-range code v has 7 fraction bits (_q7, 255 << 7 is white), light has
 * 16 (65535 is white).
 *
 *   decode  below the toe's end v times a constant; above it a cubic in each of
 *           eight pieces of 32 codes
 *   encode  below the toe's end a constant times the light; above it
 *           scale * m^e - offset with light = m / 4^k, m from 1/4 to 1, and m^e
 *           a polynomial of degree 4 in m - 5/8
 *
 * Fitted by least squares to sRGB and BT.709. Over all 32641 codes and 65536
 * values of light: decode is within 0.05 of a code, encode within 0.08, encode
 * of decode within 0.08. Both rise.
 */
#ifndef GLINT_KERNELS_TONE_H
#define GLINT_KERNELS_TONE_H

#include <stdint.h>

enum { GLINT_WHITE_Q7 = 255 << 7 };

struct glint_tone16 {
    int16_t toe_end_q7, toe_q15; /* of decode: light _q16 per code _q7 */
    int16_t piece[4][8];         /* of powers of the place within, light _q16 */
    uint16_t toe_end_q16, toe_q13; /* of encode: code _q7 per light _q16 */
    int16_t power_q15[5];
    int16_t lift[8];   /* 4^k, by k = 0 .. 4 */
    uint16_t scale[8]; /* white _q7 / 4^(k e) */
    int16_t offset_q7;
};

/* How Y', Cb, Cr and R', G', B' mix. */
struct glint_mix {
    struct glint_tone16 tone;
    int16_t black;    /* code of Y' = 0 */
    int16_t luma_q15; /* R'G'B' per Y', less 1 */
    /* R', G', B' per Cb and Cr, a quarter; _q15 */
    int16_t red_cr_q15, green_cb_q15, green_cr_q15, blue_cb_q15;
    int16_t to_luma_q15[3]; /* Y' per R', G', B' */
    int16_t to_chroma_q15[2][3];
};

#endif
