/* SPDX-License-Identifier: MIT */
#include "scenes/environment_file.h"

#include <stdlib.h>
#include <string.h>

#include "formats/picture.h"
#include "model/model_file.h"
#include "posix/ending.h"
#include "posix/input.h"
#include "model/names.h"

#define MAX_FILE_BYTES ((size_t)1 << 28)

static bool is_text(const char *name)
{
    return glint_ends_in(name, ".environment");
}

bool environment_file_is_source(const char *argument)
{
    return is_text(argument) || glint_ends_in(argument, ".exr") ||
           glint_ends_in(argument, ".hdr") || glint_ends_in(argument, ".pfm") ||
           glint_ends_in(argument, ".dds");
}

bool environment_file_is_baked(const char *argument)
{
    return tool_begins_as(argument, GLINT_ENVIRONMENT_MAGIC);
}

static enum glint_status read_text(const char *path,
                                   struct glint_environment_options *options,
                                   char source[GLINT_ENVIRONMENT_FILE_BYTES],
                                   struct glint_error *error)
{
    uint8_t *text = NULL;
    size_t bytes = 0;
    enum glint_status status =
        glint_input_slurp(&text, &bytes, path, 1 << 16, error);

    if (status == GLINT_OK)
        status = glint_environment_parse(options, source, (const char *)text,
                                         bytes, path, error);
    free(text);
    return status;
}

/* Bakes the picture FROM, under the name of the file NAMED. */
static enum glint_status bake(const char *named, const char *from,
                              const struct glint_environment_options *options,
                              struct environment_file *file,
                              struct glint_error *error)
{
    struct glint_float_image picture = {0};
    unsigned char *data = NULL;
    uint64_t key = TOOL_KEY_BEGIN;
    char name[64];
    enum glint_status status = glint_picture_load_float(from, &picture, error);

    if (status == GLINT_OK) {
        tool_scene_name(named, name);
        tool_key_mix(&key, options, sizeof *options);
        tool_key_mix(&key, picture.rgb,
                     3 * sizeof(float) * (size_t)picture.width *
                         (size_t)picture.height);
        status = glint_environment_bake(&picture, options, name, key, &data,
                                        &file->bytes, &file->report, error);
        if (status == GLINT_E_UNSUPPORTED) {
            const struct glint_error cause = *error;

            snprintf(error->text, sizeof error->text, "%.120s: %.120s", from,
                     cause.text);
        }
    }
    free(picture.rgb);
    file->data = data;
    file->is_baked_now = true;
    return status;
}

/* Reads the picture or text PATH and bakes it. */
static enum glint_status
bake_source(const char *path, const char *written,
            void (*over)(void *ctx, struct glint_environment_options *),
            void *ctx, struct environment_file *file, struct glint_error *error)
{
    struct glint_environment_options options;
    char source[GLINT_ENVIRONMENT_FILE_BYTES], beside[TOOL_PATH_BYTES];
    const char *picture = path;
    enum glint_status status = GLINT_OK;

    memset(&options, 0, sizeof options); /* padding is a part of the key */
    glint_environment_defaults(&options);
    if (is_text(path)) {
        status = read_text(path, &options, source, error);
        if (status == GLINT_OK)
            status = tool_find_input(path, source, written, beside, error);
        picture = beside;
    }
    if (over)
        over(ctx, &options);
    return status == GLINT_OK ? bake(path, picture, &options, file, error)
                              : status;
}

enum glint_status environment_file_read(
    const char *path, const char *written,
    void (*over)(void *ctx, struct glint_environment_options *), void *ctx,
    struct environment_file *file, struct glint_error *error)
{
    char self[TOOL_PATH_BYTES];
    const char *reason = "";
    uint8_t *data = NULL;
    enum glint_status status;

    *file = (struct environment_file){.data = NULL};
    status = tool_find_input("", path, written, self, error);
    if (status == GLINT_OK && environment_file_is_source(path)) {
        status = bake_source(path, written, over, ctx, file, error);
    } else if (status == GLINT_OK) {
        status =
            glint_input_slurp(&data, &file->bytes, path, MAX_FILE_BYTES, error);
        file->data = data; /* malloc aligns it */
    }
    if (status != GLINT_OK ||
        glint_environment_open(&file->environment, file->data, file->bytes,
                               &reason) == GLINT_OK)
        return status;
    snprintf(error->text, sizeof error->text, "%.180s: %.70s", path, reason);
    environment_file_close(file);
    return GLINT_E_LENS;
}

int environment_file_open(const struct tool *tool, const char *path,
                          void (*over)(void *ctx,
                                       struct glint_environment_options *),
                          void *ctx, struct environment_file *file)
{
    struct glint_error error = {""};
    enum glint_status status;
    const int code = tool_scene_is_kept(tool, path);

    if (code != EXIT_OK)
        return code;
    status =
        environment_file_read(path, tool->written, over, ctx, file, &error);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

void environment_file_close(struct environment_file *file)
{
    free(file->data);
    *file = (struct environment_file){.data = NULL};
}
