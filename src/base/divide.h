/* SPDX-License-Identifier: MIT
 *
 * Division of 64 bits where it is done often: a CPU of 32 bits calls a function
 * for it that works bit by bit, some 300 instructions.
 */
#ifndef GLINT_BASE_DIVIDE_H
#define GLINT_BASE_DIVIDE_H

#include <stdint.h>

#include "base/q.h"

/* N / D, cut towards 0, in 32-bit steps; D is not 0, both are within +-2^63 and
 * not INT64_MIN. */
int64_t glint_divide(int64_t n, int64_t d);

/* The same, by what the CPU does best. */
static inline int64_t q_divide(int64_t n, int64_t d)
{
#if UINTPTR_MAX > UINT32_MAX
    return n / d; /* NOLINT: so it is for the caller to see to */
#else
    return glint_divide(n, d);
#endif
}

/* Floor of (2^63 - 1) / X, for X from 2^31 on. */
uint32_t glint_reciprocal(uint32_t x);

static inline uint32_t q_reciprocal(uint32_t x)
{
#if UINTPTR_MAX > UINT32_MAX
    return (uint32_t)((UINT64_MAX >> 1) / x);
#else
    return glint_reciprocal(x);
#endif
}

/* X times 2^UP, cut; below 2^32, and UP from -31 to 31. */
static inline uint32_t q_upper(uint64_t x, int up)
{
#if UINTPTR_MAX > UINT32_MAX
    return (uint32_t)(x << (up + 32) >> 32);
#else
    return (uint32_t)(up < 0 ? x >> -up : x << up);
#endif
}

/* Bits by which X, not 0, is shorter than 32. */
static inline int q_up(uint64_t x)
{
    return 32 - bit_length(x | 1);
}

/* N / D, 0 <= N <= D, D not 0; at most 2^-30 more or 2^-29 less, and within 0
 * .. 1. */
static inline int32_t q_part_q30(uint64_t n, uint64_t d)
{
    const int up = q_up(d);

    return (int32_t)((uint64_t)q_upper(n, up) * q_reciprocal(q_upper(d, up)) >>
                     33);
}

#endif
