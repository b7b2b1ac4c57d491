/* SPDX-License-Identifier: MIT */
#include "tile/edges.h"

#include "base/compiler.h"
#include "base/q.h"

enum { ONE_Q16 = 1 << 16 };

/* What deposits in one tile. */
struct pen {
    uint64_t *sum_q38[3]; /* of the channels that are lit */
    int64_t light_q22[3];
    int n_channels;
    int x0, x1, y0, y1; /* pixels of the tile */
    int tile_log2;
};

/* ------------------------------------------------------------------ deposit
 */

/* Light below 2^43, areas at most 2^16. */
static void add(const struct pen *pen, int at, int64_t area_q16)
{
    for (int c = 0; c < pen->n_channels; c++)
        pen->sum_q38[c][at] += (uint64_t)(pen->light_q22[c] * area_q16);
}

/* A straight piece of an edge within one row: from X0 to X1 (X0 <= X1) over the
 * height HEIGHT, in several pixels. FIRST and LAST are the pixels of its ends,
 * ROW is where the pixel 0 of the row would be. */
static void add_wide(const struct pen *pen, int row, int64_t x0_q16,
                     int64_t x1_q16, int64_t height_q16, int first, int last)
{
    const int64_t size = height_q16 < 0 ? -height_q16 : height_q16;
    const int64_t rise_q32 = (size << 32) / (x1_q16 - x0_q16);
    const int begin = first > pen->x0 ? first : pen->x0;
    const int end = last < pen->x1 - 1 ? last : pen->x1 - 1;
    int64_t before = 0, low, high;

    /* height reached where the edge enters pixel BEGIN */
    low = begin > first ? (rise_q32 * (begin * (int64_t)ONE_Q16 - x0_q16)) >> 32
                        : 0;
    for (int i = begin; i <= end; i++, low = high) {
        const int64_t right_q16 = (i + 1) * (int64_t)ONE_Q16;
        /* how far the ends lie from the right side, twice the mean */
        const int64_t a = i > first ? ONE_Q16 : right_q16 - x0_q16;
        const int64_t b = i < last ? 0 : right_q16 - x1_q16;
        int64_t area;

        high = i < last ? (rise_q32 * (right_q16 - x0_q16)) >> 32 : size;
        area = low + q_shift((high - low) * (a + b), 17);
        add(pen, row + i, height_q16 < 0 ? before - area : area - before);
        before = area;
    }
    if (last + 1 < pen->x1 && last + 1 > pen->x0)
        add(pen, row + last + 1,
            height_q16 < 0 ? before - size : size - before);
}

/* The same for any ends; HEIGHT is positive where the edge runs up. */
static void add_run(const struct pen *pen, int y, int64_t x0_q16,
                    int64_t x1_q16, int64_t height_q16)
{
    const int64_t low = x0_q16 < x1_q16 ? x0_q16 : x1_q16;
    const int64_t high = x0_q16 < x1_q16 ? x1_q16 : x0_q16;
    const int first = (int)(low >> 16);
    const int last = high > low ? (int)((high - 1) >> 16) : first;
    const int row = ((y - pen->y0) << pen->tile_log2) - pen->x0;
    int64_t area;

    if (first >= pen->x1)
        return;
    if (last < pen->x0) {
        add(pen, row + pen->x0, height_q16);
        return;
    }
    if (first < last) {
        add_wide(pen, row, low, high, height_q16, first, last);
        return;
    }
    area = q_shift((height_q16 < 0 ? -height_q16 : height_q16) *
                       (2 * (first + 1) * (int64_t)ONE_Q16 - low - high),
                   17);
    area = height_q16 < 0 ? -area : area;
    add(pen, row + first, area);
    if (first + 1 < pen->x1)
        add(pen, row + first + 1, height_q16 - area);
}

/* An edge, from its upper end to its lower one. */
struct line {
    int64_t x0_q16, y0_q16, x1_q16, y1_q16;
    int64_t slope; /* of x, 2^SHIFT */
    int shift;
};

static void slope_init(struct line *l)
{
    const int64_t dx = l->x1_q16 - l->x0_q16;
    const int wide = bit_length((uint64_t)(dx < 0 ? -dx : dx));

    /* 2^-28 of the height is a step up to 2^12 pixels */
    l->shift = wide > 34 ? 62 - wide : 28;
    l->slope = dx * (INT64_C(1) << l->shift) / (l->y1_q16 - l->y0_q16);
}

/* Where the edge is at height Y: the same for every tile and both directions;
 * never beyond its ends, since the slope is rounded towards 0. */
static int64_t line_at(const struct line *l, int64_t y_q16)
{
    return y_q16 == l->y1_q16 ? l->x1_q16
                              : l->x0_q16 + l->slope * (y_q16 - l->y0_q16) /
                                                (INT64_C(1) << l->shift);
}

