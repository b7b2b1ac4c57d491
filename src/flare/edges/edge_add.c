/* SPDX-License-Identifier: MIT
 *
 * Adds the light of edges to one tile's sums: smooth edges by the area that
 * they cover in each pixel, pixel-snapped edges by their height in each row.
 * edge.h has the formats. */
#include "flare/edges/edge.h"

#include <stddef.h>

#include "base/compiler.h"
#include "base/divide.h"
#include "base/q.h"

#define ONE_Q16 (INT32_C(1) << 16)
#define ONE_Q40 (INT64_C(1) << 40)

/* An integer type for values below 2^31 that the CPU adds fastest. */
typedef int_fast32_t fast;

/* Width of the sums: 64 bits (WIDE), or 32 bits (NARROW) if the light of the
 * tile stays below MOST_NARROW. */
enum mode { WIDE, NARROW };

/* Number of edges between an edge that is added and the edge that is
 * prefetched. The edges of a tile are scattered in memory. */
enum { AHEAD = 12 };
#define MOST_NARROW (INT64_C(1) << 23)

/* One row of one channel of a tile. Pointers are offset so that index 0 is
 * pixel 0 of the picture. */
struct run {
    union {
        uint64_t *wide;
        uint32_t *narrow;
    } row;      /* sums of the row, wide or narrow by the mode */
    int less;   /* number of low bits of areas (_q16) that are dropped: 0 for
                   linear pictures, 8 for all others */
    int x0, x1; /* the tile's columns */
    int64_t light;
    int64_t rise_q32; /* increase of the covered area per pixel of x */
};

static inline void add_light_change(const struct run *r, enum mode mode, int x,
                                    fast area)
{
    if (mode == NARROW)
        r->row.narrow[x] += (uint32_t)r->light * (uint32_t)area;
    else
        r->row.wide[x] += (uint64_t)(r->light * area);
}

/* Converts AREA, at most one pixel, to the units of the sums. */
static inline fast convert_area_to_sum_units(const struct run *r,
                                             enum mode mode, fast area_q16)
{
    const int less = mode == NARROW ? 8 : r->less;

    return (area_q16 + (1 << less >> 1)) >> less;
}

/* Adds a piece of an edge that lies in one row, runs over several pixels from x
 * = A to B (A <= B) and is HEIGHT high. The covered area rises from 0 to HEIGHT
 * from left to right, and each pixel of the tile gets the increase from the
 * pixel on its left. */
static void add_piece_over_many_pixels(const struct run *r, enum mode mode,
                                       int64_t a_q40, int64_t b_q40,
                                       fast height_q16)
{
    const int first = (int)(a_q40 >> 40), last = (int)(b_q40 >> 40);
    const int64_t a_q16 = a_q40 >> 24, b_q16 = b_q40 >> 24;
    /* The first difference needs the covered area of the pixel left of the
     * tile, if there is one. */
    const int begin = r->x0 > 0 ? r->x0 - 1 : 0;
    const int from = first > begin ? first : begin;
    const int to = last < r->x1 - 1 ? last : r->x1 - 1;
    fast low = 0, before = 0;

    if (from > first)
        low = (fast)(r->rise_q32 * ((int64_t)from * ONE_Q16 - a_q16) >> 32);
    for (int i = from; i <= to; i++) {
        const int64_t side_q16 = (i + INT64_C(1)) * ONE_Q16;
        const fast high = i < last
                              ? (fast)(r->rise_q32 * (side_q16 - a_q16) >> 32)
                              : height_q16;
        /* sum of the distances of the two ends of the piece within this pixel
         * from the pixel's right side */
        const fast far_q16 = (fast)((i > first ? ONE_Q16 : side_q16 - a_q16) +
                                    (i < last ? 0 : side_q16 - b_q16));
        const fast area = convert_area_to_sum_units(
            r, mode, low + (fast)((int64_t)(high - low) * far_q16 >> 17));

        if (i >= r->x0)
            add_light_change(r, mode, i, area - before);
        before = area;
        low = high;
    }
    if (last < r->x1 && last >= r->x0)
        add_light_change(r, mode, last + 1,
                         convert_area_to_sum_units(r, mode, height_q16) -
                             before);
}

