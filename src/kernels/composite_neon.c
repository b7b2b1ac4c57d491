/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include <arm_neon.h>

#define V            int16x8_t
#define V_N          8
#define V_PARTS      2
#define KERNEL(name) name##_neon

#define U(x) vreinterpretq_u16_s16(x)
#define S(x) vreinterpretq_s16_u16(x)

#define v_set                    vdupq_n_s16
#define v_load                   vld1q_s16
#define v_store                  vst1q_s16
#define v_load_repeated          vld1q_s16
#define v_load_mean              vld1q_s16
#define v_store_mean             vst1q_s16
#define v_add                    vaddq_s16
#define v_sub                    vsubq_s16
#define v_add_sat                vqaddq_s16
#define v_times                  vqrdmulhq_s16
#define v_max                    vmaxq_s16
#define v_or                     vorrq_s16
#define v_right(x, n)            S(vshrq_n_u16(U(x), n))
#define v_sub_unsigned_sat(a, b) S(vqsubq_u16(U(a), U(b)))
#define v_and_not(mask, x)       vbicq_s16(x, mask)
#define v_equal(a, b)            S(vceqq_s16(a, b))

/* Makes the compiler compute X, or load from P, only after it has computed Y.
 * The empty assembly pretends to use both. */
#define AFTER(x, y)      __asm__("" : "+w"(x) : "w"(y))
#define LOAD_AFTER(p, y) __asm__("" : "+r"(p) : "w"(y))

/* A plus half of B, unsigned. */
#define v_add_half(a, b) S(vsraq_n_u16(U(a), U(b), 1))

/* Mean of values of 0 or more, rounded up. */
#define v_mean vrhaddq_s16

static inline int v_is_zero(V x)
{
#if defined(__aarch64__)
    return vmaxvq_u32(vreinterpretq_u32_s16(x)) == 0;
#else
    const uint64x2_t both = vreinterpretq_u64_s16(x);

    return vget_lane_u64(vorr_u64(vget_low_u64(both), vget_high_u64(both)),
                         0) == 0;
#endif
}

/* --------------------------------------------------------------- constants */

/* Factors of a tone curve, which stay in registers of eight factors each.
 * Compilers keep a table in two consecutive registers only if it is a variable,
 * not a member of a struct. */
struct v_tone {
    int16x8_t factor, toe_end, rise[2], turn;
    const uint8x16x2_t *level, *slope, *curve;
};

struct v_mix {
    struct v_tone tone;
    int16x8_t from_ycc, to_ycc, black, white;
};

#define TONE        struct v_tone
#define MIX         struct v_mix
#define CONSTANT(c) (c)

#if defined(__aarch64__)
#define TIMES(x, f, i) vqrdmulhq_laneq_s16(x, f, i)
#else
#define TIMES(x, f, i) \
    vqrdmulhq_lane_s16(x, (i)&4 ? vget_high_s16(f) : vget_low_s16(f), (i)&3)
#endif

/* On 64-bit ARM the tables are loaded once, because there are enough registers;
 * on 32-bit ARM they are loaded at each use. */
#if defined(__aarch64__)
#define TABLES(t, tone)                                       \
    const uint8x16x2_t t##_level = load_table((tone)->level), \
                       t##_slope = load_table((tone)->slope), \
                       t##_curve = load_table((tone)->curve)
#define TABLE(t, tone, name) &t##_##name
#else
#define TABLES(t, tone)      (void)0
#define TABLE(t, tone, name) (const void *)(tone)->name
#endif

#define TONE_HERE(t, tone)                                            \
    {                                                                 \
        vld1q_s16((tone)->factor.one), vld1q_s16((tone)->toe_end),    \
            {vld1q_s16((tone)->rise[0]), vld1q_s16((tone)->rise[1])}, \
            vld1q_s16((tone)->turn), TABLE(t, tone, level),           \
            TABLE(t, tone, slope), TABLE(t, tone, curve)              \
    }

#define LOAD_TONE(t, tone)                             \
    TABLES(t, tone);                                   \
    const struct v_tone t##_here = TONE_HERE(t, tone); \
    const struct v_tone *const t = &t##_here

