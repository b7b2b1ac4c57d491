/* SPDX-License-Identifier: MIT */
#include "kernels/ward/ward.h"

#include <arm_neon.h>

#define W            int32x4_t
#define W_N          4
#define KERNEL(name) name##_neon
#define U(x)         vreinterpretq_u32_s32(x)
#define S(x)         vreinterpretq_s32_u32(x)

#define w_set             vdupq_n_s32
#define w_load            vld1q_s32
#define w_store           vst1q_s32
#define w_add             vaddq_s32
#define w_sub             vsubq_s32
#define w_mul             vmulq_s32
#define w_mad             vmlaq_s32
#define w_msb             vmlsq_s32
#define w_and             vandq_s32
#define w_xor             veorq_s32
#define w_larger          vmaxq_s32
#define w_smaller         vminq_s32
#define w_magnitude       vabsq_s32
#define w_shl             vshlq_n_s32
#define w_sar             vshrq_n_s32
#define w_shl_each        vshlq_s32
#define w_shr(x, n)       S(vshrq_n_u32(U(x), n))
#define w_shr_all(x, n)   S(vshlq_u32(U(x), vdupq_n_s32(-(n))))
#define w_shr_each(x, by) S(vshlq_u32(U(x), vnegq_s32(by)))
#define w_above(a, b)     S(vcgtq_s32(a, b))
#define w_choose(m, a, b) vbslq_s32(U(m), a, b)

static inline W w_log2(W x)
{
    return w_sub(w_set(31), vclzq_s32(x));
}

static inline int w_is_any_set(W mask)
{
    const uint32x2_t half =
        vorr_u32(vget_low_u32(U(mask)), vget_high_u32(U(mask)));

    return vget_lane_u64(vreinterpret_u64_u32(half), 0) != 0;
}

/* Loads lane I of TO from the element of FROM whose index is lane I of AT. */
#define LOAD_LANE(to, from, at, i) \
    to = vld1q_lane_u32((from) + vgetq_lane_u32(at, i), to, i)

static inline W w_gather(const uint32_t *code, W at)
{
    const uint32x4_t k = U(at);
    uint32x4_t c = vld1q_dup_u32(code + vgetq_lane_u32(k, 0));

    LOAD_LANE(c, code, k, 1);
    LOAD_LANE(c, code, k, 2);
    LOAD_LANE(c, code, k, 3);
    return S(c);
}

/* Loads, for each lane, mip level K and the level after it. A level has two
 * words, so one load of four words reads both levels. */
static inline void w_gather_levels(const struct glint_texels_level *level, W k,
                                   W side_log2[2], W first[2])
{
    const int32x4_t a = vld1q_s32(&level[vgetq_lane_s32(k, 0)].side_log2);
    const int32x4_t b = vld1q_s32(&level[vgetq_lane_s32(k, 1)].side_log2);
    const int32x4_t c = vld1q_s32(&level[vgetq_lane_s32(k, 2)].side_log2);
    const int32x4_t d = vld1q_s32(&level[vgetq_lane_s32(k, 3)].side_log2);
    const int32x4x2_t ac = vzipq_s32(a, c), bd = vzipq_s32(b, d);
    const int32x4x2_t this_one = vzipq_s32(ac.val[0], bd.val[0]);
    const int32x4x2_t next = vzipq_s32(ac.val[1], bd.val[1]);

    side_log2[0] = this_one.val[0];
    first[0] = this_one.val[1];
    side_log2[1] = next.val[0];
    first[1] = next.val[1];
}

/* Three scalars, in the form that multiplications by lane accept. */
struct three {
    int32x2_t low, high;
};

static inline struct three load_three_scalars(const int32_t x[3])
{
    return (struct three){vld1_s32(x), vld1_dup_s32(x + 2)};
}

#define THREE struct three
/* Multiply by scalar K of X; K is 0, 1 or 2. */
#define w_mad_by(a, b, x, k)                       \
    ((k) == 0   ? vmlaq_lane_s32(a, b, (x).low, 0) \
     : (k) == 1 ? vmlaq_lane_s32(a, b, (x).low, 1) \
                : vmlaq_lane_s32(a, b, (x).high, 0))
#define w_set_by(x, k)                       \
    ((k) == 0   ? vdupq_lane_s32((x).low, 0) \
     : (k) == 1 ? vdupq_lane_s32((x).low, 1) \
                : vdupq_lane_s32((x).high, 0))

/* Sums of light in R, G, B; each of the two lanes sums half of the samples. */
struct total {
    uint64x2_t rgb[3];
};

static inline struct total clear_total_light(void)
{
    return (struct total){{vdupq_n_u64(0), vdupq_n_u64(0), vdupq_n_u64(0)}};
}

struct lane_found;
static inline void add_light_to_total(struct total *total,
                                      const struct lane_found *found,
                                      W weight_q12);
static inline void store_total_light(const struct total *total,
                                     uint64_t sum_q12[3])
{
    for (int j = 0; j < 3; j++)
        sum_q12[j] =
            vgetq_lane_u64(total->rgb[j], 0) + vgetq_lane_u64(total->rgb[j], 1);
}

#include "kernels/ward/sum_v.inc"

static inline void add_light_to_total(struct total *total,
                                      const struct lane_found *found,
                                      W weight_q12)
{
    const W by = w_sub(found->log2, w_set(34));
    const int64x2_t low = vmovl_s32(vget_low_s32(by));
    const int64x2_t high = vmovl_s32(vget_high_s32(by));
    const uint32x4_t weight = U(weight_q12);

    for (int j = 0; j < 3; j++) {
        const uint32x4_t rgb = U(found->rgb[j]);

        total->rgb[j] = vaddq_u64(
            total->rgb[j],
            vshlq_u64(vmull_u32(vget_low_u32(rgb), vget_low_u32(weight)), low));
        total->rgb[j] = vaddq_u64(
            total->rgb[j],
            vshlq_u64(vmull_u32(vget_high_u32(rgb), vget_high_u32(weight)),
                      high));
    }
}
