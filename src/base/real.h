/* SPDX-License-Identifier: MIT
 *
 * Arithmetic with struct glint_real (glint/real.h), a floating-point number
 * made of integers: a mantissa, which is 0 or has a magnitude of 2^30 .. 2^31 -
 * 1, times a power of two. Products and quotients are truncated, with a
 * relative error of at most 2^-30. */
#ifndef GLINT_BASE_REAL_H
#define GLINT_BASE_REAL_H

#include "base/divide.h"
#include "glint/real.h"

/* Returns X * 2^EXPONENT; X is within +-2^62. */
static inline struct glint_real real_of(int64_t x, int exponent)
{
    const uint64_t size = q_magnitude(x);
    const int up = 31 - bit_length(size);
    const int32_t mantissa = (int32_t)(up >= 0 ? size << up : size >> -up);

    if (x == 0)
        return (struct glint_real){0, 0};
    return (struct glint_real){x < 0 ? -mantissa : mantissa, exponent - up};
}

static inline struct glint_real real_times(struct glint_real a,
                                           struct glint_real b)
{
    return real_of((int64_t)a.mantissa * b.mantissa, a.exponent + b.exponent);
}

/* Returns A / B; B is not 0. */
static inline struct glint_real real_over(struct glint_real a,
                                          struct glint_real b)
{
    return real_of(q_divide(a.mantissa * (INT64_C(1) << 31), b.mantissa),
                   a.exponent - b.exponent - 31);
}

/* Returns A + B, both 0 or more. */
static inline struct glint_real real_plus(struct glint_real a,
                                          struct glint_real b)
{
    const struct glint_real big = a.exponent > b.exponent ? a : b;
    const struct glint_real small = a.exponent > b.exponent ? b : a;
    const int off = big.exponent - small.exponent;

    if (a.mantissa == 0 || b.mantissa == 0)
        return a.mantissa ? a : b;
    return real_of((int64_t)big.mantissa +
                       (off > 31 ? 0 : small.mantissa >> off),
                   big.exponent);
}

/* Returns whether A < B, both 0 or more. */
static inline int real_less(struct glint_real a, struct glint_real b)
{
    if (a.mantissa == 0 || b.mantissa == 0)
        return b.mantissa > 0;
    return a.exponent != b.exponent ? a.exponent < b.exponent
                                    : a.mantissa < b.mantissa;
}

/* Returns X * 2^FRAC, truncated to an integer and clamped to +-LIMIT. */
static inline int64_t real_integer(struct glint_real x, int frac, int64_t limit)
{
    const int up = x.exponent + frac;
    int64_t size = x.mantissa < 0 ? -(int64_t)x.mantissa : x.mantissa;

    if (x.mantissa == 0 || up < -31)
        return 0;
    if (up > 31)
        size = limit;
    else
        size = up >= 0 ? size * (INT64_C(1) << up) : size >> -up;
    size = size < limit ? size : limit;
    return x.mantissa < 0 ? -size : size;
}

#endif