#define LOAD_MIX(m, mix)                                            \
    TABLES(m, &(mix)->tone);                                        \
    const struct v_mix m##_here = {                                 \
        TONE_HERE(m, &(mix)->tone), vld1q_s16((mix)->from_ycc.one), \
        vld1q_s16((mix)->to_ycc.one), vld1q_s16((mix)->black),      \
        vld1q_s16((mix)->white)};                                   \
    const struct v_mix *const m = &m##_here

#if defined(__aarch64__)
static inline uint8x16x2_t load_table(const int16_t *p)
{
    return vld1q_u8_x2((const uint8_t *)p);
}
#endif

/* ------------------------------------------------------------------ tables */

/* Number of leading zeros, 0 .. 16. */
#define v_zeros vclzq_s16

/* Byte offsets of the entries of a table. A lookup at an offset past the
 * table's end gives 0. */
#define PLACES uint8x16_t

static inline PLACES v_table_offsets(const TONE *t, V k)
{
#if defined(__aarch64__)
    const V twice = vmulq_laneq_s16(k, t->factor, GLINT_TONE_ENTRY);
#else
    const V twice =
        vmulq_lane_s16(k, vget_high_s16(t->factor), GLINT_TONE_ENTRY & 3);
#endif
    return vreinterpretq_u8_s16(vorrq_s16(twice, v_set(0x0100)));
}

static inline V v_look_up_entries(const uint8x16x2_t *table, PLACES at)
{
#if defined(__aarch64__)
    return vreinterpretq_s16_u8(vqtbl2q_u8(*table, at));
#elif defined(__clang__)
    const uint8x8x4_t quarters = {
        {vget_low_u8(table->val[0]), vget_high_u8(table->val[0]),
         vget_low_u8(table->val[1]), vget_high_u8(table->val[1])}};

    return vreinterpretq_s16_u8(
        vcombine_u8(vtbl4_u8(quarters, vget_low_u8(at)),
                    vtbl4_u8(quarters, vget_high_u8(at))));
#else
    /* Inline assembly is used because GCC would copy the four registers of the
     * table through the stack. */
    uint8x8x4_t quarters;
    uint8x16_t entry;

    __asm__("vld1.8 %h1, [%2]\n\t"
            "vtbl.8 %e0, %h1, %e3\n\t"
            "vtbl.8 %f0, %h1, %f3"
            : "=&w"(entry), "=&w"(quarters)
            : "r"(table), "w"(at), "m"(*table));
    return vreinterpretq_s16_u8(entry);
#endif
}

/* Returns X times 2^ZEROS. NEON shifts each lane by its own count, so the table
 * of powers is not used. */
static inline V v_shift_by_zeros(const TONE *t, V x, V zeros, PLACES at)
{
    (void)t;
    (void)at;
    return vshlq_s16(x, zeros);
}

/* ------------------------------------------------------------ codes to lanes
 *
 * Codes of 8 bits are loaded as _q7, and clamped to 0 .. 255 when stored. */

static inline V v_load_codes(const uint8_t *p)
{
    return S(vshll_n_u8(vld1_u8(p), 7));
}

static inline void v_store_codes(uint8_t *p, V x)
{
    vst1_u8(p, vqshrun_n_s16(x, 7));
}

static inline void v_load_pairs(const uint16_t *p, V x[2])
{
    const uint16x8x2_t pairs = vld2q_u16(p);

    x[0] = S(pairs.val[0]);
    x[1] = S(pairs.val[1]);
}

static inline void v_load_code_pairs(const uint8_t *p, V x[2])
{
    const uint8x8x2_t pairs = vld2_u8(p);

    x[0] = S(vshll_n_u8(pairs.val[0], 7));
    x[1] = S(vshll_n_u8(pairs.val[1], 7));
}

static inline void v_store_code_pairs(uint8_t *p, const V x[2])
{
    const uint8x8x2_t pairs = {
        {vqshrun_n_s16(x[0], 7), vqshrun_n_s16(x[1], 7)}};

    vst2_u8(p, pairs);
}

#define v_load_chroma  v_load_code_pairs
#define v_store_chroma v_store_code_pairs

/* Loads sixteen pixels of two bytes each: luma and chroma, luma second if
 * LUMA_AT is 1. */
