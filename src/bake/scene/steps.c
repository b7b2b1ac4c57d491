/* SPDX-License-Identifier: MIT */
#include "bake/scene/write_scene.h"

#include <math.h>

#include "glint/scene/model.h"

/* log2 of the ratio of the run time's coordinate range to the extent of the
 * scene, for scenes without and with planes. Objects may move in the rest of
 * the range. Planes end at the limits of the range: with PLANE_SHARE_LOG2 that
 * is less than a pixel below the horizon. */
#define SHARE_LOG2       2
#define PLANE_SHARE_LOG2 6

static double compute_max_coordinate(const double x[3])
{
    return fmax(fabs(x[0]), fmax(fabs(x[1]), fabs(x[2])));
}

static double compute_vector_length(const double x[3])
{
    return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

/* Returns an upper bound of the distance of the points of object O from the
 * object's origin. */
static double compute_object_reach(const struct glint_description *scene,
                                   const struct glint_described_object *o)
{
    double reach = o->radius;

    /* The factor 2 is needed for the mesh's bounding sphere. Its centre is that
     * of the bounding box, not the origin, and it extends beyond the
     * corners. */
    for (int i = 0; i < o->n_triangles; i++)
        for (int k = 0; k < 3; k++)
            reach =
                fmax(reach,
                     2 * compute_vector_length(
                             scene->triangle[o->first_triangle + i].place[k]));
    return reach;
}

struct glint_steps
glint_steps_choose_size(const struct glint_description *scene, double *reach)
{
    struct glint_steps steps = {.hand = scene->left_handed ? 1 : -1};
    int exponent, share_log2 = SHARE_LOG2;

    *reach = compute_max_coordinate(scene->camera.at);
    for (int i = 0; i < scene->n_lights; i++)
        if (scene->light[i].kind == GLINT_DESCRIBED_LAMP)
            *reach =
                fmax(*reach, fmax(compute_max_coordinate(scene->light[i].at),
                                  scene->light[i].radius));
    for (int i = 0; i < scene->n_objects; i++) {
        *reach =
            fmax(*reach, compute_max_coordinate(scene->object[i].at) +
                             compute_object_reach(scene, &scene->object[i]));
        if (scene->object[i].kind == GLINT_DESCRIBED_PLANE)
            share_log2 = PLANE_SHARE_LOG2;
    }
    if (scene->motion.data)
        *reach = fmax(*reach,
                      scene->motion.reach + 2 * scene->motion.size +
                          scene->motion.foods * fmax(1, scene->motion.shells));
    if (*reach < GLINT_DESCRIPTION_LEAST)
        *reach = GLINT_DESCRIPTION_LEAST;
    frexp(*reach, &exponent); /* sets exponent such that reach < 2^exponent */
    steps.unit_log2 = 28 - share_log2 - exponent;
    steps.scale = ldexp(1, steps.unit_log2);
    return steps;
}

void glint_steps_convert_position(const struct glint_steps *steps,
                                  const double at[3], int32_t to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] =
            (int32_t)lrint(at[i] * steps->scale * (i == 2 ? steps->hand : 1));
}

void glint_steps_convert_unit_vector(const struct glint_steps *steps,
                                     const double x[3], int32_t to_q30[3])
{
    for (int i = 0; i < 3; i++)
        to_q30[i] = (int32_t)lrint(x[i] * 0x1p30 * (i == 2 ? steps->hand : 1));
}

void glint_steps_convert_rotation(const struct glint_steps *steps,
                                  const double turn[4], int32_t to_q30[4])
{
    /* mirroring one axis reverses the rotations about both other axes */
    for (int i = 0; i < 4; i++)
        to_q30[i] = (int32_t)lrint(turn[i] * 0x1p30 *
                                   (i == 1 || i == 2 ? steps->hand : 1));
}

void glint_turn_multiply_quaternions(const double a[4], const double b[4],
                                     double turn[4])
{
    turn[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    turn[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
    turn[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
    turn[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

void glint_described_upright(const double normal[3], double turn[4])
{
    /* With the normal n, the quaternion (1 + y.n, y x n) rotates y to n. It is
     * divided by its length, as a rotation needs a unit quaternion. */
    const double w = 1 + normal[1];
    const double size =
        sqrt(w * w + normal[0] * normal[0] + normal[2] * normal[2]);

    turn[2] = 0;
    if (size < 1e-9) {
        turn[0] = turn[3] = 0;
        turn[1] = 1;
        return;
    }
    turn[0] = w / size;
    turn[1] = normal[2] / size;
    turn[3] = -normal[0] / size;
}
