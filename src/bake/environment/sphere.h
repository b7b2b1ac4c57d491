/* SPDX-License-Identifier: MIT
 *
 * Environment light as an octahedron map (glint/scene/environment.h), in double
 * precision.
 */
#ifndef GLINT_BAKE_ENVIRONMENT_SPHERE_H
#define GLINT_BAKE_ENVIRONMENT_SPHERE_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/scene/environment_bake.h"

struct glint_sphere_texel {
    double light[3];  /* mean radiance of the texel, per channel */
    double weight;    /* solid angle of the texel, sr */
    double toward[3]; /* unit vector to the texel's centre */
};

/* An octahedron map. glint_sphere_allocate() allocates texel;
 * glint_sphere_free() frees it. */
struct glint_sphere {
    int side;
    struct glint_sphere_texel *texel; /* texels of the map, [side][side] */
};

/* Sets TOWARD to the direction of point (U, V) of the octahedron map; U
 * (across) and V (down) are 0 .. 1. Returns the solid angle per unit of map
 * area at that point, sr. */
double glint_sphere_compute_direction(double u, double v, double toward[3]);

/* Sets TOWARD to the direction of the centre of texel I of a map of SIDE x SIDE
 * texels. Returns the solid angle per unit of map area there, sr. */
double glint_sphere_compute_texel_direction(int side, int i, double toward[3]);

/* Sets (U, V) to the point of the octahedron map in direction TOWARD, a unit
 * vector. */
void glint_sphere_locate_direction(const double toward[3], double *u,
                                   double *v);

/* Returns the index of texel (X, Y) of a map of SIDE x SIDE texels. X and Y are
 * -1 .. SIDE; a texel outside the map is replaced by its neighbour on the
 * octahedron. */
size_t glint_sphere_get_texel_index(int side, int x, int y);

double glint_luminance(const double rgb[3]);

/* Allocates a black map of SIDE x SIDE texels. Returns false if there is no
 * memory. */
bool glint_sphere_allocate(struct glint_sphere *sphere, int side);
void glint_sphere_free(struct glint_sphere *sphere);

/* Allocates TO with SIDE x SIDE texels and sets it to FROM, averaged over
 * blocks of texels. SIDE must divide the side of FROM. Returns false if there
 * is no memory. */
bool glint_sphere_downsample(struct glint_sphere *to, int side,
                             const struct glint_sphere *from);

/* panorama.c: projects PICTURE, rotated and scaled by OPTIONS, onto SPHERE,
 * which must be allocated and black. Clamps and counts invalid pixels.
 * Preserves energy. Returns false if the aspect ratio of PICTURE is not
 * supported. */
bool glint_sphere_project_panorama(
    struct glint_sphere *sphere, const struct glint_float_image *picture,
    const struct glint_environment_options *options,
    struct glint_environment_report *report);

/* A light extracted from the map, as a disc. */
struct glint_split_light {
    double toward[3];
    double radius; /* angular radius of the disc, radians */
    /* irradiance of a surface that faces the light, per channel */
    double irradiance[3];
};

/* split.c: moves the brightest lights, at most options->max_lights, from SPHERE
 * to LIGHTS. The mean light around each replaces it in SPHERE. Returns the
 * number of lights, or -1 if there is no memory. */
int glint_sphere_extract_lights(struct glint_sphere *sphere,
                                const struct glint_environment_options *options,
                                struct glint_split_light *lights,
                                struct glint_environment_report *report);

/* levels.c: sets LIGHT[4^SIDE_LOG2][3], one value per texel, to FROM blurred by
 * the kernel exp((c - 1) / SIGMA^2), where c is the cosine between two
 * directions. Returns false if there is no memory. */
bool glint_sphere_blur_light(const struct glint_sphere *from, double sigma,
                             int side_log2, double (*light)[3]);

/* Sets LIGHT[4^SIDE_LOG2][3] to the light that a white diffuse surface reflects
 * under the environment FROM. The direction of a texel is the normal of its
 * surface. */
void glint_sphere_compute_irradiance(const struct glint_sphere *from,
                                     int side_log2, double (*light)[3]);

/* Encodes the light of N texels as RGB with a shared exponent (9E5), in
 * multiples of UNIT, rounded to nearest. Light must be at most 511 * 2^19
 * units. */
void glint_environment_encode_9e5(const double (*light)[3], size_t n,
                                  double unit, uint32_t *code);

#endif
