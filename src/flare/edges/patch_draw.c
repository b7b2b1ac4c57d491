/* SPDX-License-Identifier: MIT
 *
 * Draws patches (patch.h): adds their light to the sums of a tile, row by row.
 * Like the light of edges, it is stored as differences between neighbouring
 * pixels. */
#include <stddef.h>

#include "base/compiler.h"
#include "base/divide.h"
#include "base/q.h"
#include "flare/edges/patch.h"

enum {
    ONE_Q16 = 1 << 16,
    HALF_Q16 = 1 << 15,
    MOST_TILE = 64,
    RUN_LOG2 = 3, /* log2 of the number of pixels of a run */
    RUN = 1 << RUN_LOG2,
    STEEP_Q16 = 1 << 10 /* min magnitude of across_q16 of a steep side; flatter
                           sides do not limit the columns of a row */
};

/* A side of a patch, as a linear function of the pixel. The value is the
 * distance of the pixel's centre from the side, positive inside, in pixels /
 * (|x| + |y|), where (x, y) is the side's unit normal. */
struct side {
    int64_t at_q24; /* value of the function at the centre of the box's first
                       pixel */
    int32_t across_q16, down_q16;
    /* Coefficients for the covered fraction of a pixel. p and q are the
     * magnitudes of the components of the scaled normal, p <= q. less is p,
     * square is 1 / (2 p q), larger is 1 / q. */
    int32_t less_q16, square_q16, larger_q16;
    /* The column at which the function is -1/2 in row 0 (column), and its
     * change per row (step). Not set if the side is nearly horizontal. */
    int64_t column_q16, step_q16;
};

/* A side of the patch that cuts pixels of the current row. */
struct part {
    const struct side *side;
    int64_t at_q16; /* value of the side's function at the row's first pixel */
};

struct draw {
    const struct glint_edge_sums *sums;
    struct glint_patch patch;
    struct side side[GLINT_OUTLINE_CORNERS];
    /* node: nodes of the patch's mip level of the stop's transmission. run:
     * nodes of the level whose node distance is two runs of pixels; NULL if
     * there is no such level. */
    const uint16_t *node_q15, *run_q15;
    int run_nodes, run_shift;
    uint32_t once_q24[2], twice_q24[2]; /* change of the position in the stop
                                           per pixel (once) and per two pixels
                                           (twice) */
    int nodes, shift;     /* number of nodes per side of the level; 2^shift is
                             their distance in the stop, _q24 */
    struct glint_box box; /* pixels of the patch's box within the tile */
    /* The current row. part: the sides of the patch that cut its pixels. area:
     * for each pixel, the transmission minus that which edges draw (1 or 0),
     * times the covered area; a 0 follows. */
    int n_parts;
    struct part part[GLINT_OUTLINE_CORNERS];
    int32_t area[MOST_TILE + 2 * RUN];
};

STATIC_ASSERT(sizeof(struct draw) <= GLINT_PATCH_SCRATCH);

static int32_t compute_magnitude(int32_t x)
{
    return x < 0 ? -x : x;
}

static void set_patch_side(struct side *s, const struct draw *d, int i)
{
    const struct glint_patch *p = &d->patch;
    const int next = i + 1 < p->n ? i + 1 : 0;
    const int64_t dx = (int64_t)p->x_q8[next] - p->x_q8[i];
    const int64_t dy = (int64_t)p->y_q8[next] - p->y_q8[i];
    const int64_t all = (dx < 0 ? -dx : dx) + (dy < 0 ? -dy : dy);
    int32_t larger_q16;

    if (all == 0) {
        *s = (struct side){.at_q24 = INT64_C(1) << 40};
        return;
    }
    s->across_q16 = (int32_t)q_divide(-dy * ONE_Q16, all);
    s->down_q16 = (int32_t)q_divide(dx * ONE_Q16, all);
    s->at_q24 = (d->box.x0 * 256 + 128 - p->x_q8[i]) * (int64_t)s->across_q16 +
                (d->box.y0 * 256 + 128 - p->y_q8[i]) * (int64_t)s->down_q16;
    s->less_q16 = q_smaller(compute_magnitude(s->across_q16),
                            compute_magnitude(s->down_q16));
    larger_q16 = q_larger(ONE_Q16 - s->less_q16, HALF_Q16);
    s->larger_q16 = (int32_t)q_divide(INT64_C(1) << 32, larger_q16);
    if (compute_magnitude(s->across_q16) > STEEP_Q16) {
        s->column_q16 =
            q_divide(-((s->at_q24 >> 8) + HALF_Q16) * ONE_Q16, s->across_q16);
        s->step_q16 = q_divide(-(int64_t)s->down_q16 * ONE_Q16, s->across_q16);
    }
    s->square_q16 =
        s->less_q16 > 64
            ? (int32_t)q_divide((int64_t)s->larger_q16 << 15, s->less_q16)
            : 0;
}

