/* SPDX-License-Identifier: MIT */
#include "bake/environment/sphere.h"

#include <math.h>
#include <stdlib.h>

double glint_sphere_compute_direction(double u, double v, double toward[3])
{
    const double p = 2 * u - 1, q = 2 * v - 1;
    double length;

    toward[1] = 1 - fabs(p) - fabs(q);
    toward[0] = toward[1] < 0 ? copysign(1 - fabs(q), p) : p;
    toward[2] = toward[1] < 0 ? copysign(1 - fabs(p), q) : q;
    length = sqrt(toward[0] * toward[0] + toward[1] * toward[1] +
                  toward[2] * toward[2]);
    for (int k = 0; k < 3; k++)
        toward[k] /= length;
    /* An area dp dq of the square is an area sqrt(3) dp dq of an octahedron
     * face, whose plane is 1 / sqrt(3) from the centre. The factors cancel: its
     * solid angle is dp dq / length^3. */
    return 4 / (length * length * length);
}

double glint_sphere_compute_texel_direction(int side, int i, double toward[3])
{
    const int x = i % side, y = i / side;

    return glint_sphere_compute_direction((x + .5) / side, (y + .5) / side,
                                          toward);
}

void glint_sphere_locate_direction(const double toward[3], double *u, double *v)
{
    const double sum = fabs(toward[0]) + fabs(toward[1]) + fabs(toward[2]);
    const double x = toward[0] / sum, z = toward[2] / sum;
    const bool is_below = toward[1] < 0;

    *u = .5 + .5 * (is_below ? copysign(1 - fabs(z), x) : x);
    *v = .5 + .5 * (is_below ? copysign(1 - fabs(x), z) : z);
}

size_t glint_sphere_get_texel_index(int side, int x, int y)
{
    if (x < 0 || x >= side) {
        x = x < 0 ? 0 : side - 1;
        y = side - 1 - y;
    }
    if (y < 0 || y >= side) {
        y = y < 0 ? 0 : side - 1;
        x = side - 1 - x;
    }
    return (size_t)y * (size_t)side + (size_t)x;
}

double glint_luminance(const double rgb[3])
{
    return .2126 * rgb[0] + .7152 * rgb[1] + .0722 * rgb[2];
}

bool glint_sphere_allocate(struct glint_sphere *sphere, int side)
{
    sphere->side = side;
    sphere->texel = calloc((size_t)side * (size_t)side, sizeof *sphere->texel);
    if (!sphere->texel)
        return false;
    for (int i = 0; i < side * side; i++)
        glint_sphere_compute_texel_direction(side, i, sphere->texel[i].toward);
    return true;
}

void glint_sphere_free(struct glint_sphere *sphere)
{
    free(sphere->texel);
    sphere->texel = NULL;
}

bool glint_sphere_downsample(struct glint_sphere *to, int side,
                             const struct glint_sphere *from)
{
    const int step = from->side / side;

    if (!glint_sphere_allocate(to, side))
        return false;
    for (int y = 0; y < from->side; y++)
        for (int x = 0; x < from->side; x++) {
            const struct glint_sphere_texel *f =
                &from->texel[glint_sphere_get_texel_index(from->side, x, y)];
            struct glint_sphere_texel *t =
                &to->texel[glint_sphere_get_texel_index(side, x / step,
                                                        y / step)];

            for (int c = 0; c < 3; c++)
                t->light[c] += f->weight * f->light[c];
            t->weight += f->weight;
        }
    for (size_t i = 0; i < (size_t)side * (size_t)side; i++)
        for (int c = 0; c < 3; c++)
            to->texel[i].light[c] /= to->texel[i].weight;
    return true;
}
