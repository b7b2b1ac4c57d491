/* SPDX-License-Identifier: MIT
 *
 * Draws by cells: grids become primitives, primitives go into tiles, of one
 * level or two, tiles become pixels. */
#include "base/q.h"
#include "flare/state.h"
#include "published/ghost_grid.h"
#include "published/raster.h"

/* The memory of a flare that is drawn by cells, beyond that of any flare. */
struct by_cells {
    uint8_t *level; /* [max_vertices]: marks of cells that merging leaves; those
                       of a bundle begin at its first vertex */
    struct glint_primitive *primitive;
};

/* The memory of one worker. */
struct worker {
    int64_t *acc_q20; /* [3][side * side]: sums of one small tile */
    struct glint_clip *clip;
    int32_t *start; /* lists of the small tiles of one large tile */
    int32_t *ref;
    const struct draw *draw; /* set while the worker draws a row of tiles */
    const struct glint_bins *bins;
    int at_tile; /* index of the next tile */
    struct glint_box tile;
};

static struct by_cells *own_of(const struct glint_flare *f)
{
    return f->own;
}

static struct worker *worker_of(const struct glint_flare *f, int i)
{
    return f->worker[i].own;
}

/* carve and carve_worker run twice: once to measure, which gives NULL, and once
 * to place. */
static void *carve(struct glint_arena *a, const struct glint_flare_config *c)
{
    struct by_cells measured, *placed, *own;

    placed = glint_arena_take(a, 1, sizeof *placed);
    own = placed ? placed : &measured;
    own->level =
        glint_arena_take(a, (size_t)c->max_vertices, sizeof *own->level);
    own->primitive =
        glint_arena_take(a, (size_t)c->max_primitives, sizeof *own->primitive);
    return placed;
}

static void *carve_worker(struct glint_arena *a,
                          const struct glint_flare_config *c)
{
    const size_t side = (size_t)1 << c->tile_log2;
    const size_t tiles =
        c->coarse_log2 ? (size_t)1 << (2 * (c->coarse_log2 - c->tile_log2)) : 0;
    struct worker measured, *placed, *w;

    placed = glint_arena_take(a, 1, sizeof *placed);
    w = placed ? placed : &measured;
    w->acc_q20 = glint_arena_take(a, 3 * side * side, sizeof *w->acc_q20);
    w->clip = glint_arena_take(a, 1, sizeof *w->clip);
    w->start = glint_arena_take(a, tiles + 1, sizeof *w->start);
    w->ref = glint_arena_take(a, (size_t)c->max_tile_refs, sizeof *w->ref);
    return placed;
}

static void transfer_job(void *ctx, int job, int worker)
{
    struct glint_flare *f = ctx;
    struct glint_transfer *t = &f->worker[worker].plan->transfer;
    const struct glint_place place =
        glint_plan_place(&f->plan, &f->planned[job]);

    glint_plan_transfer(&f->plan, &f->planned[job], t);
    glint_transfer_grid(t, &place, f->bundle[job].n_cells,
                        f->vertex + f->slot[job].first_vertex);
}

static void fill(struct glint_flare *flare)
{
    glint_workers_run(flare->cfg.workers, flare->n_bundles, transfer_job,
                      flare);
}

static struct glint_ghost_grid grid_of(const struct glint_flare *f, int bundle)
{
    const struct glint_bundle_slot *slot = &f->slot[bundle];

    return (struct glint_ghost_grid){
        .vertex = f->vertex,
        .first = slot->first_vertex,
        .bundle = &f->bundle[bundle],
        .stop = &f->cfg.stop,
        .width = f->cfg.width,
        .height = f->cfg.height,
        .antialias = f->cfg.antialias,
        .merge_steps = f->cfg.merge_steps,
        .merge_gamma_q16 = f->cfg.merge_gamma_q16,
        .level = own_of(f)->level + slot->first_vertex,
    };
}

/* Counts the index entries that the primitives of a bundle take. */
struct span {
    const struct glint_bins *bins;
    int refs;
};

static void add_span(void *ctx, struct glint_box box)
{
    struct span *s = ctx;

    s->refs = glint_flare_add_need(s->refs, glint_bins_span(s->bins, box));
}