/* Returns the fraction of a pixel that lies inside side S. DISTANCE is the
 * function of S at the pixel's middle. */
static int32_t compute_inside_fraction_q16(const struct side *s,
                                           int64_t distance_q16)
{
    const int upper = distance_q16 > 0;
    /* distance from the side to that corner of the pixel that lies farthest
     * outside */
    const int64_t t_q16 = HALF_Q16 - (upper ? distance_q16 : -distance_q16);
    int64_t part_q16;

    if (t_q16 <= 0)
        return upper ? ONE_Q16 : 0;
    if (t_q16 < s->less_q16 && s->square_q16)
        part_q16 = (t_q16 * t_q16 >> 16) * s->square_q16 >> 16;
    else
        part_q16 = (t_q16 - s->less_q16 / 2) * s->larger_q16 >> 16;
    part_q16 = part_q16 < 0 ? 0 : part_q16 > HALF_Q16 ? HALF_Q16 : part_q16;
    return (int32_t)(upper ? ONE_Q16 - part_q16 : part_q16);
}

/* Returns the fraction of pixel X of the current row that lies in the patch. */
static int32_t compute_pixel_cover_q16(const struct draw *d, int x)
{
    int64_t cover_q16 = ONE_Q16;

    for (int i = 0; i < d->n_parts && cover_q16 > 0; i++) {
        const struct part *p = &d->part[i];
        const int64_t at_q16 = p->at_q16 + (int64_t)x * p->side->across_q16;

        if (at_q16 < HALF_Q16)
            cover_q16 =
                cover_q16 * compute_inside_fraction_q16(p->side, at_q16) >> 16;
    }
    return (int32_t)cover_q16;
}

static int32_t clamp_to_table_q24(int32_t at_q24)
{
    const int32_t one = 1 << 24;

    return at_q24 < -one ? 0 : at_q24 >= one ? 2 * one - 1 : at_q24 + one;
}

/* Returns the transmission at position (S, T) in the stop, stop radii,
 * interpolated between the four nodes around it. */
static inline int32_t interpolate_shade_light_q15(const struct draw *d,
                                                  int32_t s_q24, int32_t t_q24)
{
    const uint32_t x = (uint32_t)clamp_to_table_q24(s_q24),
                   y = (uint32_t)clamp_to_table_q24(t_q24);
    const uint32_t u = x >> (d->shift - 8) & 255, v = y >> (d->shift - 8) & 255;
    const uint16_t *at =
        d->node_q15 + (y >> d->shift) * (uint32_t)d->nodes + (x >> d->shift);
    const uint32_t low = at[0] * (256 - u) + at[1] * u;
    const uint32_t high = at[d->nodes] * (256 - u) + at[d->nodes + 1] * u;

    return (int32_t)((low * (256 - v) + high * v + (1 << 15)) >> 16);
}

/* A position in the stop, in stop radii: the point through which the ray of a
 * pixel passes. */
struct place {
    uint32_t at_q24[2]; /* The position is modulo 2^32, as it is used only
                           within the stop. */
};

static struct place compute_stop_position_of_pixel(const struct draw *d, int y,
                                                   int x)
{
    const struct glint_patch *p = &d->patch;
    const uint32_t dx = (uint32_t)(d->box.x0 - p->box.x0 + x);
    const uint32_t dy = (uint32_t)(d->box.y0 - p->box.y0 + y);
    struct place at;

    for (int k = 0; k < 2; k++)
        at.at_q24[k] = (uint32_t)p->at_q24[k] +
                       dx * (uint32_t)p->across_q24[k] +
                       dy * (uint32_t)p->down_q24[k];
    return at;
}

/* Returns the transmission LIGHT minus that which edges draw (1 for a clear
 * stop, else 0), in the units of areas in the sums. */
static inline int32_t convert_light_to_area(const struct draw *d,
                                            int32_t light_q15)
{
    const int32_t off_q15 = light_q15 - d->patch.clear * 32768;

    return d->sums->linear ? off_q15 * 2 : (off_q15 + 64) >> 7;
}

