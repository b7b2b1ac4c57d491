/* SPDX-License-Identifier: MIT
 *
 * lens_files.h - where the lenses that come with glint lie, and their models.
 *
 * In a source tree in lenses/ above the executable; installed, and moved
 * wherever, in share/glint above it; last where make install was to put them.
 * $GLINT_LENSES, a folder of tables, comes before all.
 */
#ifndef GLINT_TOOLS_MODEL_LENS_FILES_H
#define GLINT_TOOLS_MODEL_LENS_FILES_H

#include <stdbool.h>
#include <stddef.h>

/* Sets PATH to the folder number I (0 ...) that may hold KIND, "lenses" or
 * "models". False: there are no more. */
bool lens_folder(int i, const char *kind, char *path, size_t bytes);

/* The table of lens NAME, without .lens. False: there is none. */
bool lens_file_find(const char *name, char *path, size_t bytes);

/* Calls EACH for every lens by name, in order, until it returns false. Returns
 * how many there are, or -1: no memory. */
typedef bool lens_files_fn(void *ctx, const char *name);
int lens_files_each(lens_files_fn *each, void *ctx);

#endif