static void count_job(void *ctx, int job, int worker)
{
    struct glint_flare *f = ctx;
    struct glint_ghost_grid grid = grid_of(f, job);
    struct glint_bundle_slot *slot = &f->slot[job];
    struct span span = {&f->bins, 0};

    (void)worker;
    glint_ghost_grid_merge(&grid);
    grid.see = add_span;
    grid.ctx = &span;
    glint_ghost_grid_emit(&grid, job, NULL);
    slot->refs = span.refs;
    slot->n = grid.n_primitives;
    slot->n_dropped = grid.n_dropped;
    slot->n_merged = grid.n_merged;
}

static void emit_job(void *ctx, int job, int worker)
{
    struct glint_flare *f = ctx;
    struct glint_ghost_grid grid = grid_of(f, job);

    (void)worker;
    glint_ghost_grid_emit(&grid, job,
                          own_of(f)->primitive + f->slot[job].first);
    f->slot[job].n_held = grid.n_held;
}

/* Gives each bundle its place among the primitives, as far as they fit. */
static void place_primitives(struct glint_flare *f)
{
    int full = 0;

    for (int i = 0; i < f->n_bundles; i++) {
        struct glint_bundle_slot *slot = &f->slot[i];

        f->stats.need_primitives =
            glint_flare_add_need(f->stats.need_primitives, slot->n);
        slot->first = f->stats.primitives;
        full |= slot->n > f->cfg.max_primitives - f->stats.primitives;
        if (full)
            continue;
        f->stats.primitives += slot->n;
        f->n_drawn = i + 1;
    }
}

/* --------------------------------------------------------------------- bins */

static struct glint_box primitive_box(const struct glint_flare *f, int index)
{
    const struct glint_primitive *p = &own_of(f)->primitive[index];
    struct glint_corners corners;

    glint_corners_gather(&corners, f->vertex, p->vertex,
                         glint_primitive_corners(p));
    return glint_primitive_box(p, &corners, f->cfg.width, f->cfg.height);
}

/* Keeps the first bundles whose index entries fit, and counts the entries of
 * all. */
static void keep_refs(struct glint_flare *f)
{
    int full = 0, n_kept = 0;

    for (int i = 0; i < f->n_bundles; i++) {
        const int refs = f->slot[i].refs;

        f->stats.need_refs = glint_flare_add_need(f->stats.need_refs, refs);
        full |= i >= f->n_drawn || refs > f->cfg.max_refs - f->stats.refs;
        if (full)
            continue;
        f->stats.refs += refs;
        n_kept = i + 1;
    }
    f->n_drawn = n_kept;
}

/* Sorts the primitives of the bundles that were kept into tiles. */
static void fill_bins(struct glint_flare *f)
{
    int n = 0;

    for (int i = 0; i < f->n_drawn; i++)
        n += f->slot[i].n;
    glint_bins_open(&f->bins);
    for (int i = 0; i < n; i++)
        glint_bins_count(&f->bins, primitive_box(f, i));
    glint_bins_sum(&f->bins);
    for (int i = 0; i < n; i++)
        glint_bins_put(&f->bins, primitive_box(f, i), i);
    glint_bins_close(&f->bins);
}

/* Returns the small tiles of large tile TILE. */
static struct glint_bins small_bins(const struct glint_flare *f, int tile,
                                    const struct worker *w)
{
    struct glint_bins bins;

    glint_bins_init(&bins, glint_bins_tile(&f->bins, tile), f->cfg.tile_log2,
                    w->start, w->ref);
    return bins;
}

/* Sets need_tile_refs to the longest index list that one large tile will need.
 * The lists of large tiles must be there, with all bundles. */
static void count_tile_refs(struct glint_flare *f)
{
    const int n = f->bins.tiles_x * f->bins.tiles_y;

    for (int tile = 0; tile < n; tile++) {
        const struct glint_bins bins = small_bins(f, tile, worker_of(f, 0));
        struct span span = {&bins, 0};

        for (int k = f->bins.start[tile]; k < f->bins.start[tile + 1]; k++)
            add_span(&span, primitive_box(f, f->bins.ref[k]));
        f->stats.need_tile_refs = q_larger(f->stats.need_tile_refs, span.refs);
    }
}

/* Adds the entries that BOX takes in small tiles to the count of each large
 * tile that it touches. */