/* Returns whether the run of pixels that begins at AT needs no patch, because
 * the transmission equals that which edges draw. It is read at the nearest node
 * of the mip level whose nodes are two runs apart. */
static int is_run_uniform(const struct draw *d, struct place at)
{
    const struct glint_patch *p = &d->patch;
    int node[2];

    for (int k = 0; k < 2; k++) {
        const uint32_t middle_q24 =
            at.at_q24[k] + RUN / 2 * (uint32_t)p->across_q24[k];

        node[k] = (clamp_to_table_q24((int32_t)middle_q24) +
                   (1 << (d->run_shift - 1))) >>
                  d->run_shift;
    }
    node[0] = d->run_q15[node[1] * d->run_nodes + node[0]];
    return d->patch.clear ? node[0] >= 32766 : node[0] <= 2;
}

static inline int32_t compute_pixel_area(const struct draw *d,
                                         const struct place *at)
{
    return convert_light_to_area(
        d, interpolate_shade_light_q15(d, (int32_t)at->at_q24[0],
                                       (int32_t)at->at_q24[1]));
}

static inline void advance_stop_position(struct place *at,
                                         const uint32_t by_q24[2])
{
    at->at_q24[0] += by_q24[0];
    at->at_q24[1] += by_q24[1];
}

/* Sets the areas of the run of pixels that begins at pixel X; its position in
 * the stop is AT. For linear pictures each pixel is computed. For 8-bit
 * pictures every second pixel is computed, and each pixel between is the mean
 * of its neighbours. Returns nonzero if any area is nonzero. */
static int32_t compute_run_areas(struct draw *d, struct place at, int x)
{
    int32_t any = 0, area = compute_pixel_area(d, &at);

    if (d->sums->linear) {
        for (int i = 0; i < RUN; i++, advance_stop_position(&at, d->once_q24)) {
            d->area[x + i] = compute_pixel_area(d, &at);
            any |= d->area[x + i];
        }
        return any;
    }
    for (int i = 0; i < RUN; i += 2) {
        int32_t next;

        advance_stop_position(&at, d->twice_q24);
        next = compute_pixel_area(d, &at);
        d->area[x + i] = area;
        d->area[x + i + 1] = (area + next) >> 1;
        any |= area | next;
        area = next;
    }
    return any;
}

/* Sets the areas of row Y for all runs of pixels that contain pixels of FROM ..
 * END - 1. The patch's sides are not applied yet. Runs begin at multiples of
 * their length, so that the picture does not depend on tiles. Returns whether
 * any area is nonzero. */
static int compute_uncut_row_areas(struct draw *d, int y, int from, int end)
{
    int any = 0;

    for (int x = from & ~(RUN - 1); x < end; x += RUN) {
        const struct place at = compute_stop_position_of_pixel(d, y, x);

        if (d->run_q15 && is_run_uniform(d, at))
            for (int i = 0; i < RUN; i++)
                d->area[x + i] = 0;
        else
            any |= compute_run_areas(d, at, x);
    }
    return any;
}

static void scale_pixel_area(struct draw *d, int x, int32_t cover_q16)
{
    d->area[x] = (int32_t)(((int64_t)d->area[x] * cover_q16 + HALF_Q16) >> 16);
}

/* Sets the areas of row Y in the columns FROM .. END - 1, which the patch may
 * touch, and weights each by the fraction of the pixel that the patch covers.
 * Returns 0 if all areas are 0. */
static int compute_patch_row_areas(struct draw *d, int y, int from, int end)
{
    int32_t cover;
    int x = from, last = end;

    if (!compute_uncut_row_areas(d, y, from, end))
        return 0;
    for (; x < last && (cover = compute_pixel_cover_q16(d, x)) < ONE_Q16; x++)
        scale_pixel_area(d, x, cover);
    for (; last > x && (cover = compute_pixel_cover_q16(d, last - 1)) < ONE_Q16;
         last--)
        scale_pixel_area(d, last - 1, cover);
    d->area[end] = 0;
    return 1;
}

/* Finds the range of columns FROM .. END - 1 of the box that the patch may
 * touch in row Y. A side limits the range on the left if its function rises
 * with x, on the right if the function falls. */
