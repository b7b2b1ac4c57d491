/* SPDX-License-Identifier: MIT
 *
 * What a flare holds, and what its two ways to draw, by edges (by_edges.c) and
 * by cells (by_cells.c), are to flare.c, which has what they share.
 */
#ifndef GLINT_FLARE_STATE_H
#define GLINT_FLARE_STATE_H

#include "base/arena.h"
#include "flare/ghost_edges.h"
#include "published/ghost_grid.h"
#include "flare/plan.h"
#include "glint/flare.h"
#include "tile/bins.h"
#include "flare/edges.h"
#include "published/raster.h"
#include "image/quads.h"

/* What one worker needs while it draws. */
struct glint_flare_worker {
    struct glint_light_rows *light; /* two rows of a tile */
    int32_t *light_q20;             /* [3][2 side]: one of a linear picture */
    struct glint_quads_rows *codes;
    int n_tiles; /* small tiles that it drew */
    int n_held;  /* samples of a linear picture at the end of their range */
    struct glint_plan_scratch *plan;
    /* by edges */
    struct glint_ghost_rows *rows;
    uint64_t *wide; /* of one tile: tile/edges.h */
    uint32_t *narrow_q24;
    int64_t *carry;
    uint64_t *touched;
    int32_t *at; /* its places in the bins, tile by tile */
    int first_edge, max_edges, n_edges; /* its part of the edges */
    /* by cells */
    int64_t *acc_q20; /* [3][side * side], one small tile's sums */
    struct glint_clip *clip;
    int32_t *start; /* small tiles of one large tile */
    int32_t *ref;
};

struct glint_bundle_slot {
    int first_vertex;
    int first; /* primitive or edge; -1: it found no place */
    int n, n_dropped, n_merged, n_held;
    int worker; /* by edges: who made it */
};

struct glint_flare {
    struct glint_flare_config cfg;
    struct glint_flare_stats stats;
    int half, width, height; /* of the frame: see struct glint_flare_frame; what
                                is drawn has this size */
    const struct glint_half *quads;    /* if half */
    int n_bundles, n_vertices;         /* taken in */
    struct glint_plan plan;            /* of a lens, unless frame is NULL */
    struct glint_bundle_plan *planned; /* of each bundle planned */
    struct glint_real flux, brightest; /* of what was planned */
    int n_drawn;                       /* of these, the bundles that bin kept */
    struct glint_bundle *bundle;
    struct glint_bundle_slot *slot;
    struct glint_vertex *vertex;
    struct glint_edge *edge; /* by edges */
    int32_t
        *order; /* by edges: bundles, then rows of tiles, as they are done */
    int32_t limit_q8; /* of a cell's light in a pixel */
    uint8_t *level;   /* by cells: one per vertex, what merge found */
    struct glint_primitive *primitive; /* by cells */
    struct glint_bins bins;            /* first level */
    struct glint_flare_worker *worker;
    struct glint_resolve *resolve; /* tables for the picture drawn last */
};

/* A way from bundles to pixels. */
struct glint_raster {
    int max_bundles;
    int masks;      /* takes a stop with a mask */
    int two_levels; /* tiles of tiles, if asked for */
    int halves;     /* can draw half as many pixels each way */
    /* Its own parts of flare and worker; see carve() of flare.c. */
    void (*carve)(struct glint_flare *f, struct glint_arena *a,
                  const struct glint_flare_config *c);
    void (*carve_worker)(struct glint_flare_worker *w, struct glint_arena *a,
                         const struct glint_flare_config *c);
    void (*begin)(struct glint_flare *f); /* once placed; or NULL */
    /* Fills the vertices of the bundles planned; NULL: they come and go. */
    void (*fill)(struct glint_flare *f);
    /* Sorts the bundles taken in into tiles: sets all statistics but the counts
     * of bundles and vertices, n_drawn, and what draw needs. */
    void (*bin)(struct glint_flare *f);
    void (*draw)(struct glint_flare *f, const struct glint_image *image);
};

/* A + B, held at INT_MAX: a need that large cannot be served anyway. */
static inline int glint_flare_add_need(int a, int b)
{
    return a > INT32_MAX - b ? INT32_MAX : a + b;
}

/* Tiles of so many pixels that cover a picture. */
static inline size_t glint_flare_count_tiles(int pixels_x, int pixels_y,
                                             int log2)
{
    const size_t side = (size_t)1 << log2;

    return (((size_t)pixels_x + side - 1) >> log2) *
           (((size_t)pixels_y + side - 1) >> log2);
}

#endif
