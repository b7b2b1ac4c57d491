/* SPDX-License-Identifier: MIT */
#include "engine/frame/frame_parts.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

#include "engine/frame/block.h"

/* Most bundles that a frame may have by edges, and by other rasters. */
enum { MAX_BUNDLES = 1 << 20, MAX_BUNDLES_OTHER = 65535 };

bool glint_frame_has_sets(const struct glint_frame *f)
{
    return f->lens && f->setup->n_sets && f->dials.dispersion_q8 > 0;
}

enum glint_status glint_frame_hold_lights(struct glint_frame *f, int n)
{
    struct glint_light *light;

    if (n <= f->light_capacity)
        return GLINT_OK;
    light = realloc(f->light, (size_t)n * sizeof *f->light);
    if (!light)
        return GLINT_E_MEMORY;
    f->light = light;
    f->light_capacity = n;
    return GLINT_OK;
}

enum glint_status glint_frame_hold_ghosts(struct glint_frame *f)
{
    if (!f->seen)
        f->seen = calloc(GLINT_MAX_GHOSTS, sizeof *f->seen);
    f->dim.method = &glint_dim_method;
    if (!f->dim.log2_q8 && f->lens)
        f->dim.log2_q8 = calloc((size_t)GLINT_DIM_NODES * GLINT_DIM_VALUES *
                                    ((size_t)f->setup->n_ghosts + 1),
                                sizeof *f->dim.log2_q8);
    return f->seen && (f->dim.log2_q8 || !f->lens) ? GLINT_OK : GLINT_E_MEMORY;
}

static bool is_by_edges(const struct glint_frame *f)
{
    return !f->cfg.raster || f->cfg.raster == &glint_raster_edges;
}

/* Returns how many of N bundles a frame may take. */
static int bundles_within(const struct glint_frame *f, double n)
{
    const int most = is_by_edges(f) ? MAX_BUNDLES : MAX_BUNDLES_OTHER;

    return n < most ? (int)n : most;
}

int glint_frame_bundles(const struct glint_frame *f, int n_lights)
{
    const struct glint_setup *s = f->setup;

    return bundles_within(
        f, (double)n_lights * s->n_ghosts *
               (glint_frame_has_sets(f) ? s->set_size[0] : s->n_wavelengths));
}

bool glint_frame_is_served(struct glint_frame *f,
                           const struct glint_flare_stats *s)
{
    struct glint_flare_config *c = &f->cfg;

    const int bundles = bundles_within(f, s->need_bundles);

    if (f->reserved || f->is_full)
        return true;
    if (bundles <= c->max_bundles && s->need_vertices <= c->max_vertices &&
        s->need_primitives <= c->max_primitives &&
        s->need_refs <= c->max_refs && s->need_tile_refs <= c->max_tile_refs)
        return true;
    c->max_bundles = larger(c->max_bundles, bundles);
    c->max_vertices = larger(c->max_vertices, s->need_vertices);
    /* Workers' shares are never quite even. */
    c->max_primitives = larger(
        c->max_primitives,
        (int)fmin(INT_MAX,
                  s->need_primitives *
                      (glint_workers_count(c->workers) > 1 ? 1.5 : 1.0)));
    c->max_refs = larger(c->max_refs, s->need_refs);
    c->max_tile_refs = larger(c->max_tile_refs, s->need_tile_refs);
    return false;
}

/* Returns the bytes for a number of primitives, with references for each and,
 * by cells, vertices: rather too many. */
static size_t bytes_for(struct glint_frame *f, int primitives)
{
    const bool by_edges = is_by_edges(f);

    f->cfg.max_primitives = primitives;
    f->cfg.max_refs = 2 * primitives;
    f->cfg.max_vertices = by_edges ? 0 : 2 * primitives;
    f->cfg.max_tile_refs = f->cfg.coarse_log2 ? primitives : 0;
    return glint_flare_bytes(&f->cfg);
}

/* Sets the capacities that BYTES have room for; returns false if there is none.
 */
static bool fit(struct glint_frame *f, size_t bytes)
{
    int most = 0;

    for (int step = 1 << 24; step > 0; step /= 2) {
        const size_t need = bytes_for(f, most + step);

        if (need != 0 && need <= bytes)
            most += step;
    }
    return most > 0 && bytes_for(f, most) <= bytes;
}

enum glint_status glint_frame_regrow(struct glint_frame *f)
{
    const size_t most = (size_t)((double)f->most_bytes * f->share);
    size_t bytes = glint_flare_bytes(&f->cfg);

    if (f->lens && !f->reserved && most && bytes > most) {
        if (!fit(f, most))
            return GLINT_E_MEMORY;
        f->is_full = true;
        bytes = glint_flare_bytes(&f->cfg);
    }

    free(f->mem);
    f->bytes = 0;
    f->block = glint_block_take(bytes, &f->mem);
    if (!f->block)
        return GLINT_E_MEMORY;
    f->bytes = bytes;
    return glint_flare_init(&f->flare, &f->cfg, f->block, bytes);
}

