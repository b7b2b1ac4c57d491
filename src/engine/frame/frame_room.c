/* SPDX-License-Identifier: MIT */
#include "engine/frame/frame_parts.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/frame/block.h"
#include "engine/setup/dirt.h"

/* max number of ray bundles of a frame */
enum { MAX_BUNDLES = 1 << 20 };
/* min fineness to which limits of memory and work may reduce grids */
enum { LEAST_FINENESS = 8 };
/* Factor on the capacity for edges (primitives), because workers fill their
 * ranges unevenly. Memory limits assume this factor for one worker, too, so
 * that pictures do not depend on the number of workers. */
#define UNEVEN 1.5
/* fraction of the memory limit to which coarser grids reduce a frame; below 1,
 * as grids have integer numbers of cells */
#define ROOM_SHARE 0.9
/* If coarser grids still need more than this fraction of the memory of the
 * previous grids, grids are not made coarser again. */
#define NO_GAIN 0.98

bool glint_frame_has_wave_sets(const struct glint_frame *f)
{
    return f->lens && f->setup->n_sets && f->dials.dispersion_q8 > 0;
}

enum glint_status glint_frame_allocate_lights(struct glint_frame *f, int n)
{
    struct glint_light *light;

    if (n <= f->lights.capacity)
        return GLINT_OK;
    light = realloc(f->lights.light, (size_t)n * sizeof *f->lights.light);
    if (!light)
        return GLINT_E_MEMORY;
    f->lights.light = light;
    f->lights.capacity = n;
    return GLINT_OK;
}

static int clamp_bundle_count(double n)
{
    return n < MAX_BUNDLES ? (int)n : MAX_BUNDLES;
}

/* Returns the number of ray bundles of N_LIGHTS lights in the wavelengths of
 * the first set, or in all wavelengths if there are no sets. */
static int count_bundles_of_first_wave_set(const struct glint_frame *f,
                                           int n_lights)
{
    const struct glint_setup *s = f->setup;

    return clamp_bundle_count(
        (double)n_lights * glint_frame_count_pupil_regions(f) *
        (glint_frame_has_wave_sets(f) ? s->set_size[0] : s->n_wavelengths));
}

static size_t compute_frame_memory_limit(const struct glint_frame *f)
{
    return (size_t)((double)f->limits.most_bytes * f->limits.share);
}

/* Returns the frame's configuration with the capacities that STATS, the result
 * of binning, requires. */
static struct glint_flare_config
make_config_with_needed_capacity(const struct glint_frame *f,
                                 const struct glint_flare_stats *s)
{
    struct glint_flare_config needed = f->cfg;

    needed.max_bundles = clamp_bundle_count(s->need_bundles);
    needed.max_vertices = s->need_vertices;
    needed.max_primitives = s->need_primitives;
    needed.max_refs = s->need_refs;
    return needed;
}

/* Returns the bytes that the capacities for S need with one worker and UNEVEN
 * times the edges, so that the result does not depend on the number of workers.
 * FIXED receives how many of these bytes do not depend on the fineness of
 * grids. */
static double estimate_flare_bytes(const struct glint_frame *f,
                                   const struct glint_flare_stats *s,
                                   double *fixed)
{
    struct glint_flare_config needed = make_config_with_needed_capacity(f, s);
    double bytes;

    needed.workers = NULL;
    needed.max_primitives = (int)fmin(INT_MAX, s->need_primitives * UNEVEN);
    bytes = (double)glint_flare_bytes(&needed);
    needed.max_primitives = needed.max_refs = 1;
    *fixed = (double)glint_flare_bytes(&needed);
    return bytes;
}

/* Sets the capacities of the frame's configuration to PRIMITIVES edges and
 * twice as many references to edges in tiles. Returns the bytes that the
 * configuration then needs. */
static size_t set_primitive_capacity(struct glint_frame *f, int primitives)
{
    f->cfg.max_primitives = primitives;
    f->cfg.max_refs = 2 * primitives;
    return glint_flare_bytes(&f->cfg);
}

