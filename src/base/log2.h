/* SPDX-License-Identifier: MIT
 *
 * Binary logarithm and exponential in fixed point; both are continuous, and
 * exact at powers of 2.
 */
#ifndef GLINT_BASE_LOG2_H
#define GLINT_BASE_LOG2_H

#include "base/q.h"

/* Returns log2(X) for X >= 1; the error is below 2^-14. For X = 2^n (1 + f) the
 * result is n + f + f (1 - f) p(f), where p is a minimax polynomial and f is in
 * 0 .. 1. */
static inline int32_t q_log2_q16(uint64_t x)
{
    const int whole = bit_length(x) - 1;
    const int32_t f_q16 =
        (int32_t)((whole > 16 ? x >> (whole - 16) : x << (16 - whole)) &
                  0xffff);
    int32_t bend_q16 =
        Q_CONST(0.1463143, 16) - q_mul(f_q16, Q_CONST(0.0440047, 16), 16);

    bend_q16 = Q_CONST(0.2660299, 16) - q_mul(f_q16, bend_q16, 16);
    bend_q16 = Q_CONST(0.4417403, 16) - q_mul(f_q16, bend_q16, 16);
    return whole * 65536 + f_q16 +
           q_mul(q_mul(f_q16, 65536 - f_q16, 16), bend_q16, 16);
}

/* Returns 2^X for X below 46. The relative error is below 2^-15 for X of 0 or
 * more; below 0 the result is truncated to _q16. */
static inline int64_t q_exp2_q16(int32_t x_q16)
{
    const int whole = x_q16 >> 16;
    const int32_t f_q16 = x_q16 & 0xffff;
    int32_t bend_q16 =
        Q_CONST(0.0654388, 16) + q_mul(f_q16, Q_CONST(0.0136865, 16), 16);
    int64_t y_q16;

    bend_q16 = Q_CONST(0.3070043, 16) + q_mul(f_q16, bend_q16, 16);
    y_q16 =
        65536 + f_q16 - q_mul(q_mul(f_q16, 65536 - f_q16, 16), bend_q16, 16);
    if (whole < 0)
        return whole < -17 ? 0 : y_q16 >> -whole;
    return y_q16 << (whole < 45 ? whole : 45);
}

#endif
