/* SPDX-License-Identifier: MIT
 *
 * glint/real.h - floating-point numbers as two integers.
 *
 * For powers, fluxes and lengths of the integer half, which have no common
 * scale. */
#ifndef GLINT_REAL_H
#define GLINT_REAL_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* mantissa * 2^exponent: mantissa 0, or 2^30 .. 2^31 - 1 in magnitude;
 * exponent within +-200. */
struct glint_real {
    int32_t mantissa;
    int32_t exponent;
};

/* Convert from and to double, for the halves that have floating point. A number
 * that is not finite becomes 0. */
struct glint_real glint_real_of(double x);
double glint_real_value(struct glint_real x);

#ifdef __cplusplus
}
#endif

#endif
