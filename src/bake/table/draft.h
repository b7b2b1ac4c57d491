/* SPDX-License-Identifier: MIT
 *
 * A baked file under construction: a growing block of memory, to which
 * sections are appended.
 */
#ifndef GLINT_BAKE_TABLE_DRAFT_H
#define GLINT_BAKE_TABLE_DRAFT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/blob.h"

/* A file under construction. Must be initialised with zeros. Owns DATA, a block
 * from malloc(). */
struct glint_draft {
    unsigned char *data;
    size_t bytes, capacity;
    bool out_of_memory; /* true: further writes have no effect */
};

/* Appends BYTES from DATA, or zeros if DATA is NULL, padded to a multiple of 4
 * bytes. Returns their offset in the file. */
uint32_t glint_draft_append(struct glint_draft *draft, const void *data,
                            size_t bytes);

/* Overwrites BYTES at offset WHERE of the file. */
void glint_draft_overwrite(struct glint_draft *draft, uint32_t where,
                           const void *data, size_t bytes);

/* Sets the common members at the start of the header of a baked file, except
 * size and checksum. The name consists of those characters of NAME that are
 * a-z, A-Z, 0-9, '-' or '_', at most 63. If there are none, INSTEAD is used. */
void glint_draft_begin_header(void *header, const struct glint_blob_kind *kind,
                              uint32_t variant, uint64_t key, const char *name,
                              const char *instead);

/* Writes HEADER to the beginning of the file, sets its size and checksum, and
 * moves the file to *DATA[*BYTES]. Frees DRAFT and returns false if GOOD is
 * false or if there was no memory. */
bool glint_draft_finish_file(struct glint_draft *draft, const void *header,
                             size_t header_bytes, bool good,
                             unsigned char **data, size_t *bytes);

#endif
