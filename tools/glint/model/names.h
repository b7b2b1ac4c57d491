/* SPDX-License-Identifier: MIT
 *
 * Names of scene and environment files, and hashes of their contents. */
#ifndef GLINT_TOOLS_MODEL_NAMES_H
#define GLINT_TOOLS_MODEL_NAMES_H

#include "options/tool.h"

/* Returns whether ARGUMENT is a file that begins with the 32-bit word MAGIC. */
bool tool_has_magic(const char *argument, uint32_t magic);

enum { TOOL_PATH_BYTES = 4096 };

/* Sets PATH to the path of the file NAME, which is relative to the folder of
 * the file TEXT. Returns GLINT_E_IO if PATH is too long, or GLINT_E_ARGUMENT if
 * PATH is the output file WRITTEN (may be NULL). */
enum glint_status tool_make_input_path(const char *text, const char *name,
                                       const char *written,
                                       char path[TOOL_PATH_BYTES],
                                       struct glint_error *error);

/* Adds the position of the file NAME in the text PATH to the beginning of
 * ERROR, which is about this file: "PATH:LINE:COLUMN: ". KEY: first word of the
 * line. */
void tool_add_place_of_name(const char *path, const char *key, const char *name,
                            struct glint_error *error);

/* Sets NAME to the name of the file PATH without folder and extension. */
void tool_copy_base_name(const char *path, char name[64]);

/* FNV-1a hash: a key starts as TOOL_KEY_BEGIN, and tool_hash_into_key() adds
 * DATA[BYTES] to it. */
#define TOOL_KEY_BEGIN UINT64_C(14695981039346656037)
void tool_hash_into_key(uint64_t *key, const void *data, size_t bytes);

/* Prints a usage error and returns its exit code if the scene PATH is the
 * output file of TOOL, which would overwrite it. Otherwise returns EXIT_OK. */
int tool_check_scene_not_overwritten(const struct tool *tool, const char *path);

#endif
