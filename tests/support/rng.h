/* SPDX-License-Identifier: MIT
 *
 * Pseudo-random numbers for tests, the same on every machine, by a linear
 * congruential generator. Its high bits are the most random.
 *
 *     uint32_t seed = 1;
 *     x = rng_int_below(&seed, 256);
 */
#ifndef GLINT_TESTS_RNG_H
#define GLINT_TESTS_RNG_H

#include <stdint.h>

/* Returns 32 random bits. Bit k has a period of 2^(k + 1) numbers. */
static inline uint32_t rng_bits32(uint32_t *seed)
{
    return *seed = *seed * UINT32_C(1664525) + UINT32_C(1013904223);
}

/* Returns an integer of 0 .. N - 1; N is 1 .. 2^24. */
static inline int rng_int_below(uint32_t *seed, int n)
{
    return (int)((uint64_t)(rng_bits32(seed) >> 8) * (uint32_t)n >> 24);
}

/* Returns a number in [0, 1). */
static inline double rng_unit(uint32_t *seed)
{
    return (rng_bits32(seed) >> 8) * 0x1p-24;
}

/* Returns 32 bits of xorshift [Marsaglia03]; *SEED must not be 0. */
static inline uint32_t rng_xorshift(uint32_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 17;
    return *seed ^= *seed << 5;
}

/* Returns a number in [-1, 1), by rng_xorshift(). */
static inline double rng_signed(uint32_t *seed)
{
    return rng_xorshift(seed) * 0x1p-31 - 1;
}

#endif