static void add_line(const struct pen *pen, struct line *l, int up)
{
    const int64_t top = pen->y0 * (int64_t)ONE_Q16;
    const int64_t bottom = pen->y1 * (int64_t)ONE_Q16;
    const int64_t left = pen->x0 * (int64_t)ONE_Q16;
    const int64_t right = pen->x1 * (int64_t)ONE_Q16;
    const int64_t end = l->y1_q16 < bottom ? l->y1_q16 : bottom;
    const int beside = l->x0_q16 <= left && l->x1_q16 <= left;
    int64_t y = l->y0_q16 > top ? l->y0_q16 : top, x = left;

    if (y >= end || (l->x0_q16 >= right && l->x1_q16 >= right))
        return;
    if (!beside) {
        slope_init(l);
        x = line_at(l, y);
    }
    while (y < end) {
        const int64_t floor_q16 = (y | (ONE_Q16 - 1)) + 1;
        const int64_t next = floor_q16 < end ? floor_q16 : end;
        const int64_t x_next = beside ? left : line_at(l, next);

        if (beside)
            add(pen, (int)((y >> 16) - pen->y0) << pen->tile_log2,
                up ? next - y : y - next);
        else
            add_run(pen, (int)(y >> 16), x, x_next, up ? next - y : y - next);
        y = next;
        x = x_next;
    }
}

static void add_outline(const struct pen *pen, const struct glint_outline *o)
{
    for (int i = 0; i < o->n; i++) {
        const int j = i + 1 < o->n ? i + 1 : 0;
        const int up = o->y_q16[j] < o->y_q16[i];
        const int upper = up ? j : i, lower = up ? i : j;
        struct line line = {.x0_q16 = o->x_q16[upper],
                            .y0_q16 = o->y_q16[upper],
                            .x1_q16 = o->x_q16[lower],
                            .y1_q16 = o->y_q16[lower]};

        if (line.y0_q16 < line.y1_q16)
            add_line(pen, &line, up);
    }
}

/* ---------------------------------------------------------------- primitive
 */

/* The pen's light: irradiance below 2^41 times energy and colour. */
static void ink(struct pen *pen, const struct glint_edges *e,
                const struct glint_bundle *bundle, int64_t irradiance_q22,
                int32_t energy_q16, uint64_t *sum_q38)
{
    const int64_t light_q22 = q_shift(irradiance_q22 * energy_q16, 16);

    pen->n_channels = 0;
    for (int c = 0; c < 3; c++) {
        const int64_t lit_q22 = q_shift(light_q22 * bundle->rgb_q14[c], 14);

        if (lit_q22 == 0)
            continue;
        pen->sum_q38[pen->n_channels] =
            sum_q38 + ((ptrdiff_t)c << (2 * e->tile_log2));
        pen->light_q22[pen->n_channels++] = lit_q22;
    }
}

/* A primitive that is thinner than a strip: its light, spread over one. */
static int64_t strip_light_q22(const struct glint_edges *e,
                               const struct glint_primitive *p,
                               struct glint_outline *o, int share_log2)
{
    const int64_t share_q28 = o->share_q28;
    const int64_t area2_q32 = glint_outline_widen_q32(o);

    return q_shift(glint_irradiance_q22(&e->bundle[p->bundle], share_log2,
                                        area2_q32, 33, e->limit_q8) *
                       (share_q28 >> 8),
                   20);
}

void glint_edges_primitive(const struct glint_edges *edges, int primitive,
                           struct glint_box tile, struct glint_outline *outline,
                           uint64_t *sum_q38)
{
    const struct glint_primitive *p = &edges->primitive[primitive];
    const struct glint_bundle *bundle = &edges->bundle[p->bundle];
    const int cut = p->flags & (GLINT_CUT_STOP | GLINT_CUT_BARREL);
    struct glint_corners c;
    struct pen pen = {.x0 = tile.x0,
                      .x1 = tile.x1,
                      .y0 = tile.y0,
                      .y1 = tile.y1,
                      .tile_log2 = edges->tile_log2};

    glint_corners_gather(&c, edges->vertex, p->vertex,
                         glint_primitive_corners(p));
    for (int k = 0; k < (cut ? c.n - 2 : 1); k++) {
        int64_t light_q22;

        if (cut)
            glint_outline_cut(outline, &c, k, edges->stop, cut);
        else
            glint_outline_whole(outline, &c);
        if (outline->n == 0)
            continue;
        light_q22 = p->flags & GLINT_THIN
                        ? strip_light_q22(edges, p, outline,
                                          p->share_log2 - (cut && c.n == 4))
                        : glint_irradiance_q22(
                              bundle, p->share_log2, c.area2_q16,
                              2 * GLINT_VERTEX_FRAC + 1, edges->limit_q8);
        ink(&pen, edges, bundle, light_q22, outline->energy_q16, sum_q38);
        add_outline(&pen, outline);
    }
}

void glint_edges_finish(const struct glint_edges *edges, struct glint_box tile,
                        int64_t *sum)
{
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < tile.y1 - tile.y0; y++) {
            int64_t *row = sum + (((ptrdiff_t)c << edges->tile_log2 | y)
                                  << edges->tile_log2);
            uint64_t light_q38 = 0;

            for (int x = 0; x < tile.x1 - tile.x0; x++) {
                light_q38 += (uint64_t)row[x];
                row[x] =
                    ((int64_t)light_q38 >> 18) + ((int64_t)light_q38 >> 17 & 1);
            }
        }
}
