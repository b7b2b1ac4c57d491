/* SPDX-License-Identifier: MIT */
#include "tile/edges.h"

#include "base/compiler.h"
#include "base/q.h"

#define PIXEL_Q40 (INT64_C(1) << 40)
#define ONE_Q16   (INT64_C(1) << 16)

/* --------------------------------------------------------------------- edge
 */

int glint_edge_set(struct glint_edge *edge, const int32_t a_q8[2],
                   const int32_t b_q8[2], int32_t light, int32_t other)
{
    const int up = b_q8[1] < a_q8[1];
    const int32_t *upper = up ? b_q8 : a_q8, *lower = up ? a_q8 : b_q8;

    if (a_q8[1] == b_q8[1])
        return 0;
    *edge = (struct glint_edge){.x_q8 = upper[0],
                                .y_q8 = upper[1],
                                .end_y_q8 = lower[1],
                                .slope_q40 = ((int64_t)lower[0] - upper[0]) *
                                             (INT64_C(1) << 32) /
                                             ((int64_t)lower[1] - upper[1]),
                                .left = up ? other : light,
                                .right = up ? light : other};
    return 1;
}

/* Where EDGE is at height Y, within its own: below 2^29 q8 pixels, so 2^61. The
 * slope is rounded towards 0, so it never lies beyond its ends. */
static int64_t x_at_q40(const struct glint_edge *e, int32_t y_q8)
{
    return e->x_q8 * (INT64_C(1) << 32) + e->slope_q40 * (y_q8 - e->y_q8);
}

