/* SPDX-License-Identifier: MIT */
#include "model/response_cache.h"

#include <stdlib.h>
#include <string.h>

#include "model/cache_file.h"

static void tell(const struct tool *tool, const char *lens, const char *what,
                 const char *where)
{
    if (tool->verbose && !tool->quiet)
        fprintf(stderr, "glint %s: response of %s: %s%s\n", tool->name, lens,
                what, where);
}

static bool path_of(char path[CACHE_PATH_BYTES], const char *lens, uint64_t key)
{
    return cache_file_folder(path, CACHE_PATH_BYTES) &&
           cache_file_name(path, CACHE_PATH_BYTES, lens, key, "response");
}

static int read_entry(void *ctx, const char *lens, uint64_t key, void *data,
                      size_t bytes)
{
    char path[CACHE_PATH_BYTES];
    size_t got = 0;
    uint8_t *const file =
        path_of(path, lens, key) ? cache_file_read(path, bytes, &got) : NULL;
    const bool is_read = file && got == bytes;

    if (is_read) {
        memcpy(data, file, bytes);
        tell(ctx, lens, "read from ", path);
    }
    free(file);
    return is_read;
}

static void write_entry(void *ctx, const char *lens, uint64_t key,
                        const void *data, size_t bytes)
{
    char path[CACHE_PATH_BYTES];
    struct glint_error error = {""};

    if (!path_of(path, lens, key))
        tell(ctx, lens, "measured", "");
    else if (cache_file_write(path, data, bytes, &error) == GLINT_OK)
        tell(ctx, lens, "measured, kept in ", path);
    else
        tell(ctx, lens, "measured, not kept: ", error.text);
}

struct glint_engine_cache response_cache(const struct tool *tool)
{
    return (struct glint_engine_cache){read_entry, write_entry, (void *)tool};
}
