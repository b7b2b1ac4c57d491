/* SPDX-License-Identifier: MIT
 *
 * The two parts of the check of a baked scene: model.c, what objects are made
 * of, and model_mesh.c, meshes, objects and their maps. */
#ifndef GLINT_SCENE_MODEL_CHECK_H
#define GLINT_SCENE_MODEL_CHECK_H

#include "base/blob.h"
#include "glint/scene/model.h"

struct glint_scene_check {
    struct glint_blob blob;
    struct glint_scene_model model;
};

extern const char glint_scene_outside[]; /* "a table lies outside ..." */

/* Return texts that say what is wrong, or NULL. Objects are checked last: they
 * refer to all else. */
const char *glint_scene_check_mesh(struct glint_scene_check *check,
                                   const struct glint_scene_mesh *mesh);
const char *glint_scene_check_object(const struct glint_scene_check *check,
                                     const struct glint_scene_object *object);

/* Checks stones and skins, but not the files of stones, which the part for them
 * opens. */
const char *glint_scene_check_stones(struct glint_scene_check *check);

/* Returns what is wrong with a camera, or NULL. */
const char *glint_scene_camera_fault(const struct glint_scene_camera *camera);

/* The same of brushed metal. */
const char *glint_scene_ward_fault(const struct glint_scene_ward *ward);

/* Returns whether NAME is terminated and printable, and not empty. */
int glint_scene_name_fits(const char *name);

/* Returns whether each of the N elements of V is within +-LIMIT. */
int glint_scene_within(const int32_t *v, int n, int32_t limit);

/* Returns whether X is 0 or a positive number in the form of glint_real. */
int glint_scene_is_light(const struct glint_real *x);

/* Returns whether V[N], N 1 .. 4, is a unit vector to 2^-20. */
int glint_scene_is_unit(const int32_t *v_q30, int n);

/* Returns whether an object of this kind may be at AT, turned by any unit
 * quaternion. */
int glint_scene_fits(const struct glint_scene_model *model,
                     const struct glint_scene_object *object,
                     const int32_t at[3]);

#endif
