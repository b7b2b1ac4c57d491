/* SPDX-License-Identifier: MIT
 *
 * Collects the statistics of a frame of a scene: cost of each object, coverage
 * and highlights.
 */
#ifndef GLINT_TOOLS_SCENES_ACCOUNT_H
#define GLINT_TOOLS_SCENES_ACCOUNT_H

#include "options/json_writer.h"
#include "scenes/scene_frame.h"

/* names of the types of work that are counted */
extern const char *const scene_item_name[GLINT_SCENE_ITEMS];

/* Statistics of the frame drawn last. */
struct scene_account {
    /* cost of each object, [n_objects], owned */
    struct glint_scene_part *objects;
    struct glint_scene_part all;
    struct glint_scene_layered layer[GLINT_KINDS];
};

/* Fills ACCOUNT; scene_account_free() frees it. Returns GLINT_E_MEMORY on
 * failure. */
enum glint_status scene_account_collect_costs(struct scene_account *account,
                                              const struct scene_frame *frame);
void scene_account_free(struct scene_account *account);

/* Writes the statistics of the frame drawn last as members of a JSON object,
 * except those of lights. BYTES is the size of the baked scene. */
void scene_account_write_json(struct json_writer *json,
                              const struct scene_frame *frame, size_t bytes);

/* Writes the JSON member "highlights": a list of the highlights of the frame
 * drawn last. */
void scene_write_highlights_json(struct json_writer *json,
                                 const struct scene_frame *frame);

#endif
