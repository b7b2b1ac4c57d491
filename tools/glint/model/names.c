/* SPDX-License-Identifier: MIT */
#include "model/names.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "model/model_file.h"
#include "posix/error.h"
#include "posix/input.h"
#include "posix/output.h"

bool tool_has_magic(const char *argument, uint32_t magic)
{
    uint32_t first = 0;
    struct stat st;
    FILE *file;

    /* A pipe can be read only once, so it is not opened here. */
    if (!tool_is_file_name(argument) || stat(argument, &st) < 0 ||
        !S_ISREG(st.st_mode))
        return false;
    file = fopen(argument, "rb");
    if (!file)
        return false;
    if (fread(&first, sizeof first, 1, file) < 1)
        first = 0;
    fclose(file);
    return first == magic;
}

void tool_hash_into_key(uint64_t *key, const void *data, size_t bytes)
{
    const uint8_t *byte = data;

    for (size_t i = 0; i < bytes; i++)
        *key = (*key ^ byte[i]) * UINT64_C(1099511628211);
}

enum glint_status tool_make_input_path(const char *text, const char *name,
                                       const char *written,
                                       char path[TOOL_PATH_BYTES],
                                       struct glint_error *error)
{
    const char *const slash = name[0] == '/' ? NULL : strrchr(text, '/');
    const int folder = slash ? (int)(slash - text) + 1 : 0;

    if (snprintf(path, TOOL_PATH_BYTES, "%.*s%s", folder, text, name) >=
        TOOL_PATH_BYTES) {
        snprintf(error->text, sizeof error->text,
                 "the file's name is too long");
        return GLINT_E_IO;
    }
    if (!written || !glint_target_is_input(path, written))
        return GLINT_OK;
    snprintf(error->text, sizeof error->text,
             "%.180s would be overwritten by -o; name another file", name);
    return GLINT_E_ARGUMENT;
}

/* Returns the index of NAME in the line LINE[BYTES] if its first word is KEY,
 * otherwise -1. */
static int find_name_in_line(const char *line, int bytes, const char *key,
                             const char *name)
{
    const int n_key = (int)strlen(key), n_name = (int)strlen(name);
    int i = 0;

    while (i < bytes && (line[i] == ' ' || line[i] == '\t'))
        i++;
    if (i + n_key > bytes || memcmp(line + i, key, (size_t)n_key) != 0)
        return -1;
    for (i += n_key; i + n_name <= bytes; i++)
        if ((line[i - 1] == ' ' || line[i - 1] == '\t') &&
            memcmp(line + i, name, (size_t)n_name) == 0)
            return i;
    return -1;
}

/* Sets ERROR to "PATH:LINE:COLUMN: CAUSE". The beginning of a long PATH is
 * omitted so that CAUSE fits. Does not change ERROR if only a few characters of
 * PATH fit. */
static void add_place_to_error(const char *path, int line, int column,
                               const char *cause, struct glint_error *error)
{
    enum { LEAST = 16 };
    const int n_path = (int)strlen(path);
    const int room = (int)(sizeof error->text - strlen(cause)) - 1 -
                     snprintf(NULL, 0, ":%d:%d: ", line, column);
    const int cut = n_path > room ? n_path - room + 3 : 0;
    int used;

    if (cut && room < LEAST)
        return;
    used = snprintf(error->text, sizeof error->text,
                    "%s%s:%d:%d: ", cut ? "..." : "", path + cut, line, column);
    snprintf(error->text + used, sizeof error->text - (size_t)used, "%s",
             cause);
    glint_utf8_replace_unprintable(error->text);
}

void tool_add_place_of_name(const char *path, const char *key, const char *name,
                            struct glint_error *error)
{
    const struct glint_error cause = *error;
    struct glint_error other;
    uint8_t *data = NULL;
    size_t bytes = 0, at = 0;

    if (!cause.text[0] || glint_input_read_whole_file(
                              &data, &bytes, path, 1 << 16, &other) != GLINT_OK)
        return;
    for (int line = 1; at < bytes; line++) {
        const char *const start = (const char *)data + at;
        const char *const end = memchr(start, '\n', bytes - at);
        const int n = end ? (int)(end - start) : (int)(bytes - at);
        const int column = find_name_in_line(start, n, key, name);

        if (column >= 0) {
            add_place_to_error(path, line, column + 1, cause.text, error);
            break;
        }
        at += (size_t)n + 1;
    }
    free(data);
}

void tool_copy_base_name(const char *path, char name[64])
{
    const char *const slash = strrchr(path, '/');
    const char *const start = slash ? slash + 1 : path;

    snprintf(name, 64, "%.*s", (int)strcspn(start, "."), start);
}

int tool_check_scene_not_overwritten(const struct tool *tool, const char *path)
{
    if (!tool->written || !glint_target_is_input(path, tool->written))
        return EXIT_OK;
    return tool_usage(tool,
                      "-o %s would overwrite the input; name another file",
                      tool->written);
}
