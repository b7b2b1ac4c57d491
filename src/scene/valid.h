/* SPDX-License-Identifier: MIT
 *
 * Checks that the values of a scene are in range: those in its file, and those
 * that a program changes.
 */
#ifndef GLINT_SCENE_VALID_H
#define GLINT_SCENE_VALID_H

#include "glint/scene/model.h"

/* Returns the error of a camera as text, or NULL if it is valid. */
const char *glint_scene_camera_fault(const struct glint_scene_camera *camera);

/* Returns the error of the parameters of brushed metal as text, or NULL if
 * they are valid. */
const char *glint_scene_ward_fault(const struct glint_scene_ward *ward);

/* Returns whether NAME is terminated and printable, and not empty. */
int glint_scene_name_fits(const char *name);

/* Returns whether X is in LO .. HI. */
static inline int glint_scene_between(int64_t x, int64_t lo, int64_t hi)
{
    return x >= lo && x <= hi;
}

/* Returns whether each of the N elements of V is within +-LIMIT. */
int glint_scene_within(const int32_t *v, int n, int32_t limit);

/* Returns whether X is 0, or positive and a normalised glint_real. */
int glint_scene_is_light(const struct glint_real *x);

/* Returns whether V[N] is a unit vector to within 2^-20. N must be 1 .. 4. */
int glint_scene_is_unit(const int32_t *v_q30, int n);

/* Returns the length of V, rounded up. V must be within +-2^30. */
int64_t glint_scene_length(const int32_t v[3]);

/* Returns whether OBJECT at AT, in any rotation, stays within the scene's
 * range. */
int glint_scene_fits(const struct glint_scene_model *model,
                     const struct glint_scene_object *object,
                     const int32_t at[3]);

#endif
