/* SPDX-License-Identifier: MIT
 *
 * Draws the ghosts of a flare as polygons: allocates memory for their edges,
 * converts bundles of rays to edges, sorts edges into tiles, and draws the
 * tiles. */
#ifndef GLINT_FLARE_BY_EDGES_H
#define GLINT_FLARE_BY_EDGES_H

#include "flare/edges/edge.h"
#include "flare/state.h"

struct glint_by_edges {
    struct glint_edge *edge;
    int32_t *order; /* order in which workers run jobs: first indices of ray
                       bundles to convert to edges, then indices of rows of
                       tiles to draw */
    /* max light that one cell of a ray grid may add to a pixel, 1 = display
     * white */
    int32_t limit_q8;
    int linear; /* 1: the target picture is in linear light */
};

/* The state and memory of one worker. */
struct glint_edges_worker {
    struct glint_ghost_rows *rows;
    /* Sums of edges for the row of tiles that the worker draws. */
    struct glint_edge_sums sums;
    /* [tile]: index in the bins at which the worker stores its next edge in the
     * tile */
    int32_t *at;
    /* The worker's range of the flare's edge array: index of its first edge,
     * capacity, and number of edges stored. */
    int first_edge, max_edges, n_edges;
    /* the flare that is being drawn, while the worker draws a row of tiles */
    const struct glint_flare *flare;
    int at_tile; /* index of the next tile to draw */
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

/* Max number of ray bundles of a frame. */
enum { GLINT_EDGES_MAX_BUNDLES = 1 << 20 };

/* Allocate memory from arena A: the first function for the edges of a flare,
 * the second for the edge sums of one worker. Return NULL if A only
 * measures. */
struct glint_by_edges *glint_edges_allocate(struct glint_arena *a,
                                            const struct glint_flare_config *c);
struct glint_edges_worker *
glint_edges_allocate_worker(struct glint_arena *a,
                            const struct glint_flare_config *c);

/* Sets the edge sums of all workers to 0. Drawing a tile requires that its sums
 * are 0 at the start. */
void glint_edges_clear_sums(struct glint_flare *f);

/* Converts all ray bundles of FLARE to edges and sorts the edges into tiles.
 * Sets n_drawn, the bins, and the statistics of primitives and references. */
void glint_edges_bin(struct glint_flare *flare);

/* Draws the passes PASS[0 .. N_BELOW - 1], and the edges in front of them.
 * Writes the pass of the edges to PASS[N_BELOW], so PASS must have space for
 * it. */
void glint_edges_draw(struct glint_flare *flare,
                      const struct glint_tiles *tiles, struct glint_pass *pass,
                      int n_below);

/* Returns the pass that draws the edges in the bins. */
struct glint_pass glint_edges_make_pass(const struct glint_flare *flare);

#endif
