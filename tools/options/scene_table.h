/* SPDX-License-Identifier: MIT
 *
 * What of a scene needs the offline half: a lens given as a table. Programs
 * that take baked models only have models_only.c instead.
 */
#ifndef GLINT_TOOLS_OPTIONS_SCENE_TABLE_H
#define GLINT_TOOLS_OPTIONS_SCENE_TABLE_H

#include "options/scene.h"

/* Reads lens NAME and finds or bakes its model, unless rays are exact. Returns
 * an exit code; has printed on failure. */
int scene_open_table(const struct tool *tool, struct scene *scene,
                     const char *name);

/* What a model for SCENE, whose lens has been read, is baked with. */
struct glint_bake_options scene_bake_options(const struct scene *scene);

/* Its setup where there is no model. */
enum glint_status scene_table_setup(struct scene *scene,
                                    struct glint_error *error);

/* What traces its rays where there is no model. */
const struct glint_frame_rays *scene_table_rays(void);

#endif
