/* SPDX-License-Identifier: MIT */
#include "kernels/maps/maps.h"

#include <arm_neon.h>

/* Keeps sixteen sums in registers while it processes all taps. */
void glint_convolve_neon(int32_t *sum, const int32_t *value, ptrdiff_t stride,
                         const int32_t *tap, int n_taps, int n)
{
    for (int i = 0; i < n; i += 16) {
        const int32_t *v = value + i;
        int32x4_t s[4];

        for (int j = 0; j < 4; j++)
            s[j] = vld1q_s32(sum + i + 4 * j);
        for (int k = 0; k < n_taps; k++, v += stride) {
            const int16x4_t t = vreinterpret_s16_s32(vdup_n_s32(tap[k]));

            for (int j = 0; j < 2; j++) {
                const int16x8x2_t p = vld2q_s16((const int16_t *)(v + 8 * j));

                s[2 * j] =
                    vmlal_lane_s16(s[2 * j], vget_low_s16(p.val[0]), t, 0);
                s[2 * j + 1] =
                    vmlal_lane_s16(s[2 * j + 1], vget_high_s16(p.val[0]), t, 0);
                s[2 * j] =
                    vmlal_lane_s16(s[2 * j], vget_low_s16(p.val[1]), t, 1);
                s[2 * j + 1] =
                    vmlal_lane_s16(s[2 * j + 1], vget_high_s16(p.val[1]), t, 1);
            }
        }
        for (int j = 0; j < 4; j++)
            vst1q_s32(sum + i + 4 * j, s[j]);
    }
}
