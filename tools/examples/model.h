/* SPDX-License-Identifier: MIT
 *
 * Reads baked models, for the examples.
 */
#ifndef GLINT_TOOLS_EXAMPLES_MODEL_H
#define GLINT_TOOLS_EXAMPLES_MODEL_H

#include <stdio.h>
#include <stdlib.h>

#include "glint/model.h"

/* Returns the content of the file PATH, which the caller frees, and sets *BYTES
 * to the size. Returns NULL if the file cannot be read. */
static inline void *read_all(const char *path, size_t *bytes)
{
    FILE *file = fopen(path, "rb");
    char *data = NULL;
    long size = -1;

    if (file && fseek(file, 0, SEEK_END) == 0)
        size = ftell(file);
    if (size > 0 && fseek(file, 0, SEEK_SET) == 0)
        data = malloc((size_t)size);
    if (data && fread(data, 1, (size_t)size, file) != (size_t)size) {
        free(data);
        data = NULL;
    }
    if (file)
        fclose(file);
    *bytes = (size_t)size;
    return data;
}

/* Opens the model in the file PATH as LENS. Returns its memory, which the
 * caller frees. If the file is not a model, prints the reason and returns
 * NULL. */
static inline void *model_read(const char *path, struct glint_lens *lens)
{
    const char *reason = "cannot be read";
    size_t bytes;
    void *data = read_all(path, &bytes);

    if (data && glint_lens_open(lens, data, bytes, &reason) == GLINT_OK)
        return data;
    fprintf(stderr, "%s: %s\n", path, reason);
    free(data);
    return NULL;
}

#endif
