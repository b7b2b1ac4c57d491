/* SPDX-License-Identifier: MIT */
#include "veil/glare.h"

#include "base/arena.h"
#include "base/q.h"
#include "veil/parts.h"

/* ------------------------------------------------------------------ memory */

static int is_valid_config(const struct glint_veil_config *c)
{
    return c->n_workers >= 1 && c->n_workers <= 64 && c->width >= 1 &&
           c->width <= GLINT_MAX_SIDE && c->height >= 1 &&
           c->height <= GLINT_MAX_SIDE;
}

/* Returns the number of cells along a side of SIDE pixels of a picture whose
 * longer side has LONGER pixels. */
static int count_cells_along_side(int side, int longer)
{
    const int most =
        q_larger(1, q_smaller(GLINT_VEIL_CELLS, longer / GLINT_VEIL_LEAST_PX));

    return q_larger(1, (most * side + longer / 2) / longer);
}

void glint_veil_count_cells(int width, int height, int cells[2])
{
    const int longer = q_larger(width, height);

    cells[0] = count_cells_along_side(width, longer);
    cells[1] = count_cells_along_side(height, longer);
}

static void allocate_cell_axis(struct glint_arena *a,
                               struct glint_veil_axis *axis, int side)
{
    enum { N = GLINT_VEIL_CELLS };

    axis->cell = glint_arena_allocate(a, (size_t)side, 1);
    axis->start = glint_arena_allocate(a, N + 1, sizeof *axis->start);
    for (int k = 0; k < 3; k++)
        axis->share_q16[k] = glint_arena_allocate(
            a, (size_t)side + GLINT_VEIL_LANES, sizeof *axis->share_q16[k]);
    axis->fill_q16 = glint_arena_allocate(a, N, sizeof *axis->fill_q16);
}

/* Allocates a veil and its arrays from arena A. Called twice: first with an
 * arena that only counts bytes, where it returns NULL; then with an arena that
 * has memory. */
static struct glint_veil *allocate_veil(struct glint_arena *a,
                                        const struct glint_veil_config *c)
{
    struct glint_veil measured, *placed, *v;
    int cells[2];
    size_t n;

    glint_veil_count_cells(c->width, c->height, cells);
    n = 3 * (size_t)cells[0] * (size_t)cells[1];
    placed = glint_arena_allocate(a, 1, sizeof *placed);
    v = placed ? placed : &measured;
    allocate_cell_axis(a, &v->across, c->width);
    allocate_cell_axis(a, &v->down, c->height);
    v->curve = glint_arena_allocate(a, 1, sizeof *v->curve);
    v->light_q16 = glint_arena_allocate(a, n, sizeof *v->light_q16);
    v->narrow = glint_arena_allocate(a, n, sizeof *v->narrow);
    v->along = glint_arena_allocate(a, n, sizeof *v->along);
    v->sum_q30 = glint_arena_allocate(a, n, sizeof *v->sum_q30);
    v->cell_q20 = glint_arena_allocate(a, n, sizeof *v->cell_q20);
    v->front_q20 =
        c->has_front ? glint_arena_allocate(a, n, sizeof *v->front_q20) : NULL;
    v->worker =
        glint_arena_allocate(a, (size_t)c->n_workers, sizeof *v->worker);
    v->rows = glint_arena_allocate(a, (size_t)c->n_workers, sizeof *v->rows);
    if (placed) {
        v->n_x = cells[0];
        v->n_y = cells[1];
    }
    return placed;
}

size_t glint_veil_count_bytes(const struct glint_veil_config *cfg)
{
    struct glint_arena arena = glint_arena_begin_measuring();

    if (!is_valid_config(cfg))
        return 0;
    allocate_veil(&arena, cfg);
    return arena.used;
}

/* Sets fill_q16 of each of N cells along SIDE pixels: (the cell's exact width)
 * / (number of pixels summed in it). Pixels are read in groups of STEP; a group
 * belongs to the cell of its first pixel. */
