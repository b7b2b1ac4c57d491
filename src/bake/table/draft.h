/* SPDX-License-Identifier: MIT
 *
 * A baked file while it is being written: a growing block of memory, to which
 * sections are appended.
 */
#ifndef GLINT_BAKE_TABLE_DRAFT_H
#define GLINT_BAKE_TABLE_DRAFT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/blob.h"

/* Owns DATA, allocated with malloc(). Initialised with zeros. */
struct glint_draft {
    unsigned char *data;
    size_t bytes, room;
    bool out_of_memory; /* true: further writes have no effect */
};

/* Appends BYTES from DATA (zeros if DATA is NULL), padded to a multiple of
 * 4. Returns their offset. */
uint32_t glint_draft_put(struct glint_draft *draft, const void *data,
                         size_t bytes);

/* Overwrites BYTES at offset WHERE. */
void glint_draft_amend(struct glint_draft *draft, uint32_t where,
                       const void *data, size_t bytes);

/* Sets the fields that the HEADER of every baked file begins with, except
 * size and checksum. The name consists of the first 63 characters of NAME
 * that are a-z, A-Z, 0-9, '-' or '_'; if there are none, of INSTEAD. */
void glint_draft_begin(void *header, const struct glint_blob_kind *kind,
                       uint32_t variant, uint64_t key, const char *name,
                       const char *instead);

/* Writes HEADER to the beginning of the file, sets its size and checksum,
 * and moves the file to *DATA[*BYTES]. If GOOD is false or there is no
 * memory, frees DRAFT and returns false. */
bool glint_draft_finish(struct glint_draft *draft, const void *header,
                        size_t header_bytes, bool good, unsigned char **data,
                        size_t *bytes);

#endif
