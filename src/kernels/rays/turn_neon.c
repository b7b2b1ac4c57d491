/* SPDX-License-Identifier: MIT */
#include "kernels/rays/rays.h"

#include <arm_neon.h>

/* 64-bit products of four lanes with one factor. */
struct products {
    int64x2_t low, high;
};

static inline struct products multiply_lanes(int32x4_t x, int32x2_t factor)
{
    return (struct products){vmull_s32(vget_low_s32(x), factor),
                             vmull_s32(vget_high_s32(x), factor)};
}

static inline struct products add_products(struct products a, struct products b)
{
    return (struct products){vaddq_s64(a.low, b.low),
                             vaddq_s64(a.high, b.high)};
}

static inline struct products subtract_products(struct products a,
                                                struct products b)
{
    return (struct products){vsubq_s64(a.low, b.low),
                             vsubq_s64(a.high, b.high)};
}

/* How products are scaled: the shift to the left, and the exclusive limit of
 * the magnitude of results. */
struct scale_products {
    int64x2_t up;
    int32x4_t limit;
};

/* Stores the scaled sums of products in OUT, 0 in lanes that reach the limit.
 * Returns a mask of the lanes below the limit. */
static inline uint32x4_t scale_products(struct scale_products s,
                                        struct products sum, int32_t *out)
{
    const int32x4_t x = vcombine_s32(vqmovn_s64(vrshlq_s64(sum.low, s.up)),
                                     vqmovn_s64(vrshlq_s64(sum.high, s.up)));
    const uint32x4_t fits = vcltq_s32(vqabsq_s32(x), s.limit);

    vst1q_s32(out, vandq_s32(x, vreinterpretq_s32_u32(fits)));
    return fits;
}

static inline void mark_rays_beyond_limit(uint32x4_t x_fits, uint32x4_t y_fits,
                                          int32_t *lost)
{
    const int32x4_t fit = vreinterpretq_s32_u32(vandq_u32(x_fits, y_fits));

    vst1q_s32(lost, vornq_s32(vld1q_s32(lost), fit));
}

void glint_turn_neon(const struct glint_turn *t, const int32_t *x,
                     const int32_t *y, int32_t (*out)[GLINT_TURNED],
                     int32_t (*lost)[GLINT_TURNED])
{
    const int32x2_t c = vdup_n_s32(t->cos), s = vdup_n_s32(t->sin);
    const struct scale_products to = {vdupq_n_s64(-(int64_t)t->shift),
                                      vdupq_n_s32(t->limit)};

    for (int i = 0; i < GLINT_TURNED; i += 4) {
        const int32x4_t a = vld1q_s32(x + i), b = vld1q_s32(y + i);
        const struct products xc = multiply_lanes(a, c),
                              xs = multiply_lanes(a, s);
        const struct products yc = multiply_lanes(b, c),
                              ys = multiply_lanes(b, s);

        mark_rays_beyond_limit(
            scale_products(to, subtract_products(xc, ys), out[0] + i),
            scale_products(to, add_products(xs, yc), out[1] + i), lost[0] + i);
        mark_rays_beyond_limit(
            scale_products(to, add_products(xc, ys), out[2] + i),
            scale_products(to, subtract_products(xs, yc), out[3] + i),
            lost[1] + i);
    }
}
