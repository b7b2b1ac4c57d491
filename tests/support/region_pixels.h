/* SPDX-License-Identifier: MIT
 *
 * Sums the moments of image regions pixel by pixel: the reference for the
 * library's sums over whole rows.
 */
#ifndef GLINT_TESTS_SUPPORT_REGION_PIXELS_H
#define GLINT_TESTS_SUPPORT_REGION_PIXELS_H

#include "lamps/regions.h"

/* Adds pixels X0 .. X1 - 1 of row Y, all with the same light, to the moments
 * and colour of SUM. */
static inline void region_add_pixels(struct glint_region *sum,
                                     const struct glint_region_light *light,
                                     int x0, int x1, int y)
{
    const int64_t n = x1 - x0, w_q14 = light->w_q14;
    const int64_t r2 = region_sum_squares_below(x1) -
                       region_sum_squares_below(x0) + n * ((int64_t)y * y);

    sum->w_q14 += w_q14 * n;
    sum->wx_q14 += w_q14 * (n * (x0 + x1 - 1) / 2);
    sum->wy_q14 += w_q14 * n * y;
    sum->wr2_q14 += (uint64_t)w_q14 * (uint64_t)r2;
    for (int i = 0; i < 3; i++)
        sum->rgb_q14[i] += light->rgb_q14[i] * n;
}

#endif
