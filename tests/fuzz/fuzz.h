/* SPDX-License-Identifier: MIT
 *
 * Functions shared by the fuzz targets.
 */
#ifndef GLINT_TESTS_FUZZ_FUZZ_H
#define GLINT_TESTS_FUZZ_FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/blob.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static inline void require(int condition)
{
    if (!condition)
        abort();
}

/* Returns an allocated copy of exactly SIZE bytes, so that ASan detects
 * overreads. */
static inline unsigned char *fuzz_copy(const uint8_t *data, size_t size)
{
    unsigned char *copy = malloc(size ? size : 1);

    require(copy != NULL);
    if (size)
        memcpy(copy, data, size);
    return copy;
}

/* As fuzz_copy(), but sets magic, version, size and checksum of a baked file
 * to valid values. */
static inline unsigned char *fuzz_blob(const uint8_t *data, size_t size,
                                       uint32_t magic, uint32_t version)
{
    unsigned char *copy = fuzz_copy(data, size);
    uint32_t *const word = (void *)copy;

    if (size >= sizeof(struct glint_blob_header)) {
        word[0] = magic;
        word[1] = version;
        glint_blob_set_size_and_checksum(copy, size);
    }
    return copy;
}

#endif
