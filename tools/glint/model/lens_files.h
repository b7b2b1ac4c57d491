/* SPDX-License-Identifier: MIT
 *
 * lens_files.h - the folders of the lenses that come with glint, and of their
 * models.
 *
 * First comes $GLINT_LENSES, a folder of tables; then lenses/ and models/ above
 * the program, or the plug-in of a host, that contains this code, as in a
 * source tree, and in share/glint above it, as where glint is installed;
 * last the folder given to make install.
 */
#ifndef GLINT_TOOLS_MODEL_LENS_FILES_H
#define GLINT_TOOLS_MODEL_LENS_FILES_H

#include <stdbool.h>
#include <stddef.h>

/* Sets PATH to the Ith place, from 0, to look for KIND, "lenses" or "models",
 * or to "" if that place is not known. The folder need not exist. Returns false
 * if there are no more places. */
bool lens_folder(int i, const char *kind, char *path, size_t bytes);

/* Sets PATH to the table of lens NAME, which comes without .lens. Returns false
 * if there is none. */
bool lens_file_find(const char *name, char *path, size_t bytes);

/* Calls EACH for every lens by name, in order, until it returns false. Returns
 * how many lenses there are, or -1 without memory. */
typedef bool lens_files_fn(void *ctx, const char *name);
int lens_files_each(lens_files_fn *each, void *ctx);

#endif
