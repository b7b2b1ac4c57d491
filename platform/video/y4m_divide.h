/* SPDX-License-Identifier: MIT
 *
 * video/y4m_divide.h - divisions by constants, computed as multiplications, for
 * adding light to pixels. 32-bit CPUs need a function call to divide 64 bits.
 * Results equal the division rounded to nearest, ties away from 0. */
#ifndef GLINT_PLATFORM_VIDEO_Y4M_DIVIDE_H
#define GLINT_PLATFORM_VIDEO_Y4M_DIVIDE_H

#include <stdint.h>

enum { Y4M_SHARE_BITS = 40, Y4M_PART_BITS = 48, Y4M_PART_SKIP = 14 };

/* Returns the factor that y4m_scaled_quotient() needs to compute K 2^UP / D. UP
 * must be at most 20, D 219 .. 65535. */
static inline int64_t y4m_scaled_quotient_factor(int up, int32_t d)
{
    return ((INT64_C(1) << (up + Y4M_SHARE_BITS)) + d - 1) / d;
}

/* Returns K 2^UP / D, where UP and D are those of FACTOR. |K| must be at most
 * 2^20, and the result at most 2^22. FACTOR is too large by less than 1, so the
 * quotient before the shift is too large by less than 2^-20. A quotient that is
 * not an integer is at least 1 / 2D below the next integer, so this error
 * cannot reach the integer. */
static inline int32_t y4m_scaled_quotient(int32_t k, int64_t factor)
{
    const int64_t size = k < 0 ? -(int64_t)k : k;
    const int64_t share =
        (size * factor + (INT64_C(1) << (Y4M_SHARE_BITS - 1))) >>
        Y4M_SHARE_BITS;

    return (int32_t)(k < 0 ? -share : share);
}

/* Returns the factor that y4m_divide_fraction() needs to divide by D, 2^15 ..
 * 2^16. */
static inline int64_t y4m_fraction_factor(int32_t d)
{
    return (INT64_C(1) << Y4M_PART_BITS) / d;
}

/* Returns N / D, clamped to 0 .. 2^20. The bits lost by Y4M_PART_SKIP and by
 * rounding FACTOR amount to less than 1. Q is therefore the quotient or one
 * less. */
static inline int32_t y4m_divide_fraction(int64_t n, int32_t d, int64_t factor)
{
    const int64_t m = n + d / 2;
    int64_t q;

    if (n <= 0)
        return 0;
    if (m >= (int64_t)d << 20)
        return INT32_C(1) << 20;
    q = ((m >> Y4M_PART_SKIP) * factor) >> (Y4M_PART_BITS - Y4M_PART_SKIP);
    return (int32_t)(q + (m - q * d >= d));
}

/* Returns N / 2^S, S >= 1. */
static inline int64_t y4m_divide_by_power_of_two(int64_t n, int s)
{
    const int64_t half = INT64_C(1) << (s - 1);

    return n < 0 ? -((-n + half) >> s) : (n + half) >> s;
}

#endif
