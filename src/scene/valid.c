/* SPDX-License-Identifier: MIT */
#include "scene/valid.h"

#include "base/q.h"

enum {
    ONE_Q15 = 1 << 15,
    ONE_Q30 = 1 << 30,
    LEAST_ALPHA_Q24 = 1 << 14,
    MAX_REAL_EXPONENT = 200
};

int glint_scene_is_valid_name(const char *name)
{
    int n = 0;

    while (n < GLINT_SCENE_NAME && name[n] > ' ' && name[n] <= '~')
        n++;
    return n > 0 && n < GLINT_SCENE_NAME && name[n] == 0;
}

int glint_scene_is_vector_within(const int32_t *v, int n, int32_t limit)
{
    int fits = 1;

    for (int k = 0; k < n; k++)
        fits &= glint_scene_is_number_in_range(v[k], -(int64_t)limit, limit);
    return fits;
}

int glint_scene_is_unit_vector(const int32_t *v_q30, int n)
{
    int64_t square_q56 = 0;

    if (!glint_scene_is_vector_within(v_q30, n, ONE_Q30 + (1 << 12)))
        return 0;
    for (int k = 0; k < n; k++) /* up to four squares, each below 2^57 */
        square_q56 += q_shift((int64_t)v_q30[k] * v_q30[k], 4);
    return glint_scene_is_number_in_range(
        square_q56 - (INT64_C(1) << 56), -(INT64_C(1) << 37), INT64_C(1) << 37);
}

int glint_scene_is_valid_intensity(const struct glint_real *x)
{
    return x->mantissa == 0 ||
           (x->mantissa >= ONE_Q30 &&
            glint_scene_is_number_in_range(x->exponent, -MAX_REAL_EXPONENT,
                                           MAX_REAL_EXPONENT));
}

int64_t glint_scene_compute_vector_length(const int32_t v[3])
{
    uint64_t square = 0;

    for (int k = 0; k < 3; k++)
        square += (uint64_t)((int64_t)v[k] * v[k]);
    return (int64_t)q_root(square) + 1;
}

int glint_scene_is_object_in_range(const struct glint_scene_model *model,
                                   const struct glint_scene_object *object,
                                   const int32_t at[3])
{
    const struct glint_scene_mesh *mesh;
    int64_t reach = object->radius;

    if (object->kind == GLINT_OBJECT_MESH) {
        mesh = &model->mesh[object->mesh];
        /* The margin is 4 steps: two for rounding of vertices relative to the
         * bounding sphere, and two for rounding of rotations. */
        reach =
            glint_scene_compute_vector_length(mesh->centre) + mesh->radius + 4;
    }
    return reach < GLINT_SCENE_SPAN &&
           glint_scene_is_vector_within(
               at, 3, (int32_t)(GLINT_SCENE_SPAN - 1 - reach));
}

static int are_axes_perpendicular(const int32_t a_q30[3],
                                  const int32_t b_q30[3])
{
    int64_t dot_q56 = 0;

    for (int k = 0; k < 3; k++)
        dot_q56 += q_shift((int64_t)a_q30[k] * b_q30[k], 4);
    return glint_scene_is_number_in_range(dot_q56, -(INT64_C(1) << 37),
                                          INT64_C(1) << 37);
}

const char *glint_scene_check_camera(const struct glint_scene_camera *c)
{
    const int has_x = c->kind != GLINT_CAMERA_LENS;
    const int has_y = c->kind == GLINT_CAMERA_CORNERS;

    if (c->kind > GLINT_CAMERA_LENS)
        return "the scene's camera is of an unknown type";
    if (!glint_scene_is_vector_within(c->at, 3, GLINT_SCENE_SPAN - 1))
        return "the scene's camera is outside the scene's coordinate range";
    for (int k = 0; k < 3; k++)
        if (!glint_scene_is_unit_vector(c->axis_q30[k], 3) ||
            !are_axes_perpendicular(c->axis_q30[k], c->axis_q30[(k + 1) % 3]))
            return "the axes of the scene's camera are not orthogonal unit "
                   "vectors";
    if (!glint_scene_is_number_in_range(c->tan_x_q24, has_x << 12,
                                        has_x << 30) ||
        !glint_scene_is_number_in_range(c->tan_y_q24, has_y << 12, has_y << 30))
        return "the camera's field of view is out of range";
    return NULL;
}

const char *glint_scene_check_metal(const struct glint_scene_ward *w)
{
    for (int k = 0; k < 3; k++)
        if (!glint_scene_is_number_in_range(w->specular_q15[k], 0, ONE_Q15))
            return "a material's weight or colour is not 0 .. 1";
    if (!glint_scene_is_number_in_range(w->alpha_q24[0], LEAST_ALPHA_Q24,
                                        1 << 24) ||
        !glint_scene_is_number_in_range(w->alpha_q24[1], LEAST_ALPHA_Q24,
                                        1 << 24) ||
        w->norm > 1)
        return "the roughness or norm of a brushed metal is out of range";
    return NULL;
}
