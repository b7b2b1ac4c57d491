/* SPDX-License-Identifier: MIT */
#include "base/q.h"
#include "kernels/kernels.h"

/* In 16-bit lanes everything fits int16. */
static int32_t step(int32_t sum, int32_t x, int fraction, int32_t more)
{
    const int32_t next = q_mul(sum, x, fraction) + more;

    if (fraction == 15)
        Q_FITS("16-bit lanes", next, INT16_MIN, INT16_MAX);
    return next;
}

void glint_horner_along_c(int32_t *out, const int32_t *c, int degree,
                          const int32_t *x, int fraction, int n)
{
    for (int i = 0; i < n; i++) {
        int32_t sum = c[degree];

        for (int k = degree - 1; k >= 0; k--)
            sum = step(sum, x[i], fraction, c[k]);
        out[i] = sum;
    }
}

void glint_horner_across_c(int32_t *out, const int32_t *c, int stride,
                           int degree, int32_t x, int fraction, int n)
{
    for (int i = 0; i < n; i++) {
        int32_t sum = c[degree * stride + i];

        for (int k = degree - 1; k >= 0; k--)
            sum = step(sum, x, fraction, c[k * stride + i]);
        out[i] = sum;
    }
}
