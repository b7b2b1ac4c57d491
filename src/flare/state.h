/* SPDX-License-Identifier: MIT
 *
 * The private members of struct glint_flare: ray bundles and plan (flare.c),
 * edges and tiles (by_edges.c). */
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
    int first; /* index of the ray bundle's first edge; -1: the edges did not
                  fit */
    int n, n_dropped, n_held;
    int worker; /* index of the worker that emitted the edges */
    int refs;   /* number of bin entries that the edges would need; set only if
                   the edges did not fit */
};

/* What the next frame may reuse of this frame. */
enum glint_reusable {
    GLINT_REUSABLE_NOT,
    GLINT_REUSABLE_PLANNED, /* a plan without binned edges */
    GLINT_REUSABLE_BINNED   /* bins with exactly the edges of the plan */
};

struct glint_flare {
    struct glint_flare_config cfg;
    struct glint_flare_stats stats;
    /* half: 1 at half resolution. width, height: size of the drawn area,
     * pixels; at half resolution each of these pixels covers 2 x 2 pixels of
     * the picture. */
    int half, width, height;
    const struct glint_half *quads; /* functions for half resolution, or NULL */
    int n_bundles, n_vertices;      /* numbers of ray bundles and vertices that
                                       have been added */
    /* source of vertices that are computed on demand; NULL: vertices are
     * stored, or computed by the polynomials of the plan */
    const struct glint_flare_rays *rays;
    struct glint_plan plan; /* the plan of a frame; plan.frame is NULL if the
                               ray bundles were added by the caller instead */
    struct glint_bundle_plan
        *planned; /* [max_bundles]: the plan of each ray bundle */
    struct glint_real flux, brightest; /* total flux of all planned ray bundles;
                                          max of their mean irradiances */
    int n_drawn; /* number of drawn bundles: the edges of the first n_drawn ray
                    bundles are in the bins */
    struct glint_bundle *bundle;
    struct glint_bundle_slot *slot;
    struct glint_vertex *vertex;
    struct glint_by_edges *edges;
    void *reuse;                  /* state of cfg.reuse, or NULL without it */
    enum glint_reusable reusable; /* the data of this frame that the next can
                                     reuse; GLINT_REUSABLE_NOT if cfg.reuse is
                                     NULL */
    struct glint_bins bins;
    struct glint_flare_worker *worker;
    /* tables for the pixel format of the picture that is being drawn */
    struct glint_resolve *resolve;
};

/* Functions that reuse binned edges from frame to frame (reuse/reuse.c). */
struct glint_reuse {
    /* Allocates the state of the reuse from arena A; returns NULL while A only
     * measures. */
    void *(*allocate_state)(struct glint_arena *a,
                            const struct glint_flare_config *c);
    /* Returns 1 and reuses the last plan if its inputs equal these and its
     * edges are still in the bins. Otherwise records the inputs for the next
     * frame and returns 0. */
    int (*reuse_if_unchanged)(struct glint_flare *f,
                              const struct glint_flare_frame *frame,
                              const struct glint_light *lights, int n_lights);
    /* Sets the colours of the binned ray bundles to their planned colours times
     * the frame's gain for each light (gain_q14). */
    void (*apply_gains)(struct glint_flare *f);
};

/* Clears the workers' records of the last draw: the numbers of tiles and
 * clamped samples, and the pointer for blending. */
void glint_flare_reset_tile_state(struct glint_flare *flare);

/* Prepares the flare's tables for the pixel format of IMAGE. Without an image
 * (NULL) the light is discarded. Returns the tiles in which the frame is
 * drawn. */
struct glint_tiles glint_flare_prepare_tiles(struct glint_flare *flare,
                                             const struct glint_image *image);

/* Returns A + B, clamped to INT32_MAX. A and B count items that need memory. */
static inline int glint_flare_add_needed_count(int a, int b)
{
    return a > INT32_MAX - b ? INT32_MAX : a + b;
}

/* Returns the number of tiles of 2^LOG2 x 2^LOG2 pixels that cover PIXELS_X x
 * PIXELS_Y pixels. */
static inline size_t glint_flare_count_tiles(int pixels_x, int pixels_y,
                                             int log2)
{
    const size_t side = (size_t)1 << log2;

    return (((size_t)pixels_x + side - 1) >> log2) *
           (((size_t)pixels_y + side - 1) >> log2);
}

#endif
