/* SPDX-License-Identifier: MIT
 *
 * lens_files.h - the folders with the lenses that come with glint, and with
 * their models. glint searches these folders in this order: $GLINT_LENSES, a
 * folder of tables; lenses/ and models/ in a folder above the program or
 * plug-in that contains this code (a source tree); share/glint above it (an
 * installation); the folder given to make install.
 */
#ifndef GLINT_TOOLS_MODEL_LENS_FILES_H
#define GLINT_TOOLS_MODEL_LENS_FILES_H

#include <stdbool.h>
#include <stddef.h>

/* Sets PATH to folder number I, from 0, that is searched for KIND, "lenses" or
 * "models", or to "" if that folder is unknown. The folder need not exist.
 * Returns false if I is past the last folder. */
bool lens_find_folder(int i, const char *kind, char *path, size_t bytes);

/* Sets PATH to the table of lens NAME, given without .lens. Returns false if
 * there is no such table. */
bool lens_find_file(const char *name, char *path, size_t bytes);

/* Calls EACH for every lens, sorted by name, until it returns false. Returns
 * the number of lenses, or -1 if there is no memory. */
typedef bool lens_files_fn(void *ctx, const char *name);
int lens_files_visit_all(lens_files_fn *each, void *ctx);

#endif
