/* SPDX-License-Identifier: MIT
 *
 * Reads lens tables (.lens files).
 */
#ifndef GLINT_TOOLS_MODEL_TABLE_FILE_H
#define GLINT_TOOLS_MODEL_TABLE_FILE_H

#include "glint/prescription.h"
#include "options/tool.h"

/* Prints that no lens has the name NAME, and similar names. */
void tool_report_unknown_lens(const struct tool *tool, const char *name);

/* Returns the path of the lens ARGUMENT: ARGUMENT itself if it is a file name,
 * else PATH, which receives the path of the lens's table. If there is no such
 * lens, prints similar names and returns NULL. */
const char *tool_find_lens_file(const struct tool *tool, const char *argument,
                                char *path, size_t bytes);

/* Reads the lens ARGUMENT, a file name or the name of a table that comes
 * with glint. Returns an exit code, after printing the reason on failure. */
int tool_read_lens(const struct tool *tool, const char *argument,
                   struct glint_prescription *lens);

#endif
