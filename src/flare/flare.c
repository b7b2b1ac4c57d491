/* SPDX-License-Identifier: MIT */
#include "glint/flare.h"

#include "base/real.h"
#include "flare/dim.h"
#include "flare/edges/ghost_shade.h"
#include "flare/by_edges.h"
#include "flare/wave_sets.h"

enum {
    /* opening of a stop with the radius of the model's stop */
    WHOLE_OPENING_Q30 = 1 << 30,
    LEAST_OPENING_Q30 = 1 << 20
};

/* ------------------------------------------------------------------- memory */

static void allocate_worker(struct glint_flare_worker *w, struct glint_arena *a,
                            const struct glint_flare_config *c)
{
    const size_t side = (size_t)1 << c->tile_log2;
    struct glint_tile_scratch *t = &w->tile;

    t->light = glint_arena_allocate(a, 1, sizeof *t->light);
    t->light_q20 = glint_arena_allocate(a, 3 * 2 * side, sizeof *t->light_q20);
    t->codes = glint_arena_allocate(a, 1, sizeof *t->codes);
    w->plan = glint_arena_allocate(a, 1, sizeof *w->plan);
    w->edges = glint_edges_allocate_worker(a, c);
}

/* Allocates a flare from arena A. Called twice: first with an arena that only
 * measures, so that it returns NULL, then to allocate. */
static struct glint_flare *allocate_flare(struct glint_arena *a,
                                          const struct glint_flare_config *c)
{
    const size_t n_workers = (size_t)glint_workers_count(c->workers);
    union {
        struct glint_flare flare;
        struct glint_flare_worker worker;
    } measured;
    struct glint_flare_worker *workers;
    struct glint_flare *f, *placed;

    placed = glint_arena_allocate(a, 1, sizeof *placed);
    f = placed ? placed : &measured.flare;
    f->bundle =
        glint_arena_allocate(a, (size_t)c->max_bundles, sizeof *f->bundle);
    f->slot = glint_arena_allocate(a, (size_t)c->max_bundles, sizeof *f->slot);
    f->planned =
        glint_arena_allocate(a, (size_t)c->max_bundles, sizeof *f->planned);
    f->vertex =
        glint_arena_allocate(a, (size_t)c->max_vertices, sizeof *f->vertex);
    f->edges = glint_edges_allocate(a, c);
    f->reuse = c->reuse ? c->reuse->allocate_state(a, c) : NULL;
    f->bins.start = glint_arena_allocate(
        a, glint_flare_count_tiles(c->width, c->height, c->tile_log2) + 1,
        sizeof *f->bins.start);
    f->bins.ref =
        glint_arena_allocate(a, (size_t)c->max_refs, sizeof *f->bins.ref);
    f->worker = glint_arena_allocate(a, n_workers, sizeof *f->worker);
    f->resolve = glint_arena_allocate(a, 1, sizeof *f->resolve);
    workers = a->base ? f->worker : NULL;
    for (size_t i = 0; i < n_workers; i++)
        allocate_worker(workers ? &workers[i] : &measured.worker, a, c);
    return placed;
}

static int is_valid_stop(const struct glint_stop *s)
{
    const int32_t most_q30 = (1 << 30) - 1;

    if (s->round_q30 &&
        (s->n_blades == 0 || s->round_q30 < 0 || s->round_q30 > most_q30 ||
         s->off_q30 < 1 || s->off_q30 - 1 > most_q30))
        return 0;
    if (s->opening_q30 && (s->opening_q30 < LEAST_OPENING_Q30 ||
                           s->opening_q30 > WHOLE_OPENING_Q30))
        return 0;
    if (s->shade && !glint_shade_is_valid(s->shade))
        return 0;
    return s->n_blades == 0 ||
           (s->n_blades >= 3 && s->n_blades <= GLINT_MAX_BLADES &&
            s->apothem_q16 > 0);
}

