/* SPDX-License-Identifier: MIT */
#include "bake/table/draft.h"

#include <stdlib.h>
#include <string.h>

uint32_t glint_draft_put(struct glint_draft *d, const void *data, size_t bytes)
{
    const size_t padded = (bytes + 3) / 4 * 4, where = d->bytes;

    if (d->out_of_memory || where + padded > UINT32_MAX / 2) {
        d->out_of_memory = true;
        return 0;
    }
    if (where + padded > d->room) {
        const size_t room = 2 * (where + padded);
        unsigned char *more = realloc(d->data, room);

        if (!more) {
            d->out_of_memory = true;
            return 0;
        }
        d->data = more;
        d->room = room;
    }
    memset(d->data + where, 0, padded);
    if (data)
        memcpy(d->data + where, data, bytes);
    d->bytes += padded;
    return (uint32_t)where;
}

void glint_draft_amend(struct glint_draft *d, uint32_t where, const void *data,
                       size_t bytes)
{
    if (!d->out_of_memory)
        memcpy(d->data + where, data, bytes);
}

void glint_draft_name(char to[64], const char *from, const char *instead)
{
    int n = 0;

    for (; *from && n < 63; from++)
        if ((*from >= 'a' && *from <= 'z') || (*from >= 'A' && *from <= 'Z') ||
            (*from >= '0' && *from <= '9') || *from == '-' || *from == '_')
            to[n++] = *from;
    to[n] = '\0';
    if (!n)
        memcpy(to, instead, strlen(instead) + 1);
}
