/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include <smmintrin.h>

#define V            __m128i
#define V_N          8
#define KERNEL(name) name##_sse41
#define OP(name)     _mm_##name
#define WHOLE(name)  _mm_##name##_si128
#define v_places     _mm_set_epi64x

#include "kernels/composite_x86.h"

static inline V v_repeat(const int16_t *p)
{
    return _mm_loadu_si128((const __m128i *)(const void *)p);
}

static inline V v_load_codes(const uint8_t *p)
{
    return _mm_cvtepu8_epi16(_mm_loadl_epi64((const __m128i *)(const void *)p));
}

/* Held to 0 .. 255. */
static inline void v_store_codes(uint8_t *p, V x)
{
    _mm_storel_epi64((__m128i *)(void *)p, _mm_packus_epi16(x, x));
}

static inline uint32_t w_first(W x)
{
    return (uint32_t)_mm_cvtsi128_si32(x);
}

/* Of each lane and those before it. */
static inline W w_sums(W x)
{
    x = w_add(x, _mm_slli_si128(x, 4));
    return w_add(x, _mm_slli_si128(x, 8));
}

static inline W w_last(W x)
{
    return _mm_shuffle_epi32(x, 0xff);
}

/* Held to 0 .. 65535. */
#define w_narrow _mm_packus_epi32

#include "kernels/composite_v.h"
