/* SPDX-License-Identifier: MIT
 *
 * Division of 64 bits where it is done often: a CPU of 32 bits calls a function
 * for it that works bit by bit, some 300 instructions.
 */
#ifndef GLINT_BASE_DIVIDE_H
#define GLINT_BASE_DIVIDE_H

#include <stdint.h>

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

#endif
