/* SPDX-License-Identifier: MIT
 *
 * Draws a flare in three parallel steps: converts ray bundles to edges, sorts
 * edges into tiles, and converts rows of tiles to pixels. */
#include "base/divide.h"
#include "base/q.h"
#include "flare/by_edges.h"
#include "flare/edges/ghost_edges.h"

/* ------------------------------------------------------------------ memory */

/* Returns the max number of jobs of a parallel step. The first step has a job
 * per ray bundle, the last a job per row of tiles. */
static size_t count_max_jobs(const struct glint_flare_config *c)
{
    const size_t rows = glint_flare_count_tiles(1, c->height, c->tile_log2);

    return rows > (size_t)c->max_bundles ? rows : (size_t)c->max_bundles;
}

/* Allocates the memory from A. This function and the next are called twice:
 * first with an arena that only adds up sizes, so that they return NULL, then
 * to allocate. */
struct glint_by_edges *glint_edges_allocate(struct glint_arena *a,
                                            const struct glint_flare_config *c)
{
    struct glint_by_edges measured, *placed, *own;

    placed = glint_arena_allocate(a, 1, sizeof *placed);
    own = placed ? placed : &measured;
    own->edge =
        glint_arena_allocate(a, (size_t)c->max_primitives, sizeof *own->edge);
    own->order = glint_arena_allocate(a, count_max_jobs(c), sizeof *own->order);
    return placed;
}

struct glint_edges_worker *
glint_edges_allocate_worker(struct glint_arena *a,
                            const struct glint_flare_config *c)
{
    const size_t side = (size_t)1 << c->tile_log2;
    const size_t n_sums = 3 * side * (size_t)GLINT_EDGE_STRIDE(c->tile_log2);
    struct glint_edges_worker measured, *placed, *w;
    struct glint_edge_sums *s;

    placed = glint_arena_allocate(a, 1, sizeof *placed);
    w = placed ? placed : &measured;
    w->rows = glint_arena_allocate(a, 1, sizeof *w->rows);
    w->at = glint_arena_allocate(
        a, glint_flare_count_tiles(c->width, c->height, c->tile_log2) + 1,
        sizeof *w->at);
    s = &w->sums;
    s->wide = glint_arena_allocate(a, n_sums, sizeof *s->wide);
    s->narrow = glint_arena_allocate(a, n_sums, sizeof *s->narrow);
    s->carry = glint_arena_allocate(a, 3 * side, sizeof *s->carry);
    s->touched = glint_arena_allocate(a, 3, sizeof *s->touched);
    return placed;
}

void glint_edges_clear_sums(struct glint_flare *f)
{
    const int log2 = f->cfg.tile_log2;

    for (int i = 0; i < glint_workers_count(f->cfg.workers); i++) {
        struct glint_edge_sums *s = &glint_flare_get_edges_worker(f, i)->sums;

        for (int c = 0; c < 3; c++)
            s->touched[c] = 0;
        for (int k = 0; k < (3 << log2) * GLINT_EDGE_STRIDE(log2); k++) {
            s->wide[k] = 0;
            s->narrow[k] = 0;
        }
    }
}

/* ------------------------------------------------------------------- order */

typedef int weight_fn(const struct glint_flare *f, int job);

/* Sorts N jobs by falling log2 of their work, WEIGHT. So no worker begins a
 * long job when the others have finished. The order does not affect the
 * picture. */
static void sort_jobs_by_weight(struct glint_flare *f, int n, weight_fn *weight)
{
    int32_t *order = glint_flare_get_edges(f)->order;
    int32_t at[33] = {0};

    for (int i = 0; i < n; i++)
        at[32 - bit_length((uint32_t)weight(f, i))]++;
    for (int k = 0, sum = 0; k < 33; k++) {
        const int here = at[k];

        at[k] = sum;
        sum += here;
    }
    for (int i = 0; i < n; i++)
        order[at[32 - bit_length((uint32_t)weight(f, i))]++] = i;
}

static int get_bundle_cells(const struct glint_flare *f, int bundle)
{
    return f->bundle[bundle].n_cells;
}

static int count_tile_row_edges(const struct glint_flare *f, int row)
{
    const int32_t *start = f->bins.start + row * f->bins.tiles_x;

    return start[f->bins.tiles_x] - start[0];
}

/* ----------------------------------------------------------------- bundles */

/* Returns the flux that ray bundle B would have if all its rays had energy 1.
 * The unit is display white times pixels; the result is rounded up, and at most
 * 2^26. */
