/* SPDX-License-Identifier: MIT */
#include "glint/flare.h"

#include "base/arena.h"
#include "flare/ghost_grid.h"
#include "tile/bins.h"
#include "tile/edges.h"
#include "tile/raster.h"
#include "tile/resolve.h"

/* What one worker needs while it draws. */
struct worker {
    int64_t *acc_q20;              /* [3][side * side], one small tile's sums */
    struct glint_clip *clip;       /* by cells */
    struct glint_outline *outline; /* by edges */
    int32_t *start;                /* small tiles of one large tile */
    int32_t *ref;
    int n_tiles; /* small tiles that it drew */
};

struct bundle_slot {
    int first_vertex;
    int first_primitive;
    int n_primitives, n_dropped, n_merged;
    int64_t light_q8; /* the most that it can add to a pixel */
};

struct glint_flare {
    struct glint_flare_config cfg;
    struct glint_flare_stats stats;
    int n_bundles, n_vertices; /* taken in */
    int n_drawn;               /* of these, the bundles that bin kept */
    struct glint_bundle *bundle;
    struct bundle_slot *slot;
    struct glint_vertex *vertex;
    uint8_t *level; /* one per vertex: what merge found */
    struct glint_primitive *primitive;
    int32_t limit_q8;       /* of what a primitive adds to a pixel */
    struct glint_bins bins; /* first level */
    struct worker *worker;
    struct glint_resolve *resolve; /* tables for the picture drawn last */
};

/* ------------------------------------------------------------------- memory */

/* Texture is looked up at pixel centres. */
static enum glint_raster raster_of(const struct glint_flare_config *c)
{
    return c->stop.mask_q13 ? GLINT_RASTER_CELLS : c->raster;
}

static int first_level_log2(const struct glint_flare_config *c)
{
    return c->coarse_log2 ? c->coarse_log2 : c->tile_log2;
}

static size_t tile_count(int pixels_x, int pixels_y, int log2)
{
    const size_t side = (size_t)1 << log2;

    return (((size_t)pixels_x + side - 1) >> log2) *
           (((size_t)pixels_y + side - 1) >> log2);
}

static void carve_worker(struct worker *w, struct glint_arena *a,
                         const struct glint_flare_config *c)
{
    const size_t pixels = (size_t)1 << (2 * c->tile_log2);
    const size_t tiles =
        c->coarse_log2 ? (size_t)1 << (2 * (c->coarse_log2 - c->tile_log2)) : 0;

    w->acc_q20 = glint_arena_take(a, 3 * pixels, sizeof *w->acc_q20);
    w->clip = glint_arena_take(a, raster_of(c) == GLINT_RASTER_CELLS,
                               sizeof *w->clip);
    w->outline = glint_arena_take(a, raster_of(c) == GLINT_RASTER_EDGES,
                                  sizeof *w->outline);
    w->start = glint_arena_take(a, tiles + 1, sizeof *w->start);
    w->ref = glint_arena_take(a, (size_t)c->max_tile_refs, sizeof *w->ref);
}

/* Runs twice: to measure, with F NULL, and to place. */
static struct glint_flare *carve(struct glint_arena *a,
                                 const struct glint_flare_config *c)
{
    const size_t n_workers = (size_t)glint_workers_count(c->workers);
    struct glint_flare measured, *placed;
    struct glint_flare *f;
    struct worker none;

    placed = glint_arena_take(a, 1, sizeof *placed);
    f = placed ? placed : &measured;
    f->bundle = glint_arena_take(a, (size_t)c->max_bundles, sizeof *f->bundle);
    f->slot = glint_arena_take(a, (size_t)c->max_bundles, sizeof *f->slot);
    f->vertex = glint_arena_take(a, (size_t)c->max_vertices, sizeof *f->vertex);
    f->level = glint_arena_take(a, (size_t)c->max_vertices, sizeof *f->level);
    f->primitive =
        glint_arena_take(a, (size_t)c->max_primitives, sizeof *f->primitive);
    f->bins.start = glint_arena_take(
        a, tile_count(c->width, c->height, first_level_log2(c)) + 1,
        sizeof *f->bins.start);
    f->bins.ref = glint_arena_take(a, (size_t)c->max_refs, sizeof *f->bins.ref);
    f->worker = glint_arena_take(a, n_workers, sizeof *f->worker);
    f->resolve = glint_arena_take(a, 1, sizeof *f->resolve);
    for (size_t i = 0; i < n_workers; i++)
        carve_worker(a->base && f->worker ? &f->worker[i] : &none, a, c);
    return placed;
}

