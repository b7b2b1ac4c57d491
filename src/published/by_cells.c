/* SPDX-License-Identifier: MIT
 *
 * Drawing by cells: grids to primitives, primitives to tiles, one level or two,
 * tiles to pixels.
 */
#include "base/q.h"
#include "flare/state.h"

static void carve(struct glint_flare *f, struct glint_arena *a,
                  const struct glint_flare_config *c)
{
    f->level = glint_arena_take(a, (size_t)c->max_vertices, sizeof *f->level);
    f->primitive =
        glint_arena_take(a, (size_t)c->max_primitives, sizeof *f->primitive);
}

static void carve_worker(struct glint_flare_worker *w, struct glint_arena *a,
                         const struct glint_flare_config *c)
{
    const size_t side = (size_t)1 << c->tile_log2;
    const size_t tiles =
        c->coarse_log2 ? (size_t)1 << (2 * (c->coarse_log2 - c->tile_log2)) : 0;

    w->acc_q20 = glint_arena_take(a, 3 * side * side, sizeof *w->acc_q20);
    w->clip = glint_arena_take(a, 1, sizeof *w->clip);
    w->start = glint_arena_take(a, tiles + 1, sizeof *w->start);
    w->ref = glint_arena_take(a, (size_t)c->max_tile_refs, sizeof *w->ref);
}

static void transfer_job(void *ctx, int job, int worker)
{
    struct glint_flare *f = ctx;
    struct glint_transfer *t = &f->worker[worker].plan->transfer;
    const struct glint_place place =
        glint_plan_place(&f->plan, f->planned[job].beam);

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
        .level = f->level + slot->first_vertex,
    };
}

static void count_job(void *ctx, int job, int worker)
{
    struct glint_flare *f = ctx;
    struct glint_ghost_grid grid = grid_of(f, job);
    struct glint_bundle_slot *slot = &f->slot[job];

    (void)worker;
    glint_ghost_grid_merge(&grid);
    glint_ghost_grid_emit(&grid, job, NULL);
    slot->n = grid.n_primitives;
    slot->n_dropped = grid.n_dropped;
    slot->n_merged = grid.n_merged;
}

static void emit_job(void *ctx, int job, int worker)
{
    struct glint_flare *f = ctx;
    struct glint_ghost_grid grid = grid_of(f, job);

    (void)worker;
    glint_ghost_grid_emit(&grid, job, f->primitive + f->slot[job].first);
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
    const struct glint_primitive *p = &f->primitive[index];
    struct glint_corners corners;

    glint_corners_gather(&corners, f->vertex, p->vertex,
                         glint_primitive_corners(p));
    return glint_primitive_box(p, &corners, f->cfg.width, f->cfg.height);
}

/* Counts the index entries bundle by bundle and keeps the bundles that fit. */
static void count_refs(struct glint_flare *f)
{
    int full = 0, n_kept = 0;

    for (int i = 0; i < f->n_drawn; i++) {
        const struct glint_bundle_slot *slot = &f->slot[i];
        int refs = 0;

        for (int k = 0; k < slot->n; k++)
            refs = glint_flare_add_need(
                refs,
                glint_bins_span(&f->bins, primitive_box(f, slot->first + k)));
        f->stats.need_refs = glint_flare_add_need(f->stats.need_refs, refs);
        full |= refs > f->cfg.max_refs - f->stats.refs;
        if (full)
            continue;
        f->stats.refs += refs;
        n_kept = i + 1;
    }
    f->n_drawn = n_kept;
}

/* Of the bundles that were kept. */
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

/* Small tiles of the large tile TILE. */
static struct glint_bins small_bins(const struct glint_flare *f, int tile,
                                    const struct glint_flare_worker *w)
{
    struct glint_bins bins;

    glint_bins_init(&bins, glint_bins_tile(&f->bins, tile), f->cfg.tile_log2,
                    w->start, w->ref);
    return bins;
}

/* The longest index list that one large tile will need. */
static void count_tile_refs(struct glint_flare *f)
{
    const int n = f->bins.tiles_x * f->bins.tiles_y;

    for (int tile = 0; tile < n; tile++) {
        const struct glint_bins bins = small_bins(f, tile, &f->worker[0]);
        int refs = 0;

        for (int k = f->bins.start[tile]; k < f->bins.start[tile + 1]; k++)
            refs = glint_flare_add_need(
                refs, glint_bins_span(&bins, primitive_box(f, f->bins.ref[k])));
        if (refs > f->stats.need_tile_refs)
            f->stats.need_tile_refs = refs;
    }
    f->stats.tile_refs = f->stats.need_tile_refs < f->cfg.max_tile_refs
                             ? f->stats.need_tile_refs
                             : f->cfg.max_tile_refs;
}

static void bin(struct glint_flare *flare)
{
    struct glint_workers *workers = flare->cfg.workers;

    glint_workers_run(workers, flare->n_bundles, count_job, flare);
    place_primitives(flare);
    glint_workers_run(workers, flare->n_drawn, emit_job, flare);
    count_refs(flare);
    fill_bins(flare);
    if (flare->cfg.coarse_log2)
        count_tile_refs(flare);
}

/* ------------------------------------------------------------------ drawing */

struct draw {
    struct glint_flare *flare;
    const struct glint_image *image; /* NULL: light is dropped */
    struct glint_cell_raster cells;
};