/* Returns height / width of an edge with the slope SLOPE; height and width are
 * _q16, the result has 32 fraction bits. The result is limited for edges so
 * steep that x moves by less than 2^-16 pixels per 1/256 pixel of y. */
static int64_t compute_area_rise(int64_t slope_q40)
{
    const int64_t size = slope_q40 < 0 ? -slope_q40 : slope_q40;
    const int64_t least = INT64_C(1) << 24;

    const uint64_t by = (uint64_t)(size > least ? size : least);
    const int up = q_count_normalising_shift(by); /* 7 at most */
    const int64_t r =
        q_reciprocal(q_shift_to_32_bits(by, up)); /* 2^(63 - up) / size */

    /* 1/256 pixel of height is 2^8 in _q16. */
    return (r << 8) >> (7 - up);
}

/* Adds a piece of an edge that lies in one row and in one or two pixels of the
 * tile: from x = A to B (A <= B), HEIGHT high. */
static inline void add_piece_in_two_pixels(const struct run *r, enum mode mode,
                                           fast a_q16, fast b_q16,
                                           fast height_q16)
{
    const int first = (int)(a_q16 >> 16);
    const fast far_q16 = ONE_Q16 - (a_q16 & 0xffff);
    const fast left_q16 = ONE_Q16 - (b_q16 & 0xffff);
    const fast height = convert_area_to_sum_units(r, mode, height_q16);

    if (first == b_q16 >> 16) {
        const int64_t area_q33 = (int64_t)height_q16 * (far_q16 + left_q16);
        const fast area =
            convert_area_to_sum_units(r, mode, (fast)(area_q33 >> 17));

        add_light_change(r, mode, first, area);
        add_light_change(r, mode, first + 1, height - area);
    } else {
        const fast low_q16 = (fast)(r->rise_q32 * far_q16 >> 32);
        const int64_t rest_q33 =
            (int64_t)(height_q16 - low_q16) * (ONE_Q16 + left_q16);
        const fast one = convert_area_to_sum_units(
            r, mode, (fast)((int64_t)low_q16 * far_q16 >> 17));
        const fast two = convert_area_to_sum_units(
            r, mode, low_q16 + (fast)(rest_q33 >> 17));

        add_light_change(r, mode, first, one);
        add_light_change(r, mode, first + 1, two - one);
        add_light_change(r, mode, first + 2, height - two);
    }
}

/* Adds a piece of an edge that lies in one row, from x = A to B, and is HEIGHT
 * high. A may be larger than B. */
static inline void add_edge_piece(const struct run *r, enum mode mode,
                                  int64_t a_q40, int64_t b_q40, fast height_q16)
{
    const int64_t low_q40 = a_q40 < b_q40 ? a_q40 : b_q40;
    const int64_t high_q40 = a_q40 < b_q40 ? b_q40 : a_q40;
    const int first = (int)(low_q40 >> 40), last = (int)(high_q40 >> 40);

    if (last < r->x0) { /* A piece left of the picture is treated as one at the
                           picture's left side. */
        if (r->x0 == 0)
            add_light_change(r, mode, 0,
                             convert_area_to_sum_units(r, mode, height_q16));
    } else if (first >= r->x1) {
        return;
    } else if (first == last ||
               (last == first + 1 && first >= r->x0 && last < r->x1)) {
        add_piece_in_two_pixels(r, mode, (fast)(low_q40 >> 24),
                                (fast)(high_q40 >> 24), height_q16);
    } else {
        add_piece_over_many_pixels(r, mode, low_q40, high_q40, height_q16);
    }
}

/* Moves the pointer of R by N array elements: by columns, or by rows times
 * their stride. */
static inline void advance_run(struct run *r, enum mode mode, ptrdiff_t n)
{
    if (mode == NARROW)
        r->row.narrow += n;
    else
        r->row.wide += n;
}

/* Returns a mask of 64 bits, one per row of the tile, in which the bits of rows
 * A .. B - 1 are 1. */
static uint64_t make_row_mask(int a, int b)
{
    return (UINT64_MAX << a) & (UINT64_MAX >> (64 - b));
}

/* Adds the part of an edge that crosses N complete rows. The part begins at X
 * and moves by STEP per row. */
