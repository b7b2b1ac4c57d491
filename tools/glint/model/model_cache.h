/* SPDX-License-Identifier: MIT
 *
 * Cache of the models of lens tables. A model is baked when it is first needed.
 *
 * Models are in share/glint/models, if glint was installed with them, or in
 * $XDG_CACHE_HOME/glint, or ~/.cache/glint. A file name contains the lens's
 * name and a hash of table and options, so that an outdated model is never
 * found. If no file can be written, the model is baked in every run.
 */
#ifndef GLINT_TOOLS_MODEL_MODEL_CACHE_H
#define GLINT_TOOLS_MODEL_MODEL_CACHE_H

#include "model/coating.h"
#include "model/model_file.h"

/* Sets MODEL to the model of LENS with OPTIONS: the installed one, else the
 * cached one, else a new one, which is baked and added to the cache. FILE is
 * the lens as named on the command line. COATING has been applied to LENS. If
 * FILE is outside glint's lens folders, it is rejected if its bake exceeds
 * MODEL_CACHE_WORK; glint bake has no such limit. Replaces the members workers,
 * progress and allow of OPTIONS. Returns an exit code, after printing the
 * reason on failure. */
int model_open_cached(const struct tool *tool,
                      const struct glint_prescription *lens, const char *file,
                      struct glint_bake_options options,
                      const struct coating *coating, struct model_file *model);

/* Max work of a bake, in the units that allow() of struct glint_bake_options
 * counts. This corresponds to about 30 s of processor time. */
enum { MODEL_CACHE_WORK = 750 };

/* Returns whether FILE, the lens as named on the command line, is a lens file
 * outside glint's lens folders. */
bool model_is_lens_from_file(const struct glint_prescription *lens,
                             const char *file);

/* Returns whether the model is installed or cached, so that no bake is
 * needed. */
bool model_is_cached(const struct glint_prescription *lens,
                     const struct glint_bake_options *options);

/* Appends "/NAME-KEY.glint" to the folder in PATH. Returns false if the path is
 * too long. */
bool model_cache_append_name(char *path, size_t bytes, const char *lens,
                             uint64_t key);

/* Sets PATH to the path of FILE in the cache folder, and creates the folder.
 * Returns false if there is no cache. */
bool model_cache_make_path(char *path, size_t bytes, const char *file);

#endif
