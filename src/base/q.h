/* SPDX-License-Identifier: MIT
 *
 * Fixed-point arithmetic.
 *
 * Variables have stdint types, and the suffix of a name states the number of
 * fraction bits: x_q30 has 30. q_mul(a_qA, b_qB, s) has A + B - s fraction
 * bits; tools/lint/q checks the suffixes. Functions round to nearest, ties up,
 * unless their comment states otherwise. With -DGLINT_Q_CHECK, an operation
 * whose exact result does not fit aborts. */
#ifndef GLINT_BASE_Q_H
#define GLINT_BASE_Q_H

#include <stdint.h>

#include "base/compiler.h"

static inline uint64_t q_magnitude(int64_t x)
{
    return (uint64_t)(x < 0 ? -x : x);
}

#ifdef GLINT_Q_CHECK
void glint_q_abort_on_overflow(const char *operation, int64_t exact);
#define Q_FITS(op, r, lo, hi) \
    ((r) < (lo) || (r) > (hi) ? glint_q_abort_on_overflow(op, r) : (void)0)
#else
#define Q_FITS(op, r, lo, hi) ((void)0)
#endif

/* Converts a literal at compile time to a rounded fixed-point constant with
 * FRAC fraction bits. */
#define Q_CONST(x, frac) \
    ((int32_t)((x) * (double)(INT64_C(1) << (frac)) + ((x) < 0 ? -0.5 : 0.5)))

/* Returns x / 2^s, rounded; 0 <= s <= 62, |x| < 2^62. */
static inline int64_t q_shift(int64_t x, int s)
{
    Q_FITS("q_shift", x, -(INT64_C(1) << 62), INT64_C(1) << 62);
    return s ? (x + (INT64_C(1) << (s - 1))) >> s : x;
}

/* Returns X as an int32; the caller guarantees that X fits. */
static inline int32_t q_narrow(int64_t x)
{
    Q_FITS("q_narrow", x, INT32_MIN, INT32_MAX);
    return (int32_t)x;
}

/* Returns a * b / 2^s, rounded; 1 <= s <= 62. */
static inline int32_t q_mul(int32_t a, int32_t b, int s)
{
    return q_narrow(q_shift((int64_t)a * b, s));
}

/* Returns X / 2^S, rounded, for any S. LIMIT is at most 2^30. If the magnitude
 * would reach LIMIT, returns 0 and sets all bits of *LOST, which is unchanged
 * otherwise. */
static inline int32_t q_scaled(int64_t x, int s, int32_t limit, int32_t *lost)
{
    int64_t y = 0;
    int fits = 1;

    if (s > 0 && s < 63)
        y = q_shift(x, s);
    else if (s <= 0)
        fits = x == 0 || (s >= -31 && bit_length(q_magnitude(x)) - s <= 32);
    if (s <= 0 && s >= -31 && fits)
        y = x * (INT64_C(1) << -s);
    fits &= y < limit && y > -limit;
    *lost |= -!fits;
    return fits ? (int32_t)y : 0;
}

/* Returns the square root of X, rounded down. The root has half as many
 * fraction bits as X. */
static inline uint32_t q_root(uint64_t x)
{
    uint64_t root = 0;

    for (int bit = (bit_length(x) + 1) / 2 - 1; bit >= 0; bit--) {
        const uint64_t trial = root | (UINT64_C(1) << bit);

        if (trial * trial <= x)
            root = trial;
    }
    return (uint32_t)root;
}

static inline int32_t q_smaller(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static inline int32_t q_larger(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* Returns X clamped to LO .. HI. Meant for light; clamped positions would
 * distort outlines. */
static inline int32_t q_clamp_sat(int64_t x, int32_t lo, int32_t hi)
{
    return x < lo ? lo : x > hi ? hi : (int32_t)x;
}

#endif