static int stop_ok(const struct glint_stop *s)
{
    if (s->mask_q13)
        return s->mask_nodes >= 2 && s->mask_nodes <= 4096 &&
               s->mask_span_q16 >= 1 << 15 && s->mask_span_q16 <= 1 << 18;
    return s->n_blades == 0 ||
           (s->n_blades >= 3 && s->n_blades <= GLINT_MAX_BLADES);
}

static int config_ok(const struct glint_flare_config *c)
{
    const int workers = glint_workers_count(c->workers);

    return c->width >= 1 && c->width <= GLINT_MAX_SIDE && c->height >= 1 &&
           c->height <= GLINT_MAX_SIDE && c->tile_log2 >= 3 &&
           c->tile_log2 <= 6 &&
           (c->coarse_log2 == 0 ||
            (c->coarse_log2 > c->tile_log2 && c->coarse_log2 <= 8)) &&
           c->merge_steps >= 0 && c->merge_steps <= 4 &&
           c->merge_gamma_q16 >= 0 && c->merge_gamma_q16 <= 1 << 16 &&
           (c->raster == GLINT_RASTER_EDGES ||
            c->raster == GLINT_RASTER_CELLS) &&
           (c->weights == GLINT_WEIGHTS_LOOP_DEROSE ||
            c->weights == GLINT_WEIGHTS_WACHSPRESS) &&
           c->max_bundles >= 0 && c->max_bundles <= 65535 &&
           c->max_vertices >= 0 && c->max_primitives >= 0 && c->max_refs >= 0 &&
           c->max_tile_refs >= 0 && workers >= 1 && workers <= 64 &&
           stop_ok(&c->stop);
}

size_t glint_flare_bytes(const struct glint_flare_config *cfg)
{
    struct glint_arena arena = glint_arena_measure();

    if (!config_ok(cfg))
        return 0;
    carve(&arena, cfg);
    return arena.used;
}

enum glint_status glint_flare_init(struct glint_flare **flare,
                                   const struct glint_flare_config *cfg,
                                   void *mem, size_t bytes)
{
    struct glint_arena arena = glint_arena_over(mem, bytes);
    struct glint_flare *f;

    if (!config_ok(cfg) || (uintptr_t)mem % GLINT_ALIGN != 0)
        return GLINT_E_ARGUMENT;
    if (glint_flare_bytes(cfg) > bytes)
        return GLINT_E_MEMORY;
    f = carve(&arena, cfg);
    f->cfg = *cfg;
    glint_bins_init(&f->bins, (struct glint_box){0, 0, cfg->width, cfg->height},
                    first_level_log2(cfg), f->bins.start, f->bins.ref);
    for (int i = 0; i < glint_workers_count(cfg->workers); i++)
        f->worker[i].n_tiles = 0;
    glint_flare_begin(f);
    *flare = f;
    return GLINT_OK;
}

/* ------------------------------------------------------------------ bundles */

void glint_flare_begin(struct glint_flare *flare)
{
    flare->n_bundles = flare->n_vertices = flare->n_drawn = 0;
    flare->stats = (struct glint_flare_stats){0};
}

/* A + B, held at INT_MAX: a need that large cannot be served anyway. */
static int add_sat(int a, int b)
{
    return a > INT32_MAX - b ? INT32_MAX : a + b;
}

struct glint_vertex *glint_flare_add(struct glint_flare *flare,
                                     const struct glint_bundle *bundle)
{
    const int n = (bundle->n_cells + 1) * (bundle->n_cells + 1);
    struct glint_flare_stats *s = &flare->stats;
    struct glint_vertex *vertices;

    s->need_bundles++;
    s->need_vertices = add_sat(s->need_vertices, n);
    if (flare->n_bundles == flare->cfg.max_bundles ||
        n > flare->cfg.max_vertices - flare->n_vertices) {
        s->dropped_bundles++;
        return NULL;
    }
    vertices = flare->vertex + flare->n_vertices;
    flare->bundle[flare->n_bundles] = *bundle;
    flare->slot[flare->n_bundles++] =
        (struct bundle_slot){.first_vertex = flare->n_vertices};
    flare->n_vertices += n;
    return vertices;
}