static int64_t compute_bundle_flux(const struct glint_bundle *b)
{
    const int64_t cells = (int64_t)b->n_cells * b->n_cells; /* at most 2^20 */
    const int up = b->flux_exponent - 31 + 8;
    const int64_t most_q8 = INT64_C(1) << 34, flux = b->flux_q31 * cells;

    if (b->flux_q31 == 0 || up < -62)
        return 0;
    if (up + bit_length((uint64_t)flux) > 34)
        return most_q8 >> 8;
    return ((up < 0 ? flux >> -up : flux << up) >> 8) + 1;
}

/* Returns the max light that one cell of a ray grid may add to a pixel, 1 =
 * display white, so that sums do not overflow. Sums of _q36 in colours up to 4
 * stay below 2^63 if no pixel gets more than 2^24. A cell cannot add more than
 * its flux. So the limit is GLINT_LIMIT_Q8, or, if the flux of all ray bundles
 * reaches 2^24, at most 2^23 / number of cells. */
static int32_t compute_cell_light_limit_q8(const struct glint_flare *f)
{
    const int64_t most = INT64_C(1) << 24;
    int64_t flux = 0, cells = 1, share_q8;

    for (int i = 0; i < f->n_bundles; i++) {
        flux += compute_bundle_flux(&f->bundle[i]);
        cells += (int64_t)f->bundle[i].n_cells * f->bundle[i].n_cells;
    }
    if (flux < most)
        return GLINT_LIMIT_Q8;
    share_q8 = q_divide(most << 8, 2 * cells);
    return (int32_t)(share_q8 < GLINT_LIMIT_Q8 ? share_q8 : GLINT_LIMIT_Q8);
}

static int add_bin_entries(const struct glint_flare *f, int refs, int first,
                           int n)
{
    const struct glint_edge *edge = glint_flare_get_edges(f)->edge + first;

    for (int k = 0; k < n; k++)
        refs = glint_flare_add_needed_count(
            refs, glint_edge_count_bin_entries(&edge[k], &f->bins));
    return refs;
}

/* Converts ray bundle BUNDLE to edges and stores them after the earlier edges
 * of worker WORKER. If they do not all fit into the worker's range, counts none
 * as stored, sets slot[BUNDLE].first to -1 and, unless BINS is NULL,
 * slot[BUNDLE].refs to the number of entries in BINS that they would need. */
static void emit_bundle_edges(struct glint_flare *f, int bundle, int worker,
                              const struct glint_bins *bins)
{
    const struct glint_by_edges *own = glint_flare_get_edges(f);
    struct glint_plan_scratch *plan = f->worker[worker].plan;
    struct glint_edges_worker *w = glint_flare_get_edges_worker(f, worker);
    struct glint_bundle_slot *slot = &f->slot[bundle];
    struct glint_ghost_edges ghost = {
        .vertex = f->vertex + slot->first_vertex,
        .bundle = &f->bundle[bundle],
        .number = (uint32_t)bundle,
        .stop = &f->cfg.stop,
        .rays = f->rays,
        .worker = worker,
        .coded = f->rays && f->rays->coded,
        .snap_codes_q8 = f->rays ? f->rays->snap_codes_q8 : 0,
        .width = f->width,
        .top = f->bins.region.y0,
        .height = f->bins.region.y1,
        .limit_q8 = own->limit_q8,
        .steps = f->cfg.irradiance_steps,
        .rows = w->rows,
        .edge = own->edge + w->first_edge + w->n_edges,
        .max_edges = w->max_edges - w->n_edges,
        .bins = bins};

    if (f->plan.frame) {
        glint_plan_set_transfer(&f->plan, &f->planned[bundle], &plan->transfer);
        ghost.transfer = &plan->transfer;
        ghost.coded = f->plan.frame->faintest.mantissa != 0;
        ghost.snap_codes_q8 = ghost.coded ? f->plan.frame->snap_codes_q8 : 0;
        ghost.place =
            glint_plan_map_sensor_to_picture(&f->plan, &f->planned[bundle]);
        ghost.sag_q16 = f->planned[bundle].sag_q16;
        ghost.flux = f->planned[bundle].flux;
        ghost.irradiance = f->planned[bundle].irradiance;
    }
    if (!f->rays ||
        f->rays->open(f->rays->ctx, worker, bundle, ghost.top, ghost.height))
        glint_ghost_emit_edges(&ghost);
    slot->first = -1;
    slot->n = ghost.n_edges;
    slot->n_dropped = ghost.n_dropped;
    slot->n_held = ghost.n_held;
    slot->refs = 0;
    if (ghost.n_edges > ghost.max_edges) {
        if (bins)
            slot->refs =
                add_bin_entries(f, ghost.more_refs, w->first_edge + w->n_edges,
                                ghost.max_edges);
        return;
    }
    slot->first = w->first_edge + w->n_edges;
    w->n_edges += ghost.n_edges;
}