static inline void add_complete_rows(struct run r, enum mode mode, int n,
                                     int64_t x_q40, int64_t step_q40,
                                     int stride)
{
    for (; n > 0; n--) {
        add_edge_piece(&r, mode, x_q40, x_q40 + step_q40, ONE_Q16);
        advance_run(&r, mode, stride);
        x_q40 += step_q40;
    }
}

/* Adds N complete rows of an edge that crosses only one or two pixels of the
 * tile in each row. */
static inline void add_complete_rows_in_two_pixels(struct run r, enum mode mode,
                                                   int n, int64_t x_q40,
                                                   int64_t step_q40, int stride)
{
    for (; n > 0; n--) {
        const fast a_q16 = (fast)(x_q40 >> 24);
        const fast b_q16 = (fast)((x_q40 += step_q40) >> 24);

        add_piece_in_two_pixels(&r, mode, a_q16 < b_q16 ? a_q16 : b_q16,
                                a_q16 < b_q16 ? b_q16 : a_q16, ONE_Q16);
        advance_run(&r, mode, stride);
    }
}

/* The part of an edge within a tile, in one colour channel. */
struct part {
    struct run run; /* the first row of the part */
    int32_t y_q8, end_q8;
    int64_t x_q40; /* x of its upper end */
};

static inline struct part clip_edge_to_tile(const struct glint_edge_sums *s,
                                            enum mode mode,
                                            const struct glint_edge *e,
                                            int64_t light, int channel)
{
    const struct glint_box *t = &s->tile;
    const int32_t end_q8 = q_smaller(e->end_y_q8, t->y1 * 256);
    const int32_t y_q8 = q_larger(e->y_q8, t->y0 * 256);
    const int row = (y_q8 >> 8) - t->y0;
    const ptrdiff_t at =
        (ptrdiff_t)((channel << s->tile_log2) + row) * s->stride - t->x0;
    struct part p = {{{NULL}, s->linear ? 0 : 8, t->x0, t->x1, light, 0},
                     y_q8,
                     end_q8,
                     compute_edge_x_q40(e, y_q8)};

    s->touched[channel] |= make_row_mask(row, ((end_q8 + 255) >> 8) - t->y0);
    if (mode == NARROW)
        p.run.row.narrow = s->narrow + at;
    else
        p.run.row.wide = s->wide + at;
    return p;
}

/* Returns the height, 1/256 pixel, that edge part P covers in its first row. */
static inline int32_t compute_first_row_height(const struct part *p)
{
    return q_smaller((p->y_q8 | 255) + 1, p->end_q8) - p->y_q8;
}

/* Adds edge part P as a smooth edge: the pixels that it crosses get the exact
 * covered area. */
static inline void add_smooth_edge(const struct glint_edge_sums *s,
                                   enum mode mode, const struct glint_edge *e,
                                   struct part p)
{
    const int64_t end_q40 = compute_edge_x_q40(e, p.end_q8);
    const int64_t low_q40 = p.x_q40 < end_q40 ? p.x_q40 : end_q40;
    const int64_t high_q40 = p.x_q40 < end_q40 ? end_q40 : p.x_q40;
    int n;

    if (low_q40 >> 40 != high_q40 >> 40)
        p.run.rise_q32 = compute_area_rise(e->slope_q40);
    if (p.y_q8 & 255) {
        const int32_t height_q8 = compute_first_row_height(&p);
        const int64_t next_q40 = p.x_q40 + e->slope_q40 * height_q8;

        add_edge_piece(&p.run, mode, p.x_q40, next_q40, height_q8 * 256);
        advance_run(&p.run, mode, s->stride);
        p.x_q40 = next_q40;
        p.y_q8 += height_q8;
    }
    n = (p.end_q8 - p.y_q8) >> 8;
    /* An edge that crosses no complete row may be so flat that its step
     * overflows. */
    if (n > 0) {
        const int64_t step_q40 = e->slope_q40 * 256;
        const int is_narrow = step_q40 < ONE_Q40 && step_q40 > -ONE_Q40;

        if (low_q40 >> 40 < p.run.x0 || high_q40 >> 40 >= p.run.x1 ||
            !is_narrow)
            add_complete_rows(p.run, mode, n, p.x_q40, step_q40, s->stride);
        else
            add_complete_rows_in_two_pixels(p.run, mode, n, p.x_q40, step_q40,
                                            s->stride);
        advance_run(&p.run, mode, (ptrdiff_t)n * s->stride);
        p.x_q40 += n * step_q40;
        p.y_q8 += n * 256;
    }
    if (p.y_q8 < p.end_q8)
        add_edge_piece(&p.run, mode, p.x_q40, end_q40,
                       (p.end_q8 - p.y_q8) * 256);
}

