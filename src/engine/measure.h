/* SPDX-License-Identifier: MIT
 *
 * How far two pictures in linear light are apart.
 *
 * Both are exposed by the reference (its 99.9th percentile of luminance over
 * all pixels becomes 1) or as is said, clipped, sRGB-encoded and rounded to 8
 * bits; metrics are taken on the codes, PSNR of equal codes on what they were
 * before rounding. Flux is compared before clipping.
 */
#ifndef GLINT_ENGINE_MEASURE_H
#define GLINT_ENGINE_MEASURE_H

#include <stdbool.h>
#include <stdint.h>

#include "glint/image.h"

struct glint_measure {
    double psnr_db; /* over the three channels; 999 where nothing that can be
                       seen differs */
    /* Structural similarity of luma, 8 x 8 blocks every 4 pixels. */
    double ssim;
    double p99;      /* 99th percentile of |difference|, codes */
    double flux;     /* sum of the test's light over the reference's */
    double factor;   /* factor that the test was multiplied by */
    double exposure; /* factor that the reference was multiplied by */
    bool same_codes; /* all codes are equal, as measure_at finds them */
};

/* Returns the factor that makes the 99.9th percentile of luminance 1; 1 for a
 * black picture. */
double glint_measure_exposure(const struct glint_float_image *image);

/* LINEAR times EXPOSURE as sRGB codes, [height][width][3]; NULL: no memory. */
uint8_t *glint_measure_encode(const struct glint_float_image *image,
                              double exposure);

/* The PSNR, SSIM and p99 of codes, [height][width][3]; else RESULT stays. */
void glint_measure_codes(const uint8_t *reference, const uint8_t *test,
                         int width, int height, struct glint_measure *result);

/* Compares TEST with REFERENCE, of one size. FIT: times the factor that fits
 * best in the squares first. False: no memory. */
bool glint_measure_compare(const struct glint_float_image *reference,
                           const struct glint_float_image *test, bool fit,
                           struct glint_measure *result);

/* The same at EXPOSURE. */
bool glint_measure_at(const struct glint_float_image *reference,
                      const struct glint_float_image *test, bool fit,
                      double exposure, struct glint_measure *result);

#endif
