/* SPDX-License-Identifier: MIT
 *
 * Reads scene texts and the files that they name. */
#ifndef GLINT_TOOLS_SCENES_SCENE_FILE_H
#define GLINT_TOOLS_SCENES_SCENE_FILE_H

#include "glint/scene/bake.h"
#include "model/names.h"

/* Returns whether ARGUMENT is the name of a scene text: NAME.scene. */
bool tool_is_scene_text(const char *argument);

/* Reads the scene text PATH and the files that it names, relative to its
 * folder. Rejects a file that is the output of TOOL. Prints warnings, unless
 * TOOL is quiet. Sets *KEY (KEY may be NULL) to a hash of all these files.
 * Returns an exit code, after printing the reason on failure. On EXIT_OK the
 * caller frees SCENE. */
int tool_read_scene(const struct tool *tool, const char *path,
                    struct glint_description *scene, uint64_t *key);

/* Reads the scene text PATH and bakes it into *DATA, which the caller frees.
 * Returns an exit code, after printing the reason on failure. */
int tool_bake_scene(const struct tool *tool, const char *path, uint8_t **data,
                    size_t *bytes, struct glint_scene_bake_report *report);

#endif
