/* SPDX-License-Identifier: MIT
 *
 * Lamps as a camera takes them, of known power: a shape, blurred by a bell
 * curve and by the glare of a lens, over a background, with noise.
 */
#ifndef GLINT_TESTS_POWER_PICTURE_H
#define GLINT_TESTS_POWER_PICTURE_H

#include <stdint.h>

#include "support/rng.h"
#include "glint/image.h"

enum power_shape { POWER_DISC, POWER_SQUARE, POWER_TUBE, POWER_SHAPES };

struct power_lamp {
    enum power_shape shape;
    double x, y;   /* pixels */
    double radius; /* pixels; of squares half a side, of tubes half a length */
    double angle;  /* radians */
    double sigma;  /* pixels: standard deviation of the bell curve */
    double glare;  /* fraction of the light that becomes glare, 0 .. 1 */
    double reach;  /* pixels: glare falls by (1 + (r / reach)^2)^(-fall / 2) */
    double fall;
    double rgb[3]; /* The luminance is 1. */
};

/* A picture of linear light, three numbers a pixel. */
struct power_picture {
    int width, height;
    double *rgb;
};

/* Sets LIGHT, one number a pixel, to what LAMP gives at power 1. */
void power_draw(double *light, int width, int height,
                const struct power_lamp *lamp);

/* Changes LIGHT into what a camera with LENS sees: blurred, and with the glare
 * of all pixels above OVER. */
void power_see(double *light, int width, int height,
               const struct power_lamp *lens, double over);

/* Writes RGB, 8-bit codes of sRGB, from GAIN times the light SCENE with
 * noise of SIGMA codes. */
void power_expose(uint8_t *rgb, const struct power_picture *scene, double gain,
                  double sigma, uint32_t *seed);

#endif
