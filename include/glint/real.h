/* SPDX-License-Identifier: MIT
 *
 * glint/real.h - floating-point numbers as two integers, for code without
 * floating point. Powers, fluxes and lengths use them, because their ranges are
 * too wide for fixed point. */
#ifndef GLINT_REAL_H
#define GLINT_REAL_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The number mantissa * 2^exponent. The mantissa is 0, or its magnitude is 2^30
 * .. 2^31 - 1; the exponent is within +-200. */
struct glint_real {
    int32_t mantissa;
    int32_t exponent;
};

/* Convert a double to glint_real, and back. A number that is not finite becomes
 * 0. */
struct glint_real glint_real_of(double x);
double glint_real_value(struct glint_real x);

#ifdef __cplusplus
}
#endif

#endif
