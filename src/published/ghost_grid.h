/* SPDX-License-Identifier: MIT
 *
 * From a bundle's ray grid to primitives, for the rasteriser of cells.
 *
 *   in   vertices of the grid, row by row
 *   out  convex quads, triangles where a quad is folded or has lost a corner,
 *        each with the irradiance that keeps the energy of its cells
 *
 * Blocks of 2 x 2 equal cells become one where their edges agree, up to four
 * times over [Bodonyi23]. What nothing of can be seen is left out. A cell that
 * lost one corner keeps half of its light, one that lost more is dropped.
 * Cells of a ghost that is focused to a few pixels become points; others
 * without area lose their light.
 */
#ifndef GLINT_PUBLISHED_GHOST_GRID_H
#define GLINT_PUBLISHED_GHOST_GRID_H

#include <stdint.h>

#include "flare/edges/primitive.h"
#include "glint/light.h"

/* A bundle in the making; counts are what the grid gave. */
struct glint_ghost_grid {
    const struct glint_vertex *vertex; /* all bundles' */
    int first;                         /* first vertex of this bundle */
    const struct glint_bundle *bundle;
    const struct glint_stop *stop;
    int width, height;       /* pixels of the picture */
    int merge_steps;         /* 0 .. 4 */
    int32_t merge_gamma_q16; /* relative */
    uint8_t *level;          /* [n_cells][n_cells], scratch that keeps what
                                merge found for emit */
    int antialias;           /* cells of a few pixels are sampled finely */
    int sampled;             /* all cells are that small */
    int focused;             /* the whole ghost is a few pixels wide */
    int n_primitives, n_dropped, n_merged;
    int n_held; /* primitives written that had more light than a pixel gets of
                   one */

    /* Unless NULL, it is handed the box of each primitive, written or not. */
    void (*see)(void *ctx, struct glint_box box);
    void *ctx;
};

/* Decides which blocks of cells become one. */
void glint_ghost_grid_merge(struct glint_ghost_grid *grid);

/* Counts the primitives, and writes them unless OUT is NULL, as bundle BUNDLE.
 */
void glint_ghost_grid_emit(struct glint_ghost_grid *grid, int bundle,
                           struct glint_primitive *out);

#endif
