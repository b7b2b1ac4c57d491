/* SPDX-License-Identifier: MIT
 *
 * Compares and counts the eight bytes of a 64-bit word at once. The byte at the
 * lowest address is the lowest byte of the word.
 */
#ifndef GLINT_BASE_BYTES_H
#define GLINT_BASE_BYTES_H

#include "base/compiler.h"

#define BYTES_EACH UINT64_C(0x0101010101010101)
#define BYTES_LOW  (0x7f * BYTES_EACH)
#define BYTES_HIGH (0x80 * BYTES_EACH)

/* Returns the eight bytes at P as a word. Compilers turn this form into one
 * load. */
static WHOLLY_INLINE uint64_t bytes_load(const uint8_t *p)
{
    return (uint64_t)p[0] | (uint64_t)p[1] << 8 | (uint64_t)p[2] << 16 |
           (uint64_t)p[3] << 24 | (uint64_t)p[4] << 32 | (uint64_t)p[5] << 40 |
           (uint64_t)p[6] << 48 | (uint64_t)p[7] << 56;
}

/* Returns a word in which the high bit of each byte is set if that byte of V is
 * at least CODE. CODE must be 1 .. 128, or 129 .. 256 if IS_ABOVE_128 is 1. No
 * byte carries into the next one, because both addends are below 128. */
static WHOLLY_INLINE uint64_t bytes_find_at_or_above(uint64_t v, int code,
                                                     int is_above_128)
{
    const uint64_t add =
        (uint64_t)((is_above_128 ? 256 : 128) - code) * BYTES_EACH;
    const uint64_t sum = (v & BYTES_LOW) + add;

    return (is_above_128 ? sum & v : sum | v) & BYTES_HIGH;
}

/* Packs the high bits of the eight bytes of HIGH into bits 0 .. 7 of the
 * result. Bit 0 is the high bit of the lowest byte. */
static WHOLLY_INLINE uint32_t bytes_pack_high_bits(uint64_t high)
{
    return (uint32_t)((high >> 7) * UINT64_C(0x0102040810204080) >> 56);
}

/* Returns the number of bytes of HIGH whose high bit is set. */
static WHOLLY_INLINE uint32_t bytes_count_high_bits(uint64_t high)
{
    return (uint32_t)((high >> 7) * BYTES_EACH >> 56);
}

#endif
