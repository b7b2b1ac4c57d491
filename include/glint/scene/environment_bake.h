/* SPDX-License-Identifier: MIT
 *
 * glint/scene/environment_bake.h - a panorama becomes a baked
 * environment, in double precision.
 *
 *     glint_environment_defaults(&options);
 *     glint_environment_bake(&picture, &options, "night", key, &data, &bytes,
 *                            &report, &error);
 *     glint_environment_open(&environment, data, bytes, &reason);
 *
 *   in   linear light: twice as wide as high, longitudes across and latitudes
 *        down, its middle ahead and its right edge behind; or 3 x 2 faces of a
 *        cube, +x +y +z over -x -y -z
 *   out  levels, irradiance map and list of bright lights, in one file
 *
 * The same picture and options give the same bytes. */
#ifndef GLINT_SCENE_ENVIRONMENT_BAKE_H
#define GLINT_SCENE_ENVIRONMENT_BAKE_H

#include <stddef.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/scene/environment.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

struct glint_environment_options {
    int side_log2; /* GLINT_ENVIRONMENT_LEAST_LOG2 .. MOST_LOG2 */
    enum glint_environment_levels levels;
    int max_lights;     /* 0 .. GLINT_ENVIRONMENT_MAX_LIGHTS */
    double light_deg;   /* rms radius above which a spot is not light, 0.1 .. 20
                         */
    double light_above; /* light is distinguished from the rest down to that
                           many times the mean of what is below it, 2 .. 1000 */
    double turn_deg;    /* about y, to the right; -360 .. 360 */
    double scale;       /* factor of all light, 1e-6 .. 1e6 */
};

/* What baking found and did. Luminance is of BT.709. */
struct glint_environment_report {
    int width, height;              /* of the picture */
    long long negative, not_finite; /* pixels that were clamped to 0, or at the
                                       largest finite value if they were +inf */
    double mean, largest;           /* luminance, over the sphere */
    double residual_largest;        /* of texels, without the lights */
    double light_share;             /* of the list of lights in all light */
    int spots;                      /* that are lights; those listed at most */
};

/* Sets OPTIONS to a side of 256, Gaussian levels, 9e5, 16 lights. */
void glint_environment_defaults(struct glint_environment_options *options);

/* Bakes PICTURE. NAME is kept in the file, its first 63 characters of a-z, A-Z,
 * 0-9, '-' and '_', as is KEY. *DATA is malloc'ed. GLINT_E_ARGUMENT: OPTIONS
 * are out of range. GLINT_E_UNSUPPORTED: PICTURE has another shape, or no light
 * that can be scaled. GLINT_E_MEMORY. */
enum glint_status
glint_environment_bake(const struct glint_float_image *picture,
                       const struct glint_environment_options *options,
                       const char *name, uint64_t key, unsigned char **data,
                       size_t *bytes, struct glint_environment_report *report,
                       struct glint_error *error);

#define GLINT_ENVIRONMENT_FILE_BYTES 201

/* Reads DATA[BYTES], a text as tools/examples/scenes/README.md has it, into
 * SOURCE, the name of the picture, and OPTIONS. GLINT_E_LENS: ERROR states
 * file, line, column and cause. */
enum glint_status
glint_environment_parse(struct glint_environment_options *options,
                        char source[GLINT_ENVIRONMENT_FILE_BYTES],
                        const char *data, size_t bytes, const char *file_name,
                        struct glint_error *error);

#ifdef __cplusplus
}
#endif

#endif
