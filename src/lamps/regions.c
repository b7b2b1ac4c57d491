/* SPDX-License-Identifier: MIT */
#include "lamps/regions.h"

#include "base/arena.h"
#include "base/bytes.h"
#include "base/q.h"
#include "lamps/bright.h"

/* --------------------------------------------------------------------- sums */

void glint_region_add_run(struct glint_region *sum, int x0, int x1, int y)
{
    sum->area += x1 - x0;
    sum->x0 = q_smaller(sum->x0, x0);
    sum->x1 = q_larger(sum->x1, x1);
    sum->y0 = q_smaller(sum->y0, y);
    sum->y1 = q_larger(sum->y1, y + 1);
}

void glint_region_add_region(struct glint_region *sum,
                             const struct glint_region *other)
{
    if (other->first < sum->first)
        sum->first = other->first;
    sum->area += other->area;
    sum->n_seeds += other->n_seeds;
    sum->n_clipped += other->n_clipped;
    sum->x0 = q_smaller(sum->x0, other->x0);
    sum->x1 = q_larger(sum->x1, other->x1);
    sum->y0 = q_smaller(sum->y0, other->y0);
    sum->y1 = q_larger(sum->y1, other->y1);
    sum->w_q14 += other->w_q14;
    sum->wx_q14 += other->wx_q14;
    sum->wy_q14 += other->wy_q14;
    sum->wr2_q14 += other->wr2_q14;
    for (int i = 0; i < 3; i++) {
        sum->rgb_q14[i] += other->rgb_q14[i];
        sum->rim_rgb_q14[i] += other->rim_rgb_q14[i];
    }
}

/* Returns A / B with FRAC fraction bits, rounded. Requires 0 <= A / B < 2^(62 -
 * FRAC) and 0 < B < 2^(62 - FRAC). */
static int64_t divide_to_fixed_point(uint64_t a, int64_t b, int frac)
{
    const uint64_t d = (uint64_t)b;

    return (int64_t)((a / d << frac) + (((a % d) << frac) + d / 2) / d);
}

static int32_t compute_mean_coordinate_q8(int64_t wx_q14, int64_t w_q14)
{
    return q_narrow(divide_to_fixed_point((uint64_t)wx_q14, w_q14, 8));
}

void glint_region_compute_centroid(const struct glint_region *sum,
                                   int32_t *x_q8, int32_t *y_q8)
{
    *x_q8 = compute_mean_coordinate_q8(sum->wx_q14, sum->w_q14);
    *y_q8 = compute_mean_coordinate_q8(sum->wy_q14, sum->w_q14);
}

/* Returns the RMS distance of the points of a uniformly lit box from its
 * centre. DIAGONAL2 is the square of the box's diagonal. */
static int32_t compute_box_radius_q8(uint64_t diagonal2)
{
    return (int32_t)q_root((diagonal2 << 16) / 12);
}

/* The origin of the sums is first moved to the pixel nearest to the centroid.
 * Sums may have wrapped modulo 2^64, but the moved ones do not and are
 * exact. */
int32_t glint_region_compute_rms_radius_q8(const struct glint_region *sum)
{
    const int64_t across = sum->x1 - sum->x0, down = sum->y1 - sum->y0;
    const uint64_t diagonal2 = (uint64_t)(across * across + down * down);
    const int32_t x_q8 = compute_mean_coordinate_q8(sum->wx_q14, sum->w_q14);
    const int32_t y_q8 = compute_mean_coordinate_q8(sum->wy_q14, sum->w_q14);
    const int32_t x = (x_q8 + 128) >> 8, y = (y_q8 + 128) >> 8;
    const int64_t fx_q8 = x_q8 - x * 256, fy_q8 = y_q8 - y * 256;
    const uint64_t about =
        sum->wr2_q14 - 2 * (uint64_t)x * (uint64_t)sum->wx_q14 -
        2 * (uint64_t)y * (uint64_t)sum->wy_q14 +
        ((uint64_t)x * (uint64_t)x + (uint64_t)y * (uint64_t)y) *
            (uint64_t)sum->w_q14;
    const int64_t mean_q16 = divide_to_fixed_point(about, sum->w_q14, 16) -
                             fx_q8 * fx_q8 - fy_q8 * fy_q8;

    if ((uint64_t)sum->w_q14 > (UINT64_C(1) << 63) / (diagonal2 / 4 + 1))
        return compute_box_radius_q8(diagonal2);
    return (int32_t)q_root(mean_q16 > 0 ? (uint64_t)mean_q16 : 0);
}

