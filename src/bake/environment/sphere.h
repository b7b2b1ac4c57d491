/* SPDX-License-Identifier: MIT
 *
 * Environment light, as texels of an unfolded octahedron
 * (glint/scene/environment.h), in double precision. */
#ifndef GLINT_BAKE_ENVIRONMENT_SPHERE_H
#define GLINT_BAKE_ENVIRONMENT_SPHERE_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/scene/environment_bake.h"

struct glint_sphere_texel {
    double light[3];  /* mean radiance */
    double weight;    /* solid angle, sr */
    double toward[3]; /* unit vector to its middle */
};

/* Owned: TEXEL is malloc'ed. */
struct glint_sphere {
    int side;
    struct glint_sphere_texel *texel; /* [side][side] */
};

/* Sets TOWARD to the direction of point (U, V) of the square, 0 .. 1 across and
 * down; returns its solid angle / the solid angle of the square. */
double glint_sphere_toward(double u, double v, double toward[3]);

/* Sets TOWARD to the direction of the middle of texel I of a square of SIDE;
 * returns its solid angle / the solid angle of a texel of the square. */
double glint_sphere_middle(int side, int i, double toward[3]);

/* Sets (U, V) to the point of the square in direction TOWARD, a unit vector. */
void glint_sphere_place(const double toward[3], double *u, double *v);

/* Returns the index of texel (X, Y) of a square of SIDE, each -1 .. SIDE, where
 * texels outside the square wrap to their neighbours on the octahedron. */
size_t glint_sphere_index(int side, int x, int y);

double glint_luminance(const double rgb[3]);

/* Makes SPHERE black; returns false without memory. */
bool glint_sphere_open(struct glint_sphere *sphere, int side);
void glint_sphere_close(struct glint_sphere *sphere);

/* Makes TO the means of FROM; the side of TO must divide the side of FROM.
 * Returns false if there is no memory. */
bool glint_sphere_shrink(struct glint_sphere *to, int side,
                         const struct glint_sphere *from);

/* panorama.c: projects PICTURE onto SPHERE, which is open and black, rotated
 * and scaled by OPTIONS; clamps and counts invalid pixels. Preserves the
 * energy. Returns false if the shape of PICTURE is not supported. */
bool glint_sphere_project(struct glint_sphere *sphere,
                          const struct glint_float_image *picture,
                          const struct glint_environment_options *options,
                          struct glint_environment_report *report);

/* A bright light that was separated from the levels: a disc. */
struct glint_split_light {
    double toward[3];
    double radius;        /* radians */
    double irradiance[3]; /* of a surface that faces it */
};

/* split.c: removes up to options->max_lights lights from SPHERE, the strongest,
 * and fills the holes from their surroundings. Returns the number of lights, or
 * -1 if there is no memory. */
int glint_sphere_split(struct glint_sphere *sphere,
                       const struct glint_environment_options *options,
                       struct glint_split_light *lights,
                       struct glint_environment_report *report);

/* levels.c: sets LIGHT[4^SIDE_LOG2][3] to FROM blurred by exp((cos - 1) /
 * SIGMA^2), at the middles of texels. Returns false without memory. */
bool glint_sphere_blur(const struct glint_sphere *from, double sigma,
                       int side_log2, double (*light)[3]);

/* Sets LIGHT[4^SIDE_LOG2][3] to the irradiance of a white surface under FROM,
 * by its normal.
 */
void glint_sphere_irradiance(const struct glint_sphere *from, int side_log2,
                             double (*light)[3]);

/* Writes N texels as the codes nearest to their light in units of UNIT. No
 * texel may be brighter than 511 * 2^19 units. */
void glint_environment_put_9e5(const double (*light)[3], size_t n, double unit,
                               uint32_t *code);

#endif
