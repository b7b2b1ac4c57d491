/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include <smmintrin.h>

#define V            __m128i
#define V_N          8
#define V_PARTS      2
#define KERNEL(name) name##_sse41
#define OP(name)     _mm_##name
#define WHOLE(name)  _mm_##name##_si128
#define v_bytes      _mm_set_epi64x
#define v_half(p)    _mm_load_si128((const __m128i *)(const void *)(p))

static inline void v_pairs_from_bytes(V codes, V x[2]);
static inline V b_pack_pairs(const V x[2]);
#define v_chroma_from_bytes v_pairs_from_bytes
#define b_pack_chroma       b_pack_pairs

#include "kernels/composite_x86.inc"

static inline V v_load_repeated(const int16_t *p)
{
    return b_load(p);
}

static inline V v_load_codes(const uint8_t *p)
{
    return v_left(
        _mm_cvtepu8_epi16(_mm_loadl_epi64((const __m128i *)(const void *)p)),
        7);
}

static inline void v_store_codes(uint8_t *p, V x)
{
    x = v_right_signed(x, 7);
    _mm_storel_epi64((__m128i *)(void *)p, _mm_packus_epi16(x, x));
}

/* Returns the even lanes of X in its lower half and the odd lanes in its
 * upper half. */
static inline V separate_even_odd(V x)
{
    return v_shuffle(x, v_bytes(0x0f0e0b0a07060302, 0x0d0c090805040100));
}

static inline void v_load_pairs(const uint16_t *p, V x[2])
{
    const V a = separate_even_odd(v_half(p)),
            b = separate_even_odd(v_half(p + 8));

    x[0] = _mm_unpacklo_epi64(a, b);
    x[1] = _mm_unpackhi_epi64(a, b);
}

static inline void v_pairs_from_bytes(V codes, V x[2])
{
    x[0] = v_right(v_left(codes, 8), 1);
    x[1] = v_right(v_and(codes, v_set((int16_t)0xff00)), 1);
}

static inline V b_pack_pairs(const V x[2])
{
    return v_shuffle(
        _mm_packus_epi16(v_right_signed(x[0], 7), v_right_signed(x[1], 7)),
        v_bytes(0x0f070e060d050c04, 0x0b030a0209010800));
}

/* Loads eight dither thresholds for sixteen pixels: thresholds of even
 * pixels, then of odd pixels; for chroma, thresholds of Cb, then of Cr. */
static inline void v_load_pair_dither(const int16_t *p, V x[2])
{
    const V both = separate_even_odd(b_load(p));

    x[0] = _mm_unpacklo_epi64(both, both);
    x[1] = _mm_unpackhi_epi64(both, both);
}

#define v_load_chroma_dither v_load_pair_dither
#define v_load_mean          v_load
#define v_store_mean         v_store

/* Averages each even pixel with the next odd pixel. */
static inline V v_average_pairs(const V x[2])
{
    return v_mean(x[0], x[1]);
}

#include "kernels/composite_v.inc"

/* -------------------------------------------------------------------- sums */

static inline uint32_t w_get_first_lane(V x)
{
    return (uint32_t)_mm_cvtsi128_si32(x);
}

static inline V w_prefix_sums(V x)
{
    x = OP(add_epi32)(x, _mm_slli_si128(x, 4));
    return OP(add_epi32)(x, _mm_slli_si128(x, 8));
}

static inline V w_repeat_last_lane(V x)
{
    return _mm_shuffle_epi32(x, 0xff);
}

/* Packs the lanes of two vectors, clamped to 0 .. 65535. */
#define w_clamp_to_uint16 _mm_packus_epi32

#include "kernels/run_sum_x86.inc"
