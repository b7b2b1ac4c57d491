/* SPDX-License-Identifier: MIT */
#include "kernels/ward/ward.h"

#include <immintrin.h>

#define W            __m256i
#define W_N          8
#define KERNEL(name) name##_avx2
#define OP(name)     _mm256_##name
#define WHOLE(name)  _mm256_##name##_si256
#define REPEAT(x)    _mm256_broadcastsi128_si256(x)
#define w_shl_each   _mm256_sllv_epi32
#define w_shr_each   _mm256_srlv_epi32

static inline W w_gather(const uint32_t *code, W at)
{
    return _mm256_i32gather_epi32((const int *)(const void *)code, at, 4);
}

static inline void w_gather_levels(const struct glint_texels_level *level, W k,
                                   W side_log2[2], W first[2])
{
    const int *words = &level->side_log2;

    for (int i = 0; i < 2; i++) {
        side_log2[i] = _mm256_i32gather_epi32(words + 2 * i, k, 8);
        first[i] = _mm256_i32gather_epi32(words + 2 * i + 1, k, 8);
    }
}

#include "kernels/ward/sum_x86.inc"
