/* SPDX-License-Identifier: MIT
 *
 * Blurs environment light on the sphere.
 *
 * Texels are grouped in square blocks, each enclosed in a cone of directions.
 * A block is skipped if its cone is farther than four sigma from the direction
 * whose blur is computed.
 */
#include "bake/environment/sphere.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/view.h"

enum { BLOCKS = 32 }; /* max number of blocks per side */

/* distance at which the Gaussian is truncated, sigmas; its weight there is
 * 3e-4 */
#define REACH 4.0

struct block {
    /* axis and half angle, radians, of a cone that encloses the block's
     * texels */
    double toward[3], angle;
    /* The block is skipped for directions whose cosine with the cone's axis is
     * below this value. */
    double nearest;
};

static double compute_dot_product(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void compute_block_cone(const struct glint_sphere *s, int i, int j,
                               int side, struct block *b)
{
    double length, cosine = 1;

    memset(b, 0, sizeof *b);
    for (int y = j * side; y < (j + 1) * side; y++)
        for (int x = i * side; x < (i + 1) * side; x++)
            for (int k = 0; k < 3; k++)
                b->toward[k] +=
                    s->texel[glint_sphere_get_texel_index(s->side, x, y)]
                        .toward[k];
    length = sqrt(compute_dot_product(b->toward, b->toward));
    for (int k = 0; k < 3; k++)
        b->toward[k] /= length;
    for (int y = j * side; y < (j + 1) * side; y++)
        for (int x = i * side; x < (i + 1) * side; x++)
            cosine =
                fmin(cosine,
                     compute_dot_product(
                         b->toward,
                         s->texel[glint_sphere_get_texel_index(s->side, x, y)]
                             .toward));
    b->angle = acos(cosine);
}

/* Adds the Gaussian-weighted light of block (I, J), SIDE texels wide, to SUM[0
 * .. 2] (RGB) and its weight to SUM[3]. TOWARD: direction for which the blur is
 * computed. NEAREST: min cosine between it and a texel that counts. */
static void add_block_light(const struct glint_sphere *s, int i, int j,
                            int side, const double toward[3], double sigma,
                            double nearest, double sum[4])
{
    for (int y = j * side; y < (j + 1) * side; y++)
        for (int x = i * side; x < (i + 1) * side; x++) {
            const struct glint_sphere_texel *t =
                &s->texel[glint_sphere_get_texel_index(s->side, x, y)];
            const double cosine = compute_dot_product(toward, t->toward);
            double weight;

            if (cosine < nearest)
                continue;
            weight = t->weight * exp((cosine - 1) / (sigma * sigma));
            for (int c = 0; c < 3; c++)
                sum[c] += weight * t->light[c];
            sum[3] += weight;
        }
}

bool glint_sphere_blur_light(const struct glint_sphere *from, double sigma,
                             int side_log2, double (*light)[3])
{
    const int blocks = from->side < BLOCKS ? from->side : BLOCKS;
    const int side = from->side / blocks, n = 1 << side_log2;
    const double reach = fmin(REACH * sigma, GLINT_PI);
    struct block *block =
        malloc((size_t)blocks * (size_t)blocks * sizeof *block);

    if (!block)
        return false;
    for (int k = 0; k < blocks * blocks; k++) {
        compute_block_cone(from, k % blocks, k / blocks, side, &block[k]);
        block[k].nearest = reach + block[k].angle < GLINT_PI
                               ? cos(reach + block[k].angle)
                               : -2;
    }
    for (int i = 0; i < n * n; i++) {
        double toward[3], sum[4] = {0, 0, 0, 0};

        glint_sphere_compute_texel_direction(n, i, toward);
        for (int k = 0; k < blocks * blocks; k++)
            if (compute_dot_product(toward, block[k].toward) >=
                block[k].nearest)
                add_block_light(from, k % blocks, k / blocks, side, toward,
                                sigma, cos(reach), sum);
        for (int c = 0; c < 3; c++)
            light[i][c] = sum[3] > 0 ? sum[c] / sum[3] : 0;
    }
    free(block);
    return true;
}

void glint_sphere_compute_irradiance(const struct glint_sphere *from,
                                     int side_log2, double (*light)[3])
{
    const int n = 1 << side_log2;
    const size_t texels = (size_t)from->side * (size_t)from->side;

    for (int i = 0; i < n * n; i++) {
        double normal[3], sum[3] = {0, 0, 0};

        glint_sphere_compute_texel_direction(n, i, normal);
        for (size_t k = 0; k < texels; k++) {
            const struct glint_sphere_texel *t = &from->texel[k];
            const double cosine = compute_dot_product(normal, t->toward);

            for (int c = 0; c < 3 && cosine > 0; c++)
                sum[c] += t->weight * cosine * t->light[c];
        }
        for (int c = 0; c < 3; c++)
            light[i][c] = sum[c] / GLINT_PI;
    }
}
