/* SPDX-License-Identifier: MIT
 *
 * The SSE4.1 operations that kernels use, by the 128-bit SIMD of WebAssembly:
 * with this header *_sse41.c compile for wasm32. Shifts need counts below the
 * size of a lane, and _mm_blendv_epi8() masks of whole bytes.
 * _mm_mulhrs_epi16() differs for INT16_MIN times INT16_MIN, which no kernel
 * computes.
 */
#ifndef GLINT_KERNELS_WASM_SMMINTRIN_H
#define GLINT_KERNELS_WASM_SMMINTRIN_H

#include <wasm_simd128.h>

typedef v128_t __m128i;

#define _mm_load_si128         wasm_v128_load
#define _mm_loadu_si128        wasm_v128_load
#define _mm_loadl_epi64        wasm_v128_load64_zero
#define _mm_store_si128        wasm_v128_store
#define _mm_storeu_si128       wasm_v128_store
#define _mm_storel_epi64(p, x) wasm_v128_store64_lane(p, x, 0)

#define _mm_setr_epi8        wasm_i8x16_make
#define _mm_set_epi64x(h, l) wasm_i64x2_make(l, h)
#define _mm_set1_epi8(x)     wasm_i8x16_splat((int8_t)(x))
#define _mm_set1_epi16       wasm_i16x8_splat
#define _mm_set1_epi32       wasm_i32x4_splat
#define _mm_set1_epi64x      wasm_i64x2_splat
#define _mm_setzero_si128()  wasm_i32x4_splat(0)
#define _mm_cvtsi32_si128(x) wasm_i32x4_make(x, 0, 0, 0)
#define _mm_cvtsi128_si32(x) wasm_i32x4_extract_lane(x, 0)
#define _mm_extract_epi32    wasm_i32x4_extract_lane

#define _mm_and_si128          wasm_v128_and
#define _mm_or_si128           wasm_v128_or
#define _mm_xor_si128          wasm_v128_xor
#define _mm_andnot_si128(a, b) wasm_v128_andnot(b, a)
#define _mm_testz_si128(a, b)  (!wasm_v128_any_true(wasm_v128_and(a, b)))
#define _mm_movemask_epi8(x)   ((int)wasm_i8x16_bitmask(x))

#define _mm_add_epi8     wasm_i8x16_add
#define _mm_sub_epi8     wasm_i8x16_sub
#define _mm_adds_epu8    wasm_u8x16_add_sat
#define _mm_min_epu8     wasm_u8x16_min
#define _mm_max_epi8     wasm_i8x16_max
#define _mm_add_epi16    wasm_i16x8_add
#define _mm_sub_epi16    wasm_i16x8_sub
#define _mm_adds_epi16   wasm_i16x8_add_sat
#define _mm_subs_epu16   wasm_u16x8_sub_sat
#define _mm_avg_epu16    wasm_u16x8_avgr
#define _mm_max_epi16    wasm_i16x8_max
#define _mm_mullo_epi16  wasm_i16x8_mul
#define _mm_mulhrs_epi16 wasm_i16x8_q15mulr_sat
#define _mm_madd_epi16   wasm_i32x4_dot_i16x8
#define _mm_cmpeq_epi16  wasm_i16x8_eq
#define _mm_add_epi32    wasm_i32x4_add
#define _mm_sub_epi32    wasm_i32x4_sub
#define _mm_mullo_epi32  wasm_i32x4_mul
#define _mm_min_epi32    wasm_i32x4_min
#define _mm_max_epi32    wasm_i32x4_max
#define _mm_abs_epi32    wasm_i32x4_abs
#define _mm_cmpeq_epi32  wasm_i32x4_eq
#define _mm_cmpgt_epi32  wasm_i32x4_gt
#define _mm_add_epi64    wasm_i64x2_add
#define _mm_sub_epi64    wasm_i64x2_sub