/* Clipped pixels carry little colour information. So their weight is 1/64 of
 * that of unclipped pixels in the region and next to it: a large unclipped rim
 * determines the colour, and a region without a rim becomes white, with a
 * continuous transition. */
void glint_region_compute_colour(const struct glint_region *sum,
                                 int32_t rgb_q15[3])
{
    int64_t c[3], y;

    for (int i = 0; i < 3; i++)
        c[i] = 63 * sum->rim_rgb_q14[i] + sum->rgb_q14[i];
    y = region_compute_luminance(c[0], c[1], c[2]);
    for (int i = 0; i < 3; i++)
        rgb_q15[i] =
            y > 0 ? q_narrow(divide_to_fixed_point((uint64_t)c[i], y, 15))
                  : 1 << 15;
}

/* ---------------------------------------------------------------- labelling */

void glint_regions_allocate(struct glint_regions *r, struct glint_arena *arena,
                            int width)
{
    const size_t n_runs = ((size_t)width + 1) / 2;

    r->width = width;
    r->above.run = glint_arena_allocate(arena, n_runs, sizeof *r->above.run);
    r->here.run = glint_arena_allocate(arena, n_runs, sizeof *r->here.run);
    r->component =
        glint_arena_allocate(arena, 2 * n_runs, sizeof *r->component);
    r->active = glint_arena_allocate(arena, 2 * n_runs, sizeof *r->active);
    r->idle = glint_arena_allocate(arena, 2 * n_runs, sizeof *r->idle);
}

void glint_regions_begin_picture(struct glint_regions *r)
{
    r->n_active = r->n_idle = 0;
    r->above.n_runs = r->here.n_runs = 0;
    for (int label = 2 * ((r->width + 1) / 2); label > 0; label--)
        r->idle[r->n_idle++] = label - 1;
}

static int32_t find_root_label(struct glint_component *c, int32_t label)
{
    while (c[label].parent != label) {
        c[label].parent = c[c[label].parent].parent;
        label = c[label].parent;
    }
    return label;
}

static int32_t unite_regions(struct glint_component *c, int32_t a, int32_t b)
{
    a = find_root_label(c, a);
    b = find_root_label(c, b);
    if (a == b)
        return a;
    glint_region_add_region(&c[a].sum, &c[b].sum);
    c[b].parent = a;
    return a;
}

static int32_t begin_region(struct glint_regions *r, int32_t first)
{
    const int32_t label = r->idle[--r->n_idle];

    r->component[label] = (struct glint_component){
        .sum = {.first = first, .x0 = INT32_MAX, .y0 = INT32_MAX},
        .parent = label};
    r->active[r->n_active++] = label;
    return label;
}

/* Returns a mask whose bit i is set if pixel i of a block has brightness LOW or
 * more. */
static WHOLLY_INLINE uint32_t make_bright_pixel_mask(
    const uint8_t value[BRIGHT_BLOCK], int low, int is_above_128)
{
    uint32_t bits = 0;

    for (int i = 0; i < BRIGHT_BLOCK / 8; i++)
        bits |= bytes_pack_high_bits(bytes_find_at_or_above(
                    bytes_load(value + 8 * i), low, is_above_128))
                << 8 * i;
    return bits;
}

/* Appends the run of pixels BEGIN .. END - 1 to ROW. Does nothing if BEGIN is
 * -1. */
static WHOLLY_INLINE void append_run(struct glint_run_row *row, int begin,
                                     int end)
{
    if (begin >= 0)
        row->run[row->n_runs++] =
            (struct glint_run){.x0 = begin, .x1 = end, .label = -1};
}

