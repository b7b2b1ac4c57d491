/* SPDX-License-Identifier: MIT
 *
 * What a frame modelled and what it left out: by ghost, light and wavelength.
 *
 *     explain_open(&explain, &frame);      of the frame drawn last, by edges
 *     explain_print(&explain, ...);        explain_json(), explain_mark()
 *     explain_close(&explain);
 *
 * Counts and reasons are the flare's own (glint_flare_account); light is
 * measured by drawing each part of the frame by itself.
 */
#ifndef GLINT_TOOLS_ENGINE_EXPLAIN_H
#define GLINT_TOOLS_ENGINE_EXPLAIN_H

#include <stdbool.h>
#include <stdint.h>

#include "engine/frame.h"

/* A ghost, a light or a wavelength of the frame; or all of it. */
struct explain_part {
    int of[GLINT_FATES]; /* bundles, by what became of them */
    int cells;           /* a side of its largest grid */
    int terms, barrels;  /* of the bundle with most of them */
    long long surveyed;  /* rays that the plan looked at */
    long long vertices, edges, rows, refs, all_terms; /* terms of vertices */
    int tiles, lit;     /* tiles drawn, pixels that get light */
    double flux, share; /* that reaches the picture; of the frame's */
    double brightest;   /* pixel: mean of R, G, B */
    double work, cost;  /* instructions, about; of the frame's */
};

enum { EXPLAIN_BARRELS = 6 };

/* Where a frame's work goes. */
enum explain_stage {
    EXPLAIN_LOOKING, /* at what might be seen */
    EXPLAIN_VERTICES,
    EXPLAIN_EDGES,
    EXPLAIN_ROWS,
    EXPLAIN_PIXELS, /* that are lit, however many ghosts share them */
    EXPLAIN_STAGES
};

struct explain {
    struct frame *frame;
    int n_ghosts; /* pairs of surfaces */
    int n_beams;
    int n_waves;   /* wavelengths, or where ghosts choose sets of them, these */
    int *ghost_of; /* of each ghost and part of the lens: which pair it is */
    struct explain_part all, *ghost, *beam, *wave;
    int barrels[EXPLAIN_BARRELS]; /* bundles that so many cut */
    double stage[EXPLAIN_STAGES]; /* instructions, about */
    double unit;                  /* of light, over what was drawn */
    int n_tiles;                  /* that there are */
    int32_t *linear_q20;          /* [height][width][3]: one part */
};

/* UNIT: what the light that was drawn is multiplied by. GLINT_E_MEMORY. */
enum glint_status explain_open(struct explain *explain, struct frame *frame,
                               double unit);
void explain_close(struct explain *explain);

/* Draws ghost GHOST alone, or all for -1, into linear_q20. */
void explain_draw(struct explain *explain, int ghost);

/* Bundles of PART that were looked for, and that are drawn. */
int explain_bundles(const struct explain_part *part);
int explain_drawn(const struct explain_part *part);

/* What FATE means, as a phrase for tables and a word for programs. */
const char *explain_reason(enum glint_fate fate);
const char *explain_word(enum glint_fate fate);

/* Numbers of all ghosts, sorted: by light, by work, or as they are. */
enum explain_order { EXPLAIN_LIGHT, EXPLAIN_WORK, EXPLAIN_NUMBER };
void explain_sort(const struct explain *explain, enum explain_order order,
                  int *ghosts);

/* Lights as they were given, and what the picture is. */
struct explain_title {
    const char *lens;
    const struct glint_lamp *lamp;
    int n_lamps;
    bool linear;
    enum explain_order order;
    int top; /* ghosts that are listed, and marked */
    const struct frame_report *report;
};

void explain_print(const struct explain *explain,
                   const struct explain_title *title);
void explain_json(const struct explain *explain,
                  const struct explain_title *title);

/* A new picture, to be freed: PICTURE dimmed, its touched tiles shaded, the
 * first ghosts outlined and numbered, and a legend below. GLINT_E_MEMORY. */
enum glint_status explain_mark(struct explain *explain,
                               const struct explain_title *title,
                               const struct glint_image *picture,
                               struct glint_image *marked);

#endif
