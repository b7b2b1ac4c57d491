/* SPDX-License-Identifier: MIT */
#include "kernels/rays/rays.h"

#include <arm_neon.h>

#define W            int32x4_t
#define W_N          4
#define KERNEL(name) name##_neon
#define w_add        vaddq_s32
#define w_set        vdupq_n_s32
#define w_load       vld1q_s32
#define w_store      vst1q_s32

struct factor {
    W x;
};

static inline struct factor factor_of(W x_q30)
{
    return (struct factor){x_q30};
}

/* Returns A * BY / 2^30, rounded. vqrdmulh returns the rounded upper half of 2
 * A BY. Therefore A, which is below 2^30 in magnitude, is doubled first. */
static inline W w_multiply_q30(W a, struct factor by)
{
    return vqrdmulhq_s32(vshlq_n_s32(a, 1), by.x);
}

#include "kernels/rays/horner_v.inc"