/* Sets the capacities of the frame's configuration to the max that fits into
 * BYTES, by binary search. Returns false if no primitive fits. */
static bool fit_capacity_to_bytes(struct glint_frame *f, size_t bytes)
{
    int most = 0;

    for (int step = 1 << 24; step > 0; step /= 2) {
        const size_t need = set_primitive_capacity(f, most + step);

        if (need != 0 && need <= bytes)
            most += step;
    }
    return most > 0 && set_primitive_capacity(f, most) <= bytes;
}

/* Returns the capacity for edges with which set_primitive_capacity() provides
 * enough edges and references for S. */
static double count_needed_primitives(const struct glint_flare_stats *s)
{
    return fmax(s->need_primitives * UNEVEN, s->need_refs / 2.0);
}

/* Makes grids coarser if the memory that S requires exceeds the limit or the
 * reserved memory. Returns whether they changed. The result depends neither on
 * the number of workers nor on earlier frames. Memory that is not reserved
 * grows to its limit, so that the coarser grids fit. */
static bool coarsen_grids_to_memory(struct glint_frame *f,
                                    const struct glint_flare_stats *s)
{
    const double most = f->limits.reserved
                            ? f->limits.most_primitives
                            : (double)compute_frame_memory_limit(f);
    const int fineness = f->dials.fineness;
    double fixed = 0;
    const double need = f->limits.reserved ? count_needed_primitives(s)
                                           : estimate_flare_bytes(f, s, &fixed);

    if (most <= 0 || f->budget.ms > 0 || need <= most ||
        fineness <= LEAST_FINENESS ||
        (f->limits.tight > 0 && need > NO_GAIN * f->limits.tight))
        return false;
    if (f->limits.tight <= 0)
        f->limits.tight_bytes = glint_frame_count_needed_bytes(f, s);
    f->limits.tight = need;
    f->dials.fineness = max_int(
        LEAST_FINENESS,
        min_int(fineness - 1,
                (int)(fineness * sqrt(fmax(0, (ROOM_SHARE * most - fixed) /
                                                  (need - fixed))))));
    if (!f->limits.reserved)
        fit_capacity_to_bytes(f, (size_t)most);
    return f->limits.is_held = true;
}

bool glint_frame_fit_capacity(struct glint_frame *f,
                              const struct glint_flare_stats *s)
{
    struct glint_flare_config *c = &f->cfg;
    const int bundles = clamp_bundle_count(s->need_bundles);

    if (f->limits.is_full)
        return true;
    if (coarsen_grids_to_memory(f, s))
        return false;
    if (f->limits.reserved)
        return true;
    if (bundles <= c->max_bundles && s->need_primitives <= c->max_primitives &&
        s->need_refs <= c->max_refs)
        return true;
    c->max_bundles = max_int(c->max_bundles, bundles);
    c->max_primitives = max_int(
        c->max_primitives,
        (int)fmin(INT_MAX,
                  s->need_primitives *
                      (glint_workers_count(c->workers) > 1 ? UNEVEN : 1.0)));
    c->max_refs = max_int(c->max_refs, s->need_refs);
    return false;
}

enum glint_status glint_frame_reallocate_flare(struct glint_frame *f)
{
    const size_t most = compute_frame_memory_limit(f);
    size_t bytes = glint_flare_bytes(&f->cfg);

    if (f->lens && !f->limits.reserved && most && bytes > most) {
        if (!fit_capacity_to_bytes(f, most))
            return GLINT_E_MEMORY;
        f->limits.is_full = true;
        bytes = glint_flare_bytes(&f->cfg);
    }

    /* A block of the right size is reused, as in videos whose every frame
     * reaches the limit. */
    if (!f->memory.block || f->memory.bytes != bytes) {
        free(f->memory.mem);
        f->memory.bytes = 0;
        f->memory.block = glint_block_allocate_aligned(bytes, &f->memory.mem);
        if (!f->memory.block)
            return GLINT_E_MEMORY;
        f->memory.bytes = bytes;
    }
    return glint_flare_init(&f->memory.flare, &f->cfg, f->memory.block, bytes);
}

