/* SPDX-License-Identifier: MIT
 *
 * A baked file while it is written: a block that grows, section by section. */
#ifndef GLINT_BAKE_TABLE_DRAFT_H
#define GLINT_BAKE_TABLE_DRAFT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Owned: DATA is malloc'ed. Begins as zeros. */
struct glint_draft {
    unsigned char *data;
    size_t bytes, room;
    bool out_of_memory; /* nothing more is written */
};

/* Appends BYTES from DATA (zeros if it is NULL), padded to a multiple of 4.
 * Returns the offset of its beginning. */
uint32_t glint_draft_put(struct glint_draft *draft, const void *data,
                         size_t bytes);

/* Overwrites BYTES at the offset WHERE. */
void glint_draft_amend(struct glint_draft *draft, uint32_t where,
                       const void *data, size_t bytes);

/* Copies the first 63 characters of FROM that a baked file's name may have,
 * a-z, A-Z, 0-9, '-' and '_', to TO; INSTEAD if there are none. */
void glint_draft_name(char to[64], const char *from, const char *instead);

#endif