/* Row Y of a tile's sums in channel C. */
static const int64_t *sums_of(const struct glint_flare *f,
                              const struct glint_flare_worker *w, int c, int y)
{
    const int side = 1 << f->cfg.tile_log2;

    return w->acc_q20 + (ptrdiff_t)(c * side + y) * side;
}

static void resolve_linear(const struct draw *d, struct glint_flare_worker *w,
                           struct glint_box tile)
{
    const int n = tile.x1 - tile.x0;
    int32_t *const row_q20[3] = {w->light_q20, w->light_q20 + n,
                                 w->light_q20 + 2 * n};

    for (int y = tile.y0; y < tile.y1; y++) {
        for (int c = 0; c < 3; c++)
            for (int x = 0; x < n; x++)
                row_q20[c][x] =
                    q_clamp_sat(sums_of(d->flare, w, c, y - tile.y0)[x],
                                INT32_MIN, INT32_MAX);
        w->n_held += glint_resolve_linear(d->image, tile.x0, y, n,
                                          (const int32_t *const *)row_q20);
    }
}

/* Two rows at a time, which share their colours in 4:2:0. */
static void resolve_codes(const struct draw *d,
                          const struct glint_flare_worker *w,
                          struct glint_box tile)
{
    const int n_x = tile.x1 - tile.x0;

    for (int y = tile.y0; y < tile.y1; y += 2) {
        const int n_y = y + 2 < tile.y1 ? 2 : tile.y1 - y;

        for (int c = 0; c < 3; c++)
            for (int row = 0; row < n_y; row++)
                for (int x = 0; x < n_x; x++)
                    w->light->rgb_q16[c][row][x] = (uint16_t)q_clamp_sat(
                        q_shift(sums_of(d->flare, w, c, y + row - tile.y0)[x],
                                4),
                        0, 65535);
        if (d->image)
            glint_resolve_stretch(d->flare->resolve, d->image, tile.x0, y, n_x,
                                  n_y, w->light, &w->codes->rows);
    }
}

/* The tile pass: clear, every primitive, resolve. */
static void draw_tile(struct draw *d, struct glint_flare_worker *w,
                      struct glint_box tile, const int32_t *ref, int n_refs)
{
    const int sums = 3 << (2 * d->flare->cfg.tile_log2);

    if (n_refs == 0)
        return;
    for (int i = 0; i < sums; i++)
        w->acc_q20[i] = 0;
    for (int i = 0; i < n_refs; i++)
        glint_cell_raster_primitive(&d->cells, ref[i], tile, w->clip,
                                    w->acc_q20);
    w->n_tiles++;
    if (d->image && d->image->format == GLINT_LINEAR_Q20)
        resolve_linear(d, w, tile);
    else
        resolve_codes(d, w, tile);
}

static void draw_tiles(struct draw *d, struct glint_flare_worker *w,
                       const struct glint_bins *bins, int first, int end)
{
    for (int tile = first; tile < end; tile++)
        draw_tile(d, w, glint_bins_tile(bins, tile),
                  bins->ref + bins->start[tile],
                  bins->start[tile + 1] - bins->start[tile]);
}

/* One level: a job is a row of small tiles. */
static void row_job(void *ctx, int job, int worker)
{
    struct draw *d = ctx;
    const struct glint_bins *bins = &d->flare->bins;

    draw_tiles(d, &d->flare->worker[worker], bins, job * bins->tiles_x,
               (job + 1) * bins->tiles_x);
}

/* Two levels: a job is a large tile, sorted into small ones first. */
static void coarse_job(void *ctx, int job, int worker)
{
    struct draw *d = ctx;
    struct glint_flare *f = d->flare;
    struct glint_flare_worker *w = &f->worker[worker];
    struct glint_bins bins = small_bins(f, job, w);
    const int32_t first = f->bins.start[job];
    int32_t end = first;
    int n_refs = 0;

    glint_bins_open(&bins);
    for (int32_t k = first; k < f->bins.start[job + 1]; k++) {
        const struct glint_box box = primitive_box(f, f->bins.ref[k]);

        n_refs += glint_bins_span(&bins, box);
        if (n_refs > f->cfg.max_tile_refs)
            break;
        glint_bins_count(&bins, box);
        end = k + 1;
    }
    glint_bins_sum(&bins);
    for (int32_t k = first; k < end; k++)
        glint_bins_put(&bins, primitive_box(f, f->bins.ref[k]), f->bins.ref[k]);
    glint_bins_close(&bins);
    draw_tiles(d, w, &bins, 0, bins.tiles_x * bins.tiles_y);
}

static void draw(struct glint_flare *flare, const struct glint_image *image)
{
    const struct glint_flare_config *c = &flare->cfg;
    struct draw d = {.flare = flare,
                     .image = image,
                     .cells = {.vertex = flare->vertex,
                               .primitive = flare->primitive,
                               .bundle = flare->bundle,
                               .stop = &c->stop,
                               .weights = c->weights,
                               .antialias = c->antialias,
                               .tile_log2 = c->tile_log2}};

    if (c->coarse_log2)
        glint_workers_run(c->workers, flare->bins.tiles_x * flare->bins.tiles_y,
                          coarse_job, &d);
    else
        glint_workers_run(c->workers, flare->bins.tiles_y, row_job, &d);
}

const struct glint_raster glint_raster_cells = {.max_bundles = 65535,
                                                .masks = 1,
                                                .two_levels = 1,
                                                .carve = carve,
                                                .carve_worker = carve_worker,
                                                .fill = fill,
                                                .bin = bin,
                                                .draw = draw};
