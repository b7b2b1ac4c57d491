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
    int first; /* first edge; -1: there was no room for them */
    int n, n_dropped, n_held;
    int worker; /* worker that made it */
    int refs;   /* entries in the bins; only set if the bundle found no room */
};

/* What of the plan is in the bins. */
enum glint_reusable {
    GLINT_REUSABLE_NOT,
    GLINT_REUSABLE_PLANNED, /* nothing yet: it waits to be binned */
    GLINT_REUSABLE_BINNED   /* all of it, and nothing else */
};

struct glint_flare {
    struct glint_flare_config cfg;
    struct glint_flare_stats stats;
    /* 1: half resolution; and the size in pixels that is drawn. */
    int half, width, height;
    const struct glint_half *quads; /* set only at half resolution */
    int n_bundles, n_vertices;      /* bundles and vertices taken in so far */
    /* What computes vertices; NULL: they are stored, or planned. */
    const struct glint_flare_rays *rays;
    struct glint_plan plan; /* plan for a lens, unless plan.frame is NULL */
    struct glint_bundle_plan *planned; /* plan of each bundle planned */
    struct glint_real flux, brightest; /* flux of all bundles planned, and the
                                          largest mean irradiance of one */
    int n_drawn; /* number of bundles, the first ones, that bin kept */
    struct glint_bundle *bundle;
    struct glint_bundle_slot *slot;
    struct glint_vertex *vertex;
    struct glint_by_edges *edges;
    void *reuse;                  /* state of cfg.reuse; NULL: there is none */
    enum glint_reusable reusable; /* always NOT without cfg.reuse */
    struct glint_bins bins;
    struct glint_flare_worker *worker;
    /* Tables for the picture that is being drawn. */
    struct glint_resolve *resolve;
};

/* Reuse of what was binned (reuse/). */
struct glint_reuse {
    /* Carves its state; returns NULL while A only measures. */
    void *(*carve)(struct glint_arena *a, const struct glint_flare_config *c);
    /* Returns whether a plan of these inputs would equal the last one, which is
     * still binned, and then reuses that; otherwise records the inputs of the
     * next plan. */
    int (*take)(struct glint_flare *f, const struct glint_flare_frame *frame,
                const struct glint_light *lights, int n_lights);
    /* Gives the bundles that are binned the factors of the frame. */
    void (*turn)(struct glint_flare *f);
};

/* Forgets the counts of the last draw, and the passes that were under it. */
void glint_flare_forget(struct glint_flare *flare);

/* Sets up the flare's tables for IMAGE (NULL: light is dropped) and returns the
 * tiles that a frame is drawn onto. */
struct glint_tiles glint_flare_start(struct glint_flare *flare,
                                     const struct glint_image *image);

/* Returns A + B, at most INT32_MAX: a need that large cannot be met anyway. */
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
