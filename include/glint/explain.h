/* SPDX-License-Identifier: MIT
 *
 * glint/explain.h - explains what a frame drew and what it left out: by ghost,
 * light and wavelength.
 *
 *     glint_explain_open(&explain, engine, 0);      what it drew last
 *     glint_explain_close(&explain);
 *
 * Counts and reasons are the flare's own (glint_flare_account); light is
 * measured by drawing each part of the frame by itself. */
#ifndef GLINT_EXPLAIN_H
#define GLINT_EXPLAIN_H

#include <stdint.h>

#include "glint/engine.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Kinds of items whose number decides the cost: of a plan, before anything is
 * drawn, or of a frame that was drawn. */
enum glint_cost_kind {
    GLINT_COST_LOOKED_AT, /* bundles that a plan looks at, or for a drawn frame
                             the rays that it traced for them */
    GLINT_COST_BUNDLES,  /* bundles drawn: a few rays each, and a polynomial for
                            each row */
    GLINT_COST_VERTICES, /* vertices of grids */
    GLINT_COST_EDGES,    /* edges across which light changes */
    GLINT_COST_ROWS,     /* rows of pixels that edges cross */
    GLINT_COST_PARTS,    /* parts of cells that dust or a mask shades */
    GLINT_COST_LIT,      /* pixels with any light */
    GLINT_COST_STAR,     /* pixels that parts of stars give light to */
    GLINT_COST_VEIL,     /* pixels under a veil, and what spreads it as such */
    GLINT_COST_KINDS
};

/* The cost of one item, in thousand instructions of a processor with 8 lanes of
 * 32 bits. */
struct glint_cost_weight {
    const char *name;
    double planned; /* weight for counts that glint_cost_of() predicts from a
                       plan */
    double counted; /* weight for counts of a frame that was drawn */
};
extern const struct glint_cost_weight glint_cost_weight[GLINT_COST_KINDS];

/* A part of the frame: a ghost, a light or a wavelength; or the whole frame. */
struct glint_explain_part {
    int of[GLINT_OUTCOMES]; /* number of bundles of each outcome */
    int cells;              /* cells a side of its largest grid */
    /* Of the part's bundles, the largest number of terms that a bundle's
     * polynomials have together, and the largest number of barrels that can cut
     * one. */
    int terms, barrels;
    long long probed; /* rays that the plan looked at */
    /* all_terms is the sum over vertices of the terms of each. */
    long long vertices, edges, rows, refs, all_terms;
    int tiles, lit;     /* tiles drawn, and pixels that get light */
    double flux, share; /* light that reaches the picture, and its fraction of
                           the frame's */
    double brightest;   /* brightest pixel, as the mean of R, G, B */
    /* Estimated instructions, and their fraction of the frame's. */
    double work, cost;
};

enum { GLINT_EXPLAIN_BARRELS = 6 };

struct glint_frame; /* opaque */

struct glint_explain {
    struct glint_frame *frame;
    struct glint_frame *own; /* FRAME, if glint_explain_at() has made it; or
                                NULL */
    /* What was drawn, and by which settings. */
    const struct glint_view *view;
    const struct glint_setup *setup;
    const struct glint_lens *lens;
    const struct glint_tint *tints;     /* NULL: none */
    const struct glint_light *lights;   /* [n_lights] */
    const struct glint_wave_sets *sets; /* NULL: ghosts do not choose */
    double dim_codes; /* ghosts fainter than that shared rays; 0: none */
    int n_ghosts;     /* number of pairs of surfaces */
    int n_lights;
    int n_waves;   /* number of wavelengths, or of sets of them if ghosts choose
                      among sets */
    int *ghost_of; /* index of the pair that each ghost or part of the lens
                      belongs to */
    struct glint_explain_part all, *ghost, *light, *wave;
    int barrels[GLINT_EXPLAIN_BARRELS]; /* number of bundles that are cut by 0,
                                           1, ... barrels */
    double stage[GLINT_COST_KINDS]; /* estimated instructions of each stage */
    double unit;                    /* factor on the light that was drawn */
    int tile_log2, n_tiles; /* log2 of the side of tiles, and their number */
    int32_t *linear_q20;    /* [height][width][3]: light of one part */
};

/* Explains the picture that ENGINE, which has a model, drew last, with one lamp
 * or more. GAIN: that of a glint_engine_render(), else 0. To be closed after a
 * failure, too. GLINT_E_MEMORY. */
enum glint_status glint_explain_open(struct glint_explain *explain,
                                     struct glint_engine *engine, double gain);

/* Does the same of N LAMPS, drawn at SCALE on a black picture of WIDTH x HEIGHT
 * with the settings of ENGINE and three wavelengths. Without a model, or a lamp
 * that it reaches, there are no ghosts. */
enum glint_status glint_explain_at(struct glint_explain *explain,
                                   struct glint_engine *engine,
                                   const struct glint_engine_lamp *lamps, int n,
                                   double scale, int width, int height);
void glint_explain_close(struct glint_explain *explain);

/* Draws ghost GHOST alone, or all ghosts for -1, into linear_q20. */
void glint_explain_draw(struct glint_explain *explain, int ghost);

/* Return the number of bundles of PART, whatever became of them, and the number
 * of those that were drawn, even if they change no pixel. */
int glint_explain_bundles(const struct glint_explain_part *part);
int glint_explain_drawn(const struct glint_explain_part *part);

/* Returns the millions of instructions that the plan of the picture that ENGINE
 * drew last predicted: for stars if KIND is GLINT_COST_STAR, else for all. */
double glint_explain_planned(const struct glint_engine *engine,
                             enum glint_cost_kind kind);

/* Returns how many primitives of the flare lie in tile TILE. */
int glint_explain_listed(const struct glint_explain *explain, int tile);

/* Returns whether LAMP is farther off the axis than the model goes. */
int glint_explain_is_beyond(const struct glint_explain *explain,
                            const struct glint_lamp *lamp);

/* Lists the indices of all ghosts, sorted by falling light or work, or by
 * number. */
enum glint_explain_order {
    GLINT_EXPLAIN_LIGHT,
    GLINT_EXPLAIN_WORK,
    GLINT_EXPLAIN_NUMBER
};
void glint_explain_sort(const struct glint_explain *explain,
                        enum glint_explain_order order, int *ghosts);

#ifdef __cplusplus
}
#endif

#endif