static int32_t later(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

static int32_t sooner(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* --------------------------------------------------------------------- bins
 */

/* The pixels that EDGE crosses between two heights; what lies left of REGION is
 * taken for its first column. */
static struct glint_box reach(const struct glint_edge *e,
                              const struct glint_box *region, int32_t top_q8,
                              int32_t bottom_q8)
{
    const int64_t a = x_at_q40(e, top_q8) >> 40;
    const int64_t b = x_at_q40(e, bottom_q8) >> 40;
    const int64_t low = a < b ? a : b, high = a < b ? b : a;
    const int x0 = q_clamp_sat(low, region->x0, region->x1);
    const int x1 = q_clamp_sat(high, region->x0, region->x1);

    return (struct glint_box){x0, top_q8 >> 8, x1 + 1, (bottom_q8 + 255) >> 8};
}

typedef void box_fn(struct glint_bins *bins, struct glint_box box, void *ctx);

/* Calls DO_BOX with a box for each row of tiles. */
static void each_box(const struct glint_edge *e, struct glint_bins *bins,
                     box_fn *do_box, void *ctx)
{
    const struct glint_box *r = &bins->region;
    const int32_t end_q8 = sooner(e->end_y_q8, r->y1 * 256);
    int32_t y_q8 = later(e->y_q8, r->y0 * 256);

    while (y_q8 < end_q8) {
        const int row = ((y_q8 >> 8) - r->y0) >> bins->tile_log2;
        const int32_t floor_q8 =
            (r->y0 + ((row + 1) * (1 << bins->tile_log2))) * 256;
        const int32_t next_q8 = sooner(end_q8, floor_q8);

        do_box(bins, reach(e, r, y_q8, next_q8), ctx);
        y_q8 = next_q8;
    }
}

static void count_box(struct glint_bins *bins, struct glint_box box, void *ctx)
{
    (void)ctx;
    glint_bins_count(bins, box);
}

static void put_box(struct glint_bins *bins, struct glint_box box, void *ctx)
{
    glint_bins_put(bins, box, *(const int32_t *)ctx);
}

static void span_box(struct glint_bins *bins, struct glint_box box, void *ctx)
{
    *(int *)ctx += glint_bins_span(bins, box);
}

void glint_edge_count(const struct glint_edge *edge, struct glint_bins *bins)
{
    each_box(edge, bins, count_box, NULL);
}

void glint_edge_put(const struct glint_edge *edge, struct glint_bins *bins,
                    int32_t index)
{
    each_box(edge, bins, put_box, &index);
}

int glint_edge_span(const struct glint_edge *edge,
                    const struct glint_bins *bins)
{
    struct glint_bins same = *bins;
    int n = 0;

    each_box(edge, &same, span_box, &n);
    return n;
}

/* --------------------------------------------------------------------- add
 */

/* One row of one channel of a tile. */
struct run {
    uint64_t *change_q36; /* where pixel 0 of the picture would be */
    int x0, x1;           /* the tile's columns */
    int64_t light_q20;
};

static void change(const struct run *r, int x, int64_t area_q16)
{
    r->change_q36[x] += (uint64_t)(r->light_q20 * area_q16);
}

/* A piece of an edge within one row, from A to B (A <= B) over HEIGHT, in
 * several pixels. Covered areas rise from pixel to pixel, from 0 to HEIGHT; so
 * much of each as lies in the tile is what it changes by. */
static void add_wide(const struct run *r, int64_t a_q40, int64_t b_q40,
                     int64_t height_q16)
{
    const int64_t first = a_q40 >> 40, last = b_q40 >> 40;
    const int64_t wide_q24 = (b_q40 - a_q40) >> 16;
    const int64_t rise_q40 = (height_q16 << 40) / (wide_q24 ? wide_q24 : 1);
    /* with the last pixel of the tile before, if there is one */
    const int64_t begin = r->x0 > 0 ? r->x0 - 1 : 0;
    const int64_t from = first > begin ? first : begin;
    const int64_t to = last < r->x1 - 1 ? last : r->x1 - 1;
    int64_t before = 0;

    for (int64_t i = from; i <= to; i++) {
        const int64_t left_q24 = i > first ? (i * PIXEL_Q40 - a_q40) >> 16 : 0;
        const int64_t right_q24 = ((i + 1) * PIXEL_Q40 - a_q40) >> 16;
        const int64_t low = (rise_q40 * (left_q24 >> 8)) >> 32;
        const int64_t high =
            i < last ? (rise_q40 * (right_q24 >> 8)) >> 32 : height_q16;
        /* how far the piece's ends lie from the pixel's right side */
        const int64_t p = i > first ? ONE_Q16 : (right_q24 >> 8);
        const int64_t q = i < last ? 0 : ((i + 1) * PIXEL_Q40 - b_q40) >> 24;
        const int64_t area = low + ((high - low) * (p + q) >> 17);

        if (i >= r->x0)
            change(r, (int)i, area - before);
        before = area;
    }
    if (last < r->x1 && last >= r->x0)
        change(r, (int)last + 1, height_q16 - before);
    else if (last < r->x0 && r->x0 == 0)
        change(r, 0, height_q16);
}

/* From A to B, in any order, over HEIGHT. */
static inline void add_piece(const struct run *r, int64_t a_q40, int64_t b_q40,
                             int64_t height_q16)
{
    const int64_t i = a_q40 >> 40;

    if (i == b_q40 >> 40) {
        const int64_t far_q16 =
            2 * ONE_Q16 - ((a_q40 >> 24) & 0xffff) - ((b_q40 >> 24) & 0xffff);
        const int64_t area = (height_q16 * far_q16) >> 17;

        if (i >= r->x0 && i < r->x1) {
            change(r, (int)i, area);
            change(r, (int)i + 1, height_q16 - area);
        } else if (i < 0 && r->x0 == 0)
            change(r, 0, height_q16);
    } else if (a_q40 < b_q40)
        add_wide(r, a_q40, b_q40, height_q16);
    else
        add_wide(r, b_q40, a_q40, height_q16);
}

/* All rows of one channel. */
static void add_channel(const struct glint_edge *e, int64_t light_q20,
                        const struct glint_edge_sums *s, int channel)
{
    const struct glint_box *t = &s->tile;
    const int32_t end_q8 = sooner(e->end_y_q8, t->y1 * 256);
    int32_t y_q8 = later(e->y_q8, t->y0 * 256);
    const int row = (channel << s->tile_log2) + (y_q8 >> 8) - t->y0;
    struct run r = {s->change_q36 + (ptrdiff_t)row * s->stride - t->x0, t->x0,
                    t->x1, light_q20};
    int64_t x_q40 = x_at_q40(e, y_q8);

    for (; y_q8 < end_q8; r.change_q36 += s->stride) {
        const int32_t next_q8 = sooner((y_q8 | 255) + 1, end_q8);
        const int32_t height_q8 = next_q8 - y_q8;
        const int64_t next_q40 = x_q40 + e->slope_q40 * height_q8;

        add_piece(&r, x_q40, next_q40, (int64_t)height_q8 << 8);
        y_q8 = next_q8;
        x_q40 = next_q40;
    }
}

static int64_t coloured_q20(int32_t light, int32_t colour_q14)
{
    const int64_t light_q20 = glint_light_q20(light);

    return colour_q14 == 1 << 14 ? light_q20
                                 : q_shift(light_q20 * colour_q14, 14);
}

void glint_edge_add(const struct glint_edge *edge, const int32_t rgb_q14[3],
                    const struct glint_edge_sums *sums)
{
    for (int c = 0; c < 3; c++) {
        const int64_t light_q20 = coloured_q20(edge->right, rgb_q14[c]) -
                                  coloured_q20(edge->left, rgb_q14[c]);

        if (light_q20 != 0)
            add_channel(edge, light_q20, sums, c);
    }
}

/* ------------------------------------------------------------------- finish
 */

void glint_edge_finish(const struct glint_edge_sums *sums, int channel, int row,
                       int32_t *light_q20)
{
    const int at = (channel << sums->tile_log2) + row;
    uint64_t *sum_q36 = sums->change_q36 + (ptrdiff_t)at * sums->stride;
    uint64_t light_q36 = sums->carry_q36[at];
    const int n = sums->tile.x1 - sums->tile.x0;

    for (int x = 0; x < n; x++) {
        light_q36 += sum_q36[x];
        sum_q36[x] = 0;
        light_q20[x] = q_clamp_sat(((int64_t)light_q36 >> 16) +
                                       ((int64_t)light_q36 >> 15 & 1),
                                   INT32_MIN, INT32_MAX);
    }
    sums->carry_q36[at] = light_q36 + sum_q36[n];
    sum_q36[n] = 0;
}
