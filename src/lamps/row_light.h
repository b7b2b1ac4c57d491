/* SPDX-License-Identifier: MIT
 *
 * Sums the light of the bright stretches of a row once, for the regions of all
 * brightness levels.
 *
 *   in   a row of a picture, and which of its pixels lie in regions
 *   out  the light of any of its runs
 *
 * A stretch is a range of pixels that lie in regions. The same pixel can belong
 * to a region of each level. So prefix sums are computed once per stretch, and
 * the light of a run is the difference of two prefix sums.
 *
 *     glint_row_light_begin_row(row);
 *     for each stretch from the left:
 *         glint_row_light_sum_pixels(row, bright, x0, x1);
 *     glint_row_light_add_run_to_region(row, &region, x0, x1, width, y);
 *
 * Limits: w is at most 2^14 and x below 2^15, so that the sums of w, w x and w
 * x^2 over a row stay below 2^30, 2^44 and 2^59. */
#ifndef GLINT_LAMPS_ROW_LIGHT_H
#define GLINT_LAMPS_ROW_LIGHT_H

#include "lamps/bright.h"
#include "lamps/regions.h"

/* Number of pixels on either side of a run that count to its rim. */
enum { ROW_LIGHT_RIM = 2 };

/* Indices of the elements of a prefix sum with 32 bits. */
enum {
    ROW_LIGHT_W,   /* linear luminance, _q14 */
    ROW_LIGHT_RGB, /* first of six sums: linear R, G, B, _q14, of all pixels,
                      then of pixels without a clipped channel */
    ROW_LIGHT_RIM_RGB = ROW_LIGHT_RGB + 3,
    ROW_LIGHT_SUMS = 8 /* number of sums, a power of two for vectorisation */
};

/* The prefix sums of a column: sums over the pixels of its stretch on its
 * left. */
struct glint_row_sum {
    int32_t of[ROW_LIGHT_SUMS];
    int64_t wx_q14, wx2_q14;
};

struct glint_row_light {
    /* [width + 1]: prefix sums; sum[x] is valid if from[x] is x */
    struct glint_row_sum *sum;
    /* [width + 1]: x if the sum of column x is stored; otherwise the first
     * column of the run of equal pixels that contains x */
    uint16_t *from;
    int end; /* column after the last range of summed pixels (stretch); -1: none
                yet */
};

void glint_row_light_allocate(struct glint_row_light *row,
                              struct glint_arena *arena, int width);

void glint_row_light_begin_row(struct glint_row_light *row);

/* Computes the prefix sums of pixels X0 .. X1 - 1 of the current row of BRIGHT.
 * X0 must not decrease from call to call. */
void glint_row_light_sum_pixels(struct glint_row_light *row,
                                const struct glint_bright *bright, int x0,
                                int x1);

/* Adds the light of pixels X0 .. X1 - 1 of row Y to REGION. Adds the light of
 * ROW_LIGHT_RIM more pixels on both sides to REGION's rim. All these pixels
 * must lie in a stretch or off-screen. WIDTH is the width of the picture. */
void glint_row_light_add_run_to_region(const struct glint_row_light *row,
                                       struct glint_region *region, int x0,
                                       int x1, int width, int y);

#endif