static enum glint_status allocate_static_lights(struct glint_frame *f, int n)
{
    struct glint_still *s = &f->still;
    const size_t size = (size_t)n;

    if (n <= s->max_lights)
        return GLINT_OK;
    free(s->light);
    free(s->gain_q14);
    free(s->sum_q20);
    *s = (struct glint_still){.light = malloc(size * sizeof *s->light),
                              .gain_q14 = malloc(size * sizeof *s->gain_q14),
                              .sum_q20 = malloc(size * sizeof *s->sum_q20)};
    if (!s->light || !s->gain_q14 || !s->sum_q20)
        return GLINT_E_MEMORY;
    s->max_lights = n;
    return GLINT_OK;
}

enum glint_status glint_frame_use_static_lights(struct glint_frame *f,
                                                int32_t near_q30)
{
    struct glint_still *s = &f->still;
    int n;

    if (!f->cfg.reuse || f->dials.still_px <= 0 ||
        (f->limits.reserved && !f->cfg.reuse_gains))
        return GLINT_OK;
    if (!f->limits.reserved &&
        allocate_static_lights(f, f->lights.capacity) != GLINT_OK)
        return GLINT_E_MEMORY;
    if (s->n > max_int(f->lights.n, f->dials.max_lights))
        s->n = 0;
    n = glint_lights_still(s, f->lights.light, f->lights.n, near_q30);
    if (n == 0)
        return GLINT_OK;
    memcpy(f->lights.light, s->light, (size_t)n * sizeof *s->light);
    f->lights.n_more += n - f->lights.n;
    f->lights.n = n;
    f->lights.gain_q14 = (const int32_t(*)[3])s->gain_q14;
    return GLINT_OK;
}

/* Returns whether the memory block suffices to plan N ray bundles of the
 * frame's lights. */
static bool has_plan_capacity(const struct glint_frame *f, int n)
{
    return f->memory.block && n <= f->cfg.max_bundles &&
           (!f->cfg.reuse || f->lights.n <= f->cfg.reuse_lights) &&
           (!f->lights.gain_q14 || f->cfg.reuse_gains);
}

enum glint_status glint_frame_ensure_plan_capacity(struct glint_frame *f)
{
    const int bundles = count_bundles_of_first_wave_set(f, f->lights.n);

    if (f->limits.reserved || has_plan_capacity(f, bundles))
        return GLINT_OK;
    f->cfg.max_bundles = max_int(bundles, f->cfg.max_bundles);
    if (f->cfg.reuse)
        f->cfg.reuse_lights = max_int(f->lights.n, f->cfg.reuse_lights);
    f->cfg.reuse_gains |= f->lights.gain_q14 != NULL;
    return glint_frame_reallocate_flare(f);
}

size_t glint_frame_compute_min_bytes(struct glint_frame *f)
{
    return set_primitive_capacity(f, 1);
}

enum glint_status glint_frame_reserve_memory(struct glint_frame *f, void *mem,
                                             size_t bytes, int n_lamps,
                                             int n_drawn)
{
    struct glint_workers *const workers = f->cfg.workers;

    f->dials.max_lights =
        min_int(f->dials.max_lights, min_int(n_drawn, n_lamps));
    /* Twice the ray bundles of the first set of wavelengths suffice, as not all
     * ghosts are visible, and few need a larger set. */
    f->cfg.max_bundles = clamp_bundle_count(
        (glint_frame_has_wave_sets(f) ? 2. : 1) *
        count_bundles_of_first_wave_set(f, f->dials.max_lights));
    if (f->cfg.reuse)
        f->cfg.reuse_lights = f->dials.max_lights;
    f->cfg.reuse_gains = f->cfg.reuse && f->dials.still_px > 0;
    f->cfg.workers = NULL;
    fit_capacity_to_bytes(f, bytes);
    f->limits.most_primitives = f->cfg.max_primitives;
    f->cfg.workers = workers;
    if (!fit_capacity_to_bytes(f, bytes))
        return GLINT_E_MEMORY;
    /* Everything is allocated now, as quality parameters may change later. */
    if (glint_frame_allocate_ghost_data(f) != GLINT_OK ||
        (f->lens && glint_frame_allocate_dim_table(f) != GLINT_OK) ||
        glint_frame_allocate_lights(f, n_lamps) != GLINT_OK ||
        (f->cfg.reuse_gains &&
         allocate_static_lights(f, f->cfg.reuse_lights) != GLINT_OK))
        return GLINT_E_MEMORY;
    f->limits.reserved = true;
    if (!mem)
        return glint_frame_reallocate_flare(f);
    f->memory.block = mem;
    f->memory.bytes = bytes;
    return glint_flare_init(&f->memory.flare, &f->cfg, mem, bytes);
}