static void add_tile_span(void *ctx, struct glint_box box)
{
    const struct glint_flare *f = ctx;
    const int log2 = f->bins.tile_log2;
    const struct glint_box here = glint_box_cut(box, f->bins.region);

    if (glint_box_empty(here))
        return;
    for (int y = here.y0 >> log2; y <= (here.y1 - 1) >> log2; y++)
        for (int x = here.x0 >> log2; x <= (here.x1 - 1) >> log2; x++) {
            const int tile = y * f->bins.tiles_x + x;
            const struct glint_bins bins = small_bins(f, tile, worker_of(f, 0));
            struct span span = {&bins, f->bins.start[tile]};

            add_span(&span, box);
            f->bins.start[tile] = span.refs;
        }
}

/* Sets need_tile_refs when bundles found no room, so that lists are incomplete:
 * primitives are made once more, and dropped. The counts lie where the lists
 * will begin. */
static void count_all_tile_refs(struct glint_flare *f)
{
    const int n = f->bins.tiles_x * f->bins.tiles_y;

    glint_bins_open(&f->bins);
    for (int i = 0; i < f->n_bundles; i++) {
        struct glint_ghost_grid grid = grid_of(f, i);

        grid.see = add_tile_span;
        grid.ctx = f;
        glint_ghost_grid_emit(&grid, i, NULL);
    }
    for (int tile = 0; tile < n; tile++)
        f->stats.need_tile_refs =
            q_larger(f->stats.need_tile_refs, f->bins.start[tile]);
}

static void bin(struct glint_flare *flare)
{
    struct glint_workers *workers = flare->cfg.workers;
    int all;

    glint_workers_run(workers, flare->n_bundles, count_job, flare);
    place_primitives(flare);
    glint_workers_run(workers, flare->n_drawn, emit_job, flare);
    keep_refs(flare);
    all = flare->n_drawn == flare->n_bundles;
    if (flare->cfg.coarse_log2 && !all)
        count_all_tile_refs(flare);
    fill_bins(flare);
    if (flare->cfg.coarse_log2 && all)
        count_tile_refs(flare);
    flare->stats.tile_refs =
        q_smaller(flare->stats.need_tile_refs, flare->cfg.max_tile_refs);
}

/* ------------------------------------------------------------------ drawing */

struct draw {
    struct glint_flare *flare;
    const struct glint_tiles *tiles;
    const struct glint_pass *pass;
    int n_passes;
    struct glint_cell_raster cells;
};

/* Returns row Y of a tile's sums in channel C. */
static const int64_t *sums_of(const struct worker *w, int c, int y)
{
    const int side = 1 << w->draw->cells.tile_log2;

    return w->acc_q20 + (ptrdiff_t)(c * side + y) * side;
}

/* Begins a row of the frame's tiles, for one level. */
static void *begin_row(const void *self, struct glint_box row, int worker)
{
    const struct draw *d = self;
    struct worker *w = worker_of(d->flare, worker);

    w->draw = d;
    w->bins = &d->flare->bins;
    w->at_tile = (row.y0 >> w->bins->tile_log2) * w->bins->tiles_x;
    return w;
}

/* Begins a row of small tiles of the large tile that the worker is at, for two
 * levels. */
static void *begin_small_row(const void *self, struct glint_box row, int worker)
{
    const struct draw *d = self;
    struct worker *w = worker_of(d->flare, worker);

    (void)row;
    w->draw = d;
    return w;
}

/* Clears the sums and adds every primitive of TILE; returns 0 if there is none.
 */
static int add_tile(void *state, struct glint_box tile)
{
    struct worker *w = state;
    const int32_t *start = w->bins->start + w->at_tile++;
    const int sums = 3 << (2 * w->draw->cells.tile_log2);

    if (start[0] == start[1])
        return 0;
    for (int i = 0; i < sums; i++)
        w->acc_q20[i] = 0;
    for (int32_t k = start[0]; k < start[1]; k++)
        glint_cell_raster_primitive(&w->draw->cells, w->bins->ref[k], tile,
                                    w->clip, w->acc_q20);
    w->tile = tile;
    return 1;
}

