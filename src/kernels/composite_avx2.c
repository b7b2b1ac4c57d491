/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include <immintrin.h>

#define V                   __m256i
#define V_N                 16
#define KERNEL(name)        name##_avx2
#define OP(name)            _mm256_##name
#define WHOLE(name)         _mm256_##name##_si256
#define v_places(high, low) _mm256_set_epi64x(high, low, high, low)

#include "kernels/composite_x86.h"

/* Eight values, over and over. */
static inline V v_repeat(const int16_t *p)
{
    return _mm256_broadcastsi128_si256(
        _mm_loadu_si128((const __m128i *)(const void *)p));
}

static inline V v_load_codes(const uint8_t *p)
{
    return _mm256_cvtepu8_epi16(
        _mm_loadu_si128((const __m128i *)(const void *)p));
}

/* Held to 0 .. 255. */
static inline void v_store_codes(uint8_t *p, V x)
{
    _mm_storeu_si128((__m128i *)(void *)p,
                     _mm_packus_epi16(_mm256_castsi256_si128(x),
                                      _mm256_extracti128_si256(x, 1)));
}

static inline uint32_t w_first(W x)
{
    return (uint32_t)_mm256_cvtsi256_si32(x);
}

/* Of each lane and those before it. */
static inline W w_sums(W x)
{
    W low;

    x = w_add(x, _mm256_slli_si256(x, 4));
    x = w_add(x, _mm256_slli_si256(x, 8));
    low = _mm256_permute2x128_si256(x, x, 0x08); /* 0, lower half */
    return w_add(x, _mm256_shuffle_epi32(low, 0xff));
}

static inline W w_last(W x)
{
    return _mm256_permutevar8x32_epi32(x, _mm256_set1_epi32(7));
}

/* Held to 0 .. 65535. */
static inline V w_narrow(W a, W b)
{
    return _mm256_permute4x64_epi64(_mm256_packus_epi32(a, b), 0xd8);
}

#include "kernels/composite_v.h"
