/* SPDX-License-Identifier: MIT */
#include "bake/table/draft.h"

#include <stdlib.h>
#include <string.h>

uint32_t glint_draft_append(struct glint_draft *d, const void *data,
                            size_t bytes)
{
    const size_t padded = (bytes + 3) / 4 * 4, where = d->bytes;

    if (d->out_of_memory || where + padded > UINT32_MAX / 2) {
        d->out_of_memory = true;
        return 0;
    }
    if (where + padded > d->capacity) {
        const size_t capacity = 2 * (where + padded);
        unsigned char *more = realloc(d->data, capacity);

        if (!more) {
            d->out_of_memory = true;
            return 0;
        }
        d->data = more;
        d->capacity = capacity;
    }
    memset(d->data + where, 0, padded);
    if (data)
        memcpy(d->data + where, data, bytes);
    d->bytes += padded;
    return (uint32_t)where;
}

void glint_draft_overwrite(struct glint_draft *d, uint32_t where,
                           const void *data, size_t bytes)
{
    if (!d->out_of_memory)
        memcpy(d->data + where, data, bytes);
}

void glint_draft_begin_header(void *header, const struct glint_blob_kind *kind,
                              uint32_t variant, uint64_t key, const char *name,
                              const char *instead)
{
    struct glint_blob_header *h = header;
    size_t n = 0;

    h->magic = kind->magic;
    h->version = kind->version;
    h->variant = variant;
    h->key[0] = (uint32_t)key;
    h->key[1] = (uint32_t)(key >> 32);
    for (const char *c = name; *c && n + 1 < sizeof h->name; c++)
        if ((*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') ||
            (*c >= '0' && *c <= '9') || *c == '-' || *c == '_')
            h->name[n++] = *c;
    h->name[n] = '\0';
    if (!n)
        memcpy(h->name, instead, strlen(instead) + 1);
}

bool glint_draft_finish_file(struct glint_draft *d, const void *header,
                             size_t header_bytes, bool good,
                             unsigned char **data, size_t *bytes)
{
    glint_draft_overwrite(d, 0, header, header_bytes);
    if (!good || d->out_of_memory) {
        free(d->data);
        return false;
    }
    glint_blob_set_size_and_checksum(d->data, d->bytes);
    *data = d->data;
    *bytes = d->bytes;
    return true;
}
