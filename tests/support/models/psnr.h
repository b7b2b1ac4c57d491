/* SPDX-License-Identifier: MIT */
#ifndef GLINT_TESTS_PSNR_H
#define GLINT_TESTS_PSNR_H

#include <math.h>
#include <stddef.h>

/* Returns the PSNR, dB, between the N values of A and of B, relative to the max
 * of B. Returns 999 if A and B are equal. */
static inline double peak_psnr(const double *a, const double *b, size_t n)
{
    double square = 0, peak = 0;

    for (size_t i = 0; i < n; i++) {
        square += (a[i] - b[i]) * (a[i] - b[i]);
        peak = fmax(peak, fabs(b[i]));
    }
    return square > 0 ? 10 * log10(peak * peak * (double)n / square) : 999;
}

#endif