static struct glint_ghost_grid grid_of(const struct glint_flare *f, int bundle)
{
    const struct bundle_slot *slot = &f->slot[bundle];

    return (struct glint_ghost_grid){
        .vertex = f->vertex,
        .first = slot->first_vertex,
        .bundle = &f->bundle[bundle],
        .stop = &f->cfg.stop,
        .raster = raster_of(&f->cfg),
        .width = f->cfg.width,
        .height = f->cfg.height,
        .merge_steps = f->cfg.merge_steps,
        .merge_gamma_q16 = f->cfg.merge_gamma_q16,
        .level = f->level + slot->first_vertex,
    };
}

static void count_job(void *ctx, int job, int worker)
{
    struct glint_flare *f = ctx;
    struct glint_ghost_grid grid = grid_of(f, job);
    struct bundle_slot *slot = &f->slot[job];

    (void)worker;
    glint_ghost_grid_merge(&grid);
    glint_ghost_grid_emit(&grid, job, NULL);
    slot->n_primitives = grid.n_primitives;
    slot->n_dropped = grid.n_dropped;
    slot->n_merged = grid.n_merged;
    slot->light_q8 = grid.light_q8;
}

static void emit_job(void *ctx, int job, int worker)
{
    struct glint_flare *f = ctx;
    struct glint_ghost_grid grid = grid_of(f, job);

    (void)worker;
    glint_ghost_grid_emit(&grid, job,
                          f->primitive + f->slot[job].first_primitive);
}

/* Gives each bundle its place among the primitives, as far as they fit. */
static void place_primitives(struct glint_flare *f)
{
    int full = 0;

    for (int i = 0; i < f->n_bundles; i++) {
        struct bundle_slot *slot = &f->slot[i];

        f->stats.need_primitives =
            add_sat(f->stats.need_primitives, slot->n_primitives);
        slot->first_primitive = f->stats.primitives;
        full |=
            slot->n_primitives > f->cfg.max_primitives - f->stats.primitives;
        if (full)
            continue;
        f->stats.primitives += slot->n_primitives;
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
    if (raster_of(&f->cfg) == GLINT_RASTER_EDGES)
        return glint_corners_reach(&corners, f->cfg.width, f->cfg.height);
    return glint_primitive_box(p, &corners, f->cfg.width, f->cfg.height);
}

/* Counts the index entries bundle by bundle and keeps the bundles that fit. */
static void count_refs(struct glint_flare *f)
{
    int full = 0, n_kept = 0;

    for (int i = 0; i < f->n_drawn; i++) {
        const struct bundle_slot *slot = &f->slot[i];
        int refs = 0;

        for (int k = 0; k < slot->n_primitives; k++)
            refs = add_sat(
                refs,
                glint_bins_span(&f->bins,
                                primitive_box(f, slot->first_primitive + k)));
        f->stats.need_refs = add_sat(f->stats.need_refs, refs);
        full |= refs > f->cfg.max_refs - f->stats.refs;
        if (full)
            continue;
        f->stats.refs += refs;
        n_kept = i + 1;
    }
    f->n_drawn = n_kept;
}

static void fill_bins(struct glint_flare *f)
{
    const int n = f->stats.primitives;

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
                                    const struct worker *w)
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
            refs = add_sat(
                refs, glint_bins_span(&bins, primitive_box(f, f->bins.ref[k])));
        if (refs > f->stats.need_tile_refs)
            f->stats.need_tile_refs = refs;
    }
    f->stats.tile_refs = f->stats.need_tile_refs < f->cfg.max_tile_refs
                             ? f->stats.need_tile_refs
                             : f->cfg.max_tile_refs;
}

/* Sums of q38 light and colours up to 4 stay below 2^62 while all primitives
 * together could bring no pixel beyond 2^22. They never come near in a picture;
 * if they do, each one's share is cut down to what they may have together. */
static void limit_light(struct glint_flare *f)
{
    const int64_t most_q8 = INT64_C(1) << (22 + 8);
    int64_t light_q8 = 0;

    for (int i = 0; i < f->n_drawn; i++)
        light_q8 += f->slot[i].light_q8;
    f->limit_q8 = light_q8 <= most_q8
                      ? GLINT_LIMIT_Q8
                      : (int32_t)(most_q8 / (f->stats.primitives + 1));
}

