/* SPDX-License-Identifier: MIT
 *
 * Maps of objects that are of stone: which place of it each texel is. */
#ifndef GLINT_BAKE_SCENE_SKIN_H
#define GLINT_BAKE_SCENE_SKIN_H

#include "bake/table/draft.h"
#include "glint/scene/description.h"
#include "glint/scene/model.h"

/* Returns the index of the translucent material of OBJECT, or -1. */
int glint_skin_material(const struct glint_description *scene,
                        const struct glint_described_object *object);

/* Writes the table of SKIN, of OBJECT, whose triangles are MESH in DRAFT (of a
 * ball NULL) and whose material is MATERIAL. Returns false without memory, or
 * with an ERROR: two places of a mesh have one texel, or none has any. */
bool glint_skin_write(struct glint_draft *draft,
                      const struct glint_description *scene,
                      const struct glint_described_object *object,
                      const struct glint_scene_mesh *mesh, int material,
                      struct glint_scene_skin *skin, struct glint_error *error);

#endif
