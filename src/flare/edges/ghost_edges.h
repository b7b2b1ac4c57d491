/* SPDX-License-Identifier: MIT
 *
 * From the ray grid of a bundle to the edges that are drawn.
 *
 *   in   (n + 1)^2 vertices of one bundle, the stop
 *   out  edges across which the irradiance changes
 *
 * A cell has one irradiance: its flux over its area on the screen, negative
 * where the ghost is mirrored. Neighbours share an edge, which is drawn once,
 * with what is on either side, and not at all where both are equal: irradiance
 * is rounded to steps so that they often are. Of an edge the part is drawn that
 * lies within the stop's sides and the barrels, linear between its ends; where
 * a side or barrel crosses a cell, a chord closes it. Every part of an edge
 * follows from its two ends alone, so that neighbours agree to the bit and
 * outlines close.
 *
 * Cells that are folded, have lost a corner, are thinner than a sixteenth of a
 * pixel, or are crossed by more than two sides are drawn by themselves, closed:
 * outline.h. A round stop cuts like a barrel, lowered by its sag; where
 * vertices are given, and nothing is known of that, its cells are drawn by
 * themselves.
 */
#ifndef GLINT_FLARE_GHOST_EDGES_H
#define GLINT_FLARE_GHOST_EDGES_H

#include <stdint.h>

#include "glint/light.h"
#include "glint/transfer.h"
#include "flare/edges/edge.h"
#include "flare/edges/outline.h"

enum {
    GLINT_LIGHT_OCTAVES = 45, /* octaves of irradiance _q20 */
    GLINT_HELD_CELLS =
        64 /* cells a side up to which the second half of a grid is held */
};

/* Scratch of a worker: of the nodes of two rows, and the cells between. */
struct glint_ghost_rows {
    struct glint_outline outline;
    struct glint_vertex vertex[2][GLINT_MAX_CELLS + 1];
    /* The rows behind the middle, first to last the lower half's mirror images:
     * computed with these, if the grid is small. */
    struct glint_vertex held[GLINT_HELD_CELLS / 2][GLINT_HELD_CELLS + 1];
    uint64_t sides[2][GLINT_MAX_CELLS + 1];  /* sides of the stop that each node
                                                lies outside of, a bit each */
    uint8_t barrels[2][GLINT_MAX_CELLS + 1]; /* the same; LOST; where beyond the
                                                picture */
    int32_t light[2][GLINT_MAX_CELLS]; /* irradiance of the cells of two rows,
                                          packed */
    /* Steps of irradiance in each octave. */
    uint16_t steps[GLINT_LIGHT_OCTAVES];
    int32_t weak_q20[GLINT_LIGHT_OCTAVES]; /* smaller changes of light, by its
                                              octave: on whole pixels */
};

struct glint_ghost_edges {
    /* [n_cells + 1][n_cells + 1], unless there is TRANSFER: then they are
     * computed, row by row */
    const struct glint_vertex *vertex;
    struct glint_transfer *transfer;
    struct glint_place place;
    const uint16_t *sag_q16; /* see struct glint_bundle_plan */
    const struct glint_bundle *bundle;
    uint32_t number; /* number of the bundle */
    const struct glint_stop *stop;
    int width, height; /* size of the picture */
    int32_t limit_q8;  /* most light of a cell in a pixel at energy 1 */
    int steps;         /* per octave of irradiance; 0: not rounded */
    int coded; /* the picture has codes, which tell less apart of faint light */
    int snap_codes_q8; /* see struct glint_flare_frame */
    struct glint_ghost_rows *rows;
    struct glint_edge *edge; /* [max_edges] */
    int max_edges;
    const struct glint_bins *bins; /* bins that more_refs counts edges without
                                      room for; NULL: it counts none */
    const struct glint_vertex *row[2]; /* the two rows at work */
    /* out */
    int n_edges;   /* number of all edges; only max_edges are written */
    int more_refs; /* entries in bins that edges without room would take */
    int n_dropped; /* cells without light for want of a corner */
    int n_held;    /* cells, or halves, with more light than limit_q8 */
};

void glint_ghost_edges_emit(struct glint_ghost_edges *ghost);

#endif
