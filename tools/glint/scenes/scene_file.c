/* SPDX-License-Identifier: MIT */
#include "scenes/scene_file.h"

#include <stdlib.h>

#include "assimp/assimp.h"
#include "formats/picture.h"
#include "model/model_file.h"
#include "posix/ending.h"
#include "posix/input.h"
#include "motions/motion_file.h"
#include "scenes/environment_file.h"
#include "stones/stone_file.h"

enum { TEXT_BYTES = 1 << 20 };

/* Max work of baking the files that a scene names, in the units of
 * tool_count_bake_work(). This corresponds to about 30 s of processor time. */
#define MOST_WORK (INT64_C(1) << 28)

bool tool_is_scene_text(const char *argument)
{
    return glint_has_extension(argument, ".scene");
}

/* Reader state of a scene text */
struct reading {
    const struct tool *tool;
    const char *path;
    /* output file, which must not be an input; NULL: none */
    const char *written;
    uint64_t key;
    int64_t left; /* remaining bake work, in units of tool_count_bake_work() */
};

/* Sets PATH to the path of the file NAME, which is relative to the folder of
 * the text. Errors are those of tool_make_input_path(). */
static enum glint_status find_scene_file_path(const struct reading *reading,
                                              const char *name,
                                              char path[TOOL_PATH_BYTES],
                                              struct glint_error *error)
{
    return tool_make_input_path(reading->path, name, reading->written, path,
                                error);
}

/* If STATUS is GLINT_OK, moves FROM[N] to *DATA, sets *BYTES to N, and adds the
 * data to the key. Returns STATUS. */
static enum glint_status store_read_data(struct reading *reading,
                                         enum glint_status status, void *from,
                                         size_t n, uint8_t **data,
                                         size_t *bytes)
{
    if (status != GLINT_OK)
        return status;
    tool_hash_into_key(&reading->key, from, n);
    *data = from;
    *bytes = n;
    return GLINT_OK;
}

static bool is_obj_name(const char *name)
{
    return glint_has_extension(name, ".obj");
}

/* Reads a mesh, of any file type, as an OBJ text. */
static enum glint_status read_obj_mesh(void *ctx, const char *name,
                                       uint8_t **data, size_t *bytes,
                                       struct glint_error *error)
{
    struct reading *reading = ctx;
    char path[TOOL_PATH_BYTES];
    enum glint_status status = find_scene_file_path(reading, name, path, error);

    if (status != GLINT_OK)
        return status;
    if (is_obj_name(name))
        status = glint_input_read_whole_file(
            data, bytes, path, GLINT_DESCRIPTION_MAX_MESH_BYTES, error);
    else
        status = glint_assimp_read_mesh(data, bytes, path,
                                        GLINT_DESCRIPTION_MAX_MESH_BYTES,
                                        GLINT_DESCRIPTION_MAX_TRIANGLES, error);
    /* A wrong OBJ file is found later, with GLINT_E_LENS. Other types of meshes
     * return the same status. */
    if (status == GLINT_E_FORMAT)
        status = GLINT_E_LENS;
    if (status == GLINT_OK)
        tool_hash_into_key(&reading->key, *data, *bytes);
    return status;
}

static enum glint_status read_texture_picture(void *ctx, const char *name,
                                              struct glint_image *image,
                                              struct glint_error *error)
{
    struct reading *reading = ctx;
    char path[TOOL_PATH_BYTES];
    enum glint_status status = find_scene_file_path(reading, name, path, error);

    if (status == GLINT_OK)
        status = glint_picture_load(path, image, error);
    if (status == GLINT_OK)
        tool_hash_into_key(&reading->key, image->plane[0],
                           3 * (size_t)image->width * (size_t)image->height);
    return status;
}

static enum glint_status read_or_bake_environment(void *ctx, const char *name,
                                                  uint8_t **data, size_t *bytes,
                                                  struct glint_error *error)
{
    struct reading *reading = ctx;
    struct environment_file file = {.data = NULL};
    char path[TOOL_PATH_BYTES];
    enum glint_status status = find_scene_file_path(reading, name, path, error);

    if (status == GLINT_OK)
        status = environment_file_read(path, reading->written, NULL, NULL,
                                       &reading->left, &file, error);
    return store_read_data(reading, status, file.data, file.bytes, data, bytes);
}

/* Reads or bakes a translucent medium. The caller frees its data. */
static enum glint_status read_or_bake_medium(void *ctx, const char *name,
                                             uint8_t **data, size_t *bytes,
                                             struct glint_error *error)
{
    struct reading *reading = ctx;
    struct stone_file file = {.data = NULL};
    char path[TOOL_PATH_BYTES];
    enum glint_status status = find_scene_file_path(reading, name, path, error);

    if (status == GLINT_OK)
        status = stone_file_read(reading->tool, path, NULL, NULL, false,
                                 &reading->left, &file, error);
    return store_read_data(reading, status, file.data, file.bytes, data, bytes);
}

static enum glint_status read_or_bake_motion(void *ctx, const char *name,
                                             uint8_t **data, size_t *bytes,
                                             struct glint_error *error)
{
    struct reading *reading = ctx;
    struct motion_file file = {.data = NULL};
    char path[TOOL_PATH_BYTES];
    enum glint_status status = find_scene_file_path(reading, name, path, error);

    if (status == GLINT_OK)
        status = motion_file_read(path, reading->written, &file, error);
    return store_read_data(reading, status, file.data, file.bytes, data, bytes);
}

int tool_read_scene(const struct tool *tool, const char *path,
                    struct glint_description *scene, uint64_t *key)
{
    struct reading reading = {tool, path, tool->written, TOOL_KEY_BEGIN,
                              tool->is_bake ? INT64_MAX : MOST_WORK};
    const struct glint_description_files files = {&reading,
                                                  read_obj_mesh,
                                                  read_texture_picture,
                                                  read_or_bake_environment,
                                                  read_or_bake_motion,
                                                  read_or_bake_medium};
    struct glint_error error = {""};
    uint8_t *text = NULL;
    size_t bytes = 0;
    enum glint_status status;
    const int code = tool_check_scene_not_overwritten(tool, path);

    if (code != EXIT_OK)
        return code;
    status =
        glint_input_read_whole_file(&text, &bytes, path, TEXT_BYTES, &error);
    if (status == GLINT_OK) {
        tool_hash_into_key(&reading.key, text, bytes);
        status = glint_description_parse(scene, (const char *)text, bytes, path,
                                         &files, &error);
    }
    free(text);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    if (key)
        *key = reading.key;
    if (scene->warning[0] && !tool->quiet)
        fprintf(stderr, "glint %s: %s: %s\n", tool->name, path, scene->warning);
    return EXIT_OK;
}

int tool_bake_scene(const struct tool *tool, const char *path, uint8_t **data,
                    size_t *bytes, struct glint_scene_bake_report *report)
{
    struct glint_description *description = malloc(sizeof *description);
    struct glint_error error = {""};
    enum glint_status status = GLINT_E_MEMORY;
    uint64_t key = 0;
    char name[64];
    int code = EXIT_OK;

    if (description)
        code = tool_read_scene(tool, path, description, &key);
    if (description && code == EXIT_OK) {
        tool_copy_base_name(path, name);
        status = glint_scene_bake(description, name, key, data, bytes, report,
                                  &error);
        glint_description_free(description);
    }
    free(description);
    if (code != EXIT_OK)
        return code;
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}
