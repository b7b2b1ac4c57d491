/* SPDX-License-Identifier: MIT
 *
 * Edges of bundles: their memory, sorting into tiles, and drawing.
 */
#ifndef GLINT_FLARE_BY_EDGES_H
#define GLINT_FLARE_BY_EDGES_H

#include "flare/edges/edge.h"
#include "flare/state.h"

struct glint_by_edges {
    struct glint_edge *edge;
    int32_t *order; /* order of the jobs: indices of bundles while edges are
                       made, then of rows of tiles */
    /* Max light that one cell may give a pixel, in units of display white. */
    int32_t limit_q8;
    int linear; /* 1: the target picture is in linear light */
};

/* The state and memory of one worker. */
struct glint_edges_worker {
    struct glint_ghost_rows *rows;
    /* Sums of edges for the row of tiles that the worker draws. */
    struct glint_edge_sums sums;
    /* For each tile, the index of the worker's next entry in the bins. */
    int32_t *at;
    /* The range of the flare's edge array that the worker fills. */
    int first_edge, max_edges, n_edges;
    /* Both are set while the worker draws a row of tiles. */
    const struct glint_flare *flare;
    int at_tile; /* index of the next tile in the row */
};

static inline struct glint_by_edges *
glint_by_edges_of(const struct glint_flare *f)
{
    return f->edges;
}

static inline struct glint_edges_worker *
glint_edges_worker_of(const struct glint_flare *f, int i)
{
    return f->worker[i].edges;
}

/* Max bundles of a frame. */
enum { GLINT_EDGES_MAX_BUNDLES = 1 << 20 };

/* Carve the memory for edges, of a flare and of one worker, out of A. Return
 * NULL while A only measures. */
struct glint_by_edges *glint_edges_allocate(struct glint_arena *a,
                                            const struct glint_flare_config *c);
struct glint_edges_worker *
glint_edges_allocate_worker(struct glint_arena *a,
                            const struct glint_flare_config *c);

/* Sets all sums of all workers to 0, the state that is required before each
 * tile. */
void glint_edges_clear_sums(struct glint_flare *f);

/* Converts the bundles to edges and sorts these into tiles. Sets n_drawn,
 * the state for drawing, and all statistics except the numbers of bundles
 * and vertices. */
void glint_edges_bin(struct glint_flare *flare);

/* Draws the edges over the passes PASS[0 .. N_BELOW - 1]. Stores the pass of
 * the edges in PASS[N_BELOW]. */
void glint_edges_draw(struct glint_flare *flare,
                      const struct glint_tiles *tiles, struct glint_pass *pass,
                      int n_below);

/* Returns the pass that draws the edges in the bins. */
struct glint_pass glint_edges_make_pass(const struct glint_flare *flare);

#endif
