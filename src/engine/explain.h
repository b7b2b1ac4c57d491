/* SPDX-License-Identifier: MIT
 *
 * Explains what a frame drew and what it left out: by ghost, light and
 * wavelength.
 *
 *     glint_explain_open(&explain, &frame, 1);     drawn last
 *     glint_explain_close(&explain);
 *
 * Counts and reasons are the flare's own (glint_flare_account); light is
 * measured by drawing each part of the frame by itself. */
#ifndef GLINT_ENGINE_EXPLAIN_H
#define GLINT_ENGINE_EXPLAIN_H

#include <stdbool.h>
#include <stdint.h>

#include "engine/frame/cost.h"
#include "engine/frame/frame.h"

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
    double flux, share; /* light that reaches the picture, and its share of the
                           frame's */
    double brightest;   /* brightest pixel, as the mean of R, G, B */
    /* Estimated instructions, and their share of the frame's. */
    double work, cost;
};

enum { GLINT_EXPLAIN_BARRELS = 6 };

struct glint_explain {
    struct glint_frame *frame;
    int n_ghosts; /* number of pairs of surfaces */
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
    int n_tiles;                    /* tiles of the picture */
    int32_t *linear_q20;            /* [height][width][3]: light of one part */
};

/* Explains the frame that was drawn last. UNIT is the factor on its light.
 * GLINT_E_MEMORY. */
enum glint_status glint_explain_open(struct glint_explain *explain,
                                     struct glint_frame *frame, double unit);
void glint_explain_close(struct glint_explain *explain);

/* Draws ghost GHOST alone, or all ghosts for -1, into linear_q20. */
void glint_explain_draw(struct glint_explain *explain, int ghost);

/* Return the number of bundles of PART, whatever became of them, and the number
 * of those that were drawn, even if they change no pixel. */
int glint_explain_bundles(const struct glint_explain_part *part);
int glint_explain_drawn(const struct glint_explain_part *part);

/* Lists the indices of all ghosts, sorted by falling light or work, or by
 * number. */
enum glint_explain_order {
    GLINT_EXPLAIN_LIGHT,
    GLINT_EXPLAIN_WORK,
    GLINT_EXPLAIN_NUMBER
};
void glint_explain_sort(const struct glint_explain *explain,
                        enum glint_explain_order order, int *ghosts);

#endif
