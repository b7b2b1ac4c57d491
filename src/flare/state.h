/* SPDX-License-Identifier: MIT
 *
 * What a flare holds, and what a way to draw it (by_edges.c; by_cells.c of
 * published/) is to flare.c, which has what they share. Each carves a state of
 * its own, for the flare and for each worker.
 */
#ifndef GLINT_FLARE_STATE_H
#define GLINT_FLARE_STATE_H

#include "base/arena.h"
#include "flare/edges/primitive.h"
#include "flare/plan.h"
#include "glint/flare.h"
#include "tile/bins.h"
#include "tile/pass.h"

/* The memory of one worker. */
struct glint_flare_worker {
    struct glint_tile_scratch tile;
    struct glint_plan_scratch *plan;
    void *own; /* the raster's */
};

struct glint_bundle_slot {
    int first_vertex;
    int first; /* primitive or edge; -1: it found no place */
    int n, n_dropped, n_merged, n_held;
    int worker; /* worker that made it, by edges */
    int refs;   /* entries of the bins; by edges only if it found no place */
};

struct glint_flare {
    struct glint_flare_config cfg;
    struct glint_flare_stats stats;
    int half, width, height; /* half resolution or not, and the size that is
                                drawn with it: see struct glint_flare_frame */
    const struct glint_half *quads; /* set only at half resolution */
    int n_bundles, n_vertices;      /* bundles and vertices taken in so far */
    struct glint_plan plan;         /* plan for a lens, unless frame is NULL */
    struct glint_bundle_plan *planned; /* plan of each bundle planned */
    struct glint_real flux, brightest; /* flux of all that was planned, and the
                                          largest mean irradiance */
    int n_drawn;                       /* bundles of these that bin kept */
    struct glint_bundle *bundle;
    struct glint_bundle_slot *slot;
    struct glint_vertex *vertex;
    void *own;              /* the raster's */
    struct glint_bins bins; /* first level */
    struct glint_flare_worker *worker;
    struct glint_resolve *resolve; /* tables for the picture drawn last */
};

/* A way from bundles to pixels. */
struct glint_raster {
    int max_bundles;
    int masks;      /* takes a stop with a mask */
    int two_levels; /* tiles of tiles, if asked for */
    int halves;     /* can draw half as many pixels each way */
    /* Carves the raster's own parts of flare and worker; gives NULL while A
     * measures. */
    void *(*carve)(struct glint_arena *a, const struct glint_flare_config *c);
    void *(*carve_worker)(struct glint_arena *a,
                          const struct glint_flare_config *c);
    void (*begin)(struct glint_flare *f); /* once placed; or NULL */
    /* Fills the vertices of the bundles planned; NULL: they come and go. */
    void (*fill)(struct glint_flare *f);
    /* Sorts the bundles taken in into tiles: sets all statistics but the counts
     * of bundles and vertices, n_drawn, and what draw needs. */
    void (*bin)(struct glint_flare *f);
    /* Draws over the first N_BELOW of PASS, and may set the one after them. */
    void (*draw)(struct glint_flare *f, const struct glint_tiles *tiles,
                 struct glint_pass *pass, int n_below);
};

/* Forgets what the last frame drew, and that anything was under it. */
void glint_flare_forget(struct glint_flare *flare);

/* Returns the tiles that a frame is drawn onto. */
struct glint_tiles glint_flare_start(struct glint_flare *flare,
                                     const struct glint_image *image);

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
