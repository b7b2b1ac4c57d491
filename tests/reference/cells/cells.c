/* SPDX-License-Identifier: MIT */
#include "reference/cells/cells.h"

#include <assert.h>
#include <stdlib.h>

#include "base/q.h"
#include "flare/state.h"
#include "reference/cells/ghost_grid.h"

/* Returns the vertices of BUNDLE: those that were taken in, or rays of the lens
 * that was planned, which are put into ROOM. */
static const struct glint_vertex *rays_of(const struct glint_flare *f,
                                          int bundle, struct glint_vertex *room)
{
    struct glint_transfer transfer;
    struct glint_place place;

    if (!f->plan.frame)
        return f->vertex + f->slot[bundle].first_vertex;
    place = glint_plan_place(&f->plan, &f->planned[bundle]);
    glint_plan_transfer(&f->plan, &f->planned[bundle], &transfer);
    glint_transfer_grid(&transfer, &place, f->bundle[bundle].n_cells, room);
    return room;
}

/* Adds a bundle to ACC_Q20. Returns how many cells were merged. */
static int add_bundle(const struct glint_flare *f, int bundle,
                      const struct cells_options *o, int64_t *acc_q20)
{
    const struct glint_bundle *b = &f->bundle[bundle];
    const size_t n = (size_t)b->n_cells;
    struct glint_vertex *const room = malloc((n + 1) * (n + 1) * sizeof *room);
    struct glint_primitive *const out = malloc(2 * n * n * sizeof *out);
    uint8_t *const level = malloc(n * n);
    struct glint_ghost_grid grid = {.bundle = b,
                                    .stop = &f->cfg.stop,
                                    .width = f->cfg.width,
                                    .height = f->cfg.height,
                                    .antialias = !o->centres,
                                    .merge_steps = o->merge_steps,
                                    .merge_gamma_q16 = o->merge_gamma_q16,
                                    .level = level};
    struct glint_cell_raster raster = {.bundle = b,
                                       .stop = &f->cfg.stop,
                                       .weights = o->weights,
                                       .antialias = !o->centres,
                                       .width = f->cfg.width,
                                       .height = f->cfg.height,
                                       .acc_q20 = acc_q20};

    assert(room && out && level);
    raster.vertex = grid.vertex = rays_of(f, bundle, room);
    glint_ghost_grid_merge(&grid);
    glint_ghost_grid_emit(&grid, out);
    for (int i = 0; i < grid.n_primitives; i++)
        glint_cell_raster_primitive(&raster, &out[i]);
    free(room);
    free(out);
    free(level);
    return grid.n_merged;
}

int cells_draw(const struct glint_flare *flare,
               const struct cells_options *options, int32_t *pixels_q20)
{
    const size_t n = 3 * (size_t)flare->cfg.width * (size_t)flare->cfg.height;
    int64_t *const acc_q20 = calloc(n, sizeof *acc_q20);
    int n_merged = 0;

    assert(acc_q20);
    for (int i = 0; i < flare->n_bundles; i++)
        n_merged += add_bundle(flare, i, options, acc_q20);
    for (size_t i = 0; i < n; i++)
        pixels_q20[i] = q_clamp_sat(acc_q20[i], INT32_MIN, INT32_MAX);
    free(acc_q20);
    return n_merged;
}
