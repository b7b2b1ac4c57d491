/* SPDX-License-Identifier: MIT
 *
 * Baked scenes: from their texts, and from files.
 */
#ifndef GLINT_TOOLS_SCENES_BAKED_SCENE_H
#define GLINT_TOOLS_SCENES_BAKED_SCENE_H

#include "options/json_writer.h"
#include "scenes/scene_file.h"

struct baked_scene {
    void *data; /* malloc'ed; MODEL points into it */
    size_t bytes;
    struct glint_scene_model model;
    struct glint_scene_bake_report report; /* zeros: of a file */
    bool is_text;
};

/* Returns whether ARGUMENT is a scene: a text by its name, or a baked scene by
 * how the file begins. */
bool baked_scene_is(const char *argument);

/* Opens as SCENE the text, which it bakes, or the file PATH. Returns an exit
 * code, after printing the reason on failure. */
int baked_scene_open(const struct tool *tool, const char *path,
                     struct baked_scene *scene);

void baked_scene_close(struct baked_scene *scene);

/* Prints the contents of SCENE, and its bytes by section; with --json, as one
 * object. */
void baked_scene_print(const struct tool *tool,
                       const struct baked_scene *scene);

/* Begins the object "bytes": those of MODEL by what they hold. */
void baked_scene_bytes(struct json_writer *json,
                       const struct glint_scene_model *model);

/* glint bake of scenes, as the commands of options/tool.h. */
int cmd_bake_scene(struct tool *tool, int argc, char **argv);

#endif
