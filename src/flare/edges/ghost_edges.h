/* SPDX-License-Identifier: MIT
 *
 * Converts the ray grid of a bundle to edges.
 *
 *   in   (n + 1)^2 vertices of one bundle, the stop
 *   out  edges across which the irradiance changes
 *
 * A cell of the grid has one irradiance: its flux divided by its area on the
 * screen, negative where the ghost is mirrored. The edge between two
 * neighbouring cells is stored once, with the irradiance on either side. It is
 * left out if both irradiances are equal. Irradiance is rounded to steps, so
 * that equal values are frequent. Only the part of an edge within the stop's
 * sides and the barrel apertures is stored. Stop and barrels are functions of
 * the position, which are interpolated linearly along the edge. Where a side or
 * a barrel crosses a cell, a chord closes the outline of the cell. The visible
 * part depends only on the two ends of the edge, so that neighbouring cells
 * agree to the bit and outlines close.
 *
 * Cells that are folded, have an invalid corner, are thinner than a sixteenth
 * of a pixel, or are crossed by more than two sides or barrel apertures are
 * drawn separately as closed outlines: outline.h. A round stop cuts like a
 * barrel, corrected by its sag (see struct glint_bundle_plan). If vertices are
 * given instead of polynomials, the sag is unknown, and cells that a round stop
 * crosses are drawn separately. */
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
    GLINT_HELD_CELLS = 64     /* max number of cells per side of grids of which
                                 a mirrored half is stored */
};

/* Scratch memory of a worker: two rows of nodes and the row of cells between
 * them. */
struct glint_ghost_rows {
    struct glint_outline outline;
    struct glint_vertex vertex[2][GLINT_MAX_CELLS + 1];
    /* [j]: the mirror image of row j of nodes, which is a row after the middle
     * row; in small grids it is computed together with row j */
    struct glint_vertex held[GLINT_HELD_CELLS / 2][GLINT_HELD_CELLS + 1];
    uint64_t sides[2][GLINT_MAX_CELLS + 1]; /* [row modulo 2][i]: bit mask of
                                               the stop's sides outside of which
                                               node i lies */
    /* [row modulo 2][i]: bit mask of the barrel apertures outside of which node
     * i lies, and NODE_ bits (ghost_parts.h) */
    uint8_t barrels[2][GLINT_MAX_CELLS + 1];
    int32_t light[2][GLINT_MAX_CELLS]; /* packed irradiance of the cells in two
                                          rows */
    /* for each octave, the number of steps to which irradiance is rounded */
    uint16_t steps[GLINT_LIGHT_OCTAVES];
    int32_t weak_q20[GLINT_LIGHT_OCTAVES]; /* [octave]: change of light below
                                              which an edge is pixel-snapped */
};

struct glint_patch;
struct glint_ghost_edges {
    /* [n_cells + 1][n_cells + 1]: vertices of the grid; unused if transfer or
     * rays is set, as these compute vertices row by row */
    const struct glint_vertex *vertex;
    struct glint_transfer *transfer;
    const struct glint_flare_rays *rays;
    int worker; /* number of the worker, passed to the functions of rays */
    struct glint_place place;
    const uint16_t *sag_q16; /* interpolation errors (flare/plan.h) */
    const struct glint_bundle *bundle;
    uint32_t number; /* number of the ray bundle */
    /* total flux, and mean light of a pixel (struct glint_bundle_plan); 0 if
     * the ray bundle was not planned */
    struct glint_real flux, irradiance;
    const struct glint_stop *stop;
    int width, top, height; /* range of pixels that are drawn: columns 0 ..
                               width - 1, rows top .. height - 1 */
    int32_t limit_q8; /* max light that a cell of energy 1 may add to a pixel, 1
                         = display white */
    int steps;        /* number of steps per octave to which irradiance is
                         rounded; 0: irradiance is not rounded */
    int coded; /* 1: the picture has 8-bit codes, which resolve faint light more
                  coarsely */
    int snap_codes_q8; /* change of light, codes, below which edges are
                          pixel-snapped; 0: none is */
    struct glint_ghost_rows *rows;
    /* patch (patch.h) by which dust or masks dim the current cell, or NULL */
    struct glint_patch *patch;
    struct glint_edge *edge; /* [max_edges] */
    int max_edges;
    /* bins of the flare, used only to count more_refs; NULL: more_refs is not
     * counted */
    const struct glint_bins *bins;
    /* the two rows of nodes in use, by row number modulo 2 */
    const struct glint_vertex *row[2];
    /* Results. */
    int n_edges; /* number of edges of the ray bundle; only the first max_edges
                    are stored */
    int more_refs; /* number of bin entries that the edges after the first
                      max_edges need */
    int n_dropped; /* number of cells with an invalid corner, which are drawn as
                      a triangle or not at all */
    int n_held;    /* number of cells, or halves of cells, whose light was
                      clamped to limit_q8 */
};

void glint_ghost_emit_edges(struct glint_ghost_edges *ghost);

#endif
