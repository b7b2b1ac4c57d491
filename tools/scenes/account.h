/* SPDX-License-Identifier: MIT
 *
 * What a scene costs to draw, by what there is to do for it. */
#ifndef GLINT_TOOLS_SCENES_ACCOUNT_H
#define GLINT_TOOLS_SCENES_ACCOUNT_H

#include "glint/scene/account.h"
#include "options/json_writer.h"
#include "scenes/scene_frame.h"

/* The name of each item, and its cost in thousand instructions of a processor
 * with 8 lanes of 32 bits. */
struct scene_cost_weight {
    const char *name;
    double kinsn;
};
extern const struct scene_cost_weight scene_cost_weight[GLINT_SCENE_ITEMS];

/* The cost of a pixel of the picture, of a thing that lists of shadows have,
 * and of a triangle of a mesh that is in the picture, likewise. */
enum {
    SCENE_COST_PICTURE,
    SCENE_COST_THINGS,
    SCENE_COST_FACES,
    SCENE_COST_AROUND,
    SCENE_COST_RESTS
};

/* What became of the frame that was drawn last. */
struct scene_account {
    struct glint_scene_part *objects; /* [n_objects], malloc'ed */
    struct glint_scene_part all;
    int16_t *seen; /* [height][width]: the object that is seen, or -1 */
    double rest[SCENE_COST_RESTS]; /* how many of each */
    struct glint_scene_layered layer[GLINT_KINDS];
};

/* Sets ACCOUNT; scene_account_free() frees it. GLINT_E_MEMORY. */
enum glint_status scene_account_make(struct scene_account *account,
                                     const struct scene_frame *frame);
void scene_account_free(struct scene_account *account);

/* Return millions of instructions: of a part, and of the whole frame. */
double scene_cost_part(const struct glint_scene_part *part);
double scene_cost_minsn(const struct scene_account *account);

/* Returns that of a kind of layer of recorded motion: shells, lines, box. */
double scene_cost_layer(const struct scene_account *account,
                        enum glint_scene_kind kind);

/* Returns how many pixels things hide in the frame that was drawn last, in
 * all. */
int scene_covered_px(const struct scene_frame *frame);

/* Writes members of a JSON object on the frame that was drawn last, but on its
 * lights. BYTES are those of the baked scene. Returns the millions of
 * instructions that the frame is told to cost. */
double scene_cost_json(struct json_writer *json,
                       const struct scene_frame *frame, size_t bytes);

/* Writes "highlights": a list of those of the frame that was drawn last. */
void scene_highlights_json(struct json_writer *json,
                           const struct scene_frame *frame);

#endif
