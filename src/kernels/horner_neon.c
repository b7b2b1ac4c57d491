/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include <arm_neon.h>

#define W            int32x4_t
#define W_N          4
#define KERNEL(name) name##_neon
#define w_add        vaddq_s32
#define w_set        vdupq_n_s32
#define w_load       vld1q_s32
#define w_store      vst1q_s32

struct shift {
    int64x2_t right;
};

static inline struct shift shift_by(int fraction)
{
    return (struct shift){vdupq_n_s64(-fraction)};
}

struct factor {
    int32x2_t low, high;
};

static inline struct factor factor_of(W x)
{
    return (struct factor){vget_low_s32(x), vget_high_s32(x)};
}

static inline W w_times(W a, struct factor x, struct shift s)
{
    const int64x2_t low = vmull_s32(vget_low_s32(a), x.low);
    const int64x2_t high = vmull_s32(vget_high_s32(a), x.high);

    return vcombine_s32(vmovn_s64(vrshlq_s64(low, s.right)),
                        vmovn_s64(vrshlq_s64(high, s.right)));
}

#include "kernels/horner_v.h"