/* Appends to ROW the runs of set bits in BITS, which is the mask of the block
 * that begins at pixel X. BEGIN is the first pixel of a run that is not
 * finished at the end of the block before; -1: none. Returns the first pixel of
 * the run that is not finished at the end of this block, or -1. */
static int find_runs_in_block(struct glint_run_row *row, uint32_t bits, int x,
                              int begin)
{
    uint32_t edges = bits ^ (bits << 1 | (begin >= 0));

    for (; edges; edges &= edges - 1) {
        const int at = x + bit_length(edges & -edges) - 1;

        append_run(row, begin, at);
        begin = begin < 0 ? at : -1;
    }
    return begin;
}

static void find_row_runs(struct glint_run_row *row,
                          const struct glint_bright *b, int low)
{
    const int last = (b->width - 1) / BRIGHT_BLOCK;
    const int past = (last + 1) * BRIGHT_BLOCK - b->width;
    int begin = -1, next = 0; /* next: index of the block after the last block
                                 read */

    row->n_runs = 0;
    for (int k = 0; k < b->n_marked; k++) {
        const int i = b->marked[k], x = i * BRIGHT_BLOCK;
        uint32_t bits;

        if (b->block[i] < low)
            continue;
        bits = low > 128 ? make_bright_pixel_mask(b->value + x, low, 1)
                         : make_bright_pixel_mask(b->value + x, low, 0);
        if (i == last)
            bits &= UINT32_MAX >> past;
        if (i > next) {
            append_run(row, begin, next * BRIGHT_BLOCK);
            begin = -1;
        }
        begin = find_runs_in_block(row, bits, x, begin);
        next = i + 1;
    }
    next *= BRIGHT_BLOCK;
    append_run(row, begin, next < b->width ? next : b->width);
}

/* Labels each run of row Y. A run unites all regions that it touches in the row
 * above, or begins a new one. */
static void link_runs_to_row_above(struct glint_regions *r, int y)
{
    const struct glint_run_row *above = &r->above;
    int first = 0; /* index of the first run of the row above that may touch run
                      i or a run after it */

    for (int i = 0; i < r->here.n_runs; i++) {
        struct glint_run *run = &r->here.run[i];
        int32_t label = -1;

        while (first < above->n_runs && above->run[first].x1 < run->x0)
            first++;
        for (int j = first; j < above->n_runs && above->run[j].x0 <= run->x1;
             j++)
            label =
                label < 0
                    ? find_root_label(r->component, above->run[j].label)
                    : unite_regions(r->component, label, above->run[j].label);
        if (label < 0)
            label = begin_region(r, y * r->width + run->x0);
        r->component[label].last_row = y;
        run->label = label;
    }
}

void glint_regions_link_row(struct glint_regions *r,
                            const struct glint_bright *bright, int low, int y)
{
    find_row_runs(&r->here, bright, low);
    link_runs_to_row_above(r, y);
}

struct glint_region *glint_regions_find_region_of_run(struct glint_regions *r,
                                                      int i)
{
    return &r->component[find_root_label(r->component, r->here.run[i].label)]
                .sum;
}

static void swap_run_rows(struct glint_regions *r)
{
    const struct glint_run_row here = r->here;

    r->here = r->above;
    r->above = here;
    r->here.n_runs = 0;
}

void glint_regions_report_finished(struct glint_regions *r,
                                   glint_region_fn *done, void *ctx, int y)
{
    const int n_before = r->n_active;

    for (int i = 0; i < r->here.n_runs; i++)
        r->here.run[i].label =
            find_root_label(r->component, r->here.run[i].label);
    r->n_active = 0;
    for (int i = 0; i < n_before; i++) {
        const int32_t label = r->active[i];
        const struct glint_component *c = &r->component[label];

        if (c->parent == label && c->last_row == y) {
            r->active[r->n_active++] = label;
            continue;
        }
        if (c->parent == label)
            done(ctx, &c->sum);
        r->idle[r->n_idle++] = label;
    }
    swap_run_rows(r);
}
