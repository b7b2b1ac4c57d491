/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include <arm_neon.h>

#define V            int16x8_t
#define V_N          8
#define KERNEL(name) name##_neon

#define U(x) vreinterpretq_u16_s16(x)
#define S(x) vreinterpretq_s16_u16(x)

#define v_set              vdupq_n_s16
#define v_load             vld1q_s16
#define v_store            vst1q_s16
#define v_repeat           vld1q_s16
#define v_add              vaddq_s16
#define v_sub              vsubq_s16
#define v_add_sat          vqaddq_s16
#define v_times            vqrdmulhq_s16
#define v_low_product      vmulq_s16
#define v_min              vminq_s16
#define v_max              vmaxq_s16
#define v_and              vandq_s16
#define v_or               vorrq_s16
#define v_left             vshlq_n_s16
#define v_right_signed     vshrq_n_s16
#define v_right(x, n)      S(vshrq_n_u16(U(x), n))
#define v_pick(mask, a, b) vbslq_s16(U(mask), a, b)

/* As they lie, from any address. */
static inline V v_load_bytes(const uint8_t *p)
{
    return vreinterpretq_s16_u8(vld1q_u8(p));
}

static inline void v_store_bytes(uint8_t *p, V x)
{
    vst1q_u8(p, vreinterpretq_u8_s16(x));
}

static inline V v_load_codes(const uint8_t *p)
{
    return S(vmovl_u8(vld1_u8(p)));
}

/* Held to 0 .. 255. */
static inline void v_store_codes(uint8_t *p, V x)
{
    vst1_u8(p, vqmovun_s16(x));
}

static inline V v_add_unsigned_sat(V a, V b)
{
    return S(vqaddq_u16(U(a), U(b)));
}

static inline V v_high_product(V a, V b)
{
    const uint32x4_t low = vmull_u16(vget_low_u16(U(a)), vget_low_u16(U(b)));
    const uint32x4_t high = vmull_u16(vget_high_u16(U(a)), vget_high_u16(U(b)));

    return S(vcombine_u16(vshrn_n_u32(low, 16), vshrn_n_u32(high, 16)));
}

static inline V v_and_not(V mask, V x)
{
    return vbicq_s16(x, mask);
}

static inline V v_equal(V a, V b)
{
    return S(vceqq_s16(a, b));
}

static inline V v_greater(V a, V b)
{
    return S(vcgtq_s16(a, b));
}

/* Rounded up; of values of 0 or more. */
#define v_mean vrhaddq_s16

/* Of each pair of lanes: the other one, twice the first, twice the second. */
#define v_swap     vrev32q_s16
#define v_evens(x) vtrnq_s16(x, x).val[0]
#define v_odds(x)  vtrnq_s16(x, x).val[1]

/* Unsigned. */
static inline V v_not_less(V a, V b)
{
    return S(vcgeq_u16(U(a), U(b)));
}

/* Places of the bytes of the entries K + BASE of a table, 0 .. 7. */
static inline V v_index(V k, V entry, int base)
{
    return vmlaq_s16(v_set((int16_t)(0x0100 + base * 0x0202)), k, entry);
}

static inline int v_is_zero(V x)
{
    const uint64x2_t both = vreinterpretq_u64_s16(x);

    return (vgetq_lane_u64(both, 0) | vgetq_lane_u64(both, 1)) == 0;
}

static inline V v_look(V table, V index)
{
    const uint8x16_t t = vreinterpretq_u8_s16(table);
    const uint8x16_t k = vreinterpretq_u8_s16(index);
#if defined(__aarch64__)
    return vreinterpretq_s16_u8(vqtbl1q_u8(t, k));
#else
    const uint8x8x2_t halves = {{vget_low_u8(t), vget_high_u8(t)}};

    return vreinterpretq_s16_u8(vcombine_u8(vtbl2_u8(halves, vget_low_u8(k)),
                                            vtbl2_u8(halves, vget_high_u8(k))));
#endif
}

#define W          uint32x4_t
#define w_set      vdupq_n_u32
#define w_load     vld1q_u32
#define w_add      vaddq_u32
#define w_clear(p) vst1q_u32(p, vdupq_n_u32(0))
#define w_first(x) vgetq_lane_u32(x, 0)
#define w_last(x)  vdupq_n_u32(vgetq_lane_u32(x, 3))

static inline W w_right_signed(W x, int n)
{
    return vreinterpretq_u32_s32(
        vshlq_s32(vreinterpretq_s32_u32(x), vdupq_n_s32(-n)));
}

/* Of each lane and those before it. */
static inline W w_sums(W x)
{
    const W zero = vdupq_n_u32(0);

    x = vaddq_u32(x, vextq_u32(zero, x, 3));
    return vaddq_u32(x, vextq_u32(zero, x, 2));
}

/* Held to 0 .. 65535. */
static inline V w_narrow(W a, W b)
{
    return S(vcombine_u16(vqmovun_s32(vreinterpretq_s32_u32(a)),
                          vqmovun_s32(vreinterpretq_s32_u32(b))));
}

#include "kernels/composite_v.h"
