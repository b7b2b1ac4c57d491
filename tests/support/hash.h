/* SPDX-License-Identifier: MIT
 *
 * The hash FNV-1a of bytes.
 */
#ifndef GLINT_TESTS_HASH_H
#define GLINT_TESTS_HASH_H

#include <stddef.h>
#include <stdint.h>

#define HASH_START UINT64_C(14695981039346656037)

/* Continues the hash H by DATA[BYTES]. */
static inline uint64_t hash_bytes(uint64_t h, const void *data, size_t bytes)
{
    const uint8_t *p = data;

    for (size_t i = 0; i < bytes; i++)
        h = (h ^ p[i]) * UINT64_C(1099511628211);
    return h;
}

#endif
