/* SPDX-License-Identifier: MIT
 *
 * glint/explain.h - explains what a frame drew and what it left out: by ghost,
 * light and wavelength.
 *
 *     glint_explain_open(&explain, engine, 0);      what it drew last
 *     glint_explain_close(&explain);
 *
 * Counts and reasons are the flare's own statistics (glint_flare_account);
 * light is measured by drawing each part of the frame separately. */
#ifndef GLINT_EXPLAIN_H
#define GLINT_EXPLAIN_H

#include <stdint.h>

#include "glint/engine.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Items whose counts determine the cost: of a plan, before anything is
 * drawn, or of a drawn frame. */
enum glint_cost_kind {
    GLINT_COST_LOOKED_AT, /* bundles that a plan probes, or for a drawn frame
                             the rays traced for them */
    GLINT_COST_BUNDLES,   /* bundles drawn: a few rays each, and substituting a
                             polynomial per row */
    GLINT_COST_VERTICES,  /* vertices of grids */
    GLINT_COST_EDGES,     /* edges across which light changes */
    GLINT_COST_ROWS,      /* pixel rows that edges cross */
    GLINT_COST_PARTS,     /* pieces of cells shaded by dust or a mask */
    GLINT_COST_LIT,       /* pixels with any light */
    GLINT_COST_STAR,      /* pixels lit by parts of stars */
    GLINT_COST_VEIL,      /* pixels under a veil, and blurring it */
    GLINT_COST_KINDS
};

/* The cost of one item, in thousands of instructions of a processor with 8
 * lanes of 32 bits. */
struct glint_cost_weight {
    const char *name;
    double planned; /* weights of counts that glint_cost_of() predicts from a
                       plan */
    double counted; /* weights of counts of a drawn frame */
};
extern const struct glint_cost_weight glint_cost_weight[GLINT_COST_KINDS];

/* A part of the frame: a ghost, a light or a wavelength; or the whole frame. */
struct glint_explain_part {
    int of[GLINT_OUTCOMES]; /* number of bundles with each outcome */
    int cells;              /* cells per side of its largest grid */
    /* Maxima over its bundles: number of terms of all polynomials of a
     * bundle, and number of barrels that can cut it. */
    int terms, barrels;
    long long probed; /* rays that the plan probed */
    /* all_terms: sum of the terms of each vertex, over all vertices. */
    long long vertices, edges, rows, refs, all_terms;
    int tiles, lit; /* tiles drawn, and pixels that receive light */
    double flux,
        share; /* light in the picture, and its fraction of the frame's */
    double brightest; /* brightest pixel, as the mean of R, G, B */
    /* Estimated instructions, and their fraction of the frame's. */
    double work, cost;
};

enum { GLINT_EXPLAIN_BARRELS = 6 };

struct glint_frame; /* opaque */

struct glint_explain {
    struct glint_frame *frame;
    struct glint_frame *own; /* FRAME, if glint_explain_at() made it; or NULL */
    /* What was drawn, and the parameters it was drawn with. */
    const struct glint_view *view;
    const struct glint_setup *setup;
    const struct glint_lens *lens;
    const struct glint_tint *tints;   /* NULL: none */
    const struct glint_light *lights; /* [n_lights] */
    const struct glint_wave_sets
        *sets;        /* NULL: all ghosts use the same waves */
    double dim_codes; /* light below which ghosts shared rays; 0: none did */
    int n_ghosts;     /* number of pairs of surfaces */
    int n_lights;
    int n_waves;   /* number of wavelengths, or of sets if ghosts choose among
                      sets */
    int *ghost_of; /* index of the surface pair of each ghost or part of the
                      lens */
    struct glint_explain_part all, *ghost, *light, *wave;
    int barrels[GLINT_EXPLAIN_BARRELS]; /* number of bundles cut by 0, 1, ...
                                           barrels */
    double stage[GLINT_COST_KINDS]; /* estimated instructions of each stage */
    double unit;                    /* factor on the light that was drawn */
    int tile_log2, n_tiles; /* log2 of a tile's side, and number of tiles */
    int32_t *linear_q20;    /* [height][width][3]: light of one part */
};

/* Explains the picture that ENGINE, which needs a model, drew last, with one
 * lamp or more. GAIN: that of a glint_engine_render(), else 0. Call
 * glint_explain_close() after a failure, too. GLINT_E_MEMORY. */
enum glint_status glint_explain_open(struct glint_explain *explain,
                                     struct glint_engine *engine, double gain);

/* Does the same for N LAMPS, drawn at SCALE on a black picture of WIDTH x
 * HEIGHT with the settings of ENGINE and three wavelengths. There are no
 * ghosts without a model, or if no lamp is within its range. */
enum glint_status glint_explain_at(struct glint_explain *explain,
                                   struct glint_engine *engine,
                                   const struct glint_engine_lamp *lamps, int n,
                                   double scale, int width, int height);
void glint_explain_close(struct glint_explain *explain);

/* Draws only ghost GHOST, or all ghosts for -1, into linear_q20. */
void glint_explain_draw(struct glint_explain *explain, int ghost);

/* Return the number of bundles of PART with any outcome, and of those that
 * were drawn, even if they change no pixel. */
int glint_explain_bundles(const struct glint_explain_part *part);
int glint_explain_drawn(const struct glint_explain_part *part);

/* Returns how many primitives of the flare lie in tile TILE. */
int glint_explain_listed(const struct glint_explain *explain, int tile);

/* Returns whether LAMP is farther off the axis than the model's range. */
int glint_explain_is_beyond(const struct glint_explain *explain,
                            const struct glint_lamp *lamp);

/* Lists the indices of all ghosts by falling light. */
void glint_explain_sort(const struct glint_explain *explain, int *ghosts);

#ifdef __cplusplus
}
#endif

#endif