/* Returns a copy of the flare's bins in which the list of each tile begins at
 * the entries of WORKER. */
static struct glint_bins make_worker_bins(const struct glint_flare *f,
                                          int worker)
{
    struct glint_bins bins = f->bins;

    bins.start = glint_flare_get_edges_worker(f, worker)->at;
    return bins;
}

static void count_bundle_bin_entries(struct glint_flare *f, int bundle,
                                     int worker)
{
    const struct glint_bundle_slot *slot = &f->slot[bundle];
    struct glint_bins bins = make_worker_bins(f, worker);

    for (int k = 0; slot->first >= 0 && k < slot->n; k++)
        glint_edge_count_into_bins(
            &glint_flare_get_edges(f)->edge[slot->first + k], &bins);
}

static void emit_bundle_job(void *ctx, int job, int worker)
{
    struct glint_flare *f = ctx;
    const int bundle = glint_flare_get_edges(f)->order[job];

    emit_bundle_edges(f, bundle, worker, NULL);
    f->slot[bundle].worker = worker;
    count_bundle_bin_entries(f, bundle, worker);
}

/* Divides the edge array into equal ranges, one for each of N workers. */
static void divide_edge_array_among_workers(struct glint_flare *f, int n)
{
    const int part = f->cfg.max_primitives / n;

    for (int i = 0; i < n; i++) {
        struct glint_edges_worker *w = glint_flare_get_edges_worker(f, i);

        w->first_edge = i * part;
        w->max_edges = part;
        w->n_edges = 0;
    }
}

static void clear_bin_counts(struct glint_flare *f)
{
    for (int i = 0; i < glint_workers_count(f->cfg.workers); i++) {
        struct glint_bins bins = make_worker_bins(f, i);

        glint_bins_clear_counts(&bins);
    }
}

static int are_all_bundles_placed(const struct glint_flare *f)
{
    for (int i = 0; i < f->n_bundles; i++)
        if (f->slot[i].first < 0)
            return 0;
    return 1;
}

/* Converts the ray bundles whose edges did not fit into the range of their
 * worker, and stores these edges in the range of any worker that has enough
 * space left. */
static void emit_bundles_without_space(struct glint_flare *f)
{
    const int n_workers = glint_workers_count(f->cfg.workers);

    for (int i = 0; i < f->n_bundles; i++)
        for (int k = 0; k < n_workers && f->slot[i].first < 0; k++) {
            const struct glint_edges_worker *w =
                glint_flare_get_edges_worker(f, k);

            if (f->slot[i].n > w->max_edges - w->n_edges)
                continue;
            emit_bundle_edges(f, i, k, NULL);
            f->slot[i].worker = k;
            count_bundle_bin_entries(f, i, k);
        }
}

/* Converts all ray bundles to edges again, one after the other into one array.
 * So the choice of dropped bundles does not depend on the timing of workers.
 * Drops the first bundle that does not fit and all bundles after it. */
static void emit_bundles_in_order(struct glint_flare *f)
{
    int full = 0;

    divide_edge_array_among_workers(f, 1);
    clear_bin_counts(f);
    for (int i = 0; i < f->n_bundles; i++) {
        struct glint_bundle_slot *slot = &f->slot[i];

        emit_bundle_edges(f, i, 0, &f->bins);
        slot->worker = 0;
        full |= slot->first < 0;
        if (full && slot->first >= 0)
            slot->refs = add_bin_entries(f, 0, slot->first, slot->n);
        if (full)
            slot->first = -1;
        count_bundle_bin_entries(f, i, 0);
    }
}

static void emit_all_bundles(struct glint_flare *f)
{
    divide_edge_array_among_workers(f, glint_workers_count(f->cfg.workers));
    clear_bin_counts(f);
    sort_jobs_by_weight(f, f->n_bundles, get_bundle_cells);
    glint_workers_run(f->cfg.workers, f->n_bundles, emit_bundle_job, f);
    if (!are_all_bundles_placed(f))
        emit_bundles_without_space(f);
    if (!are_all_bundles_placed(f))
        emit_bundles_in_order(f);
    for (int i = 0; i < f->n_bundles; i++) {
        f->stats.need_primitives = glint_flare_add_needed_count(
            f->stats.need_primitives, f->slot[i].n);
        f->stats.need_refs =
            glint_flare_add_needed_count(f->stats.need_refs, f->slot[i].refs);
        if (f->slot[i].first >= 0)
            f->n_drawn = i + 1;
    }
}

