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

/* Values are below 2^fraction: raised by what is missing to 31 bits, twice
 * their product's upper half is what a shift by the fraction leaves, and rounds
 * alike. */
struct shift {
    W up;
};

static inline struct shift shift_by(int fraction)
{
    return (struct shift){vdupq_n_s32(31 - fraction)};
}

struct factor {
    W x;
};

static inline struct factor factor_of(W x)
{
    return (struct factor){x};
}

static inline W w_times(W a, struct factor by, struct shift s)
{
    return vqrdmulhq_s32(vshlq_s32(a, s.up), by.x);
}

#include "kernels/horner_v.inc"
