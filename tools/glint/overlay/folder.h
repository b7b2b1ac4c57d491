/* SPDX-License-Identifier: MIT
 *
 * A folder that the inputs of one line are drawn into, each into a file of its
 * name.
 */
#ifndef GLINT_TOOLS_OVERLAY_FOLDER_H
#define GLINT_TOOLS_OVERLAY_FOLDER_H

#include "options/engine_options.h"
#include "options/tool.h"

enum { FOLDER_PATH = 4096 };

/* Returns whether PATH names a folder: it is one, or ends in a slash. */
bool folder_is(const char *path);

/* Sets PATH to that of INPUT's name in FOLDER. Returns false if it is too
 * long. */
bool folder_path(char path[FOLDER_PATH], const char *folder, const char *input);

/* Creates FOLDER for INPUT[N], drawn with OPTIONS; *IS_NEW: it was not there.
 * Rejects inputs of one name, inputs that another's output would replace, and
 * streams that the first input would consume. Returns an exit code. */
int folder_open(const struct tool *tool, const char *folder, char **input,
                int n, const struct glint_options *options, bool *is_new);

#endif
