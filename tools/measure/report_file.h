/* SPDX-License-Identifier: MIT
 *
 * The files that a sweep leaves in its folder. */
#ifndef GLINT_TOOLS_LAB_REPORT_FILE_H
#define GLINT_TOOLS_LAB_REPORT_FILE_H

#include "options/tool.h"

/* Makes the folder PATH, unless it is there. Returns false on failure, with
 * errno. */
bool report_file_folder(const char *path);

/* Closes FILE, of open_memstream(), and saves its *TEXT of *BYTES, which it
 * frees, as NAME in FOLDER. Returns an exit code. */
int report_file_save(const struct tool *tool, const char *folder,
                     const char *name, FILE *file, char **text,
                     const size_t *bytes);

#endif
