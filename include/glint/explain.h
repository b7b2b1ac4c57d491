/* SPDX-License-Identifier: MIT
 *
 * glint/explain.h - reports for each ghost, light and wavelength of a frame
 * whether it was drawn and, if not, why.
 *
 *     glint_explain_open(&explain, engine, &config); its last picture
 *     glint_explain_close(&explain);
 *
 * Counts and reasons come from glint_flare_account(). The light of a ghost,
 * light or wavelength is measured by drawing it alone. */
#ifndef GLINT_EXPLAIN_H
#define GLINT_EXPLAIN_H

#include <stdint.h>

#include "glint/engine.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Types of work that are counted to compute the cost of a frame. Counts are
 * predicted from the frame's plan, or taken from the drawn frame. */
enum glint_cost_kind {
    /* In a plan: bundles whose light the plan estimates from a few traced rays
     * (probes). In a drawn frame: number of these rays. */
    GLINT_COST_LOOKED_AT,
    /* Bundles drawn. Each costs a few rays and, per row of rays, one
     * substitution into its polynomials. */
    GLINT_COST_BUNDLES,
    GLINT_COST_VERTICES, /* vertices of ray grids */
    GLINT_COST_EDGES,    /* edges across which light changes */
    GLINT_COST_ROWS,     /* pixel rows that these edges cross */
    /* Parts of cells on which dust or a mask is drawn. */
    GLINT_COST_PARTS,
    GLINT_COST_LIT,  /* number of pixels with any light */
    GLINT_COST_STAR, /* number of pixels lit by stars; a pixel lit by several
                        parts of a star counts several times */
    GLINT_COST_VEIL, /* number of pixels that a veil covers; their cost includes
                        that of the veil's blur */
    GLINT_COST_KINDS
};

/* Cost of one unit of work (enum glint_cost_kind), in thousands of instructions
 * of a processor with 8 SIMD lanes of 32 bits. */
struct glint_cost_weight {
    const char *name;
    double
        planned; /* cost of a unit that glint_cost_of() predicts from a plan */
    double counted; /* cost of a unit that is counted in a drawn frame */
};
extern const struct glint_cost_weight glint_cost_weight[GLINT_COST_KINDS];

/* Statistics of the bundles of one ghost, light or wavelength, or of the whole
 * frame. */
struct glint_explain_part {
    int of[GLINT_OUTCOMES]; /* number of bundles per outcome */
    int cells;              /* number of cells per side of the largest ray
                               grid */
    /* Maxima over the bundles: number of terms of all polynomials of one
     * bundle, and number of barrels that can cut it. */
    int terms, barrels;
    long long probed; /* number of rays that the plan traced to estimate these
                         bundles */
    /* Counts as in struct glint_account. all_terms: number of polynomial terms
     * of each vertex, summed over all vertices. */
    long long vertices, edges, rows, refs, all_terms;
    int tiles, lit; /* number of tiles drawn, and number of pixels that
                       receive light */
    /* Light in the picture (flux), and its fraction of the light of the frame
     * (share). */
    double flux, share;
    double brightest; /* light of the brightest pixel, in its largest channel */
    /* Bounding box of the pixels that receive light; x0 > x1: there are none.
     */
    int x0, y0, x1, y1;
    /* Estimated number of instructions (work), and its fraction of the
     * instructions of the frame (cost). */
    double work, cost;
};

enum { GLINT_EXPLAIN_BARRELS = 6 };

struct glint_frame; /* opaque: a planned frame */

