/* SPDX-License-Identifier: MIT
 *
 * 64-bit integer division for hot code. On 32-bit CPUs the compiler's own
 * 64-bit division computes one bit at a time, in about 300 instructions.
 */
#ifndef GLINT_BASE_DIVIDE_H
#define GLINT_BASE_DIVIDE_H

#include <stdint.h>

#include "base/q.h"

/* Returns N / D, truncated towards 0, computed with 32-bit operations only. D
 * must not be 0; neither N nor D may be INT64_MIN. */
int64_t glint_divide(int64_t n, int64_t d);

/* Returns N / D, truncated towards 0, by the method that is faster on this
 * CPU. */
static inline int64_t q_divide(int64_t n, int64_t d)
{
#if UINTPTR_MAX > UINT32_MAX
    return n / d; /* NOLINT: the caller guarantees that D is not 0 */
#else
    return glint_divide(n, d);
#endif
}

/* Returns (2^63 - 1) / X, rounded down; X must be at least 2^31. */
uint32_t glint_compute_reciprocal(uint32_t x);

static inline uint32_t q_reciprocal(uint32_t x)
{
#if UINTPTR_MAX > UINT32_MAX
    return (uint32_t)((UINT64_MAX >> 1) / x);
#else
    return glint_compute_reciprocal(x);
#endif
}

/* Returns X times 2^UP, truncated. The result must be below 2^32, and UP
 * within -31 .. 31. */
static inline uint32_t q_shift_to_32_bits(uint64_t x, int up)
{
#if UINTPTR_MAX > UINT32_MAX
    return (uint32_t)(x << (up + 32) >> 32);
#else
    return (uint32_t)(up < 0 ? x >> -up : x << up);
#endif
}

/* Returns 32 minus the bit length of X: the left shift that normalises X to 32
 * bits; negative if X has more than 32 bits. */
static inline int q_count_normalising_shift(uint64_t x)
{
    return 32 - bit_length(x | 1);
}

/* Returns N / D for 0 <= N <= D with D not 0. The result lies in 0 .. 1; it is
 * at most 2^-30 too high or 2^-29 too low. */
static inline int32_t q_divide_to_fraction_q30(uint64_t n, uint64_t d)
{
    const int up = q_count_normalising_shift(d);

    return (int32_t)((uint64_t)q_shift_to_32_bits(n, up) *
                         q_reciprocal(q_shift_to_32_bits(d, up)) >>
                     33);
}

#endif
