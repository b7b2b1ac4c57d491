/* SPDX-License-Identifier: MIT */
#include "scenes/baked_scene.h"

#include <stdlib.h>

#include "posix/input.h"

#define MAX_SCENE_BYTES ((size_t)1 << 30)

bool baked_scene_is(const char *argument)
{
    return tool_is_scene(argument) ||
           tool_begins_as(argument, GLINT_SCENE_MAGIC);
}

int baked_scene_open(const struct tool *tool, const char *path,
                     struct baked_scene *scene)
{
    struct glint_error error = {""};
    enum glint_status status;
    const char *reason = "";
    uint8_t *data = NULL;
    int code = EXIT_OK;

    *scene = (struct baked_scene){.data = NULL};
    if (tool_is_scene(path)) {
        code =
            tool_scene_bake(tool, path, &data, &scene->bytes, &scene->report);
        if (code != EXIT_OK)
            return code;
        scene->data = data;
        scene->is_text = true;
        status = GLINT_OK;
    } else {
        code = tool_scene_is_kept(tool, path);
        if (code != EXIT_OK)
            return code;
        status = glint_input_slurp(&data, &scene->bytes, path, MAX_SCENE_BYTES,
                                   &error);
        scene->data = data; /* malloc aligns it */
    }
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    if (glint_scene_open(&scene->model, scene->data, scene->bytes, &reason) ==
        GLINT_OK)
        return EXIT_OK;
    snprintf(error.text, sizeof error.text, "%.180s: %.70s", path, reason);
    tool_fail(tool, GLINT_E_LENS, error.text);
    baked_scene_close(scene);
    return EXIT_LENS;
}

void baked_scene_close(struct baked_scene *scene)
{
    free(scene->data);
    *scene = (struct baked_scene){.data = NULL};
}
