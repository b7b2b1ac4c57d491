/* SPDX-License-Identifier: MIT
 *
 * Between codes and linear light in 16 bits, for the kernels.
 *
 * A full-range code v has 7 fraction bits (_q7, 255 << 7 is white), light has
 * 16 (65535 is white).
 *
 *   decode: below the toe's end v times a constant; above it a parabola in
 *   each of eight pieces of 32 codes
 *
 *   encode: below the toe's end a constant times the light; above it
 *   scale * m^e - offset with light = m / 4^k, m from 1/4 to 1, and m^e a
 *   polynomial of degree 4 in m - 5/8
 *
 * Fitted by least squares to sRGB and BT.709. Over all 32641 codes and 65536
 * values of light: decode is within 0.05 of a code, encode within 0.08, encode
 * of decode within 0.08. Both rise.
 */
#ifndef GLINT_KERNELS_TONE_H
#define GLINT_KERNELS_TONE_H

#include <stdint.h>

#include "base/compiler.h"

#define GLINT_LANES 16

enum { GLINT_WHITE_Q7 = 255 << 7 };

/* A constant in all lanes of the widest vector, and a table of eight in both of
 * its halves: operands as they lie in memory. */
typedef ALIGNED(32) int16_t glint_lanes[GLINT_LANES];

struct glint_tone16 {
    glint_lanes toe_end_q7, toe_q15; /* of decode: light _q16 per code _q7 */
    glint_lanes piece[3]; /* of powers of the place within, light _q16 */
    glint_lanes toe_end_q16, toe_q13; /* of encode: code _q7 per light _q16,
                                         unsigned */
    glint_lanes power_q15[5];
    glint_lanes lift;  /* 4^k, by k = 0 .. 4 */
    glint_lanes scale; /* white _q7 / 4^(k e), unsigned */
    glint_lanes offset_q7;
    glint_lanes entry; /* from entries of a table to places of their bytes;
                          here, lest compilers make sums of the product */
};

/* How Y', Cb, Cr and R', G', B' mix. */
struct glint_mix {
    struct glint_tone16 tone;
    glint_lanes black;    /* code of Y' = 0 */
    glint_lanes luma_q15; /* R'G'B' per Y', less 1 */
    /* R', G', B' per Cb and Cr, a quarter; _q15 */
    glint_lanes red_cr_q15, green_cb_q15, green_cr_q15, blue_cb_q15;
    glint_lanes to_luma_q15[3];   /* Y' per R', G', B' */
    glint_lanes to_chroma_q15[3]; /* Cb and Cr by turns */
};

#endif
