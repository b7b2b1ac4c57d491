/* SPDX-License-Identifier: MIT
 *
 * Edges of bundles: their memory, sorting into tiles, and drawing. */
#ifndef GLINT_FLARE_BY_EDGES_H
#define GLINT_FLARE_BY_EDGES_H

#include "flare/edges/edge.h"
#include "flare/state.h"

struct glint_by_edges {
    struct glint_edge *edge;
    int32_t *order; /* indices of bundles, then of rows of tiles, in order of
                       processing */
    /* Display white: max light that one cell may give a pixel. */
    int32_t limit_q8;
    int linear; /* 1: the picture that is drawn onto is in linear light */
};

/* The state and memory of one worker. */
struct glint_edges_worker {
    struct glint_ghost_rows *rows;
    /* Sums of the row of tiles that the worker draws. */
    struct glint_edge_sums sums;
    /* Place of the worker's next entry in the bins, for each tile. */
    int32_t *at;
    /* The part of all edges that the worker fills. */
    int first_edge, max_edges, n_edges;
    /* Set while the worker draws a row of tiles. */
    const struct glint_flare *flare;
    int at_tile; /* index of the next tile */
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

/* Carve the memory for edges of a flare and of a worker; return NULL while A
 * only measures. */
struct glint_by_edges *glint_edges_carve(struct glint_arena *a,
                                         const struct glint_flare_config *c);
struct glint_edges_worker *
glint_edges_carve_worker(struct glint_arena *a,
                         const struct glint_flare_config *c);

/* Sets all sums of all workers to 0, as they must be between tiles. */
void glint_edges_begin(struct glint_flare *f);

/* Sorts the bundles into tiles: sets n_drawn, the state for drawing, and all
 * statistics except the numbers of bundles and vertices. */
void glint_edges_bin(struct glint_flare *flare);

/* Draws over the first N_BELOW passes of PASS, which has room for one more. */
void glint_edges_draw(struct glint_flare *flare,
                      const struct glint_tiles *tiles, struct glint_pass *pass,
                      int n_below);

/* Returns the pass that draws what has been binned. */
struct glint_pass glint_edges_pass(const struct glint_flare *flare);

#endif
