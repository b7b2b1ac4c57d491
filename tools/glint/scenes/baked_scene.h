/* SPDX-License-Identifier: MIT
 *
 * Opens scenes: bakes the text of a scene, or reads a baked file.
 */
#ifndef GLINT_TOOLS_SCENES_BAKED_SCENE_H
#define GLINT_TOOLS_SCENES_BAKED_SCENE_H

#include "options/json_writer.h"
#include "scenes/scene_file.h"

struct baked_scene {
    void *data; /* contents of the baked scene, owned; MODEL points into it */
    size_t bytes;
    struct glint_scene_model model;
    /* report of the bake; all zero if the scene was read from a baked file */
    struct glint_scene_bake_report report;
    bool is_text;
};

/* Returns whether ARGUMENT is a scene: a text, NAME.scene, or a file that
 * begins with the magic number of baked scenes. */
bool baked_scene_is_file(const char *argument);

/* Opens PATH as SCENE: bakes a text, or reads a baked file. Returns an exit
 * code, after printing the reason on failure. */
int baked_scene_open(const struct tool *tool, const char *path,
                     struct baked_scene *scene);

void baked_scene_close(struct baked_scene *scene);

/* Prints the contents of SCENE, and its bytes per section; with --json, as one
 * object. */
void baked_scene_print_contents(const struct tool *tool,
                                const struct baked_scene *scene);

/* Begins the JSON object "bytes", with the bytes of MODEL per section. The
 * caller ends it. */
void baked_scene_write_byte_counts(struct json_writer *json,
                                   const struct glint_scene_model *model);

/* The command glint bake for scenes; see options/tool.h. */
int cmd_bake_scene(struct tool *tool, int argc, char **argv);

#endif
