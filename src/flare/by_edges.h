/* SPDX-License-Identifier: MIT
 *
 * What a flare that is drawn by edges holds besides.
 */
#ifndef GLINT_FLARE_BY_EDGES_H
#define GLINT_FLARE_BY_EDGES_H

#include "flare/edges/edge.h"
#include "flare/state.h"

struct glint_by_edges {
    struct glint_edge *edge;
    int32_t *order;   /* bundles, then rows of tiles, as they are done */
    int32_t limit_q8; /* most light of a cell in a pixel */
    int linear;       /* the picture that is drawn onto */
};

/* The state and memory of one worker. */
struct glint_edges_worker {
    struct glint_ghost_rows *rows;
    /* Sums of the row of tiles that the worker draws. */
    struct glint_edge_sums sums;
    int32_t *at; /* places of the worker's entries in the bins, tile by tile */
    /* Part of the edges that is the worker's. */
    int first_edge, max_edges, n_edges;
    /* Set while the worker draws a row of tiles. */
    const struct glint_flare *flare;
    int at_tile; /* the next one */
};

static inline struct glint_by_edges *
glint_by_edges_of(const struct glint_flare *f)
{
    return f->own;
}

static inline struct glint_edges_worker *
glint_edges_worker_of(const struct glint_flare *f, int i)
{
    return f->worker[i].own;
}

/* The pass that draws what has been binned. */
struct glint_pass glint_edges_pass(const struct glint_flare *flare);

#endif
