/* SPDX-License-Identifier: MIT
 *
 * Checks that the values of a scene are in range: the values in its file, and
 * values that a program sets. */
#ifndef GLINT_SCENE_VALID_H
#define GLINT_SCENE_VALID_H

#include "glint/scene/model.h"

/* Returns the text of an error in the parameters of CAMERA, or NULL if they are
 * valid. */
const char *glint_scene_check_camera(const struct glint_scene_camera *camera);

/* Returns the text of an error in the parameters of brushed metal, or NULL if
 * they are valid. */
const char *glint_scene_check_metal(const struct glint_scene_ward *ward);

/* Returns whether NAME has 1 .. GLINT_SCENE_NAME - 1 printable characters, no
 * spaces, and a final 0 byte. */
int glint_scene_is_valid_name(const char *name);

/* Returns whether X is in LO .. HI. */
static inline int glint_scene_is_number_in_range(int64_t x, int64_t lo,
                                                 int64_t hi)
{
    return x >= lo && x <= hi;
}

/* Returns whether each of the N components of V is within +-LIMIT. */
int glint_scene_is_vector_within(const int32_t *v, int n, int32_t limit);

/* Returns whether X is 0, or positive and a normalised glint_real. */
int glint_scene_is_valid_intensity(const struct glint_real *x);

/* Returns whether V[N] is a unit vector to within 2^-20. N must be 1 .. 4. */
int glint_scene_is_unit_vector(const int32_t *v_q30, int n);

/* Returns an upper bound of the length of V, at most 1 above it. Components
 * must be within +-2^30. */
int64_t glint_scene_compute_vector_length(const int32_t v[3]);

/* Returns whether OBJECT, at position AT, stays within the range of scene
 * coordinates in any rotation. */
int glint_scene_is_object_in_range(const struct glint_scene_model *model,
                                   const struct glint_scene_object *object,
                                   const int32_t at[3]);

#endif