static inline void v_load_packed(const uint8_t *p, int luma_at, V y[2], V c[2])
{
    const uint8x8x4_t quads = vld4_u8(p);

    for (int k = 0; k < 2; k++) {
        const V even = S(vshll_n_u8(quads.val[2 * k], 7));
        const V odd = S(vshll_n_u8(quads.val[2 * k + 1], 7));

        y[k] = luma_at ? odd : even;
        c[k] = luma_at ? even : odd;
    }
}

static inline void v_store_packed(uint8_t *p, int luma_at, const V y[2],
                                  const V c[2])
{
    uint8x8x4_t quads;

    for (int k = 0; k < 2; k++) {
        quads.val[2 * k] = vqshrun_n_s16(luma_at ? c[k] : y[k], 7);
        quads.val[2 * k + 1] = vqshrun_n_s16(luma_at ? y[k] : c[k], 7);
    }
    vst4_u8(p, quads);
}

/* Loads eight dither thresholds for sixteen pixels: thresholds of even
 * pixels, then of odd pixels; for chroma, thresholds of Cb, then of Cr. */
static inline void v_load_pair_dither(const int16_t *p, V x[2])
{
    const int16x8x2_t pairs = vuzpq_s16(vld1q_s16(p), vld1q_s16(p));

    x[0] = pairs.val[0];
    x[1] = pairs.val[1];
}

#define v_load_chroma_dither v_load_pair_dither

/* Averages each even pixel with the next odd pixel. */
static inline V v_average_pairs(const V x[2])
{
    return v_mean(x[0], x[1]);
}

#include "kernels/composite_v.inc"

/* -------------------------------------------------------------------- sums */

/* Returns SUM rounded to _q16 and clamped to 0 .. 65535. SUM has 16 - FEWER
 * fraction bits. */
static inline uint16x4_t round_sum_to_q16(uint32x4_t sum, int32x4_t fewer)
{
    return vqmovun_s32(vrshlq_s32(vreinterpretq_s32_u32(sum), fewer));
}

/* Computes the prefix sums of sixteen lanes in groups of four: first within
 * each group; then adds the total of all earlier groups to each group. If all
 * sixteen changes are 0, which is common, the additions are skipped. */
void glint_run_sum_neon(uint32_t *change, uint32_t *carry, uint16_t *light_q16,
                        int n, int more)
{
    const uint32x4_t zero = vdupq_n_u32(0);
    const int32x4_t fewer = vdupq_n_s32(-more);
    uint32x4_t before = vdupq_n_u32(*carry);

    for (int i = 0; i < n; i += BLOCK) {
        uint32_t *at = change + i;
        const uint32x4x4_t x = vld4q_u32(at);
        const uint32x4_t x01 = vaddq_u32(x.val[0], x.val[1]);
        const uint32x4_t x012 = vaddq_u32(x01, x.val[2]);
        const uint32x4_t all = vaddq_u32(x012, x.val[3]);
        const uint32x4_t any = vorrq_u32(vorrq_u32(x.val[0], x.val[1]),
                                         vorrq_u32(x.val[2], x.val[3]));
        uint32x4_t sum;
        uint16x4x4_t light;

        if (v_is_zero(vreinterpretq_s16_u32(any))) {
            const uint16x4_t same = round_sum_to_q16(before, fewer);

            vst1q_u16(light_q16 + i, vcombine_u16(same, same));
            vst1q_u16(light_q16 + i + 8, vcombine_u16(same, same));
            continue;
        }
        for (int k = 0; k < 4; k++)
            vst1q_u32(at + 4 * k, zero);
        sum = vaddq_u32(all, vextq_u32(zero, all, 3));
        sum = vaddq_u32(sum, vextq_u32(zero, sum, 2));
        sum = vaddq_u32(sum, before);
        before = vextq_u32(before, sum, 3); /* total before each group */
        light.val[0] = round_sum_to_q16(vaddq_u32(x.val[0], before), fewer);
        light.val[1] = round_sum_to_q16(vaddq_u32(x01, before), fewer);
        light.val[2] = round_sum_to_q16(vaddq_u32(x012, before), fewer);
        light.val[3] = round_sum_to_q16(sum, fewer);
        vst4_u16(light_q16 + i, light);
        before = vdupq_n_u32(vgetq_lane_u32(sum, 3));
    }
    *carry = vgetq_lane_u32(before, 0);
}