/* Adds one row of a pixel-snapped edge. AREA, the height of the edge in the
 * row, is added to the difference at the pixel X. By the running sum it reaches
 * all pixels on the right of X, too. X is counted from the tile's left side. An
 * edge left of the picture is treated as one at the picture's left side. */
static inline void add_snapped_row(const struct run *r, enum mode mode,
                                   int64_t x_q40, fast area)
{
    const int x = (int)(x_q40 >> 40);

    if ((unsigned)x < (unsigned)r->x1)
        add_light_change(r, mode, x, area);
    else if (x < 0 && r->x0 == 0)
        add_light_change(r, mode, 0, area);
}

/* Adds N complete rows of a pixel-snapped edge, which moves by STEP per row. */
static inline void add_complete_snapped_rows(struct run r, enum mode mode,
                                             int n, int64_t x_q40,
                                             int64_t step_q40, int stride)
{
    const uint64_t end_q40 = (uint64_t)(r.x1 * ONE_Q40);
    const fast full = convert_area_to_sum_units(&r, mode, ONE_Q16);

    x_q40 += step_q40 / 2;
    if (r.x0 == 0 && (x_q40 < 0 || x_q40 + (n - 1) * step_q40 < 0)) {
        for (; n > 0; n--, x_q40 += step_q40) {
            add_snapped_row(&r, mode, x_q40, full);
            advance_run(&r, mode, stride);
        }
        return;
    }
    /* Rows in which the edge is outside the tile are skipped. Then rows are
     * added until the edge leaves the tile, as it does not return. */
    for (; n > 0 && (uint64_t)x_q40 >= end_q40; n--, x_q40 += step_q40)
        advance_run(&r, mode, stride);
    for (; n > 0 && (uint64_t)x_q40 < end_q40; n--, x_q40 += step_q40) {
        add_light_change(&r, mode, (int)(x_q40 >> 40), full);
        advance_run(&r, mode, stride);
    }
}

/* Adds edge part P as a pixel-snapped edge: in each row the light changes at
 * the pixel boundary nearest to the edge. */
static inline void add_snapped_edge(const struct glint_edge_sums *s,
                                    enum mode mode, const struct glint_edge *e,
                                    struct part p)
{
    int n;

    advance_run(&p.run, mode, p.run.x0); /* From here on columns are counted
                                      from the tile's left side. */
    p.x_q40 -= p.run.x0 * ONE_Q40;
    p.run.x1 -= p.run.x0;
    if (p.y_q8 & 255) {
        const int32_t height_q8 = compute_first_row_height(&p);
        const int64_t step_q40 = e->slope_q40 * height_q8;

        add_snapped_row(
            &p.run, mode, p.x_q40 + step_q40 / 2,
            convert_area_to_sum_units(&p.run, mode, height_q8 * 256));
        advance_run(&p.run, mode, s->stride);
        p.x_q40 += step_q40;
        p.y_q8 += height_q8;
    }
    n = (p.end_q8 - p.y_q8) >> 8;
    /* An edge that crosses no complete row may be so flat that its step
     * overflows. */
    if (n > 0) {
        add_complete_snapped_rows(p.run, mode, n, p.x_q40, e->slope_q40 * 256,
                                  s->stride);
        advance_run(&p.run, mode, (ptrdiff_t)n * s->stride);
        p.x_q40 += n * (e->slope_q40 * 256);
        p.y_q8 += n * 256;
    }
    if (p.y_q8 < p.end_q8)
        add_snapped_row(
            &p.run, mode, p.x_q40 + e->slope_q40 * (p.end_q8 - p.y_q8) / 2,
            convert_area_to_sum_units(&p.run, mode, (p.end_q8 - p.y_q8) * 256));
}

static int64_t multiply_by_colour_q20(int32_t light, int32_t colour_q14)
{
    const int64_t light_q20 = glint_light_unpack_q20(light);

    return colour_q14 == 1 << 14 ? light_q20
                                 : q_shift(light_q20 * colour_q14, 14);
}

