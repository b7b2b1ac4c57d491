/* SPDX-License-Identifier: MIT
 *
 * Makes the output folder for several inputs. The output of each input has the
 * input's file name in this folder.
 */
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

/* Creates FOLDER if it does not exist. Sets *IS_NEW to whether FOLDER was
 * created. The outputs of INPUT[N], drawn with OPTIONS, will be written there.
 * Rejects inputs with equal file names, outputs that would overwrite an input,
 * and options that read a stream, which the first input would consume. Returns
 * an exit code. */
int folder_create(const struct tool *tool, const char *folder, char **input,
                  int n, const struct glint_options *options, bool *is_new);

#endif
