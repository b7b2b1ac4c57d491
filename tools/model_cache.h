/* SPDX-License-Identifier: MIT
 *
 * Models of lens tables, baked when first needed and kept.
 *
 * They lie in $XDG_CACHE_HOME/glint, or ~/.cache/glint, under the lens's name
 * and a key of its contents and the options, so that a change of either finds
 * no old model. Where nothing can be kept, nothing is.
 */
#ifndef GLINT_TOOLS_MODEL_CACHE_H
#define GLINT_TOOLS_MODEL_CACHE_H

#include "model_file.h"

/* The model of LENS by OPTIONS, whose workers and progress are set here.
 * Returns an exit code; has printed on failure. */
int model_cached(const struct tool *tool, const struct glint_prescription *lens,
                 struct glint_bake_options options, struct model_file *model);

/* Where FILE is kept, whose folder is made. False: nowhere. */
bool model_cache_path(char *path, size_t bytes, const char *file);

#endif
