/* SPDX-License-Identifier: MIT
 *
 * Names of the files of scenes and environments, and keys of what is in them.
 */
#ifndef GLINT_TOOLS_MODEL_NAMES_H
#define GLINT_TOOLS_MODEL_NAMES_H

#include "options/tool.h"

/* Returns whether ARGUMENT is a file that begins with the word MAGIC. */
bool tool_begins_as(const char *argument, uint32_t magic);

enum { TOOL_PATH_BYTES = 4096 };

/* Sets PATH to NAME in the folder of the text TEXT. GLINT_E_IO: it is too long;
 * GLINT_E_ARGUMENT: it is the file WRITTEN, which may be NULL. */
enum glint_status tool_find_input(const char *text, const char *name,
                                  const char *written,
                                  char path[TOOL_PATH_BYTES],
                                  struct glint_error *error);

/* Sets NAME to the name of the file PATH without folder and ending. */
void tool_scene_name(const char *path, char name[64]);

/* Keys of contents, FNV-1a: begins as that, and continues with DATA[BYTES]. */
#define TOOL_KEY_BEGIN UINT64_C(14695981039346656037)
void tool_key_mix(uint64_t *key, const void *data, size_t bytes);

/* Refuses the scene PATH if it is the file that TOOL writes. Returns an exit
 * code. */
int tool_scene_is_kept(const struct tool *tool, const char *path);

#endif