/* Returns the light on the right of E minus the light on its left, for a
 * channel in which the ray bundle's colour is COLOUR. The last LESS of the 20
 * fraction bits are dropped. */
static int64_t compute_light_change(const struct glint_edge *e,
                                    int32_t colour_q14, int less)
{
    return q_shift(multiply_by_colour_q20(e->right, colour_q14), less) -
           q_shift(multiply_by_colour_q20(e->left, colour_q14), less);
}

/* Adds the light of patch E in the colour RGB. Returns the largest light of a
 * channel with 20 - LESS fraction bits. */
static int64_t add_patch_light(const struct glint_edge_sums *s, enum mode mode,
                               const struct glint_edge *e,
                               const int32_t rgb_q14[3], int less)
{
    int64_t light[3], most = 0;

    for (int c = 0; c < 3; c++) {
        light[c] = q_shift(multiply_by_colour_q20(e->left, rgb_q14[c]), less);
        most = light[c] > most ? light[c] : most;
    }
    s->patch(s, mode == NARROW, e, light);
    return most;
}

/* Adds the edges to the wide or narrow sums, by MODE. Returns an upper bound on
 * the change of a running sum along a row: the sum of the magnitudes of all
 * changes of light, max over the channels. In mode NARROW stops as soon as sums
 * could overflow. */
static WHOLLY_INLINE int64_t add_edges_to_sums(
    const struct glint_edge_sums *s, enum mode mode,
    const struct glint_edge *edge, const struct glint_bundle *bundle,
    const int32_t *ref, int n_refs)
{
    const int less = s->linear || s->fine ? 0 : 4;
    int64_t far[3] = {0, 0, 0}, most;

    for (int k = 0; k < n_refs; k++) {
        const struct glint_edge *e = &edge[ref[k]];
        const int32_t *rgb_q14 = bundle[e->bundle].rgb_q14;

        if (k + AHEAD < n_refs)
            PREFETCH(&edge[ref[k + AHEAD]]);
        if (e->patch) {
            most = add_patch_light(s, mode, e, rgb_q14, less);
            for (int c = 0; c < 3; c++)
                far[c] += most;
            if (mode == NARROW && far[0] >= MOST_NARROW)
                return far[0];
            continue;
        }
        for (int c = 0; c < 3; c++) {
            const int64_t step =
                rgb_q14[c] ? compute_light_change(e, rgb_q14[c], less) : 0;

            if (step == 0)
                continue;
            far[c] += step < 0 ? -step : step;
            if (mode == NARROW && far[c] >= MOST_NARROW)
                return far[c]; /* The narrow sums could overflow in this tile;
                                  the caller then uses the wide sums. */
            if (e->whole)
                add_snapped_edge(s, mode, e,
                                 clip_edge_to_tile(s, mode, e, step, c));
            else
                add_smooth_edge(s, mode, e,
                                clip_edge_to_tile(s, mode, e, step, c));
        }
    }
    most = far[0] > far[1] ? far[0] : far[1];
    return most > far[2] ? most : far[2];
}

static int64_t find_max_carried_light(const struct glint_edge_sums *s)
{
    int64_t most = 0;

    for (int i = 0; i < 3 << s->tile_log2; i++) {
        const int64_t size = s->carry[i] < 0 ? -s->carry[i] : s->carry[i];

        most = size > most ? size : most;
    }
    return most;
}

void glint_edges_add_to_sums(struct glint_edge_sums *sums,
                             const struct glint_edge *edge,
                             const struct glint_bundle *bundle,
                             const int32_t *ref, int n_refs)
{
    const int64_t most = MOST_NARROW * 256;
    int64_t far = 0; /* upper bound on the change of a running sum (light times
                        area) along a row, in the units of the sums */

    sums->in_narrow = 0;
    if (!sums->linear)
        far = find_max_carried_light(sums);
    if (!sums->linear && far < most) {
        far += add_edges_to_sums(sums, NARROW, edge, bundle, ref, n_refs) *
               INT64_C(256);
        sums->in_narrow = far + 2048 < most;
        if (sums->in_narrow)
            return;
        for (int i = 0; i < (3 << sums->tile_log2) * sums->stride; i++)
            sums->narrow[i] = 0;
    }
    add_edges_to_sums(sums, WIDE, edge, bundle, ref, n_refs);
}