static void find_row_columns(const struct draw *d, int y, int *from, int *end)
{
    int64_t low = 0, high = d->box.x1 - d->box.x0;

    for (int i = 0; i < d->patch.n; i++) {
        const struct side *s = &d->side[i];
        const int64_t at = (s->column_q16 + y * s->step_q16) >> 16;

        if (s->across_q16 > STEEP_Q16)
            low = at > low ? at : low;
        else if (s->across_q16 < -STEEP_Q16)
            high = at + 2 < high ? at + 2 : high;
    }
    *from = (int)(low < high ? low : high);
    *end = (int)high;
}

/* Lists the sides of the patch that cut pixels of row Y in the columns FROM ..
 * END - 1. */
static void find_cutting_sides(struct draw *d, int y, int from, int end)
{
    d->n_parts = 0;
    for (int i = 0; i < d->patch.n; i++) {
        const struct side *s = &d->side[i];
        const int64_t at_q16 = (s->at_q24 >> 8) + (int64_t)y * s->down_q16;

        if (at_q16 + (int64_t)from * s->across_q16 < HALF_Q16 ||
            at_q16 + (int64_t)(end - 1) * s->across_q16 < HALF_Q16)
            d->part[d->n_parts++] = (struct part){s, at_q16};
    }
}

static void add_areas_to_narrow_sums(uint32_t *row, const int32_t *area, int n,
                                     int64_t light)
{
    uint32_t before = 0;

    for (int x = 0; x <= n; x++) {
        const uint32_t here = (uint32_t)light * (uint32_t)area[x];

        row[x] += here - before;
        before = here;
    }
}

static void add_areas_to_wide_sums(uint64_t *row, const int32_t *area, int n,
                                   int64_t light)
{
    uint64_t before = 0;

    for (int x = 0; x <= n; x++) {
        const uint64_t here = (uint64_t)(light * area[x]);

        row[x] += here - before;
        before = here;
    }
}

/* Adds LIGHT times the areas of the pixels of row Y in the columns FROM .. END
 * - 1 to the sums of the tile. */
static void add_patch_row_to_sums(const struct draw *d, int narrow, int y,
                                  int from, int end, const int64_t light[3])
{
    const struct glint_edge_sums *s = d->sums;
    const int row = d->box.y0 + y - s->tile.y0;
    const int n = end - from;

    for (int c = 0; c < 3; c++) {
        const ptrdiff_t at =
            (ptrdiff_t)((c << s->tile_log2) + row) * s->stride + d->box.x0 -
            s->tile.x0 + from;

        if (light[c] == 0)
            continue;
        s->touched[c] |= UINT64_C(1) << row;
        if (narrow)
            add_areas_to_narrow_sums(s->narrow + at, d->area + from, n,
                                     light[c]);
        else
            add_areas_to_wide_sums(s->wide + at, d->area + from, n, light[c]);
    }
}

static void set_shade_levels(struct draw *d)
{
    const struct glint_shade *s = d->sums->shade;
    const int level = d->patch.level, coarse = level + RUN_LOG2 + 1;

    d->node_q15 = s->level_q15[level];
    d->nodes = (1 << (s->log2 - level)) + 1;
    d->shift = 25 - s->log2 + level;
    d->run_q15 = coarse < s->log2 ? s->level_q15[coarse] : NULL;
    d->run_nodes = d->run_q15 ? (1 << (s->log2 - coarse)) + 1 : 0;
    d->run_shift = 25 - s->log2 + coarse;
    for (int k = 0; k < 2; k++)
        d->once_q24[k] = (uint32_t)d->patch.across_q24[k];
    for (int k = 0; k < 2; k++)
        d->twice_q24[k] = 2 * (uint32_t)d->patch.across_q24[k];
}

void glint_patch_draw(const struct glint_edge_sums *sums, int narrow,
                      const struct glint_edge *e, const int64_t light[3])
{
    struct draw *const d = sums->scratch;
    int from, end;

    glint_patch_read_slots(&d->patch, e);
    d->sums = sums;
    d->box = glint_box_intersect(d->patch.box, sums->tile);
    if (glint_box_is_empty(d->box))
        return;
    d->box.x0 &= ~(RUN - 1);
    set_shade_levels(d);
    for (int i = 0; i < d->patch.n; i++)
        set_patch_side(&d->side[i], d, i);
    for (int y = 0; y < d->box.y1 - d->box.y0; y++) {
        find_row_columns(d, y, &from, &end);
        if (from >= end)
            continue;
        find_cutting_sides(d, y, from, end);
        if (compute_patch_row_areas(d, y, from, end))
            add_patch_row_to_sums(d, narrow, y, from, end, light);
    }
}