size_t glint_frame_count_used_bytes(const struct glint_frame *f,
                                    const struct glint_flare_stats *s)
{
    struct glint_flare_config used = f->cfg;

    used.max_bundles = min_int(s->need_bundles, f->cfg.max_bundles);
    used.max_vertices = s->vertices;
    used.max_primitives = s->primitives;
    used.max_refs = s->refs;
    return glint_flare_bytes(&used);
}

size_t glint_frame_count_needed_bytes(const struct glint_frame *f,
                                      const struct glint_flare_stats *s)
{
    const struct glint_flare_config needed =
        make_config_with_needed_capacity(f, s);

    return f->limits.tight > 0 ? f->limits.tight_bytes
                               : glint_flare_bytes(&needed);
}

static double estimate_probe_minsn(double n_rays)
{
    return 1e-3 * glint_cost_weight[GLINT_COST_LOOKED_AT].counted * n_rays;
}

static double compute_frame_work_limit_minsn(const struct glint_frame *f)
{
    return f->limits.most_minsn * f->limits.share;
}

bool glint_frame_limit_probing(struct glint_frame *f)
{
    enum {
        RAYS = 200
    }; /* number of rays of a small and a large probe of a ray bundle
          together */
    const int waves = glint_frame_has_wave_sets(f) ? f->setup->set_size[0]
                                                   : f->setup->n_wavelengths;
    const double light = estimate_probe_minsn(
        (double)RAYS * glint_frame_count_pupil_regions(f) * waves);
    const int n = f->lights.n;

    if (f->limits.most_minsn <= 0)
        return false;
    while (f->lights.n > 1 &&
           f->lights.n * light > compute_frame_work_limit_minsn(f) / 2)
        f->lights.n--;
    if (f->lights.n == n)
        return false;
    f->dials.max_lights = f->lights.n;
    return f->limits.is_held = true;
}

/* Returns whether dust causes more than half of COST, and coarser tables of
 * dust exist. */
static bool is_cost_mostly_dust(const struct glint_frame *f,
                                const struct glint_cost_plan *plan,
                                const struct glint_cost *cost)
{
    return plan->shade && f->dials.dust_log2 > GLINT_SHADE_LEAST_LOG2 &&
           2e-3 * glint_cost_weight[GLINT_COST_PARTS].planned *
                   cost->count[GLINT_COST_PARTS] >
               glint_cost_convert_to_minsn(cost);
}

/* Makes dust tables and grids coarser, step by step, until PLAN costs at most
 * MINSN or they are as coarse as possible. Returns the resulting cost, millions
 * of instructions. */
static double coarsen_grids_to_minsn(struct glint_frame *f,
                                     const struct glint_cost_plan *plan,
                                     double minsn)
{
    enum { STEP = 8 };
    struct glint_cost cost = glint_cost_of(plan, &f->dials);

    if (plan->shade)
        f->dials.dust_log2 = min_int(f->dials.dust_log2, plan->shade->log2);
    while (glint_cost_convert_to_minsn(&cost) > minsn) {
        if (is_cost_mostly_dust(f, plan, &cost))
            f->dials.dust_log2--;
        else if (f->dials.fineness > LEAST_FINENESS)
            f->dials.fineness = max_int(
                f->dials.fineness - (f->dials.fineness + STEP - 1) / STEP,
                LEAST_FINENESS);
        else
            break;
        cost = glint_cost_of(plan, &f->dials);
    }
    return glint_cost_convert_to_minsn(&cost);
}