/* the lower halves of 64-bit lanes, in the lower half of the vector */
#define EVEN_LANES(x) wasm_i32x4_shuffle(x, x, 0, 2, 0, 2)
#define _mm_mul_epi32(a, b) \
    wasm_i64x2_extmul_low_i32x4(EVEN_LANES(a), EVEN_LANES(b))

#define SHIFT_COUNT(by)      ((uint32_t)wasm_i32x4_extract_lane(by, 0))
#define _mm_slli_epi16       wasm_i16x8_shl
#define _mm_srli_epi16       wasm_u16x8_shr
#define _mm_srai_epi16       wasm_i16x8_shr
#define _mm_slli_epi32       wasm_i32x4_shl
#define _mm_srli_epi32       wasm_u32x4_shr
#define _mm_srai_epi32       wasm_i32x4_shr
#define _mm_slli_epi64       wasm_i64x2_shl
#define _mm_srli_epi64       wasm_u64x2_shr
#define _mm_srl_epi32(x, by) wasm_u32x4_shr(x, SHIFT_COUNT(by))
#define _mm_sra_epi32(x, by) wasm_i32x4_shr(x, SHIFT_COUNT(by))
#define _mm_srl_epi64(x, by) wasm_u64x2_shr(x, SHIFT_COUNT(by))
#define _mm_slli_si128(x, n)                                                 \
    wasm_i8x16_shuffle(wasm_i32x4_splat(0), x, 16 - (n), 17 - (n), 18 - (n), \
                       19 - (n), 20 - (n), 21 - (n), 22 - (n), 23 - (n),     \
                       24 - (n), 25 - (n), 26 - (n), 27 - (n), 28 - (n),     \
                       29 - (n), 30 - (n), 31 - (n))

#define _mm_cvtepu8_epi16 wasm_u16x8_extend_low_u8x16
#define _mm_packus_epi16  wasm_u8x16_narrow_i16x8
#define _mm_packus_epi32  wasm_u16x8_narrow_i32x4
#define _mm_unpacklo_epi8(a, b)                                               \
    wasm_i8x16_shuffle(a, b, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, \
                       7, 23)
#define _mm_unpackhi_epi8(a, b)                                                \
    wasm_i8x16_shuffle(a, b, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, \
                       30, 15, 31)
#define _mm_unpacklo_epi32(a, b) wasm_i32x4_shuffle(a, b, 0, 4, 1, 5)
#define _mm_unpackhi_epi32(a, b) wasm_i32x4_shuffle(a, b, 2, 6, 3, 7)
#define _mm_unpacklo_epi64(a, b) wasm_i64x2_shuffle(a, b, 0, 2)
#define _mm_unpackhi_epi64(a, b) wasm_i64x2_shuffle(a, b, 1, 3)
/* A byte of an index with the top bit set gives 0; else its lower four bits
 * choose a byte. */
#define _mm_shuffle_epi8(x, at) \
    wasm_i8x16_swizzle(x, wasm_v128_and(at, wasm_i8x16_splat((int8_t)0x8f)))
#define _mm_shuffle_epi32(x, m) \
    wasm_i32x4_shuffle(x, x, (m)&3, (m) >> 2 & 3, (m) >> 4 & 3, (m) >> 6 & 3)
#define _mm_blend_epi16(a, b, m)                                       \
    wasm_i16x8_shuffle(a, b, ((m)&1) * 8, 1 + ((m) >> 1 & 1) * 8,      \
                       2 + ((m) >> 2 & 1) * 8, 3 + ((m) >> 3 & 1) * 8, \
                       4 + ((m) >> 4 & 1) * 8, 5 + ((m) >> 5 & 1) * 8, \
                       6 + ((m) >> 6 & 1) * 8, 7 + ((m) >> 7 & 1) * 8)
#define _mm_blendv_epi8(a, b, mask) wasm_v128_bitselect(b, a, mask)

#endif
