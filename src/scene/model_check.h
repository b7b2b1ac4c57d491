/* SPDX-License-Identifier: MIT
 *
 * The check of a baked scene: model.c checks the tables that objects refer to
 * and calls model_mesh.c for meshes, objects and their maps. */
#ifndef GLINT_SCENE_MODEL_CHECK_H
#define GLINT_SCENE_MODEL_CHECK_H

#include "base/blob.h"
#include "glint/scene/model.h"
#include "scene/valid.h"

struct glint_scene_check {
    struct glint_blob blob;
    struct glint_scene_model model;
};

#define OUTSIDE "a table lies outside of the file"

/* Return texts that say what is wrong, or NULL. Objects are checked last: they
 * refer to all else. */
const char *glint_scene_check_mesh(struct glint_scene_check *check,
                                   const struct glint_scene_mesh *mesh);
const char *glint_scene_check_object(const struct glint_scene_check *check,
                                     const struct glint_scene_object *object);

/* Checks stones and skins, but not the files of stones, which the part for them
 * opens. */
const char *glint_scene_check_stones(struct glint_scene_check *check);

#endif