static void compute_cell_fill_factors(struct glint_veil_axis *axis, int side,
                                      int n, int step)
{
    for (int k = 0; k < n; k++)
        axis->fill_q16[k] = 0;
    for (int i = 0; i < side; i += step)
        axis->fill_q16[axis->cell[i]] += (uint32_t)q_smaller(step, side - i);
    for (int k = 0; k < n; k++) { /* SIDE is at most 2^15, N at most 2^6 */
        const uint32_t pixels = axis->fill_q16[k] ? axis->fill_q16[k] : 1;

        axis->fill_q16[k] =
            (uint32_t)(((uint64_t)side << 16) / (pixels * (uint32_t)n));
    }
}

/* Sets, for each of SIDE pixels, the index of its cell among N cells, and its
 * spline weights. */
static void set_axis_weights(struct glint_veil_axis *axis, int side, int n)
{
    const uint32_t twice = 2 * (uint32_t)side;
    uint32_t next = 0;

    for (int i = 0; i < side; i++) {
        /* position of the pixel's centre, in units of 1 / TWICE cells */
        const uint32_t at = (uint32_t)(2 * i + 1) * (uint32_t)n;
        const uint32_t cell = at / twice;
        const uint64_t t_q16 = ((uint64_t)(at - cell * twice) << 16) / twice;
        const uint64_t rest_q16 = 65536 - t_q16;

        axis->cell[i] = (uint8_t)cell;
        axis->share_q16[0][i] = (uint16_t)(rest_q16 * rest_q16 >> 17);
        axis->share_q16[2][i] = (uint16_t)(t_q16 * t_q16 >> 17);
        axis->share_q16[1][i] =
            (uint16_t)(65536 - axis->share_q16[0][i] - axis->share_q16[2][i]);
        for (; next <= cell; next++)
            axis->start[next] = i;
    }
    axis->start[n] = side;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < GLINT_VEIL_LANES; i++)
            axis->share_q16[k][side + i] = 0;
}

enum glint_status glint_veil_init(struct glint_veil **veil,
                                  const struct glint_veil_config *cfg,
                                  void *mem, size_t bytes)
{
    struct glint_arena arena = glint_arena_init_in_memory(mem, bytes);
    struct glint_veil *v;

    if (!is_valid_config(cfg) || (uintptr_t)mem % GLINT_ALIGN != 0)
        return GLINT_E_ARGUMENT;
    if (glint_veil_count_bytes(cfg) > bytes)
        return GLINT_E_MEMORY;
    v = allocate_veil(&arena, cfg);
    v->cfg = *cfg;
    v->is_linear = v->any = v->any_front = v->has_curve = 0;
    v->front = NULL;
    set_axis_weights(&v->across, cfg->width, v->n_x);
    set_axis_weights(&v->down, cfg->height, v->n_y);
    compute_cell_fill_factors(&v->across, cfg->width, v->n_x, 1);
    compute_cell_fill_factors(&v->down, cfg->height, v->n_y, 2);
    for (int i = 0; i < cfg->n_workers; i++)
        v->worker[i].veil = v;
    for (int i = 0; i < 3 * v->n_x * v->n_y; i++) {
        v->light_q16[i] = 0;
        v->cell_q20[i] = 0;
    }
    *veil = v;
    return GLINT_OK;
}

/* ---------------------------------------------------------------- spreading */

/* Max light of a cell, 2^8 times white, so that products of the interpolation
 * fit into 63 bits. */
enum { MOST_Q20 = 1 << 28 };

/* Returns the right shift after which the largest of N sums fits into 30 bits.
 */
static int compute_shift_to_30_bits(const int64_t *light_q16, int n)
{
    uint64_t all = 0;
    int over = 0;

    for (int i = 0; i < n; i++)
        all |= (uint64_t)light_q16[i];
    while (all >> over >= (uint64_t)1 << 30)
        over++;
    return over;
}

/* Sets SHARE[i], for each of N cells in a row, to the fraction of its light
 * that cell i scatters to cell TO, directly and mirrored at the borders. */