static void light_linear(const struct worker *w, int y,
                         int32_t *const row_q20[3])
{
    for (int c = 0; c < 3; c++)
        for (int x = 0; x < w->tile.x1 - w->tile.x0; x++)
            row_q20[c][x] =
                q_clamp_sat(sums_of(w, c, y)[x], INT32_MIN, INT32_MAX);
}

static enum glint_given light_rows(void *state,
                                   const struct glint_pass_rows *rows)
{
    const struct worker *w = state;
    const struct glint_image *image = w->draw->tiles->image;
    const int first = rows->y - w->tile.y0, n_x = w->tile.x1 - w->tile.x0;

    if (image && image->format == GLINT_LINEAR_Q20) {
        light_linear(w, first, rows->light_q20);
        return GLINT_GIVES_LIGHT;
    }
    for (int c = 0; c < 3; c++)
        for (int row = 0; row < rows->n; row++)
            for (int x = 0; x < n_x; x++)
                rows->light->rgb_q16[c][row][x] = (uint16_t)q_clamp_sat(
                    q_shift(sums_of(w, c, first + row)[x], 4), 0, 65535);
    return GLINT_GIVES_LIGHT;
}

/* Draws a row of tiles: a job of one level. */
static void row_job(void *ctx, int job, int worker)
{
    const struct draw *d = ctx;

    glint_tile_rows(d->tiles, d->pass, d->n_passes, job, worker,
                    &d->flare->worker[worker].tile);
}

/* Sorts the primitives of large tile TILE into small tiles, as far as there is
 * room for their entries. */
static void sort_tile(const struct glint_flare *f, int tile,
                      struct glint_bins *bins)
{
    const int32_t first = f->bins.start[tile];
    int32_t end = first;
    int n_refs = 0;

    glint_bins_open(bins);
    for (int32_t k = first; k < f->bins.start[tile + 1]; k++) {
        const struct glint_box box = primitive_box(f, f->bins.ref[k]);

        n_refs += glint_bins_span(bins, box);
        if (n_refs > f->cfg.max_tile_refs)
            break;
        glint_bins_count(bins, box);
        end = k + 1;
    }
    glint_bins_sum(bins);
    for (int32_t k = first; k < end; k++)
        glint_bins_put(bins, primitive_box(f, f->bins.ref[k]), f->bins.ref[k]);
    glint_bins_close(bins);
}

/* Draws one large tile: a job of two levels. */
static void coarse_job(void *ctx, int job, int worker)
{
    const struct draw *d = ctx;
    struct worker *w = worker_of(d->flare, worker);
    struct glint_bins bins = small_bins(d->flare, job, w);
    struct glint_tiles tiles = *d->tiles;

    sort_tile(d->flare, job, &bins);
    w->bins = &bins;
    w->at_tile = 0;
    tiles.region = bins.region;
    for (int row = 0; row < bins.tiles_y; row++)
        glint_tile_rows(&tiles, d->pass, d->n_passes, row, worker,
                        &d->flare->worker[worker].tile);
}

static void draw(struct glint_flare *flare, const struct glint_tiles *tiles,
                 struct glint_pass *pass, int n_below)
{
    const struct glint_flare_config *c = &flare->cfg;
    struct draw d = {.flare = flare,
                     .tiles = tiles,
                     .pass = pass,
                     .n_passes = n_below + 1,
                     .cells = {.vertex = flare->vertex,
                               .primitive = own_of(flare)->primitive,
                               .bundle = flare->bundle,
                               .stop = &c->stop,
                               .weights = c->weights,
                               .antialias = c->antialias,
                               .tile_log2 = c->tile_log2}};

    pass[n_below] = (struct glint_pass){
        .self = &d,
        .begin = c->coarse_log2 ? begin_small_row : begin_row,
        .tile = add_tile,
        .rows = light_rows};
    glint_workers_run(c->workers,
                      c->coarse_log2 ? flare->bins.tiles_x * flare->bins.tiles_y
                                     : flare->bins.tiles_y,
                      c->coarse_log2 ? coarse_job : row_job, &d);
}

const struct glint_raster glint_raster_cells = {.max_bundles = 65535,
                                                .masks = 1,
                                                .two_levels = 1,
                                                .carve = carve,
                                                .carve_worker = carve_worker,
                                                .fill = fill,
                                                .bin = bin,
                                                .draw = draw};