struct glint_explain {
    struct glint_frame *frame;
    /* the frame if glint_explain_at() created it, else NULL */
    struct glint_frame *own;
    /* Inputs of the frame. */
    const struct glint_view *view;
    const struct glint_setup *setup;
    const struct glint_lens *lens;    /* the model; NULL: rays are exact */
    const struct glint_tint *tints;   /* tints of ghosts; NULL: no ghost is
                                         tinted */
    const struct glint_light *lights; /* [n_lights] */
    const int *set_size; /* number of waves of each set; NULL: all ghosts use
                            the same waves */
    /* Brightness, in codes near black, below which ghosts of several lights
     * were drawn with the same rays. 0: no ghosts were drawn in this way. */
    double dim_codes;
    int n_ghosts; /* number of pairs of reflecting surfaces */
    int n_lights;
    /* Length of WAVE: the number of wavelengths or, if each ghost chooses a set
     * of wavelengths, the number of sets; 0 if rays are exact. */
    int n_waves;
    /* For each ghost of the lens or additional pupil region of a ghost: index
     * of the pair of surfaces that causes the ghost. */
    int *ghost_of;
    /* Number of lamps of the lights, and for each light the index of its lamp.
     * All lights that are points of one lamp of visible extent have the same
     * index. Lamps are numbered in the order of their first lights. */
    int n_lamps, *lamp_of;
    struct glint_explain_part all, *ghost, *light, *wave, *lamp;
    int barrels[GLINT_EXPLAIN_BARRELS]; /* number of bundles that 0, 1, ...
                                           barrels cut */
    double stage[GLINT_COST_KINDS]; /* estimated instructions of each stage */
    double unit; /* factor from the drawn light to the light that is reported */
    /* Log2 of the side of a tile, and number of tiles. */
    int tile_log2, n_tiles;
    /* Picture that glint_explain_draw() drew, [height][width][3]. */
    int32_t *linear_q20;
};

/* How glint_explain_open() explains a picture; all zero bytes: defaults. */
struct glint_explain_config {
    /* gain passed to glint_engine_render(); 0: another function drew the
     * picture */
    double gain;
    /* lamps of the picture; without them each light counts as a lamp */
    const struct glint_engine_lamp *lamps;
    int n_lamps;
    /* receives the progress of measuring ghosts and lights; may be NULL */
    glint_progress_fn *progress;
    void *progress_ctx;
};

/* Explains the picture that ENGINE drew last; the picture must have at least
 * one lamp. Members that describe costs are 0 if rays are exact.
 * glint_explain_close() must be called even after a failure. May return
 * GLINT_E_MEMORY. */
enum glint_status glint_explain_open(struct glint_explain *explain,
                                     struct glint_engine *engine,
                                     const struct glint_explain_config *config);

/* Like glint_explain_open(), for N LAMPS drawn at SCALE on a black picture of
 * WIDTH x HEIGHT with the settings of ENGINE and three wavelengths. If ENGINE
 * has no model, or all lamps are outside its range, there are no ghosts. */
enum glint_status glint_explain_at(struct glint_explain *explain,
                                   struct glint_engine *engine,
                                   const struct glint_engine_lamp *lamps, int n,
                                   double scale, int width, int height);
void glint_explain_close(struct glint_explain *explain);

/* Draws into linear_q20: only the ghost with index GHOST, or all ghosts if
 * GHOST is -1. May return GLINT_E_MEMORY if rays are exact. */
enum glint_status glint_explain_draw(struct glint_explain *explain, int ghost);

/* Return the number of all bundles of PART, and the number of bundles that were
 * drawn, including those that change no pixel. */
int glint_explain_bundles(const struct glint_explain_part *part);
int glint_explain_drawn(const struct glint_explain_part *part);

/* Returns the number of primitives (edges) of the flare in tile TILE; 0 if rays
 * are exact. */
int glint_explain_listed(const struct glint_explain *explain, int tile);

/* Returns whether LAMP is farther off the axis than the model's range. */
int glint_explain_is_beyond(const struct glint_explain *explain,
                            const struct glint_lamp *lamp);

/* Sets GHOSTS to the indices of all ghosts, sorted by decreasing light. */
void glint_explain_sort(const struct glint_explain *explain, int *ghosts);

#ifdef __cplusplus
}
#endif

#endif
