/* SPDX-License-Identifier: MIT
 *
 * glint/measure.h - measures the difference of two pictures in linear light.
 *
 * Both pictures are multiplied by the same factor, clipped, sRGB-encoded and
 * rounded to 8 bits. The caller passes the factor. Otherwise it is the factor
 * that makes the 99.9th percentile of the reference's luminance 1. Metrics are
 * computed from the codes; if all codes are equal, PSNR is computed from the
 * values before rounding. Flux is compared before clipping. */
#ifndef GLINT_MEASURE_H
#define GLINT_MEASURE_H

#include <stdbool.h>
#include <stdint.h>

#include "glint/image.h"

#ifdef __cplusplus
extern "C" {
#endif

struct glint_measure {
    /* Peak signal-to-noise ratio over the three channels, dB; 999 if all values
     * are equal even before rounding. */
    double psnr_db;
    /* Structural similarity of luma, 8 x 8 blocks every 4 pixels. */
    double ssim;
    double p99;      /* 99th percentile of |difference|, codes */
    double flux;     /* (sum of the light of the test picture) / (sum of the
                        light of the reference) */
    double factor;   /* factor that the test picture was multiplied by to fit
                        the reference */
    double exposure; /* factor that the reference was multiplied by before it
                        was encoded */
    bool same_codes; /* true: all codes are equal; set by glint_measure_at() */
};

/* Returns the factor that makes the 99.9th percentile of luminance 1; 1 for a
 * black picture. */
double glint_measure_exposure(const struct glint_float_image *image);

/* Returns the sRGB code of LIGHT (1 = white), 0 .. 255, not rounded. */
double glint_measure_code(double light);

/* Returns IMAGE times EXPOSURE as sRGB codes, [height][width][3], or NULL if
 * there is no memory. The caller frees the result. */
uint8_t *glint_measure_encode(const struct glint_float_image *image,
                              double exposure);

/* Sets PSNR, SSIM and p99 of RESULT from codes [height][width][3]; other
 * members are unchanged. */
void glint_measure_codes(const uint8_t *reference, const uint8_t *test,
                         int width, int height, struct glint_measure *result);

/* Compares TEST with REFERENCE, which has the same size, at the exposure
 * glint_measure_exposure() of REFERENCE. If FIT is true, TEST is first
 * multiplied by the factor that minimises the squared difference. Returns false
 * if there is no memory. */
bool glint_measure_compare(const struct glint_float_image *reference,
                           const struct glint_float_image *test, bool fit,
                           struct glint_measure *result);

/* Like glint_measure_compare(), but at the exposure EXPOSURE. */
bool glint_measure_at(const struct glint_float_image *reference,
                      const struct glint_float_image *test, bool fit,
                      double exposure, struct glint_measure *result);

#ifdef __cplusplus
}
#endif

#endif