static int is_valid_config(const struct glint_flare_config *c)
{
    const int workers = glint_workers_count(c->workers);

    return c->width >= 1 && c->width <= GLINT_MAX_SIDE && c->height >= 1 &&
           c->height <= GLINT_MAX_SIDE && c->tile_log2 >= 3 &&
           c->tile_log2 <= 6 && c->max_bundles >= 0 &&
           c->max_bundles <= GLINT_EDGES_MAX_BUNDLES && c->max_vertices >= 0 &&
           c->max_primitives >= 0 && c->max_refs >= 0 &&
           c->irradiance_steps >= 0 && c->irradiance_steps <= 4096 &&
           c->reuse_lights >= 0 && workers >= 1 && workers <= 64 &&
           is_valid_stop(&c->stop);
}

void glint_flare_reset_tile_state(struct glint_flare *flare)
{
    for (int i = 0; i < glint_workers_count(flare->cfg.workers); i++) {
        struct glint_tile_scratch *t = &flare->worker[i].tile;

        t->n_tiles = t->n_held = 0;
        t->blend = NULL;
    }
}

size_t glint_flare_bytes(const struct glint_flare_config *cfg)
{
    struct glint_arena arena = glint_arena_begin_measuring();

    if (!is_valid_config(cfg))
        return 0;
    allocate_flare(&arena, cfg);
    return arena.used;
}

enum glint_status glint_flare_init(struct glint_flare **flare,
                                   const struct glint_flare_config *cfg,
                                   void *mem, size_t bytes)
{
    struct glint_arena arena = glint_arena_init_in_memory(mem, bytes);
    struct glint_flare *f;

    if (!is_valid_config(cfg) || (uintptr_t)mem % GLINT_ALIGN != 0)
        return GLINT_E_ARGUMENT;
    if (glint_flare_bytes(cfg) > bytes)
        return GLINT_E_MEMORY;
    f = allocate_flare(&arena, cfg);
    f->cfg = *cfg;
    glint_flare_reset_tile_state(f);
    glint_edges_clear_sums(f);
    glint_flare_begin(f);
    *flare = f;
    return GLINT_OK;
}

enum glint_status glint_flare_set_stop(struct glint_flare *flare,
                                       const struct glint_stop *stop)
{
    if (!is_valid_stop(stop))
        return GLINT_E_ARGUMENT;
    flare->cfg.stop = *stop;
    flare->reusable = GLINT_REUSABLE_NOT;
    return GLINT_OK;
}

/* ------------------------------------------------------------------ bundles */

/* Sets the size of the drawn area, in drawn pixels, which are 2 x 2 pixels of
 * the picture if HALF is 1. */
static void set_drawn_size(struct glint_flare *f, int half)
{
    f->half = half;
    f->width = (f->cfg.width + half) >> half;
    f->height = (f->cfg.height + half) >> half;
    glint_bins_init(&f->bins, (struct glint_box){0, 0, f->width, f->height},
                    f->cfg.tile_log2, f->bins.start, f->bins.ref);
}

void glint_flare_begin(struct glint_flare *flare)
{
    set_drawn_size(flare, 0);
    flare->n_bundles = flare->n_vertices = flare->n_drawn = 0;
    flare->plan.frame = NULL;
    flare->rays = NULL;
    flare->reusable = GLINT_REUSABLE_NOT;
    for (int i = 0; i < glint_workers_count(flare->cfg.workers); i++)
        flare->worker[i].plan->n_rays = 0;
    flare->stats = (struct glint_flare_stats){0};
}

void glint_flare_begin_rays(struct glint_flare *flare,
                            const struct glint_flare_rays *rays)
{
    glint_flare_begin(flare);
    flare->rays = rays;
}

