/* SPDX-License-Identifier: MIT */
#include "formats/still_codec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/image.h"
#include "posix/error.h"

void glint_still_append(struct still_bytes *to, const void *bytes, size_t n)
{
    uint8_t *more;

    if (to->n + n > to->capacity && !to->is_short) {
        to->capacity = 2 * (to->n + n);
        more = realloc(to->mem, to->capacity);
        to->is_short = !more;
        if (more)
            to->mem = more;
    }
    if (to->is_short)
        return;
    memcpy(to->mem + to->n, bytes, n);
    to->n += n;
}

void glint_still_add_note(struct still_file *file, const char *text)
{
    const size_t used = strlen(file->note);

    snprintf(file->note + used, sizeof file->note - used, "%s%s",
             used ? "; " : "", text);
}

void glint_still_note_rest(struct still_file *file, size_t bytes)
{
    char text[64];

    snprintf(text, sizeof text, "%zu bytes behind its picture are dropped",
             bytes);
    if (bytes > 0)
        glint_still_add_note(file, text);
}

enum glint_status glint_still_allocate(struct still_file *file,
                                       struct glint_error *error)
{
    struct still_pixels *const p = &file->pixels;

    if (p->width < 1 || p->width > GLINT_MAX_SIDE || p->height < 1 ||
        p->height > GLINT_MAX_SIDE)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, file->path,
                                  "larger than %d pixels a side",
                                  GLINT_MAX_SIDE);
    p->mem = calloc((size_t)p->width * (size_t)p->height,
                    (size_t)p->channels * (size_t)p->sample_bytes);
    return p->mem ? GLINT_OK
                  : glint_error_report(error, GLINT_E_MEMORY, file->path,
                                       "not enough memory for the picture");
}