/* Drops what the bins did not keep from the totals. */
static void total(struct glint_flare *f)
{
    struct glint_flare_stats *s = &f->stats;

    s->bundles = f->n_drawn;
    s->vertices = f->n_vertices;
    s->dropped_bundles += f->n_bundles - f->n_drawn;
    s->primitives = 0;
    for (int i = 0; i < f->n_drawn; i++) {
        s->primitives += f->slot[i].n_primitives;
        s->dropped_cells += f->slot[i].n_dropped;
        s->merged_cells += f->slot[i].n_merged;
    }
}

void glint_flare_bin(struct glint_flare *flare, struct glint_flare_stats *stats)
{
    struct glint_workers *workers = flare->cfg.workers;

    glint_workers_run(workers, flare->n_bundles, count_job, flare);
    place_primitives(flare);
    glint_workers_run(workers, flare->n_drawn, emit_job, flare);
    count_refs(flare);
    total(flare);
    limit_light(flare);
    fill_bins(flare);
    if (flare->cfg.coarse_log2)
        count_tile_refs(flare);
    *stats = flare->stats;
}

/* ------------------------------------------------------------------ drawing */

struct draw {
    struct glint_flare *flare;
    const struct glint_image *image;
    enum glint_raster raster;
    struct glint_edges edges;
    struct glint_cell_raster cells;
};

static void add_primitives(const struct draw *d, const struct worker *w,
                           struct glint_box tile, const int32_t *ref,
                           int n_refs)
{
    if (d->raster == GLINT_RASTER_CELLS) {
        for (int i = 0; i < n_refs; i++)
            glint_cell_raster_primitive(&d->cells, ref[i], tile, w->clip,
                                        w->acc_q20);
        return;
    }
    for (int i = 0; i < n_refs; i++)
        glint_edges_primitive(&d->edges, ref[i], tile, w->outline,
                              (uint64_t *)w->acc_q20);
    glint_edges_finish(&d->edges, tile, w->acc_q20);
}

/* The tile pass: clear, every primitive, resolve. */
static void draw_tile(struct draw *d, struct worker *w, struct glint_box tile,
                      const int32_t *ref, int n_refs)
{
    const int log2 = d->flare->cfg.tile_log2, sums = 3 << (2 * log2);

    if (n_refs == 0)
        return;
    for (int i = 0; i < sums; i++)
        w->acc_q20[i] = 0;
    add_primitives(d, w, tile, ref, n_refs);
    w->n_tiles++;
    glint_resolve_tile(d->flare->resolve, d->image, tile.x0, tile.y0, tile.x1,
                       tile.y1, log2, w->acc_q20);
}

static void draw_tiles(struct draw *d, struct worker *w,
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
    struct worker *w = &f->worker[worker];
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

void glint_flare_draw(struct glint_flare *flare,
                      const struct glint_image *image)
{
    const struct glint_flare_config *c = &flare->cfg;
    struct draw d = {.flare = flare,
                     .image = image,
                     .raster = raster_of(c),
                     .edges = {.vertex = flare->vertex,
                               .primitive = flare->primitive,
                               .bundle = flare->bundle,
                               .stop = &c->stop,
                               .limit_q8 = flare->limit_q8,
                               .tile_log2 = c->tile_log2},
                     .cells = {.vertex = flare->vertex,
                               .primitive = flare->primitive,
                               .bundle = flare->bundle,
                               .stop = &c->stop,
                               .weights = c->weights,
                               .antialias = c->antialias,
                               .tile_log2 = c->tile_log2}};

    glint_resolve_init(flare->resolve, image, c->dither);
    for (int i = 0; i < glint_workers_count(c->workers); i++)
        flare->worker[i].n_tiles = 0;
    if (c->coarse_log2)
        glint_workers_run(c->workers, flare->bins.tiles_x * flare->bins.tiles_y,
                          coarse_job, &d);
    else
        glint_workers_run(c->workers, flare->bins.tiles_y, row_job, &d);
}

int glint_flare_tiles(const struct glint_flare *flare)
{
    int n = 0;

    for (int i = 0; i < glint_workers_count(flare->cfg.workers); i++)
        n += flare->worker[i].n_tiles;
    return n;
}
