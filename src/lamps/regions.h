/* SPDX-License-Identifier: MIT
 *
 * Finds regions of a picture: sets of bright pixels that are connected by sides
 * or corners.
 *
 *   in   brightness of one row after the other, and the light of its pixels
 *   out  each region once, after the rows have passed it: area, moments, colour
 *
 *     glint_regions_begin_picture(r);
 *     for each row y:
 *         glint_regions_link_row(r, bright, low, y);
 *         for each i below r->here.n_runs: add the pixels of r->here.run[i]
 *                 to *glint_regions_find_region_of_run(r, i);
 *         glint_regions_report_finished(r, done, ctx, y);
 *     glint_regions_report_finished(r, done, ctx, height);
 *
 * Regions are found in one pass. A run is a maximal sequence of pixels above
 * the threshold in a row. It is united with the runs that it touches in the row
 * above (union-find). A region that has no run in the next row is finished, and
 * its label is freed. So twice the max number of runs per row is enough labels
 * for any shape.
 *
 * Limits: the weight w of a pixel is its linear luminance, _q14, 1 .. 2^14.
 * With at most 2^30 pixels of coordinates below 2^15, the sums of w and of w x
 * reach 2^44 and 2^59 at most. The sum of w (x^2 + y^2) is unsigned and may
 * wrap. Only its value relative to the centroid is used, which is at most the
 * sum of w times a quarter of the squared diagonal of the bounding box. If that
 * limit is 2^63 or more, as for a square of 5800 x 5800 white pixels, the RMS
 * radius of the uniformly lit box is returned instead. */
#ifndef GLINT_LAMPS_REGIONS_H
#define GLINT_LAMPS_REGIONS_H

#include <stdint.h>

#include "base/q.h"

struct glint_arena;
struct glint_bright;

/* Sums over the pixels of a region. */
struct glint_region {
    int32_t first; /* index y * width + x of the region's first pixel;
                      identifies the region */
    /* Numbers of pixels: area: all; n_seeds: at or above the upper threshold;
     * n_clipped: with a clipped channel. The caller counts the last two. */
    int32_t area, n_seeds, n_clipped;
    /* Bounding box: columns x0 .. x1 - 1, rows y0 .. y1 - 1. */
    int32_t x0, y0, x1, y1;
    int64_t w_q14, wx_q14, wy_q14;
    uint64_t wr2_q14;
    int64_t rgb_q14[3];     /* sums of linear R, G, B over all pixels */
    int64_t rim_rgb_q14[3]; /* sums of linear R, G, B over pixels without a
                               clipped channel: those of the region, and those
                               up to ROW_LIGHT_RIM pixels beside its runs */
};

/* The light of one pixel, as added to a region. */
struct glint_region_light {
    int64_t w_q14;
    int32_t rgb_q14[3];
};

/* Returns the linear luminance (BT.709) of linear R, G, B, multiplied by
 * 2^15. */
static inline int64_t region_compute_luminance_times_2_15(int64_t r, int64_t g,
                                                          int64_t b)
{
    return r * Q_CONST(0.2126, 15) + g * Q_CONST(0.7152, 15) +
           b * Q_CONST(0.0722, 15);
}

static inline int64_t region_compute_luminance(int64_t r, int64_t g, int64_t b)
{
    return q_shift(region_compute_luminance_times_2_15(r, g, b), 15);
}

/* Converts RGB, the linear light of a pixel, 0 .. white, to the sums that the
 * pixel adds to a region. */
static inline struct glint_region_light
region_compute_pixel_light(const int32_t rgb_q20[3])
{
    struct glint_region_light light;
    /* rounded to _q20, then to _q14 */
    const int64_t seen_q14 = (region_compute_luminance_times_2_15(
                                  rgb_q20[0], rgb_q20[1], rgb_q20[2]) +
                              (1 << 14) + (1 << 20)) >>
                             21;

    light.w_q14 = seen_q14 > 1 ? seen_q14 : 1;
    for (int i = 0; i < 3; i++) /* at most 2^14 */
        light.rgb_q14[i] = (int32_t)q_shift(rgb_q20[i], 20 - 14);
    return light;
}

static inline int64_t region_sum_squares_below(int64_t n)
{
    return (n - 1) * n * (2 * n - 1) / 6;
}

/* Adds the pixels of a run of row Y to the area and the box. */
void glint_region_add_run(struct glint_region *sum, int x0, int x1, int y);

void glint_region_add_region(struct glint_region *sum,
                             const struct glint_region *other);

/* Sets X and Y to the flux-weighted centroid in pixel indices: the centre of
 * the first pixel is 0. */
void glint_region_compute_centroid(const struct glint_region *sum,
                                   int32_t *x_q8, int32_t *y_q8);

/* Returns the RMS distance from the centroid, pixels; 0 for a single pixel. */
int32_t glint_region_compute_rms_radius_q8(const struct glint_region *sum);

/* Sets RGB to the mean colour at luminance 1. */
void glint_region_compute_colour(const struct glint_region *sum,
                                 int32_t rgb_q15[3]);

struct glint_component {
    struct glint_region sum;
    int32_t parent; /* label of the parent in the union-find tree; the parent of
                       a root is the root */
    int32_t last_row;
};

struct glint_run {
    int32_t x0, x1; /* first pixel of the run, and the pixel after its last */
    int32_t label;
    int32_t want0, want1; /* the caller sums the light of pixels want0 .. want1
                             - 1 of the row; both 0: none */
};

struct glint_run_row {
    struct glint_run *run;
    int n_runs;
};

struct glint_regions {
    int width;
    struct glint_run_row above, here;
    struct glint_component *component;
    int32_t *active, *idle; /* labels that are in use, and free labels */
    int n_active, n_idle;
};

/* Allocates the tables for rows of WIDTH pixels from ARENA. If ARENA only
 * measures, only adds up their size. */
void glint_regions_allocate(struct glint_regions *r, struct glint_arena *arena,
                            int width);

void glint_regions_begin_picture(struct glint_regions *r);

/* Fills r->here with the runs of pixels of row Y whose brightness is LOW or
 * more. Assigns each run to the region of the runs that it touches in the row
 * above. LOW must not be below the min brightness that was set for BRIGHT. */
void glint_regions_link_row(struct glint_regions *r,
                            const struct glint_bright *bright, int low, int y);

/* Returns the sums so far of the region to which run I of r->here belongs. */
struct glint_region *glint_regions_find_region_of_run(struct glint_regions *r,
                                                      int i);

/* Receives a finished REGION, which is valid only during the call. */
typedef void glint_region_fn(void *ctx, const struct glint_region *region);

/* Calls DONE for each region that has no run in row Y, and so is finished.
 * Frees the labels of these regions. */
void glint_regions_report_finished(struct glint_regions *r,
                                   glint_region_fn *done, void *ctx, int y);

#endif
