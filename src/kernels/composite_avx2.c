/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include <immintrin.h>

#define V                  __m256i
#define V_N                16
#define V_PARTS            1
#define KERNEL(name)       name##_avx2
#define OP(name)           _mm256_##name
#define WHOLE(name)        _mm256_##name##_si256
#define v_bytes(high, low) _mm256_set_epi64x(high, low, high, low)
#define v_half(p)                \
    _mm256_broadcastsi128_si256( \
        _mm_load_si128((const __m128i *)(const void *)(p)))

static inline void v_pairs_from_bytes(__m128i codes, V x[1]);
static inline void v_chroma_from_bytes(__m128i codes, V c[2]);
static inline __m128i b_pack_pairs(const V x[1]);
static inline __m128i b_pack_chroma(const V c[2]);

#include "kernels/composite_x86.inc"

/* Loads eight values and stores them in both halves of the vector. */
static inline V v_load_repeated(const int16_t *p)
{
    return _mm256_broadcastsi128_si256(b_load(p));
}

static inline V v_load_codes(const uint8_t *p)
{
    return v_left(_mm256_cvtepu8_epi16(b_load(p)), 7);
}

static inline void v_store_codes(uint8_t *p, V x)
{
    x = v_right_signed(x, 7);
    b_store(p, _mm_packus_epi16(_mm256_castsi256_si128(x),
                                _mm256_extracti128_si256(x, 1)));
}

/* Loads sixteen values: those of even index into the lower half, those of odd
 * index into the upper half. */
static inline void v_load_pairs(const uint16_t *p, V x[1])
{
    x[0] = _mm256_permute4x64_epi64(
        v_shuffle(v_load((const int16_t *)p),
                  v_bytes(0x0f0e0b0a07060302, 0x0d0c090805040100)),
        0xd8);
}

/* Converts codes to _q7. PLACES is a shuffle control: for each half of the
 * result it selects the bytes of CODES that are converted. */
static inline V shuffle_codes_to_q7(__m128i codes, V places)
{
    return v_right(v_shuffle(_mm256_broadcastsi128_si256(codes), places), 1);
}

/* Shuffle controls that put bytes 0, 2 .. 14 (EVENS) or 1, 3 .. 15 (ODDS) into
 * the upper bytes of eight 16-bit elements; the lower bytes become 0. */
#define EVENS 0x0e800c800a800880, 0x0680048002800080
#define ODDS  0x0f800d800b800980, 0x0780058003800180

static inline void v_pairs_from_bytes(__m128i codes, V x[1])
{
    x[0] = shuffle_codes_to_q7(codes, _mm256_set_epi64x(ODDS, EVENS));
}

static inline void v_chroma_from_bytes(__m128i codes, V c[2])
{
    c[0] = shuffle_codes_to_q7(codes, _mm256_set_epi64x(EVENS, EVENS));
    c[1] = shuffle_codes_to_q7(codes, _mm256_set_epi64x(ODDS, ODDS));
}

/* Interleaves the codes in the lower halves of X and Y and packs them into
 * bytes. */
static inline __m128i interleave_codes(V x, V y)
{
    const __m128i both =
        _mm_packus_epi16(_mm_srai_epi16(_mm256_castsi256_si128(x), 7),
                         _mm_srai_epi16(_mm256_castsi256_si128(y), 7));

    return _mm_shuffle_epi8(
        both, _mm_set_epi64x(0x0f070e060d050c04, 0x0b030a0209010800));
}

static inline V swap_halves(V x)
{
    return _mm256_permute2x128_si256(x, x, 1);
}

static inline __m128i b_pack_pairs(const V x[1])
{
    return interleave_codes(x[0], swap_halves(x[0]));
}

static inline __m128i b_pack_chroma(const V c[2])
{
    return interleave_codes(c[0], c[1]);
}

/* Load eight dither thresholds: for sixteen pixels, or for the chroma of
 * sixteen pixels, where Cb and Cr have thresholds of their own. */
static inline void v_load_pair_dither(const int16_t *p, V x[1])
{
    x[0] = v_shuffle(v_load_repeated(p),
                     _mm256_set_epi64x(0x0f0e0b0a07060302, 0x0f0e0b0a07060302,
                                       0x0d0c090805040100, 0x0d0c090805040100));
}

static inline void v_load_chroma_dither(const int16_t *p, V c[2])
{
    c[0] = v_shuffle(v_load_repeated(p),
                     v_bytes(0x0d0c090805040100, 0x0d0c090805040100));
    c[1] = v_shuffle(v_load_repeated(p),
                     v_bytes(0x0f0e0b0a07060302, 0x0f0e0b0a07060302));
}

#define v_load_mean v_load_repeated

static inline void v_store_mean(int16_t *p, V x)
{
    b_store(p, _mm256_castsi256_si128(x));
}

/* Returns the mean of each even pixel and the next odd pixel, in both
 * halves. */
static inline V v_average_pairs(const V x[1])
{
    return v_mean(x[0], swap_halves(x[0]));
}

/* Functions that process two blocks of quads in one vector, one per half.
 * v_join_pairs() combines the means of their pixel pairs, or their chroma.
 * v_copy_quads_of_block() copies the values of block B to both halves. */
static inline V v_join_pairs(V x[2][1])
{
    return v_mean(_mm256_permute2x128_si256(x[0][0], x[1][0], 0x20),
                  _mm256_permute2x128_si256(x[0][0], x[1][0], 0x31));
}

static inline V v_join_chroma(V c[2][2], int k)
{
    return _mm256_permute2x128_si256(c[0][k], c[1][k], 0x20);
}

static inline V v_copy_quads_of_block(V x, int b)
{
    return b ? _mm256_permute2x128_si256(x, x, 0x11)
             : _mm256_permute2x128_si256(x, x, 0x00);
}

#include "kernels/composite_v.inc"

/* -------------------------------------------------------------------- sums */

static inline uint32_t w_get_first_lane(V x)
{
    return (uint32_t)_mm256_cvtsi256_si32(x);
}

static inline V w_prefix_sums(V x)
{
    V low;

    x = OP(add_epi32)(x, _mm256_slli_si256(x, 4));
    x = OP(add_epi32)(x, _mm256_slli_si256(x, 8));
    /* LOW is 0 in the lower half, and has the sums of the lower half in the
     * upper half. */
    low = _mm256_permute2x128_si256(x, x, 0x08);
    return OP(add_epi32)(x, _mm256_shuffle_epi32(low, 0xff));
}

static inline V w_repeat_last_lane(V x)
{
    return _mm256_permutevar8x32_epi32(x, _mm256_set1_epi32(7));
}

static inline V w_clamp_to_uint16(V a, V b)
{
    return _mm256_permute4x64_epi64(_mm256_packus_epi32(a, b), 0xd8);
}

#include "kernels/run_sum_x86.inc"
