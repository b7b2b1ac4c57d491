/* SPDX-License-Identifier: MIT
 *
 * What the files of ghost_edges.h share: ghost_rows.c, which fills rows of
 * nodes, ghost_edges.c, which draws cells of the grid, and ghost_alone.c, which
 * draws those that share no side with their neighbours.
 */
#ifndef GLINT_FLARE_GHOST_PARTS_H
#define GLINT_FLARE_GHOST_PARTS_H

#include "flare/edges/cuts.h"
#include "flare/edges/ghost_edges.h"

/* Bits of a node besides the barrels': there is no ray, or the node lies beyond
 * a side of the picture. The left side has none, as light runs in from there.
 */
enum {
    NODE_BARRELS = 3,
    NODE_LOST = 4,
    NODE_ABOVE = 8,
    NODE_BELOW = 16,
    NODE_RIGHT = 32
};

struct glint_ghost_cell {
    const struct glint_vertex *corner[4]; /* corners of the cell, in order */
    struct glint_outside at[4];
};

/* Returns a node of the two rows that are kept. */
static inline const struct glint_vertex *
ghost_node(const struct glint_ghost_edges *g, int i, int j)
{
    return &g->row[j & 1][i];
}

/* Fills row J of the nodes; valid until the next but one. */
void glint_ghost_set_nodes(struct glint_ghost_edges *g, int j);

/* Adds the edge A to B with LIGHT to its inner side and OTHER beyond, if it can
 * change a pixel. */
void glint_ghost_add_edge(struct glint_ghost_edges *g, const int32_t a_q8[2],
                          const int32_t b_q8[2], int32_t light, int32_t other);

/* The light of 2^SHARE_LOG2 cells over AREA2 / 2^FRAC pixels, as it is packed;
 * SIGN -1: of a mirrored one. */
int32_t glint_ghost_light(struct glint_ghost_edges *g, int64_t area2, int frac,
                          int share_log2, int64_t energy_q16, int sign);

/* Draws a cell that shares no side with its neighbours: TURN as of its
 * corners' order, 0 where it is not convex. */
void glint_ghost_add_odd(struct glint_ghost_edges *g,
                         const struct glint_ghost_cell *c,
                         const struct glint_corners *corners, int turn);

/* Draws a cell that is no convex quad: two triangles, or the one that is
 * left. */
void glint_ghost_add_triangles(struct glint_ghost_edges *g,
                               const struct glint_ghost_cell *c);

#endif
