/* SPDX-License-Identifier: MIT
 *
 * Turns the ray grid of a bundle into the edges that are drawn.
 *
 *   in   (n + 1)^2 vertices of one bundle, the stop
 *   out  edges across which the irradiance changes
 *
 * A cell has one irradiance: its flux over its area on the screen, negative
 * where the ghost is mirrored. The edge between two neighbours is drawn once,
 * with the irradiance on either side. It is not drawn if both are equal, and
 * irradiance is rounded to steps so that they often are. Only the part of an
 * edge within the stop's sides and the barrels is drawn; both are taken as
 * linear between its ends. Where a side or barrel crosses a cell, a chord
 * closes the cell. Each visible part depends on the two ends of its edge alone,
 * so that neighbours agree to the bit and outlines close.
 *
 * Cells that are folded, have an invalid corner, are thinner than a sixteenth
 * of a pixel, or are crossed by more than two sides are drawn separately as
 * closed outlines: outline.h. A round stop cuts like a barrel, corrected by its
 * sag (see struct glint_bundle_plan). If vertices are given instead of
 * polynomials, the sag is unknown, and cells that a round stop crosses are
 * drawn separately. */
#ifndef GLINT_FLARE_GHOST_EDGES_H
#define GLINT_FLARE_GHOST_EDGES_H

#include <stdint.h>

#include "glint/bundle.h"
#include "glint/light.h"
#include "glint/transfer.h"
#include "flare/edges/edge.h"
#include "flare/edges/outline.h"

enum {
    GLINT_LIGHT_OCTAVES = 45, /* octaves of irradiance _q20 */
    GLINT_HELD_CELLS =
        64 /* max cells per side of grids whose mirrored half is stored */
};

/* Scratch of a worker for two rows of nodes and the cells between them. */
struct glint_ghost_rows {
    struct glint_outline outline;
    struct glint_vertex vertex[2][GLINT_MAX_CELLS + 1];
    /* [j]: the mirror image of row j, one of the rows after the middle row. In
     * small grids it is computed together with row j. */
    struct glint_vertex held[GLINT_HELD_CELLS / 2][GLINT_HELD_CELLS + 1];
    uint64_t sides[2][GLINT_MAX_CELLS + 1]; /* sides of the stop that each node
                                               lies outside, a bit each */
    /* Bits of the barrels that each node lies outside, and NODE_ bits
     * (ghost_parts.h). */
    uint8_t barrels[2][GLINT_MAX_CELLS + 1];
    int32_t light[2][GLINT_MAX_CELLS]; /* irradiance of each cell of two rows,
                                          packed */
    /* Steps of irradiance in each octave. */
    uint16_t steps[GLINT_LIGHT_OCTAVES];
    int32_t weak_q20[GLINT_LIGHT_OCTAVES]; /* edges with smaller changes of
                                              light are pixel-snapped; per
                                              octave of the light */
};

struct glint_patch;
struct glint_ghost_edges {
    /* [n_cells + 1][n_cells + 1]; not used if transfer or rays is set, as
     * vertices are then computed row by row */
    const struct glint_vertex *vertex;
    struct glint_transfer *transfer;
    const struct glint_flare_rays *rays;
    int worker; /* number of the worker, passed to the functions of rays */
    struct glint_place place;
    const uint16_t *sag_q16; /* see struct glint_bundle_plan */
    const struct glint_bundle *bundle;
    uint32_t number; /* number of the bundle */
    /* As planned, see struct glint_bundle_plan; 0: the bundle was not planned.
     */
    struct glint_real flux, irradiance;
    const struct glint_stop *stop;
    int width, top, height; /* the pixels that are drawn: columns 0 .. width -
                               1, rows top .. height - 1 */
    int32_t limit_q8; /* max light that a cell may give a pixel at energy 1,
                         display white */
    int steps;        /* steps per octave of irradiance; 0: irradiance is not
                         rounded */
    int coded; /* 1: the picture is in codes, which resolve faint light more
                  coarsely */
    int snap_codes_q8; /* see struct glint_flare_frame */
    struct glint_ghost_rows *rows;
    /* Set only while a cell with dust or masks is drawn separately: the patch
     * over it. */
    struct glint_patch *patch;
    struct glint_edge *edge; /* [max_edges] */
    int max_edges;
    /* The bins for which more_refs counts the entries of edges that do not fit;
     * NULL: they are not counted. */
    const struct glint_bins *bins;
    /* The two rows of nodes that are in use. */
    const struct glint_vertex *row[2];
    /* Results. */
    int n_edges; /* number of all edges; only the first max_edges are written */
    int more_refs; /* number of entries in the bins of the edges that did not
                      fit */
    int n_dropped; /* cells left out because a corner is invalid */
    int n_held;    /* cells, or halves of cells, whose light was clamped to
                      limit_q8 */
};

void glint_ghost_emit_edges(struct glint_ghost_edges *ghost);

#endif
