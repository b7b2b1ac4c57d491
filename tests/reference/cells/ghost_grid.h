/* SPDX-License-Identifier: MIT
 *
 * Turns a bundle's ray grid into primitives, for the rasteriser of cells.
 *
 *   in   vertices of the grid, row by row
 *   out  convex quads, triangles where a quad is folded or has lost a corner,
 *        each with the irradiance that keeps the energy of its cells
 *
 * Blocks of 2 x 2 equal cells become one where their edges agree, up to four
 * times over [Bodonyi23]. Primitives that cannot be seen are left out. A cell
 * that lost one corner keeps half of its light, one that lost more is dropped.
 * Cells of a ghost that is focused to a few pixels become points; other cells
 * without area lose their light. */
#ifndef REFERENCE_CELLS_GHOST_GRID_H
#define REFERENCE_CELLS_GHOST_GRID_H

#include <stdint.h>

#include "reference/cells/cell.h"
#include "glint/light.h"

/* A bundle while it becomes primitives, and the counts of what it gave. */
struct glint_ghost_grid {
    const struct glint_vertex *vertex;
    const struct glint_bundle *bundle;
    const struct glint_stop *stop;
    int width, height; /* size of the picture in pixels */
    int merge_steps;   /* log2 of the largest side of a merged block, 0 .. 4 */
    /* Largest relative disagreement of edges that merge. */
    int32_t merge_gamma_q16;
    uint8_t *level; /* [n_cells][n_cells]: marks of cells, from merge to emit */
    int antialias;  /* 1: cells of a few pixels are sampled finely */
    int sampled;    /* 1: all cells are a few pixels wide */
    int focused;    /* 1: the whole ghost is a few pixels wide */
    int n_primitives, n_dropped, n_merged;
    int n_held; /* primitives written whose light was clamped to what one may
                   give a pixel */
};

/* Decides which blocks of cells become one primitive. */
void glint_ghost_grid_merge(struct glint_ghost_grid *grid);

/* Writes the primitives to OUT, at most two for each cell. */
void glint_ghost_grid_emit(struct glint_ghost_grid *grid,
                           struct glint_primitive *out);

#endif
