/* SPDX-License-Identifier: MIT
 *
 * The few things that C99 alone cannot say.
 */
#ifndef GLINT_BASE_COMPILER_H
#define GLINT_BASE_COMPILER_H

#include <stdint.h>

#define STATIC_ASSERT(condition) \
    __extension__ _Static_assert(condition, #condition)

/* Right shifts of negative numbers are arithmetic wherever glint runs. */
STATIC_ASSERT((-3 >> 1) == -2);

/* Bits needed to write X: 0 for 0, 64 for UINT64_MAX. */
static inline int bit_length(uint64_t x)
{
#if defined(__GNUC__)
    return x ? 64 - __builtin_clzll(x) : 0;
#else
    int n = 0;

    for (; x; x >>= 1)
        n++;
    return n;
#endif
}

#endif
