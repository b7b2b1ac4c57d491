/* SPDX-License-Identifier: MIT
 *
 * Between codes and linear light in 16 bits, for the kernels.
 *
 * A full-range code v and light x are _q15: 32767 is white, so that a code of 8
 * bits is 128.5 steps. x is unsigned and may pass white.
 *
 *   decode: toe v + w^2 (r0 + w (r1 + w r2)), w = what v passes the toe's end
 *   by. Nowhere a choice, as w is 0 in the toe.
 *
 *   encode: a cubic in each octave of light: with z = -1 .. 0 from its lower to
 *   its upper end, level + z (slope + z curve (turn0 + z turn1)), level, slope
 *   and curve looked up by the zeros that lead. Where the curve is a power the
 *   cubics of all octaves are alike, so that turn0 and turn1 serve all of them;
 *   in the toe curve is 0, and beyond white slope, too.
 *
 * Least greatest errors against sRGB and BT.709, in codes of 8 bits over all
 * 32768 codes and lights: decode 0.17 (most of it steps of light, which are 0.1
 * code in the toe; 0.09 without), encode 0.06. encode rises: within an octave
 * as every rounded factor of it does, from one to the next by the choice of
 * levels.
 */
#ifndef GLINT_KERNELS_TONE_H
#define GLINT_KERNELS_TONE_H

#include <stdint.h>

#include "base/compiler.h"

#define GLINT_LANES 16

enum { GLINT_WHITE_Q15 = INT16_MAX };

/* A constant in all lanes of the widest vector, or a table: operands as they
 * lie in memory. */
typedef ALIGNED(32) int16_t glint_lanes[GLINT_LANES];

/* Factors, _q15: one in each lane, and each in all lanes; some CPUs want these,
 * some those. */
enum { GLINT_FACTORS = 8 };
struct glint_factors {
    ALIGNED(16) int16_t one[GLINT_FACTORS];
    glint_lanes all[GLINT_FACTORS];
};

enum {
    GLINT_TONE_TOE,  /* light per code below the toe's end */
    GLINT_TONE_RISE, /* r2 */
    GLINT_TONE_TURN, /* turn1 */
    GLINT_TONE_Q7,   /* factor from steps of a code, 1 / 128.5, to _q7 */
    GLINT_TONE_ENTRY /* factor from entries of a table to places of their bytes;
                        it is here lest compilers make sums of the product */
};

struct glint_tone16 {
    struct glint_factors factor;
    glint_lanes toe_end, rise[2], turn;
    glint_lanes level, slope, curve; /* tables, by zeros that lead; of 16: 0 */
    glint_lanes power;               /* 2^zeros, unsigned */
};

/* R', G', B' are twice base + tint: base = Y' GLINT_MIX_BASE + black, and tint
 * from Cb and Cr. What they change by makes what Y', Cb, Cr change by, _q7:
 * Cb = B' GLINT_MIX_CB_BLUE - Y' GLINT_MIX_CB_LUMA, and Cr likewise. */
enum { /* factors of from_ycc */
       GLINT_MIX_BASE,
       GLINT_MIX_RED_CR,
       GLINT_MIX_GREEN_CB,
       GLINT_MIX_GREEN_CR,
       GLINT_MIX_BLUE_CB, /* half of it */
       /* Entries of to_ycc. */
       GLINT_MIX_LUMA = 0, /* share of R', G', B' in Y' */
       GLINT_MIX_CB_BLUE = 3,
       GLINT_MIX_CB_LUMA,
       GLINT_MIX_CR_RED,
       GLINT_MIX_CR_LUMA
};

/* Newton's method for 1 / x, x = 0.5 .. 1, begins at 48 / 17 - 32 / 17 x, off
 * by a seventeenth at most. The first is _q14; the second half of it, _q15, as
 * x is _q15 and the product _q14. */
enum { GLINT_SHARE_FROM = 46261, GLINT_SHARE_SLOPE = 30840 };

struct glint_mix {
    struct glint_tone16 tone;
    struct glint_factors from_ycc, to_ycc;
    glint_lanes black;
    glint_lanes white; /* Y', _q7 */
};

#endif
