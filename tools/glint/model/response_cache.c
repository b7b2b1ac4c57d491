/* SPDX-License-Identifier: MIT */
#include "model/response_cache.h"

#include <stdlib.h>
#include <string.h>

#include "model/cache_file.h"

static void print_response_notice(const struct tool *tool, const char *lens,
                                  const char *what, const char *where)
{
    if (tool->verbose && !tool->quiet)
        fprintf(stderr, "glint %s: response of %s: %s%s\n", tool->name, lens,
                what, where);
}

static bool find_response_path(char path[CACHE_PATH_BYTES], const char *lens,
                               uint64_t key)
{
    return cache_file_find_folder(path, CACHE_PATH_BYTES) &&
           cache_file_append_name(path, CACHE_PATH_BYTES, lens, key,
                                  "response");
}

static int read_cached_response(void *ctx, const char *lens, uint64_t key,
                                void *data, size_t bytes)
{
    char path[CACHE_PATH_BYTES];
    size_t got = 0;
    uint8_t *const file = find_response_path(path, lens, key)
                              ? cache_file_read(path, bytes, &got)
                              : NULL;
    const bool is_read = file && got == bytes;

    if (is_read) {
        memcpy(data, file, bytes);
        print_response_notice(ctx, lens, "read from ", path);
    }
    free(file);
    return is_read;
}

static void write_cached_response(void *ctx, const char *lens, uint64_t key,
                                  const void *data, size_t bytes)
{
    char path[CACHE_PATH_BYTES];
    struct glint_error error = {""};

    if (!find_response_path(path, lens, key))
        print_response_notice(ctx, lens, "measured", "");
    else if (cache_file_write(path, data, bytes, &error) == GLINT_OK)
        print_response_notice(ctx, lens, "measured, cached in ", path);
    else
        print_response_notice(ctx, lens, "measured, not cached: ", error.text);
}

struct glint_engine_cache response_cache_callbacks(const struct tool *tool)
{
    return (struct glint_engine_cache){read_cached_response,
                                       write_cached_response, (void *)tool};
}
