/* SPDX-License-Identifier: MIT */
#include "bake/regress/vectors.h"

#include <math.h>

#include "base/compiler.h"

/* Number of sums of a dot product. */
enum { LANES = 4 };

/* Returns the dot product of A and B. Four sums at once make shorter chains of
 * dependent additions. */
WIDE_VECTORS double glint_vector_dot(const double *a, const double *b, int n)
{
    double s[LANES] = {0, 0, 0, 0};
    int i = 0;

    for (; i + LANES <= n; i += LANES)
        for (int k = 0; k < LANES; k++)
            s[k] += a[i + k] * b[i + k];
    for (; i < n; i++)
        s[0] += a[i] * b[i];
    return (s[0] + s[1]) + (s[2] + s[3]);
}

/* Sets SUM to the dot products of A and four columns, each with the bits of
 * glint_vector_dot(). A is read once for all of them, and their sums do not
 * wait for each other. */
WIDE_VECTORS void glint_vector_dots(const double *a,
                                    const double *const b[GLINT_VECTORS], int n,
                                    double sum[GLINT_VECTORS])
{
    const double *const b0 = b[0], *const b1 = b[1], *const b2 = b[2],
                        *const b3 = b[3];
    double s0[LANES] = {0, 0, 0, 0}, s1[LANES] = {0, 0, 0, 0};
    double s2[LANES] = {0, 0, 0, 0}, s3[LANES] = {0, 0, 0, 0};
    int i = 0;

    for (; i + LANES <= n; i += LANES) {
        for (int k = 0; k < LANES; k++) {
            s0[k] += a[i + k] * b0[i + k];
            s1[k] += a[i + k] * b1[i + k];
            s2[k] += a[i + k] * b2[i + k];
            s3[k] += a[i + k] * b3[i + k];
        }
    }
    for (; i < n; i++) {
        s0[0] += a[i] * b0[i];
        s1[0] += a[i] * b1[i];
        s2[0] += a[i] * b2[i];
        s3[0] += a[i] * b3[i];
    }
    sum[0] = (s0[0] + s0[1]) + (s0[2] + s0[3]);
    sum[1] = (s1[0] + s1[1]) + (s1[2] + s1[3]);
    sum[2] = (s2[0] + s2[1]) + (s2[2] + s2[3]);
    sum[3] = (s3[0] + s3[1]) + (s3[2] + s3[3]);
}

WIDE_VECTORS void glint_vector_subtract(double *restrict a, double k,
                                        const double *restrict b, int n)
{
    int i = 0;

    for (; i + LANES <= n; i += LANES)
        for (int m = 0; m < LANES; m++)
            a[i + m] -= k * b[i + m];
    for (; i < n; i++)
        a[i] -= k * b[i];
}

/* Multiplies A by X, POWER times. */
WIDE_VECTORS void glint_vector_multiply(double *restrict a,
                                        const double *restrict x, int power,
                                        int n)
{
    for (int p = 0; p < power; p++) {
        int i = 0;

        for (; i + LANES <= n; i += LANES)
            for (int k = 0; k < LANES; k++)
                a[i + k] *= x[i + k];
        for (; i < n; i++)
            a[i] *= x[i];
    }
}

/* Returns the largest magnitude of A. */
WIDE_VECTORS double glint_vector_largest(const double *a, int n)
{
    double most[LANES] = {0, 0, 0, 0};
    int i = 0;

    for (; i + LANES <= n; i += LANES)
        for (int k = 0; k < LANES; k++)
            most[k] = fabs(a[i + k]) > most[k] ? fabs(a[i + k]) : most[k];
    for (; i < n; i++)
        most[0] = fmax(most[0], fabs(a[i]));
    return fmax(fmax(most[0], most[1]), fmax(most[2], most[3]));
}
