/* SPDX-License-Identifier: MIT
 *
 * The state of a flare: bundles and plan (flare.c), their edges and tiles
 * (by_edges.c). */
#ifndef GLINT_FLARE_STATE_H
#define GLINT_FLARE_STATE_H

#include "base/arena.h"
#include "flare/edges/primitive.h"
#include "flare/plan.h"
#include "glint/flare.h"
#include "tile/bins.h"
#include "tile/pass.h"

struct glint_by_edges;
struct glint_edges_worker;

/* The memory of one worker. */
struct glint_flare_worker {
    struct glint_tile_scratch tile;
    struct glint_plan_scratch *plan;
    struct glint_edges_worker *edges;
};

struct glint_bundle_slot {
    int first_vertex;
    int first; /* index of the first edge; -1: the edges did not fit */
    int n, n_dropped, n_held;
    int worker; /* index of the worker that emitted the edges */
    int refs;   /* entries in the bins; set only if the edges did not fit */
};

/* Whether the bins hold the edges of the current plan. */
enum glint_reusable {
    GLINT_REUSABLE_NOT,
    GLINT_REUSABLE_PLANNED, /* planned, but not binned yet */
    GLINT_REUSABLE_BINNED   /* the bins hold the edges of the whole plan and
                               nothing else */
};

struct glint_flare {
    struct glint_flare_config cfg;
    struct glint_flare_stats stats;
    /* half: 1 at half resolution. width, height: size of the drawn area, in
     * pixels of the drawing resolution. */
    int half, width, height;
    const struct glint_half *quads; /* set only at half resolution */
    int n_bundles, n_vertices;      /* bundles and vertices added so far */
    /* Computes vertices on demand. NULL: vertices are stored, or computed from
     * the plan. */
    const struct glint_flare_rays *rays;
    struct glint_plan plan; /* the plan for a lens; plan.frame is NULL if
                               nothing is planned */
    struct glint_bundle_plan *planned; /* the plan of each bundle */
    struct glint_real flux, brightest; /* flux of all planned bundles, and the
                                          largest mean irradiance of a bundle */
    int n_drawn; /* number of bundles that glint_edges_bin() kept, counted from
                    the first */
    struct glint_bundle *bundle;
    struct glint_bundle_slot *slot;
    struct glint_vertex *vertex;
    struct glint_by_edges *edges;
    void *reuse;                  /* state of cfg.reuse, or NULL without it */
    enum glint_reusable reusable; /* always GLINT_REUSABLE_NOT without
                                     cfg.reuse */
    struct glint_bins bins;
    struct glint_flare_worker *worker;
    /* Tables for the picture that is being drawn. */
    struct glint_resolve *resolve;
};

/* Reuse of binned edges from frame to frame (reuse/). */
struct glint_reuse {
    /* Carves the state of the reuse out of A; returns NULL while A only
     * measures. */
    void *(*carve)(struct glint_arena *a, const struct glint_flare_config *c);
    /* Returns whether a plan of these inputs would equal the last plan and
     * that plan is still binned, so that it is reused. Otherwise records the
     * inputs for the next plan and returns 0. */
    int (*take)(struct glint_flare *f, const struct glint_flare_frame *frame,
                const struct glint_light *lights, int n_lights);
    /* Sets the colours of the binned bundles to their planned colours times the
     * gains of the frame for each light (gain_q14). */
    void (*turn)(struct glint_flare *f);
};

/* Clears the tile counts of the last draw and the state for blending with
 * passes under the flare. */
void glint_flare_reset_tile_state(struct glint_flare *flare);

/* Prepares the flare's tables for IMAGE (NULL: light is discarded) and returns
 * the tiles that the frame is drawn in. */
struct glint_tiles glint_flare_prepare_tiles(struct glint_flare *flare,
                                             const struct glint_image *image);

/* Returns A + B, clamped to INT32_MAX, a need that no memory satisfies
 * anyway. */
static inline int glint_flare_add_need(int a, int b)
{
    return a > INT32_MAX - b ? INT32_MAX : a + b;
}

/* Returns how many tiles of 2^LOG2 x 2^LOG2 pixels cover PIXELS_X x
 * PIXELS_Y. */
static inline size_t glint_flare_count_tiles(int pixels_x, int pixels_y,
                                             int log2)
{
    const size_t side = (size_t)1 << log2;

    return (((size_t)pixels_x + side - 1) >> log2) *
           (((size_t)pixels_y + side - 1) >> log2);
}

#endif