static void
compute_spread_fractions_to_cell(const int32_t *table_q30, int n, int to,
                                 int32_t share_q30[GLINT_VEIL_CELLS])
{
    for (int from = 0; from < n; from++) {
        const int direct = to > from ? to - from : from - to;
        const int mirrored = to + from + 1;

        share_q30[from] = table_q30[direct] +
                          table_q30[mirrored > n ? 2 * n - mirrored : mirrored];
    }
}

/* Returns the sum of N cells that are STEP array elements apart, weighted by
 * SHARE. */
static int32_t sum_weighted_cells(const int32_t *from, int step,
                                  const int32_t share_q30[GLINT_VEIL_CELLS],
                                  int n)
{
    int64_t sum = 0;

    for (int i = 0; i < n; i++)
        sum += (int64_t)from[i * step] * share_q30[i];
    return (int32_t)q_shift(sum, 30);
}

static void spread_light_across(struct glint_veil *v,
                                const struct glint_veil_spread *s)
{
    int32_t share_q30[GLINT_VEIL_CELLS];

    for (int x = 0; x < v->n_x; x++) {
        compute_spread_fractions_to_cell(s->across_q30, v->n_x, x, share_q30);
        for (int row = 0; row < 3 * v->n_y; row++)
            v->along[row * v->n_x + x] = sum_weighted_cells(
                v->narrow + row * v->n_x, 1, share_q30, v->n_x);
    }
}

/* Returns LIGHT times FACTOR, rounded and clamped to 2^50. FACTOR converts the
 * scaled light of a cell to white, _q30. */
static int64_t scale_cell_light(int32_t light, struct glint_real factor)
{
    const int64_t product = (int64_t)light * factor.mantissa;
    const int down = -factor.exponent;

    if (down > 62)
        return 0;
    if (down >= 0)
        return q_shift(product, down);
    /* clamped to 2^50, more than can be drawn */
    return product > INT64_C(1) << 50 >> q_smaller(-down, 50)
               ? INT64_C(1) << 50
               : (int64_t)((uint64_t)product << -down);
}

static void spread_light_down(struct glint_veil *v,
                              const struct glint_veil_spread *s,
                              struct glint_real factor)
{
    int32_t share_q30[GLINT_VEIL_CELLS];

    for (int y = 0; y < v->n_y; y++) {
        compute_spread_fractions_to_cell(s->down_q30, v->n_y, y, share_q30);
        for (int c = 0; c < 3; c++)
            for (int x = 0; x < v->n_x; x++) {
                const int first = c * v->n_y * v->n_x + x;

                v->sum_q30[first + y * v->n_x] += scale_cell_light(
                    sum_weighted_cells(v->along + first, v->n_x, share_q30,
                                       v->n_y),
                    factor);
            }
    }
}

int glint_veil_spread_light_to(struct glint_veil *v,
                               const struct glint_veil_spread *spreads, int n,
                               int32_t *cell_q20)
{
    const int cells = v->n_x * v->n_y;
    const int over = compute_shift_to_30_bits(v->light_q16, 3 * cells);
    int any = 0;

    for (int i = 0; i < 3 * cells; i++) {
        v->narrow[i] = (int32_t)q_shift(v->light_q16[i], over);
        v->sum_q30[i] = 0;
    }
    for (int k = 0; k < n; k++) {
        struct glint_real factor = spreads[k].share;

        factor.exponent += 30 + over - 16;
        spread_light_across(v, &spreads[k]);
        spread_light_down(v, &spreads[k], factor);
    }
    for (int i = 0; i < 3 * cells; i++) {
        cell_q20[i] = q_clamp_sat(q_shift(v->sum_q30[i], 10), 0, MOST_Q20);
        any |= cell_q20[i] > 0;
    }
    return any;
}

void glint_veil_spread_light(struct glint_veil *v,
                             const struct glint_veil_spread *spreads, int n)
{
    v->any = glint_veil_spread_light_to(v, spreads, n, v->cell_q20);
}