/* Limits each ghost to three wavelengths. MINSN is the cost of the plan before.
 * Returns the estimated cost afterwards, both in millions of instructions. */
static double limit_ghost_wavelengths(struct glint_frame *f, double minsn)
{
    enum { WAVES = 3 };
    const double jobs =
        (double)f->lights.n * glint_frame_count_pupil_regions(f);
    struct glint_planned planned;
    int n = 0;

    while (glint_flare_planned(f->memory.flare, n, &planned))
        n++;
    f->dials.dispersion_q8 = 0;
    return minsn * fmin(1, WAVES * jobs / fmax(1, n));
}

/* The result is also valid before the plan is drawn, so that its cost can be
 * predicted. */
struct glint_cost_plan glint_frame_make_cost_plan(const struct glint_frame *f)
{
    return (struct glint_cost_plan){
        .flare = f->memory.flare,
        .width = f->cfg.width,
        .height = f->cfg.height,
        .n_star = f->star.is_set ? f->star.pixels : 0,
        .n_veil = glint_frame_veil_estimate_cost_px(f),
        .n_looked_at =
            f->memory.flare ? (double)glint_flare_looked(f->memory.flare) : 0,
        .can_half = f->picture.can_half,
        .can_dim = f->dim.table.log2_q8 && f->setup->n_wavelengths == 3,
        .code = f->picture.code_light,
        .shade = f->setup->dirt ? &f->setup->dirt->shade : NULL,
        .dials = f->dials};
}

bool glint_frame_limit_work(struct glint_frame *f)
{
    enum { MOST_PLANS = 12 };
    const struct glint_cost_plan plan = glint_frame_make_cost_plan(f);
    const struct glint_cost cost = glint_cost_of(&plan, &f->dials);
    const double spent = estimate_probe_minsn((double)f->plan.n_looked);
    const double again = spent / f->plan.n_plans;
    const double left = compute_frame_work_limit_minsn(f) - spent;
    const struct glint_dials before = f->dials;
    double then;

    if (f->limits.most_minsn <= 0 || f->plan.n_plans >= MOST_PLANS ||
        glint_cost_convert_to_minsn(&cost) <= left)
        return false;
    then = coarsen_grids_to_minsn(f, &plan, left - again);
    if (then > left - again && glint_frame_has_wave_sets(f))
        then = limit_ghost_wavelengths(f, then);
    if (then > left - again && f->lights.n > 1)
        f->dials.max_lights = max_int(
            1, (int)(f->lights.n * fmin(0.75, fmax(0, left / (then + again)))));
    if (f->dials.fineness == before.fineness &&
        f->dials.dust_log2 == before.dust_log2 &&
        f->dials.dispersion_q8 == before.dispersion_q8 &&
        f->dials.max_lights == before.max_lights)
        return false;
    return f->limits.is_held = true;
}

/* ------------------------------------------------------------------- dust */

bool glint_frame_select_dust_tables(struct glint_frame *f)
{
    const struct glint_shade *all =
        f->setup->dirt ? &f->setup->dirt->shade : NULL;
    const struct glint_shade *const before = f->cfg.stop.shade;
    const int was = before ? before->log2 : 0;
    int skipped;

    if (!all || !before)
        return false;
    skipped = max_int(
        all->log2 - max_int(f->dials.dust_log2, GLINT_SHADE_LEAST_LOG2), 0);
    f->shade = *all;
    f->shade.log2 = all->log2 - skipped;
    for (int k = 0; k < f->shade.log2; k++) {
        f->shade.level_q15[k] = all->level_q15[k + skipped];
        f->shade.rough_q8[k] = all->rough_q8[k + skipped];
    }
    f->cfg.stop.shade = skipped ? &f->shade : all;
    return before != f->cfg.stop.shade || was != f->cfg.stop.shade->log2;
}
