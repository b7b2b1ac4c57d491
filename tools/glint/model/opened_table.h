/* SPDX-License-Identifier: MIT
 *
 * Opens a lens from its table, which needs the offline half (ray tracing and
 * baking). Programs that accept only baked models link models_only.c instead.
 */
#ifndef GLINT_TOOLS_MODEL_OPENED_TABLE_H
#define GLINT_TOOLS_MODEL_OPENED_TABLE_H

#include "model/opened_lens.h"

/* Reads the table NAME and finds or bakes its model, unless rays are exact.
 * Returns an exit code, after printing the reason on failure. */
int opened_table_open(const struct tool *tool, struct opened_lens *lens,
                      const struct settings *settings, const char *name);

/* Returns the bake options for LENS that SETTINGS imply. */
struct glint_bake_options
opened_table_bake_options(const struct glint_prescription *lens,
                          const struct settings *settings);

/* Sets up LENS, which must have no model, with the stop and colours of
 * CAMERA, by glint_engine_setup(). */
enum glint_status
opened_table_make_setup(struct opened_lens *lens,
                        const struct glint_engine_camera *camera,
                        struct glint_error *error);

/* Returns the functions that trace a frame's rays exactly, without a model. */
const struct glint_frame_rays *opened_table_ray_functions(void);

#endif
