/* SPDX-License-Identifier: MIT */
#include "kernels/ward/ward.h"

#include <smmintrin.h>

#define W            __m128i
#define W_N          4
#define KERNEL(name) name##_sse41
#define OP(name)     _mm_##name
#define WHOLE(name)  _mm_##name##_si128
#define REPEAT(x)    x

/* Returns X times 2^BY per lane, BY 0 .. 15. SSE4.1 cannot shift each lane
 * by its own count, so a byte shuffle looks up the two bytes of 2^BY. */
static inline W w_shl_each(W x, W by)
{
    const W low =
        _mm_setr_epi8(1, 2, 4, 8, 16, 32, 64, -128, 0, 0, 0, 0, 0, 0, 0, 0);
    const W none = _mm_set1_epi32((int)0x80808000);
    const W at = _mm_or_si128(by, none);
    const W high = _mm_slli_si128(low, 8);

    return _mm_mullo_epi32(
        x, _mm_or_si128(_mm_shuffle_epi8(low, at),
                        _mm_slli_epi32(_mm_shuffle_epi8(high, at), 8)));
}

static inline W load_level_and_next(const struct glint_texels_level *level,
                                    int k)
{
    return _mm_loadu_si128((const W *)(const void *)(level + k));
}

static inline void w_gather_levels(const struct glint_texels_level *level, W k,
                                   W side_log2[2], W first[2])
{
    const W a = load_level_and_next(level, _mm_extract_epi32(k, 0));
    const W b = load_level_and_next(level, _mm_extract_epi32(k, 1));
    const W c = load_level_and_next(level, _mm_extract_epi32(k, 2));
    const W d = load_level_and_next(level, _mm_extract_epi32(k, 3));
    const W low[2] = {_mm_unpacklo_epi32(a, c), _mm_unpacklo_epi32(b, d)};
    const W high[2] = {_mm_unpackhi_epi32(a, c), _mm_unpackhi_epi32(b, d)};

    side_log2[0] = _mm_unpacklo_epi32(low[0], low[1]);
    first[0] = _mm_unpackhi_epi32(low[0], low[1]);
    side_log2[1] = _mm_unpacklo_epi32(high[0], high[1]);
    first[1] = _mm_unpackhi_epi32(high[0], high[1]);
}

#include "kernels/ward/sum_x86.inc"
