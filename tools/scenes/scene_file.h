/* SPDX-License-Identifier: MIT
 *
 * Scene texts and the files that they name. */
#ifndef GLINT_TOOLS_SCENES_SCENE_FILE_H
#define GLINT_TOOLS_SCENES_SCENE_FILE_H

#include "glint/scene/bake.h"
#include "options/tool.h"

/* Returns whether ARGUMENT is the name of a scene text: NAME.scene. */
bool tool_is_scene(const char *argument);

/* Returns whether ARGUMENT is a file that begins with the word MAGIC. */
bool tool_begins_as(const char *argument, uint32_t magic);

enum { TOOL_PATH_BYTES = 4096 };

/* Sets PATH to NAME in the folder of the text TEXT; returns false if that is
 * too long. */
bool tool_beside(const char *text, const char *name,
                 char path[TOOL_PATH_BYTES]);

/* Sets NAME to the name of the file PATH without folder and ending. */
void tool_scene_name(const char *path, char name[64]);

/* Keys of contents, FNV-1a: begins as that, and goes on with DATA[BYTES]. */
#define TOOL_KEY_BEGIN UINT64_C(14695981039346656037)
void tool_key_mix(uint64_t *key, const void *data, size_t bytes);

/* Refuses the scene PATH if it is the file that TOOL writes. Returns an exit
 * code. */
int tool_scene_is_kept(const struct tool *tool, const char *path);

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
