/* SPDX-License-Identifier: MIT
 *
 * Scene texts and the files that they name. */
#ifndef GLINT_TOOLS_SCENES_SCENE_FILE_H
#define GLINT_TOOLS_SCENES_SCENE_FILE_H

#include "glint/scene/bake.h"
#include "model/names.h"

/* Returns whether ARGUMENT is the name of a scene text: NAME.scene. */
bool tool_is_scene(const char *argument);

/* Reads the scene text PATH; what it names is looked for in the folder of PATH.
 * Returns an exit code, after printing the reason on failure, which may be that
 * one of the files is the one that TOOL writes. On EXIT_OK SCENE
 * is to be freed. Prints what is odd about it, unless quiet. KEY, unless NULL,
 * becomes a key of the contents of all files. */
int tool_scene(const struct tool *tool, const char *path,
               struct glint_description *scene, uint64_t *key);

/* Reads the scene text PATH and bakes it into *DATA, malloc'ed. Returns an exit
 * code, after printing the reason on failure. */
int tool_scene_bake(const struct tool *tool, const char *path, uint8_t **data,
                    size_t *bytes, struct glint_scene_bake_report *report);

#endif
