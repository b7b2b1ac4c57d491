/* SPDX-License-Identifier: MIT
 *
 * Draws the bundles of a flare by their edges: memory for edges, conversion,
 * sorting into tiles, drawing.
 */
#ifndef GLINT_FLARE_BY_EDGES_H
#define GLINT_FLARE_BY_EDGES_H

#include "flare/edges/edge.h"
#include "flare/state.h"

struct glint_by_edges {
    struct glint_edge *edge;
    int32_t *order; /* order in which jobs are run: indices of bundles while
                       bundles are converted to edges, indices of rows of tiles
                       while these are drawn */
    /* max light that one cell may add to a pixel, 1 = display white */
    int32_t limit_q8;
    int linear; /* 1: the target picture is in linear light */
};

/* The state and memory of one worker. */
struct glint_edges_worker {
    struct glint_ghost_rows *rows;
    /* Sums of edges for the row of tiles that the worker draws. */
    struct glint_edge_sums sums;
    /* for each tile, the index in the bins of the worker's next entry */
    int32_t *at;
    /* The worker's range of the flare's edge array: index of its first edge,
     * capacity, and number of edges stored. */
    int first_edge, max_edges, n_edges;
    /* The flare being drawn (flare) and the next tile in the row (at_tile);
     * valid while the worker draws a row of tiles. */
    const struct glint_flare *flare;
    int at_tile; /* index of the next tile in the row */
};

static inline struct glint_by_edges *
glint_flare_get_edges(const struct glint_flare *f)
{
    return f->edges;
}

static inline struct glint_edges_worker *
glint_flare_get_edges_worker(const struct glint_flare *f, int i)
{
    return f->worker[i].edges;
}

/* Max number of bundles of a frame. */
enum { GLINT_EDGES_MAX_BUNDLES = 1 << 20 };

/* Allocate from arena A the memory for the edges of a flare, and for the edge
 * sums of one worker. Return NULL if A only measures. */
struct glint_by_edges *glint_edges_allocate(struct glint_arena *a,
                                            const struct glint_flare_config *c);
struct glint_edges_worker *
glint_edges_allocate_worker(struct glint_arena *a,
                            const struct glint_flare_config *c);

/* Sets the edge sums of all workers to 0, as drawing requires at the beginning
 * of each tile. */
void glint_edges_clear_sums(struct glint_flare *f);

/* Converts all bundles of FLARE to edges and sorts the edges into tiles. Sets
 * n_drawn, the bins, and the statistics of primitives and references. */
void glint_edges_bin(struct glint_flare *flare);

/* Draws the passes PASS[0 .. N_BELOW - 1], and the edges in front of them. PASS
 * must have space for one more pass: that of the edges is written to
 * PASS[N_BELOW]. */
void glint_edges_draw(struct glint_flare *flare,
                      const struct glint_tiles *tiles, struct glint_pass *pass,
                      int n_below);

/* Returns the pass that draws the edges in the bins. */
struct glint_pass glint_edges_make_pass(const struct glint_flare *flare);

#endif