void glint_flare_set_rows(struct glint_flare *flare, int y0, int y1)
{
    struct glint_flare_stats *s = &flare->stats;

    glint_bins_init(&flare->bins, (struct glint_box){0, y0, flare->width, y1},
                    flare->cfg.tile_log2, flare->bins.start, flare->bins.ref);
    s->bundles = s->primitives = s->refs = 0;
    s->need_primitives = s->need_refs = 0;
    s->dropped_cells = s->held_cells = 0;
}

struct glint_vertex *glint_flare_add(struct glint_flare *flare,
                                     const struct glint_bundle *bundle)
{
    const int n =
        flare->rays ? 0 : (bundle->n_cells + 1) * (bundle->n_cells + 1);
    struct glint_flare_stats *s = &flare->stats;
    struct glint_vertex *vertices;

    flare->reusable = GLINT_REUSABLE_NOT;
    s->need_bundles++;
    s->need_vertices = glint_flare_add_needed_count(s->need_vertices, n);
    if (flare->n_bundles == flare->cfg.max_bundles ||
        n > flare->cfg.max_vertices - flare->n_vertices) {
        s->dropped_bundles++;
        return NULL;
    }
    vertices = flare->vertex + flare->n_vertices;
    flare->bundle[flare->n_bundles] = *bundle;
    flare->slot[flare->n_bundles++] =
        (struct glint_bundle_slot){.first_vertex = flare->n_vertices};
    flare->n_vertices += n;
    return flare->rays ? NULL : vertices;
}

/* -------------------------------------------------------------------- plan */

/* Returns the number of the N LIGHTS without those at the end of the list that
 * are outside the model's range of angles. So a frame with only such lights
 * costs nothing. */
static int count_lights_in_range(const struct glint_lens *lens,
                                 const struct glint_light *lights, int n)
{
    while (n > 0 && glint_plan_is_light_outside_model(lens, &lights[n - 1]))
        n--;
    return n;
}

/* Worker function: plans the ray bundles of all wavelengths for one ghost and
 * one light. JOB is the number of this pair. */
static void plan_ghost_and_light_job(void *ctx, int job, int worker)
{
    struct glint_flare *f = ctx;
    const struct glint_flare_frame *r = f->plan.frame;
    const int n_ghosts = (int)r->lens->header->n_ghosts;
    const int ghost = job % n_ghosts, i = job / n_ghosts;
    /* This is a copy, as the first ray bundle overwrites the memory of a merged
     * light. */
    const struct glint_light light =
        f->plan.dims ? *r->dim->method->merged_light(f, ghost, i)
                     : f->plan.light[i];

    for (int wave = 0; wave < r->n_waves; wave++) {
        const int at = job * r->n_waves + wave;

        if (at >= f->cfg.max_bundles)
            return;
        f->planned[at] = (struct glint_bundle_plan){
            .ghost = ghost, .light = i, .wave = wave};
        if (light.power.mantissa == 0)
            f->bundle[at].n_cells = 0;
        else
            glint_plan_bundle(&f->plan, &light, &f->planned[at], &f->bundle[at],
                              f->worker[worker].plan);
    }
}

/* Removes invisible ghosts among the first N ray bundles by setting n_cells to
 * 0. A sum of light may be visible although no single peak is, so the peaks of
 * a ghost in one wavelength are summed over all lights, and the wavelength is
 * removed for all lights or for none. */
static void remove_invisible_ghosts(struct glint_flare *f, int n)
{
    const struct glint_flare_frame *r = f->plan.frame;
    const int64_t stride = (int64_t)r->lens->header->n_ghosts * r->n_waves;

    for (int first = 0; first < stride && first < n; first++) {
        int64_t sum_q20 = 0;

        for (int64_t i = first; i < n; i += stride)
            sum_q20 += f->bundle[i].n_cells ? f->planned[i].peak_q20 : 0;
        for (int64_t i = first; i < n && sum_q20 < 1 << 20; i += stride)
            f->bundle[i].n_cells = 0;
    }
}

/* Removes the ray bundles with n_cells = 0 from the first N bundles and closes
 * the gaps. Sets n_bundles, flux and brightest. */
