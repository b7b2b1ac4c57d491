/* SPDX-License-Identifier: MIT */
#include "flare/edges/edge.h"

#include <stddef.h>

#include "base/compiler.h"
#include "base/divide.h"
#include "base/q.h"

#define ONE_Q40 (INT64_C(1) << 40)

/* Returns ACROSS / DOWN, the slope of an edge, rounded towards 0. DOWN must be
 * above 0, and both magnitudes below 2^30. The error is at most 2^-31 of the
 * result plus one unit. */
static int64_t compute_slope_q40(int32_t across, int32_t down)
{
    const int up = q_count_normalising_shift((uint32_t)down);
    const int64_t r = q_reciprocal((uint32_t)down << up);
    const int64_t size_q40 = (across < 0 ? -across : across) * r >> (31 - up);

    return across < 0 ? -size_q40 : size_q40;
}

int glint_edge_set_from_points(struct glint_edge *edge, const int32_t a_q8[2],
                               const int32_t b_q8[2], int32_t light,
                               int32_t other)
{
    const int up = b_q8[1] < a_q8[1];
    const int32_t *upper = up ? b_q8 : a_q8, *lower = up ? a_q8 : b_q8;

    if (a_q8[1] == b_q8[1])
        return 0;
    *edge = (struct glint_edge){.x_q8 = upper[0],
                                .y_q8 = upper[1],
                                .end_y_q8 = lower[1],
                                .slope_q40 = compute_slope_q40(
                                    lower[0] - upper[0], lower[1] - upper[1]),
                                .left = up ? other : light,
                                .right = up ? light : other};
    return 1;
}

/* Half a pixel is added to x, so that truncation rounds to the nearest
 * pixel. */
void glint_edge_snap_to_pixels(struct glint_edge *edge)
{
    edge->x_q8 += edge->whole ? 0 : 128;
    edge->whole = 1;
}

/* -------------------------------------------------------------------- bins */

enum visit { COUNT, PUT, SPAN };

/* Returns the index of the tile that contains column X, counted from the left.
 * X is clamped to LAST, the last column of the region. */
static inline int find_tile_column(int x, int last, int log2)
{
    return (x < 0 ? 0 : x > last ? last : x) >> log2;
}

/* Visits the tiles that edge E crosses, one row of tiles after the other. If E
 * is a patch, visits the tiles that its bounding box overlaps. Counts an entry
 * in each tile, or stores INDEX in it. Parts of E left of the region count to
 * the region's first column. Returns the number of tiles visited. */
static WHOLLY_INLINE int visit_crossed_tiles(const struct glint_edge *e,
                                             const struct glint_bins *bins,
                                             enum visit visit, int32_t index)
{
    const struct glint_box *r = &bins->region;
    const int log2 = bins->tile_log2, last = r->x1 - 1 - r->x0;
    const int32_t end_q8 = q_smaller(e->end_y_q8, r->y1 * 256);
    int32_t y_q8 = q_larger(e->y_q8, r->y0 * 256);
    const int row = ((y_q8 >> 8) - r->y0) >> log2;
    int32_t floor_q8 = (r->y0 + ((row + 1) * (1 << log2))) * 256;
    int32_t *start = bins->start + (ptrdiff_t)row * bins->tiles_x;
    int64_t x_q40 = compute_edge_x_q40(e, y_q8) - r->x0 * ONE_Q40;
    int n = 0;

    if (e->patch && e->whole)
        return 0;
    while (y_q8 < end_q8) {
        const int32_t next_q8 = q_smaller(end_q8, floor_q8);
        const int64_t next_q40 = x_q40 + e->slope_q40 * (next_q8 - y_q8);
        const int x = (int)(x_q40 >> 40);
        const int next_x = e->patch ? e->right - r->x0 : (int)(next_q40 >> 40);
        const int low = q_smaller(x, next_x), high = q_larger(x, next_x);

        if (low <= last)
            for (int k = find_tile_column(low, last, log2);
                 k <= find_tile_column(high, last, log2); k++) {
                n++;
                if (visit == PUT)
                    bins->ref[start[k]] = index;
                if (visit != SPAN)
                    start[k]++;
            }
        y_q8 = next_q8;
        x_q40 = next_q40;
        floor_q8 += 256 << log2;
        start += bins->tiles_x;
    }
    return n;
}

int glint_edge_count_into_bins(const struct glint_edge *edge,
                               struct glint_bins *bins)
{
    return visit_crossed_tiles(edge, bins, COUNT, 0);
}

void glint_edge_put_into_bins(const struct glint_edge *edge,
                              struct glint_bins *bins, int32_t index)
{
    visit_crossed_tiles(edge, bins, PUT, index);
}

int glint_edge_count_bin_entries(const struct glint_edge *edge,
                                 const struct glint_bins *bins)
{
    return visit_crossed_tiles(edge, bins, SPAN, 0);
}
