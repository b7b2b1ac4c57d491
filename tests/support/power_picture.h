/* SPDX-License-Identifier: MIT
 *
 * Simulated photographs of lamps with known power: a bright shape, blurred by
 * a Gaussian and by the glare of a lens, over a background, with camera noise.
 */
#ifndef GLINT_TESTS_POWER_PICTURE_H
#define GLINT_TESTS_POWER_PICTURE_H

#include <stdint.h>

#include "support/rng.h"
#include "glint/image.h"

enum power_shape { POWER_DISC, POWER_SQUARE, POWER_TUBE, POWER_SHAPES };

struct power_lamp {
    enum power_shape shape;
    double x, y; /* centre, pixels */
    /* radius of a disc, half the side of a square or length of a tube,
     * pixels */
    double radius;
    double angle; /* radians */
    double sigma; /* standard deviation of the blur, pixels */
    double glare; /* fraction of the light that becomes glare, 0 .. 1 */
    /* Glare at distance r is proportional to (1 + (r / reach)^2)^(-fall /
     * 2); reach in pixels. */
    double reach;
    double fall;
    double rgb[3]; /* colour, of luminance 1 */
};

/* An image in linear light, R, G, B per pixel. */
struct power_picture {
    int width, height;
    double *rgb;
};

/* Sets LIGHT, one value per pixel, to the image of LAMP with power 1. */
void power_draw_lamp(double *light, int width, int height,
                     const struct power_lamp *lamp);

/* Applies LENS to LIGHT: blurs it and adds the glare of all pixels brighter
 * than OVER. */
void power_apply_lens(double *light, int width, int height,
                      const struct power_lamp *lens, double over);

/* Sets RGB to the 8-bit sRGB codes of GAIN times SCENE, plus noise of standard
 * deviation SIGMA codes. */
void power_expose_codes(uint8_t *rgb, const struct power_picture *scene,
                        double gain, double sigma, uint32_t *seed);

#endif