static void compact_visible_bundles(struct glint_flare *f, int n)
{
    for (int i = 0; i < n; i++) {
        if (f->bundle[i].n_cells == 0)
            continue;
        f->flux = real_plus(f->flux, f->planned[i].flux);
        if (real_less(f->brightest, f->planned[i].irradiance))
            f->brightest = f->planned[i].irradiance;
        f->bundle[f->n_bundles] = f->bundle[i];
        f->planned[f->n_bundles] = f->planned[i];
        f->slot[f->n_bundles++] = (struct glint_bundle_slot){0};
    }
}

/* Plans the ray bundles of N_JOBS pairs of a ghost and a light.
 * Returns the number of planned bundles, at most max_bundles. */
static int plan_all_bundles(struct glint_flare *f, int n_jobs)
{
    const int n_waves = f->plan.frame->n_waves;
    const int need =
        n_jobs < INT32_MAX / n_waves ? n_jobs * n_waves : INT32_MAX;
    const int n = need < f->cfg.max_bundles ? need : f->cfg.max_bundles;

    f->stats.need_bundles = need;
    f->stats.dropped_bundles = need - n;
    if (n > 0)
        glint_workers_run(f->cfg.workers, (n + n_waves - 1) / n_waves,
                          plan_ghost_and_light_job, f);
    remove_invisible_ghosts(f, n);
    return n;
}

void glint_flare_plan(struct glint_flare *flare,
                      const struct glint_flare_frame *frame,
                      const struct glint_light *lights, int n_lights)
{
    const int n_ghosts = (int)frame->lens->header->n_ghosts;
    const int64_t pairs =
        (int64_t)count_lights_in_range(frame->lens, lights, n_lights) *
        n_ghosts;
    const int n_jobs = pairs < INT32_MAX ? (int)pairs : INT32_MAX;

    if (flare->cfg.reuse &&
        flare->cfg.reuse->reuse_if_unchanged(flare, frame, lights, n_lights))
        return;
    glint_flare_begin(flare);
    flare->quads = frame->half;
    set_drawn_size(flare, frame->half != NULL);
    flare->plan = (struct glint_plan){
        .frame = frame,
        .light = lights,
        .n_lights = n_lights,
        .width = flare->cfg.width,
        .height = flare->cfg.height,
        .sets = flare->cfg.sets,
        .half = flare->half,
        .round_q16 = flare->cfg.stop.n_blades == 0
                         ? 1 << 16
                         : flare->cfg.stop.round_q30 >> 14,
        .shaded = flare->cfg.stop.shade != NULL,
        .opening_q30 = flare->cfg.stop.opening_q30 ? flare->cfg.stop.opening_q30
                                                   : WHOLE_OPENING_Q30};
    /* The table of ghost brightness has only the angle of a light off the axis,
     * so it is not used with models that also depend on the azimuth
     * (GLINT_BASIS_LENS). */
    if (frame->dim && frame->dimmest.mantissa && !frame->sets &&
        frame->n_waves == GLINT_DIM_WAVES &&
        !(frame->lens && glint_basis_is_lens(frame->lens->header->basis))) {
        frame->dim->method->fill_nodes(
            flare, count_lights_in_range(frame->lens, lights, n_lights));
        flare->plan.dims = 1;
        frame->dim->method->merge_near_lights(
            flare, count_lights_in_range(frame->lens, lights, n_lights));
    }
    flare->flux = flare->brightest = (struct glint_real){0, 0};
    compact_visible_bundles(
        flare, frame->sets ? frame->sets->planner->plan(flare, n_jobs)
                           : plan_all_bundles(flare, n_jobs));
    if (flare->cfg.reuse)
        flare->reusable = GLINT_REUSABLE_PLANNED;
}

int glint_flare_ghost(const struct glint_flare *flare, int i)
{
    return flare->planned[i].ghost;
}