/* -------------------------------------------------------------------- bins */

/* Reduces n_drawn to the number of leading ray bundles whose edges fit into the
 * bins. The counts in the bins are undefined afterwards. */
static void drop_bundles_that_overflow_bins(struct glint_flare *f)
{
    struct glint_bins bins = make_worker_bins(f, 0);
    int refs = 0, n_kept = 0;

    for (int i = 0; i < f->n_drawn; i++) {
        for (int k = 0; k < f->slot[i].n; k++)
            refs = glint_flare_add_needed_count(
                refs, glint_edge_count_into_bins(
                          &glint_flare_get_edges(f)->edge[f->slot[i].first + k],
                          &bins));
        if (refs > f->cfg.max_refs)
            break;
        n_kept = i + 1;
    }
    f->n_drawn = n_kept;
}

/* Converts the workers' counts of bin entries per tile to start indices. In
 * each tile the entries of worker 0 come first, then those of worker 1, and so
 * on. Returns the total number of entries. */
static int assign_bin_indices(struct glint_flare *f)
{
    const int n_tiles = f->bins.tiles_x * f->bins.tiles_y;
    const int n_workers = glint_workers_count(f->cfg.workers);
    int32_t sum = 0;

    for (int tile = 0; tile < n_tiles; tile++) {
        f->bins.start[tile] = sum;
        for (int i = 0; i < n_workers; i++) {
            int32_t *at = glint_flare_get_edges_worker(f, i)->at + tile;
            const int32_t n = *at;

            *at = sum;
            sum = glint_flare_add_needed_count(sum, n);
        }
    }
    f->bins.start[n_tiles] = sum;
    return sum;
}

/* Worker function: puts the edges that worker JOB has emitted into the bins, at
 * the indices that assign_bin_indices() reserved for worker JOB. WORKER, which
 * runs this job, may be another worker. */
static void bin_worker_edges_job(void *ctx, int job, int worker)
{
    struct glint_flare *f = ctx;
    struct glint_bins bins = make_worker_bins(f, job);

    (void)worker;
    for (int i = 0; i < f->n_drawn; i++) {
        const struct glint_bundle_slot *slot = &f->slot[i];

        for (int k = 0; slot->worker == job && k < slot->n; k++)
            glint_edge_put_into_bins(
                &glint_flare_get_edges(f)->edge[slot->first + k], &bins,
                slot->first + k);
    }
}

void glint_edges_bin(struct glint_flare *flare)
{
    struct glint_flare_stats *s = &flare->stats;

    glint_flare_get_edges(flare)->limit_q8 = compute_cell_light_limit_q8(flare);
    flare->n_drawn = 0;
    emit_all_bundles(flare);
    s->refs = assign_bin_indices(flare);
    s->need_refs = glint_flare_add_needed_count(s->need_refs, s->refs);
    if (s->refs > flare->cfg.max_refs) {
        drop_bundles_that_overflow_bins(flare);
        clear_bin_counts(flare);
        for (int i = 0; i < flare->n_drawn; i++)
            count_bundle_bin_entries(flare, i, flare->slot[i].worker);
        s->refs = assign_bin_indices(flare);
    }
    glint_workers_run(flare->cfg.workers,
                      glint_workers_count(flare->cfg.workers),
                      bin_worker_edges_job, flare);
}

/* ----------------------------------------------------------------- drawing */

struct draw {
    struct glint_flare *flare;
    const struct glint_tiles *tiles;
    const struct glint_pass *pass;
    int n_passes;
};

static void draw_tile_row_job(void *ctx, int job, int worker)
{
    const struct draw *d = ctx;

    glint_tiles_draw_row(d->tiles, d->pass, d->n_passes,
                         glint_flare_get_edges(d->flare)->order[job], worker,
                         &d->flare->worker[worker].tile);
}

void glint_edges_draw(struct glint_flare *flare,
                      const struct glint_tiles *tiles, struct glint_pass *pass,
                      int n_below)
{
    struct draw d = {flare, tiles, pass, n_below + 1};

    glint_flare_get_edges(flare)->linear =
        tiles->image && tiles->image->format == GLINT_LINEAR_Q20;
    pass[n_below] = glint_edges_make_pass(flare);
    sort_jobs_by_weight(flare, flare->bins.tiles_y, count_tile_row_edges);
    glint_workers_run(flare->cfg.workers, flare->bins.tiles_y,
                      draw_tile_row_job, &d);
}
