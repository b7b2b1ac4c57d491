/* SPDX-License-Identifier: MIT
 *
 * Kernels for pixels: vectorised loops that add light to rows of codes. The
 * kernels for rays are in kernels/rays/rays.h, so that a program links only the
 * kernels that it uses. All code that differs between CPUs is in this folder.
 *
 * A kernel is a pure function over arrays: no allocation, errors or globals.
 * NAME_c.c defines it; NAME_sse41.c, NAME_avx2.c and NAME_neon.c give
 * bit-identical results. Arrays are disjoint, begin at 32-byte boundaries and
 * have N entries rounded up to a multiple of GLINT_LANES, so that no variant
 * needs a scalar loop for the remainder.
 *
 * Products are rounded to nearest, ties up, like pmulhrsw and vqrdmulh, unless
 * a comment states that they are truncated.
 */
#ifndef GLINT_KERNELS_KERNELS_H
#define GLINT_KERNELS_KERNELS_H

#include <stdint.h>

#include "kernels/tone.h"

/* Adds light to N pixels of one row of Y'CbCr.
 *   luma    codes, changed in place
 *   cb, cr  codes, one for each pixel
 *   light   R, G, B: _q16, white = 65535
 *   round   dither thresholds, _q7, below 1; pixel i uses round[i & 7]
 *   change  receives the changes of R', B' (_q15, white = 32767) and Y' (_q7),
 *           each 0 or more; 0 for a pixel without light */
typedef void
glint_add_luma_fn(uint8_t *luma, const uint8_t *cb, const uint8_t *cr,
                  const uint16_t *const light[3], int16_t *const change[3],
                  int n, const struct glint_mix *mix, const int16_t *round);

/* States when a row of 4:2:2 or 4:2:0 changes the chroma that pairs of pixels
 * share. Chroma changes by the mean changes of R', B' and Y' over all pixels
 * that share it. */
enum glint_pair_step {
    GLINT_PAIRS_ALONE, /* 4:2:2: the row's pairs have their own chroma */
    GLINT_PAIRS_FIRST, /* 4:2:0, first row: stores the mean changes of pairs */
    GLINT_PAIRS_SECOND /* 4:2:0, second row: changes chroma by the mean of both
                          rows' changes */
};

/* Adds light to N pixels of one row of Y'CbCr whose chroma is shared by
 * pairs.
 *   luma    codes, changed in place
 *   chroma  codes Cb, Cr of each pair; changed unless STEP is FIRST
 *   light, round  as for glint_add_luma_fn
 *   round_chroma  dither thresholds, _q7, below 1; chroma[i] uses
 *                 round_chroma[i & 7]
 *   mean    mean changes of each pair, R', B' (_q15) and Y' (_q7): the first
 *           row writes them, the second reads them */
typedef void glint_add_pairs_fn(uint8_t *luma, uint8_t *chroma,
                                const uint16_t *const light[3],
                                int16_t *const mean[3], int n,
                                enum glint_pair_step step,
                                const struct glint_mix *mix,
                                const int16_t *round,
                                const int16_t *round_chroma);

/* Adds light to N pixels of two bytes each: luma, followed by Cb and Cr
 * alternately. Luma comes first unless LUMA_AT is 1. PIXELS needs no
 * alignment; the other arguments are as for glint_add_pairs_fn. */
typedef void glint_add_packed_fn(uint8_t *pixels,
                                 const uint16_t *const light[3], int n,
                                 int luma_at, const struct glint_mix *mix,
                                 const int16_t *round,
                                 const int16_t *round_chroma);

/* Adds light at half resolution to two rows of N pixels, one value for 2 x 2
 * pixels; N is a multiple of twice GLINT_LANES. The change is computed once,
 * for the mean of the four pixels. It is scaled per pixel by the pixel's
 * distance to white relative to the mean's distance, so light that makes the
 * mean white makes each pixel white. Chroma moves towards its mean by the
 * same fraction. Y' never decreases.
 *   luma    codes of two rows; for a single last row, the same pointer twice
 *   chroma  codes Cb, Cr of each pair of both rows; the same row twice if they
 *           share it
 *   light   R, G, B: _q16, one for every two pixels of a row
 *   round, round_chroma  as for glint_add_pairs_fn, for both rows */
typedef void glint_add_quads_fn(uint8_t *const luma[2],
                                uint8_t *const chroma[2],
                                const uint16_t *const light[3], int n,
                                const struct glint_mix *mix,
                                const int16_t *const round[2],
                                const int16_t *const round_chroma[2]);

/* Like glint_add_quads_fn, for pixels of two bytes in the layout of
 * glint_add_packed_fn. PIXELS needs no alignment; ROUND also applies to
 * chroma. */
typedef void glint_add_quads_packed_fn(uint8_t *const pixels[2],
                                       const uint16_t *const light[3], int n,
                                       int luma_at, const struct glint_mix *mix,
                                       const int16_t *const round[2]);

/* Adds light to N codes of one channel, R', G' or B'. LIGHT and ROUND are as
 * for glint_add_luma_fn, for that channel. */
typedef void glint_add_code_fn(uint8_t *code, const uint16_t *light, int n,
                               const struct glint_tone16 *tone,
                               const int16_t *round);

/* Hide the fraction COVER (_q8, 256: all) of the light of N pixels and round
 * the remaining light to the nearest codes. Codes are unchanged where COVER
 * is 0 and become black where it is 256.
 *   code  one channel of R'G'B'
 *   ycc   Y', Cb, Cr of each pixel, _q7; BLACK: code of Y' = 0 */
typedef void glint_cover_code_fn(uint8_t *code, const uint16_t *cover_q8, int n,
                                 const struct glint_tone16 *tone);
typedef void glint_cover_ycc_fn(int16_t *const ycc_q7[3],
                                const uint16_t *cover_q8, int n, int black,
                                const struct glint_mix *mix);
glint_cover_code_fn glint_cover_code_c;
glint_cover_ycc_fn glint_cover_ycc_c;

/* Computes light along a row as the prefix sum of its changes: light[i] is
 * *CARRY plus changes 0 .. i, rounded to _q16 and clamped to 0 .. 65535.
 * Changes and *CARRY have 16 + MORE fraction bits, MORE in 2 .. 15. The
 * function clears the changes; intermediate sums may wrap around. *CARRY
 * becomes the sum at the end of the row. */
typedef void glint_run_sum_fn(uint32_t *change, uint32_t *carry,
                              uint16_t *light_q16, int n, int more);

/* The kernels that add one value of light per pixel. */
struct glint_kernels {
    glint_add_luma_fn *add_luma;
    glint_add_pairs_fn *add_pairs;
    glint_add_packed_fn *add_packed;
    glint_add_code_fn *add_code;
    glint_run_sum_fn *run_sum;
};

/* The kernels that add one value of light per 2 x 2 pixels of Y'CbCr
 * pictures. */
struct glint_quad_kernels {
    glint_add_quads_fn *add;
    glint_add_quads_packed_fn *add_packed;
};

/* Return the best kernels that the GLINT_SET_ bits SETS allow: kernels in C if
 * no bit is set, or NEON kernels where all CPUs have NEON (choose.h). */
const struct glint_kernels *glint_choose_pixel_kernels(unsigned sets);
const struct glint_quad_kernels *glint_choose_quad_kernels(unsigned sets);

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