enum glint_status glint_frame_reserve(struct glint_frame *f, void *mem,
                                      size_t bytes, int n_lamps, int n_drawn)
{
    f->dials.max_lights =
        smaller(f->dials.max_lights, smaller(n_drawn, n_lamps));
    /* Not all ghosts are seen, and few take the largest set. */
    f->cfg.max_bundles =
        bundles_within(f, (glint_frame_has_sets(f) ? 2. : 1) *
                              glint_frame_bundles(f, f->dials.max_lights));
    if (!fit(f, bytes))
        return GLINT_E_MEMORY;
    if (glint_frame_hold_ghosts(f) != GLINT_OK ||
        glint_frame_hold_lights(f, n_lamps) != GLINT_OK)
        return GLINT_E_MEMORY;
    f->reserved = true;
    if (!mem)
        return glint_frame_regrow(f);
    f->block = mem;
    f->bytes = bytes;
    return glint_flare_init(&f->flare, &f->cfg, mem, bytes);
}

size_t glint_frame_bytes_used(const struct glint_frame *f,
                              const struct glint_flare_stats *s)
{
    struct glint_flare_config used = f->cfg;

    used.max_bundles = smaller(s->need_bundles, f->cfg.max_bundles);
    used.max_vertices = s->vertices;
    used.max_primitives = s->primitives;
    used.max_refs = s->refs;
    used.max_tile_refs = s->tile_refs;
    return glint_flare_bytes(&used);
}

size_t glint_frame_bytes_needed(const struct glint_frame *f,
                                const struct glint_flare_stats *s)
{
    struct glint_flare_config needed = f->cfg;

    needed.max_bundles = bundles_within(f, s->need_bundles);
    needed.max_vertices = s->need_vertices;
    needed.max_primitives = s->need_primitives;
    needed.max_refs = s->need_refs;
    needed.max_tile_refs = s->need_tile_refs;
    return glint_flare_bytes(&needed);
}

/* Returns the millions of instructions that a plan takes for looking at N rays.
 */
static double looking_minsn(double n)
{
    return 1e-3 * glint_cost_weight[GLINT_COST_LOOKED_AT].counted * n;
}

static double bound_of(const struct glint_frame *f)
{
    return f->most_minsn * f->share;
}

bool glint_frame_hold_looking(struct glint_frame *f)
{
    enum { RAYS = 200 }; /* rays of a coarse probe and a fine one */
    const int waves = glint_frame_has_sets(f) ? f->setup->set_size[0]
                                              : f->setup->n_wavelengths;
    const double light =
        looking_minsn((double)RAYS * f->setup->n_ghosts * waves);
    const int n = f->n_lights;

    if (f->most_minsn <= 0)
        return false;
    while (f->n_lights > 1 && f->n_lights * light > bound_of(f) / 2)
        f->n_lights--;
    if (f->n_lights == n)
        return false;
    f->dials.max_lights = f->n_lights;
    return f->is_held = true;
}

/* Makes grids as fine as PLAN allows within MINSN, or else the coarsest.
 * Returns the millions of instructions that they take. */
static double hold_grids(struct glint_frame *f,
                         const struct glint_cost_plan *plan, double minsn)
{
    enum { LEAST_FINENESS = 8, STEP = 8 };
    struct glint_cost cost = glint_cost_of(plan, &f->dials);

    while (glint_cost_minsn(&cost) > minsn &&
           f->dials.fineness > LEAST_FINENESS) {
        f->dials.fineness =
            larger(f->dials.fineness - (f->dials.fineness + STEP - 1) / STEP,
                   LEAST_FINENESS);
        cost = glint_cost_of(plan, &f->dials);
    }
    return glint_cost_minsn(&cost);
}

/* Limits ghosts to three wavelengths each. Returns the work that this leaves of
 * MINSN, the work of the plan with the coarsest grids, in millions of
 * instructions. */
static double hold_waves(struct glint_frame *f, double minsn)
{
    enum { WAVES = 3 };
    const double jobs = (double)f->n_lights * f->setup->n_ghosts;
    struct glint_planned planned;
    int n = 0;

    while (glint_flare_planned(f->flare, n, &planned))
        n++;
    f->dials.dispersion_q8 = 0;
    return minsn * fmin(1, WAVES * jobs / fmax(1, n));
}

bool glint_frame_hold_work(struct glint_frame *f)
{
    enum { MOST_PLANS = 12 };
    const struct glint_cost_plan plan = glint_frame_plan(f);
    const struct glint_cost cost = glint_cost_of(&plan, &f->dials);
    const double spent = looking_minsn((double)f->n_looked);
    const double again = spent / f->n_plans;
    const double left = bound_of(f) - spent;
    const struct glint_dials before = f->dials;
    double then;

    if (f->most_minsn <= 0 || f->n_plans >= MOST_PLANS ||
        glint_cost_minsn(&cost) <= left)
        return false;
    then = hold_grids(f, &plan, left - again);
    if (then > left - again && glint_frame_has_sets(f))
        then = hold_waves(f, then);
    if (then > left - again && f->n_lights > 1)
        f->dials.max_lights = larger(
            1, (int)(f->n_lights * fmin(0.75, fmax(0, left / (then + again)))));
    if (f->dials.fineness == before.fineness &&
        f->dials.dispersion_q8 == before.dispersion_q8 &&
        f->dials.max_lights == before.max_lights)
        return false;
    return f->is_held = true;
}
