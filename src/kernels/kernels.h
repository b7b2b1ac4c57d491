/* SPDX-License-Identifier: MIT
 *
 * The hot loops, and all code that differs between CPUs: those of pixels; of
 * rays they are in kernels/rays/rays.h, so that a program that has only one of
 * them links nothing of the other.
 *
 * A kernel is a pure function over arrays: no allocation, errors or globals.
 * NAME_c.c defines it; NAME_sse41.c, NAME_avx2.c and NAME_neon.c give the same
 * bits. Arrays are disjoint, begin at 32-byte boundaries and are as long as N
 * rounded up to a multiple of GLINT_LANES, so that no variant has a tail.
 *
 * One rounding everywhere but where a product is said to be cut: to nearest,
 * ties up, as pmulhrsw and vqrdmulh do.
 */
#ifndef GLINT_KERNELS_KERNELS_H
#define GLINT_KERNELS_KERNELS_H

#include <stdint.h>

#include "kernels/tone.h"

/* Adds light to N pixels of one row of Y'CbCr.
 *   luma    codes, changed in place
 *   cb, cr  codes, one for each pixel
 *   light   R, G, B: _q16, white = 65535
 *   round   _q7, of pixel i: round[i & 7], below 1
 *   change  of R', B' (_q15, white = 32767) and Y' (_q7), each 0 or more; 0
 *           where there is no light at all */
typedef void
glint_add_luma_fn(uint8_t *luma, const uint8_t *cb, const uint8_t *cr,
                  const uint16_t *const light[3], int16_t *const change[3],
                  int n, const struct glint_mix *mix, const int16_t *round);

/* The way in which a row of pairs uses the mean changes of R', B' and Y' of its
 * pairs. */
enum glint_pair_step {
    GLINT_PAIRS_ALONE, /* the row's chroma is its own */
    GLINT_PAIRS_FIRST, /* the first of two rows keeps them */
    GLINT_PAIRS_SECOND /* the second row's chroma goes by the mean of both */
};

/* Adds light to N pixels of one row of Y'CbCr whose chroma is shared by pairs.
 *   luma    codes, changed in place
 *   chroma  codes Cb, Cr of each pair; changed unless STEP is FIRST
 *   light, round  as above
 *   round_chroma  the same for chroma[i]
 *   mean    R', B' (_q15), Y' (_q7), of each pair: kept for the second row by
 *           the first */
typedef void glint_add_pairs_fn(uint8_t *luma, uint8_t *chroma,
                                const uint16_t *const light[3],
                                int16_t *const mean[3], int n,
                                enum glint_pair_step step,
                                const struct glint_mix *mix,
                                const int16_t *round,
                                const int16_t *round_chroma);

/* The same for pixels of two bytes, luma and by turns Cb and Cr, luma first
 * unless LUMA_AT is 1; PIXELS begins anywhere. */
typedef void glint_add_packed_fn(uint8_t *pixels,
                                 const uint16_t *const light[3], int n,
                                 int luma_at, const struct glint_mix *mix,
                                 const int16_t *round,
                                 const int16_t *round_chroma);

/* Adds light that 2 x 2 pixels have in common to two rows of N pixels, N a
 * multiple of twice GLINT_LANES. What it changes is worked out once, for the
 * mean of the four: from there it falls to nothing at white, in proportion, so
 * that light which makes the mean white does so to each of them. Chroma differs
 * as much less from its mean. Y' never falls.
 *   luma    codes of two rows; of a last one that is alone: it, twice
 *   chroma  codes Cb, Cr of each pair of both; the same twice where the rows
 *           share them
 *   light   R, G, B: _q16, one for every two pixels of a row
 *   round, round_chroma  as above, of both */
typedef void glint_add_quads_fn(uint8_t *const luma[2],
                                uint8_t *const chroma[2],
                                const uint16_t *const light[3], int n,
                                const struct glint_mix *mix,
                                const int16_t *const round[2],
                                const int16_t *const round_chroma[2]);

/* The same for pixels of two bytes, which begin anywhere; ROUND serves chroma,
 * too. */
typedef void glint_add_quads_packed_fn(uint8_t *const pixels[2],
                                       const uint16_t *const light[3], int n,
                                       int luma_at, const struct glint_mix *mix,
                                       const int16_t *const round[2]);

/* Adds light to N codes of one channel of R'G'B'; LIGHT and ROUND as above. */
typedef void glint_add_code_fn(uint8_t *code, const uint16_t *light, int n,
                               const struct glint_tone16 *tone,
                               const int16_t *round);

/* Hides COVER (_q8, 0 .. 256: all of it) of N pixels: what is left of their
 * light, rounded to the nearest codes. Where COVER is 0 codes stay, and where
 * it is all they are black.
 *   code  one channel of R'G'B'
 *   ycc   Y', Cb, Cr of each pixel, _q7; BLACK: code of Y' = 0 */
typedef void glint_cover_code_fn(uint8_t *code, const uint16_t *cover_q8, int n,
                                 const struct glint_tone16 *tone);
typedef void glint_cover_ycc_fn(int16_t *const ycc_q7[3],
                                const uint16_t *cover_q8, int n, int black,
                                const struct glint_mix *mix);
glint_cover_code_fn glint_cover_code_c;
glint_cover_ycc_fn glint_cover_ycc_c;

/* Turns changes into light along a row: light[i] is *CARRY plus changes 0 .. i,
 * _q24, rounded to _q16 and held to 0 .. 65535. Changes are cleared, sums may
 * wrap and wrap back; *CARRY goes on. */
typedef void glint_run_sum_fn(uint32_t *change_q24, uint32_t *carry_q24,
                              uint16_t *light_q16, int n);

/* The kernels that pictures take. */
struct glint_kernels {
    glint_add_luma_fn *add_luma;
    glint_add_pairs_fn *add_pairs;
    glint_add_packed_fn *add_packed;
    glint_add_code_fn *add_code;
    glint_run_sum_fn *run_sum;
};

/* The kernels that pictures take in which four pixels share their light. */
struct glint_quad_kernels {
    glint_add_quads_fn *add;
    glint_add_quads_packed_fn *add_packed;
};

/* The best ones that the GLINT_SET_ bits SETS allow; of no set those in C, but
 * for what pixels take (choose.h). */
const struct glint_kernels *glint_kernels_of(unsigned sets);
const struct glint_quad_kernels *glint_quad_kernels_of(unsigned sets);

glint_add_luma_fn glint_add_luma_c, glint_add_luma_sse41, glint_add_luma_avx2,
    glint_add_luma_neon;
glint_add_pairs_fn glint_add_pairs_c, glint_add_pairs_sse41,
    glint_add_pairs_avx2, glint_add_pairs_neon;
glint_add_packed_fn glint_add_packed_c, glint_add_packed_sse41,
    glint_add_packed_avx2, glint_add_packed_neon;
glint_add_quads_fn glint_add_quads_c, glint_add_quads_sse41,
    glint_add_quads_avx2, glint_add_quads_neon;
glint_add_quads_packed_fn glint_add_quads_packed_c,
    glint_add_quads_packed_sse41, glint_add_quads_packed_avx2,
    glint_add_quads_packed_neon;
glint_add_code_fn glint_add_code_c, glint_add_code_sse41, glint_add_code_avx2,
    glint_add_code_neon;
glint_run_sum_fn glint_run_sum_c, glint_run_sum_sse41, glint_run_sum_avx2,
    glint_run_sum_neon;

#endif
