/* SPDX-License-Identifier: MIT
 *
 * The output folder of several inputs: each input is drawn to a file of the
 * same name in this folder. */
#ifndef GLINT_TOOLS_OVERLAY_FOLDER_H
#define GLINT_TOOLS_OVERLAY_FOLDER_H

#include "options/engine_options.h"
#include "options/tool.h"

enum { FOLDER_PATH = 4096 };

/* Returns whether PATH is an existing folder or ends in a slash. */
bool folder_is_path_a_folder(const char *path);

/* Sets PATH to FOLDER/NAME with the file name of INPUT. Returns false if PATH
 * is too long. */
bool folder_make_output_path(char path[FOLDER_PATH], const char *folder,
                             const char *input);

/* Creates FOLDER unless it exists; *IS_NEW is set to whether it was created.
 * INPUT[N] are drawn with OPTIONS. Rejects inputs with the same name, outputs
 * that would overwrite an input, and streams that the first input would
 * consume. Returns an exit code. */
int folder_create(const struct tool *tool, const char *folder, char **input,
                  int n, const struct glint_options *options, bool *is_new);

#endif
