/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include <smmintrin.h>

#define V            __m128i
#define V_N          8
#define KERNEL(name) name##_sse41

static inline V v_set(int16_t x)
{
    return _mm_set1_epi16(x);
}

static inline V v_load(const int16_t *p)
{
    return _mm_load_si128((const __m128i *)(const void *)p);
}

static inline void v_store(int16_t *p, V x)
{
    _mm_store_si128((__m128i *)(void *)p, x);
}

static inline V v_repeat(const int16_t *p)
{
    return _mm_loadu_si128((const __m128i *)(const void *)p);
}

/* As they lie, from any address. */
static inline V v_load_bytes(const uint8_t *p)
{
    return _mm_loadu_si128((const __m128i *)(const void *)p);
}

static inline void v_store_bytes(uint8_t *p, V x)
{
    _mm_storeu_si128((__m128i *)(void *)p, x);
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

#define v_add                _mm_add_epi16
#define v_sub                _mm_sub_epi16
#define v_add_sat            _mm_adds_epi16
#define v_add_unsigned_sat   _mm_adds_epu16
#define v_times              _mm_mulhrs_epi16
#define v_high_product       _mm_mulhi_epu16
#define v_low_product        _mm_mullo_epi16
#define v_min                _mm_min_epi16
#define v_max                _mm_max_epi16
#define v_and                _mm_and_si128
#define v_or                 _mm_or_si128
#define v_and_not            _mm_andnot_si128
#define v_equal              _mm_cmpeq_epi16
#define v_greater            _mm_cmpgt_epi16
#define v_left               _mm_slli_epi16
#define v_right              _mm_srli_epi16
#define v_right_signed       _mm_srai_epi16
#define v_look(table, index) _mm_shuffle_epi8(table, index)
#define v_pick(mask, a, b)   _mm_blendv_epi8(b, a, mask)

/* Rounded up; of values of 0 or more. */
#define v_mean _mm_avg_epu16

/* Of each pair of lanes: the other one, twice the first, twice the second. */
static inline V v_swap(V x)
{
    return _mm_shuffle_epi8(
        x, _mm_set_epi64x(0x0d0c0f0e09080b0a, 0x0504070601000302));
}

static inline V v_evens(V x)
{
    return _mm_shuffle_epi8(
        x, _mm_set_epi64x(0x0d0c0d0c09080908, 0x0504050401000100));
}

static inline V v_odds(V x)
{
    return _mm_shuffle_epi8(
        x, _mm_set_epi64x(0x0f0e0f0e0b0a0b0a, 0x0706070603020302));
}

/* Unsigned. */
static inline V v_not_less(V a, V b)
{
    return _mm_cmpeq_epi16(_mm_max_epu16(a, b), a);
}

/* Places of the bytes of the entries K + BASE of a table, 0 .. 7. */
static inline V v_index(V k, V entry, int base)
{
    return _mm_add_epi16(_mm_mullo_epi16(k, entry),
                         v_set((int16_t)(0x0100 + base * 0x0202)));
}

static inline int v_is_zero(V x)
{
    return _mm_testz_si128(x, x);
}

#define W              __m128i
#define w_add          _mm_add_epi32
#define w_right_signed _mm_srai_epi32

static inline W w_set(uint32_t x)
{
    return _mm_set1_epi32((int32_t)x);
}

static inline W w_load(const uint32_t *p)
{
    return _mm_load_si128((const __m128i *)(const void *)p);
}

static inline void w_clear(uint32_t *p)
{
    _mm_store_si128((__m128i *)(void *)p, _mm_setzero_si128());
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
