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

/* Owns data, which is allocated with malloc(). Initialise it with zeros. */
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

/* Sets the members with which the header of every baked file begins, except
 * size and checksum. The file's name is made of the characters a-z, A-Z, 0-9,
 * '-' and '_' of NAME, at most 63; if it has none, of those of INSTEAD. */
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