int glint_flare_planned(const struct glint_flare *flare, int i,
                        struct glint_planned *planned)
{
    if (i >= flare->n_bundles)
        return 0;
    *planned =
        (struct glint_planned){.n_cells = flare->bundle[i].n_cells,
                               .flux = flare->planned[i].flux,
                               .irradiance = flare->planned[i].irradiance,
                               .ghost = flare->planned[i].ghost,
                               .light = flare->planned[i].light,
                               .wave = flare->planned[i].wave,
                               .inside_q8 = flare->planned[i].inside_q8,
                               .view_q8 = flare->planned[i].view_q8,
                               .contrast_q4 = flare->planned[i].contrast_q4};
    return 1;
}

void glint_flare_light(const struct glint_flare *flare,
                       struct glint_real *brightest, struct glint_real *flux)
{
    *brightest = flare->brightest;
    *flux = flare->flux;
}

int64_t glint_flare_looked(const struct glint_flare *flare)
{
    int64_t n = 0;

    for (int i = 0; i < glint_workers_count(flare->cfg.workers); i++)
        n += flare->worker[i].plan->n_rays;
    return n;
}

/* Sets the statistics of the frame to totals over the first n_drawn ray
 * bundles, whose edges fit into the bins. */
static void sum_drawn_statistics(struct glint_flare *f)
{
    struct glint_flare_stats *s = &f->stats;

    s->bundles = f->n_drawn;
    s->vertices = f->n_vertices;
    s->dropped_bundles += f->n_bundles - f->n_drawn;
    s->primitives = 0;
    for (int i = 0; i < f->n_drawn; i++) {
        const struct glint_bundle_slot *slot = &f->slot[i];

        s->primitives += slot->n;
        s->dropped_cells =
            glint_flare_add_needed_count(s->dropped_cells, slot->n_dropped);
        s->held_cells =
            glint_flare_add_needed_count(s->held_cells, slot->n_held);
    }
}

void glint_flare_bin(struct glint_flare *flare, struct glint_flare_stats *stats)
{
    if (flare->reusable != GLINT_REUSABLE_BINNED) {
        if (flare->n_bundles > 0)
            glint_edges_bin(flare);
        sum_drawn_statistics(flare);
    }
    if (flare->reusable != GLINT_REUSABLE_NOT)
        flare->cfg.reuse->apply_gains(flare);
    *stats = flare->stats;
}

struct glint_tiles glint_flare_prepare_tiles(struct glint_flare *flare,
                                             const struct glint_image *image)
{
    static const struct glint_image none = {.format = GLINT_YUYV};

    glint_resolve_init(flare->resolve, image ? image : &none, flare->cfg.dither,
                       flare->cfg.sets);
    return (struct glint_tiles){.region = flare->bins.region,
                                .tile_log2 = flare->cfg.tile_log2,
                                .half = flare->half,
                                .width = flare->cfg.width,
                                .height = flare->cfg.height,
                                .image = image,
                                .resolve = flare->resolve,
                                .quads = flare->quads};
}

void glint_flare_draw(struct glint_flare *flare,
                      const struct glint_image *image)
{
    struct glint_pass pass[1];
    struct glint_tiles tiles;

    if (flare->bins.region.y0 == 0)
        glint_flare_reset_tile_state(flare);
    if (flare->stats.primitives == 0)
        return; /* The bins may contain the edges of an earlier frame. */
    tiles = glint_flare_prepare_tiles(flare, image);
    glint_edges_draw(flare, &tiles, pass, 0);
}

int glint_flare_tiles(const struct glint_flare *flare)
{
    int n = 0;

    for (int i = 0; i < glint_workers_count(flare->cfg.workers); i++)
        n += flare->worker[i].tile.n_tiles;
    return n;
}

int glint_flare_held(const struct glint_flare *flare)
{
    int n = 0;

    for (int i = 0; i < glint_workers_count(flare->cfg.workers); i++)
        n += flare->worker[i].tile.n_held;
    return n;
}
