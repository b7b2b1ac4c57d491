/* SPDX-License-Identifier: MIT
 *
 * Converts between codes and linear light in 16 bits, for the kernels.
 *
 * A full-range code v and light x are _q15: 32767 is white, so that an 8-bit
 * code is 128.5 units. x is unsigned and may exceed white.
 *
 *   decode: toe v + w^2 (r0 + w (r1 + w r2)). w = max(v - end of the toe, 0),
 *   so that the same formula serves the linear toe and the power curve.
 *
 *   encode: a cubic in each octave of light. z = -1 .. 0 runs from the lower to
 *   the upper end of the octave; code = level + z (slope + z curve (turn0 +
 *   z turn1)). Level, slope and curve are looked up by the number of leading
 *   zeros. Where the curve is a power, the cubics of all octaves are
 *   proportional, so that they share turn0 and turn1. In the toe, curve is 0.
 *   Above white, curve and slope are 0.
 *
 * The factors minimise the max error against sRGB and BT.709. In 8-bit codes,
 * over all 32768 codes and lights, it is 0.17 for decode (0.09 without the
 * rounding of light, whose unit is 0.1 code in the toe) and 0.06 for encode.
 * encode is monotone: within an octave because each rounded product is
 * monotone, between octaves by the choice of levels. */
#ifndef GLINT_KERNELS_TONE_H
#define GLINT_KERNELS_TONE_H

#include <stdint.h>

#include "base/compiler.h"

#define GLINT_LANES 16

enum { GLINT_WHITE_Q15 = INT16_MAX };

/* A constant that is repeated in all lanes of the widest vector, or a table of
 * this size. Vector instructions use it as a memory operand. */
typedef ALIGNED(32) int16_t glint_lanes[GLINT_LANES];

/* Factors, _q15, in two layouts: ONE has one factor per lane, ALL repeats
 * each factor in all lanes. Which layout is faster depends on the CPU. */
enum { GLINT_FACTORS = 8 };
struct glint_factors {
    ALIGNED(16) int16_t one[GLINT_FACTORS];
    glint_lanes all[GLINT_FACTORS];
};

enum {
    GLINT_TONE_TOE,  /* light per unit of code in the toe, the linear part */
    GLINT_TONE_RISE, /* r2 of decode */
    GLINT_TONE_TURN, /* turn1 of encode */
    GLINT_TONE_Q7,   /* factor that converts units of R'G'B', 1 / 128.5 code, to
                        _q7 */
    /* 2, the number of bytes per entry of a table. It is a variable because
     * compilers would replace a product with a constant by slower additions. */
    GLINT_TONE_ENTRY
};

struct glint_tone16 {
    struct glint_factors factor;
    glint_lanes toe_end, rise[2], turn;
    glint_lanes level, slope, curve; /* tables indexed by the number of leading
                                        zeros; entry 16 is 0 */
    glint_lanes power;               /* 2^zeros, unsigned */
};

/* Conversion between Y'CbCr and R'G'B'. R', G', B' are 2 (base + tint): base
 * is Y' GLINT_MIX_BASE + black, tints come from Cb and Cr. Back: Y' changes
 * by the weighted sum of the changes of R', G', B'; Cb by B'
 * GLINT_MIX_CB_BLUE - Y' GLINT_MIX_CB_LUMA; Cr likewise; all in _q7. */
enum { /* Entries of from_ycc. */
       GLINT_MIX_BASE,
       GLINT_MIX_RED_CR,
       GLINT_MIX_GREEN_CB,
       GLINT_MIX_GREEN_CR,
       GLINT_MIX_BLUE_CB, /* half of the factor, to fit 16 bits */
       /* Entries of to_ycc. */
       GLINT_MIX_LUMA = 0, /* first of three: weights of R', G', B' in Y' */
       GLINT_MIX_CB_BLUE = 3,
       GLINT_MIX_CB_LUMA,
       GLINT_MIX_CR_RED,
       GLINT_MIX_CR_LUMA
};

/* Newton's method for 1 / x, x = 0.5 .. 1, starts from 48 / 17 - 32 / 17 x,
 * with an error of at most 1/17. FROM is _q14. SLOPE is half of 32 / 17 as
 * _q15: its product with x in _q15 is _q14. */
enum { GLINT_SHARE_FROM = 46261, GLINT_SHARE_SLOPE = 30840 };

struct glint_mix {
    struct glint_tone16 tone;
    struct glint_factors from_ycc, to_ycc;
    glint_lanes black;
    glint_lanes white; /* Y' of white, _q7 */
};

#endif
