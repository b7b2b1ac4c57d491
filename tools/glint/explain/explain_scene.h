/* SPDX-License-Identifier: MIT
 *
 * Explains the scene of a frame: costs and visibility of objects and lights. */
#ifndef GLINT_TOOLS_COMMAND_EXPLAIN_SCENE_H
#define GLINT_TOOLS_COMMAND_EXPLAIN_SCENE_H

#include "explain/explain.h"
#include "options/json_writer.h"
#include "overlay/drawing.h"
#include "scenes/account.h"

struct explained_scene {
    const struct drawing *drawing;
    /* explanation of the flare; NULL without a lens */
    const struct glint_explain *flare;
    struct scene_account account;
};

/* Fills SCENE; explained_scene_close() frees it. Returns GLINT_E_MEMORY on
 * failure. */
enum glint_status explained_scene_open(struct explained_scene *scene,
                                       const struct drawing *drawing,
                                       const struct glint_explain *flare);
void explained_scene_close(struct explained_scene *scene);

/* Print the explanation of the scene as tables, or as JSON. */
void explain_scene_print_tables(const struct explained_scene *scene);
void explain_scene_write_json(struct json_writer *json,
                              const struct explained_scene *scene);

#endif
