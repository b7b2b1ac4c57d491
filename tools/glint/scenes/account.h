/* SPDX-License-Identifier: MIT
 *
 * What there was to do for a scene. */
#ifndef GLINT_TOOLS_SCENES_ACCOUNT_H
#define GLINT_TOOLS_SCENES_ACCOUNT_H

#include "options/json_writer.h"
#include "scenes/scene_frame.h"

/* The name of each item. */
extern const char *const scene_item_name[GLINT_SCENE_ITEMS];

/* What became of the frame that was drawn last. */
struct scene_account {
    struct glint_scene_part *objects; /* [n_objects], malloc'ed */
    struct glint_scene_part all;
    int16_t *seen; /* [height][width]: the object that is seen, or -1 */
    struct glint_scene_layered layer[GLINT_KINDS];
};

/* Sets ACCOUNT; scene_account_free() frees it. GLINT_E_MEMORY. */
enum glint_status scene_account_make(struct scene_account *account,
                                     const struct scene_frame *frame);
void scene_account_free(struct scene_account *account);

/* Returns how many pixels objects hide in the frame that was drawn last, in
 * all. */
int scene_covered_px(const struct scene_frame *frame);

/* Writes members of a JSON object on the frame that was drawn last, but on its
 * lights. BYTES are those of the baked scene. */
void scene_account_json(struct json_writer *json,
                        const struct scene_frame *frame, size_t bytes);

/* Writes "highlights": a list of those of the frame that was drawn last. */
void scene_highlights_json(struct json_writer *json,
                           const struct scene_frame *frame);

#endif
