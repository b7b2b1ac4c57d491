/* SPDX-License-Identifier: MIT
 *
 * glint/scene/environment_bake.h - bakes a panorama to environment light, in
 * double precision.
 *
 *     glint_environment_defaults(&options);
 *     glint_environment_bake(&picture, &options, "night", key, &data, &bytes,
 *                            &report, &error);
 *     glint_environment_open(&environment, data, bytes, &reason);
 *
 *   in a picture in linear light: an equirectangular panorama, twice as wide
 *        as high, forward in the middle, backward at the right edge; or the
 *        3 x 2 faces of a cube, +x +y +z above -x -y -z
 *   out mip levels, irradiance map and list of bright lights, in one file
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
    int side_log2; /* log2 of the side of level 0, GLINT_ENVIRONMENT_LEAST_LOG2
                      .. MOST_LOG2 */
    enum glint_environment_levels levels;
    int max_lights; /* max number of lights, 0 .. GLINT_ENVIRONMENT_MAX_LIGHTS
                     */
    /* Max RMS radius of a light, degrees, 0.1 .. 20. Wider bright spots are not
     * lights. */
    double light_deg;
    /* Lowest luminance of lights, 2 .. 1000, as a factor on the mean luminance
     * of darker texels. Lights are sought at falling thresholds, down to this
     * one. */
    double light_above;
    double turn_deg; /* rotation of the environment about y to the right,
                        degrees, -360 .. 360 */
    double scale;    /* factor on all light, 1e-6 .. 1e6 */
};

/* Results of baking. Luminance has the weights of BT.709. */
struct glint_environment_report {
    int width, height; /* size of the picture, pixels */
    /* Number of pixels with negative values, which were clamped to 0; number of
     * pixels with non-finite values: +inf became the largest finite value, the
     * others 0. */
    long long negative, not_finite;
    double mean, largest; /* mean and max luminance over the sphere */
    /* Max luminance of the texels that remained after the lights were
     * removed. */
    double residual_largest;
    double light_share; /* fraction of all light that comes from the listed
                           lights */
    /* Number of lights that were found; at most max_lights of them are
     * listed. */
    int spots;
};

/* Sets OPTIONS to a side of 256 texels, Gaussian levels and up to 16 lights. */
void glint_environment_defaults(struct glint_environment_options *options);

/* Bakes PICTURE. The file stores KEY and the first 63 characters of NAME that
 * are a-z, A-Z, 0-9, '-' or '_'. *DATA is malloc'ed. Returns GLINT_E_ARGUMENT
 * if OPTIONS are out of range. Returns GLINT_E_UNSUPPORTED if PICTURE has
 * another aspect ratio, or no light that can be scaled. May return
 * GLINT_E_MEMORY. */
enum glint_status
glint_environment_bake(const struct glint_float_image *picture,
                       const struct glint_environment_options *options,
                       const char *name, uint64_t key, unsigned char **data,
                       size_t *bytes, struct glint_environment_report *report,
                       struct glint_error *error);

#define GLINT_ENVIRONMENT_FILE_BYTES 201

/* Parses DATA[BYTES], a text as described in tools/examples/scenes/README.md.
 * Sets SOURCE to the name of the picture, and OPTIONS. On GLINT_E_LENS, ERROR
 * states file, line, column and cause. */
enum glint_status
glint_environment_parse(struct glint_environment_options *options,
                        char source[GLINT_ENVIRONMENT_FILE_BYTES],
                        const char *data, size_t bytes, const char *file_name,
                        struct glint_error *error);

#ifdef __cplusplus
}
#endif

#endif
