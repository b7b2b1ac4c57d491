/* SPDX-License-Identifier: MIT
 *
 * glint/measure.h - measures the difference of two pictures in linear light.
 *
 * Both are multiplied so that the reference's 99.9th percentile of luminance
 * over all pixels becomes 1, or by a given factor, then clipped,
 * sRGB-encoded and rounded to 8 bits. Metrics are computed from the codes;
 * if all codes are equal, PSNR from the values before rounding. Flux is
 * compared before clipping. */
#ifndef GLINT_MEASURE_H
#define GLINT_MEASURE_H

#include <stdbool.h>
#include <stdint.h>

#include "glint/image.h"

#ifdef __cplusplus
extern "C" {
#endif

struct glint_measure {
    double psnr_db; /* dB, over the three channels; 999 if nothing differs, even
                       before rounding */
    /* Structural similarity of luma, 8 x 8 blocks every 4 pixels. */
    double ssim;
    double p99;      /* 99th percentile of |difference|, codes */
    double flux;     /* sum of the test's light / sum of the reference's */
    double factor;   /* factor that the test was multiplied by */
    double exposure; /* factor that the reference was multiplied by */
    bool same_codes; /* true: all codes are equal; set by glint_measure_at() */
};

/* Returns the factor that makes the 99.9th percentile of luminance 1; 1 for a
 * black picture. */
double glint_measure_exposure(const struct glint_float_image *image);

/* Returns the sRGB code of LIGHT, 1 being white, 0 .. 255, not rounded. */
double glint_measure_code(double light);

/* Returns IMAGE times EXPOSURE as sRGB codes, [height][width][3], which the
 * caller frees; NULL if memory is short. */
uint8_t *glint_measure_encode(const struct glint_float_image *image,
                              double exposure);

/* Sets PSNR, SSIM and p99 of RESULT, from codes [height][width][3]; other
 * members stay. */
void glint_measure_codes(const uint8_t *reference, const uint8_t *test,
                         int width, int height, struct glint_measure *result);

/* Compares TEST with REFERENCE, of the same size, exposed by the reference.
 * FIT: TEST is first multiplied by the factor that minimises the squared
 * difference. Returns false if memory is short. */
bool glint_measure_compare(const struct glint_float_image *reference,
                           const struct glint_float_image *test, bool fit,
                           struct glint_measure *result);

/* Compares TEST with REFERENCE at EXPOSURE; otherwise as
 * glint_measure_compare(). */
bool glint_measure_at(const struct glint_float_image *reference,
                      const struct glint_float_image *test, bool fit,
                      double exposure, struct glint_measure *result);

#ifdef __cplusplus
}
#endif

#endif
