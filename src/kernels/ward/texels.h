/* SPDX-License-Identifier: MIT
 *
 * Bilinear lookups in the mip levels of an octahedral environment map. */
#ifndef GLINT_KERNELS_WARD_TEXELS_H
#define GLINT_KERNELS_WARD_TEXELS_H

#include "base/q.h"
#include "glint/scene/lobe.h"

/* The texels that one lookup reads, four in one level or eight in two levels:
 * indices of their codes, and their weights, which sum to 2^22. */
struct glint_reads {
    uint32_t at[8], weight_q22[8];
};

/* The light that a lookup found, as RGB with a shared exponent. The unit of RGB
 * is 2^(log2 - 34), where 1 is display white. RGB is at most 2^31, log2 at most
 * 31. */
struct glint_found {
    uint32_t rgb[3];
    int32_t log2;
};

/* Sets four entries of AT and WEIGHT_Q22 to the texels of LEVEL nearest to (U,
 * V), which is 0 .. 1 across and down the square. Their total weight is
 * SHARE_Q8. A texel outside the square is replaced by its mirror image about
 * the middle of the nearest edge, as the octahedron is unfolded into the
 * square. */
static inline void
glint_choose_texels_to_read(const struct glint_texels_level *level,
                            int32_t u_q17, int32_t v_q17, uint32_t share_q8,
                            uint32_t at[4], uint32_t weight_q22[4])
{
    const int32_t last = (1 << level->side_log2) - 1;
    /* distance from the middle of the first texel, 1/256 texel, -128 .. 2^18 */
    const int32_t x_q8 = (u_q17 << level->side_log2 >> 9) - 128;
    const int32_t y_q8 = (v_q17 << level->side_log2 >> 9) - 128;
    const int32_t x = x_q8 >> 8, y = y_q8 >> 8;
    const int32_t across[2] = {q_larger(x, 0), q_smaller(x + 1, last)};
    const int32_t down[2] = {q_larger(y, 0), q_smaller(y + 1, last)};
    const int32_t fold_y[2] = {x < 0 ? last : 0, x >= last ? last : 0};
    const int32_t fold_x[2] = {y < 0 ? last : 0, y >= last ? last : 0};
    const uint32_t right_q8 = (uint32_t)x_q8 & 255;
    const uint32_t low_q8 = (uint32_t)y_q8 & 255;

    for (int k = 0; k < 4; k++) {
        const int i = k & 1, j = k >> 1;
        const int32_t row = down[j] ^ fold_y[i], column = across[i] ^ fold_x[j];

        at[k] = level->at + (uint32_t)((row << level->side_log2) + column);
        weight_q22[k] = (i ? right_q8 : 256 - right_q8) *
                        ((j ? low_q8 : 256 - low_q8) * share_q8 >> 2);
    }
}

/* Sets FOUND to the weighted sum of the light of N texels in CODE. */
static inline void glint_sum_texel_light(const uint32_t *code,
                                         const struct glint_reads *reads, int n,
                                         struct glint_found *found)
{
    uint32_t most = 0;

    for (int k = 0; k < n; k++) {
        const uint32_t log2 = code[reads->at[k]] >> 27;

        most = log2 > most ? log2 : most;
    }
    *found = (struct glint_found){{0, 0, 0}, (int32_t)most};
    for (int k = 0; k < n; k++) {
        const uint32_t c = code[reads->at[k]];
        const uint32_t weight = reads->weight_q22[k] >> (most - (c >> 27));

        for (int j = 0; j < 3; j++)
            found->rgb[j] += weight * (c >> (9 * j) & 511);
    }
}

/* Adds light FOUND times WEIGHT_Q12, 0 .. 2^15, to SUM. */
static inline void glint_add_light_times_weight(const struct glint_found *found,
                                                uint32_t weight_q12,
                                                uint64_t sum_q12[3])
{
    for (int j = 0; j < 3; j++)
        sum_q12[j] +=
            (uint64_t)found->rgb[j] * weight_q12 >> (34 - found->log2);
}

#endif
