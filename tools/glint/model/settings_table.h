/* SPDX-License-Identifier: MIT
 *
 * The part of the settings that needs the offline half: a lens given as a
 * table. Programs that take baked models only have models_only.c instead.
 */
#ifndef GLINT_TOOLS_MODEL_SETTINGS_TABLE_H
#define GLINT_TOOLS_MODEL_SETTINGS_TABLE_H

#include "model/settings.h"

/* Reads lens NAME and finds or bakes its model, unless rays are exact. Returns
 * an exit code, after printing the reason on failure. */
int settings_open_table(const struct tool *tool, struct settings *settings,
                        const char *name);

/* Returns the options to bake a model with for SETTINGS, whose lens has been
 * read. */
struct glint_bake_options
settings_bake_options(const struct settings *settings);

/* Makes the setup of SETTINGS that have no model, for STOP. */
enum glint_status settings_table_setup(struct settings *settings,
                                       const struct stop_option *stop,
                                       struct glint_error *error);

/* Returns the functions that trace the rays of a frame without a model. */
const struct glint_frame_rays *settings_table_rays(void);

#endif
