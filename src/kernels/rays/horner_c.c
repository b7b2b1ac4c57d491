/* SPDX-License-Identifier: MIT */
#include "kernels/rays/rays.h"

#include "base/q.h"

void glint_horner_along_c(int32_t *out, const int32_t *c, int degree,
                          const int32_t *x_q30, int n)
{
    for (int i = 0; i < n; i++) {
        int32_t sum = c[degree];

        for (int k = degree - 1; k >= 0; k--)
            sum = q_mul(sum, x_q30[i], 30) + c[k];
        out[i] = sum;
    }
}

void glint_horner_across_c(int32_t *out, const int32_t *c, int stride,
                           int degree, int32_t x_q30, int n)
{
    for (int i = 0; i < n; i++) {
        int32_t sum = c[degree * stride + i];

        for (int k = degree - 1; k >= 0; k--)
            sum = q_mul(sum, x_q30, 30) + c[k * stride + i];
        out[i] = sum;
    }
}
