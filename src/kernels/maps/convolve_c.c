/* SPDX-License-Identifier: MIT */
#include "base/compiler.h"
#include "kernels/maps/maps.h"

void glint_convolve_c(int32_t *sum, const int32_t *value, ptrdiff_t stride,
                      const int32_t *tap, int n_taps, int n)
{
    for (int k = 0; k < n_taps; k++) {
        const int32_t *v = value + k * stride;
        const int32_t first = (int16_t)tap[k], second = tap[k] >> 16;

        for (int i = 0; i < n; i++)
            sum[i] += (int16_t)v[i] * first + (v[i] >> 16) * second;
    }
}
