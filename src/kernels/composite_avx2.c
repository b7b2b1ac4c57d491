/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include <immintrin.h>

#define V            __m256i
#define V_N          16
#define KERNEL(name) name##_avx2

static inline V v_set(int16_t x)
{
    return _mm256_set1_epi16(x);
}

static inline V v_load(const int16_t *p)
{
    return _mm256_load_si256((const __m256i *)(const void *)p);
}

static inline void v_store(int16_t *p, V x)
{
    _mm256_store_si256((__m256i *)(void *)p, x);
}

/* Eight values, over and over. */
static inline V v_repeat(const int16_t *p)
{
    return _mm256_broadcastsi128_si256(
        _mm_loadu_si128((const __m128i *)(const void *)p));
}

/* As they lie, from any address. */
static inline V v_load_bytes(const uint8_t *p)
{
    return _mm256_loadu_si256((const __m256i *)(const void *)p);
}

static inline void v_store_bytes(uint8_t *p, V x)
{
    _mm256_storeu_si256((__m256i *)(void *)p, x);
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

#define v_add                _mm256_add_epi16
#define v_sub                _mm256_sub_epi16
#define v_add_sat            _mm256_adds_epi16
#define v_add_unsigned_sat   _mm256_adds_epu16
#define v_times              _mm256_mulhrs_epi16
#define v_high_product       _mm256_mulhi_epu16
#define v_low_product        _mm256_mullo_epi16
#define v_min                _mm256_min_epi16
#define v_max                _mm256_max_epi16
#define v_and                _mm256_and_si256
#define v_or                 _mm256_or_si256
#define v_and_not            _mm256_andnot_si256
#define v_equal              _mm256_cmpeq_epi16
#define v_greater            _mm256_cmpgt_epi16
#define v_left               _mm256_slli_epi16
#define v_right              _mm256_srli_epi16
#define v_right_signed       _mm256_srai_epi16
#define v_look(table, index) _mm256_shuffle_epi8(table, index)
#define v_pick(mask, a, b)   _mm256_blendv_epi8(b, a, mask)

/* Rounded up; of values of 0 or more. */
#define v_mean _mm256_avg_epu16

/* Of each pair of lanes: the other one, twice the first, twice the second. */
static inline V v_swap(V x)
{
    return _mm256_shuffle_epi8(
        x, _mm256_set_epi64x(0x0d0c0f0e09080b0a, 0x0504070601000302,
                             0x0d0c0f0e09080b0a, 0x0504070601000302));
}

static inline V v_evens(V x)
{
    return _mm256_shuffle_epi8(
        x, _mm256_set_epi64x(0x0d0c0d0c09080908, 0x0504050401000100,
                             0x0d0c0d0c09080908, 0x0504050401000100));
}

static inline V v_odds(V x)
{
    return _mm256_shuffle_epi8(
        x, _mm256_set_epi64x(0x0f0e0f0e0b0a0b0a, 0x0706070603020302,
                             0x0f0e0f0e0b0a0b0a, 0x0706070603020302));
}

/* Unsigned. */
static inline V v_not_less(V a, V b)
{
    return _mm256_cmpeq_epi16(_mm256_max_epu16(a, b), a);
}

/* Places of the bytes of the entries K + BASE of a table, 0 .. 7. */
static inline V v_index(V k, V entry, int base)
{
    return _mm256_add_epi16(_mm256_mullo_epi16(k, entry),
                            v_set((int16_t)(0x0100 + base * 0x0202)));
}

static inline int v_is_zero(V x)
{
    return _mm256_testz_si256(x, x);
}

#define W              __m256i
#define w_add          _mm256_add_epi32
#define w_right_signed _mm256_srai_epi32

static inline W w_set(uint32_t x)
{
    return _mm256_set1_epi32((int32_t)x);
}

static inline W w_load(const uint32_t *p)
{
    return _mm256_load_si256((const __m256i *)(const void *)p);
}

static inline void w_clear(uint32_t *p)
{
    _mm256_store_si256((__m256i *)(void *)p, _mm256_setzero_si256());
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
