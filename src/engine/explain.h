/* SPDX-License-Identifier: MIT
 *
 * What a frame modelled and what it left out: by ghost, light and wavelength.
 *
 *     glint_explain_open(&explain, &frame, 1);     drawn last, and by edges
 *     glint_explain_close(&explain);
 *
 * Counts and reasons are the flare's own (glint_flare_account); light is
 * measured by drawing each part of the frame by itself.
 */
#ifndef GLINT_ENGINE_EXPLAIN_H
#define GLINT_ENGINE_EXPLAIN_H

#include <stdbool.h>
#include <stdint.h>

#include "engine/frame/cost.h"
#include "engine/frame/frame.h"

/* A ghost, a light or a wavelength of the frame; or all of it. */
struct glint_explain_part {
    int of[GLINT_OUTCOMES]; /* bundles, by what became of them */
    int cells;              /* a side of its largest grid */
    /* Most terms and barrels that a bundle of the part has. */
    int terms, barrels;
    long long probed; /* rays that the plan looked at */
    long long vertices, edges, rows, refs, all_terms; /* terms of vertices */
    int tiles, lit;     /* tiles drawn, pixels that get light */
    double flux, share; /* light that reaches the picture, and its share of the
                           frame's */
    double brightest;   /* pixel: mean of R, G, B */
    double work, cost;  /* instructions, about; share of the frame's */
};

enum { GLINT_EXPLAIN_BARRELS = 6 };

struct glint_explain {
    struct glint_frame *frame;
    int n_ghosts; /* pairs of surfaces */
    int n_lights;
    int n_waves;   /* wavelengths, or where ghosts choose sets of them, these */
    int *ghost_of; /* number of the pair that each ghost or part of the lens
                      belongs to */
    struct glint_explain_part all, *ghost, *light, *wave;
    int barrels[GLINT_EXPLAIN_BARRELS]; /* bundles that so many cut */
    double stage[GLINT_COST_KINDS];     /* instructions, about */
    double unit;         /* factor that the light drawn is multiplied by */
    int n_tiles;         /* tiles of the picture */
    int32_t *linear_q20; /* [height][width][3]: one part */
};

/* UNIT: what the light that was drawn is multiplied by. GLINT_E_MEMORY. */
enum glint_status glint_explain_open(struct glint_explain *explain,
                                     struct glint_frame *frame, double unit);
void glint_explain_close(struct glint_explain *explain);

/* Draws ghost GHOST alone, or all for -1, into linear_q20. */
void glint_explain_draw(struct glint_explain *explain, int ghost);

/* Bundles of PART that were looked for, and that are drawn. */
int glint_explain_bundles(const struct glint_explain_part *part);
int glint_explain_drawn(const struct glint_explain_part *part);

/* Numbers of all ghosts, sorted: by light, by work, or as they are. */
enum glint_explain_order {
    GLINT_EXPLAIN_LIGHT,
    GLINT_EXPLAIN_WORK,
    GLINT_EXPLAIN_NUMBER
};
void glint_explain_sort(const struct glint_explain *explain,
                        enum glint_explain_order order, int *ghosts);

#endif
