/* SPDX-License-Identifier: MIT
 *
 * Shared by the files behind ghost_edges.h: ghost_rows.c, which fills rows of
 * nodes, ghost_edges.c, which draws cells of the grid, and ghost_shade.c, which
 * draws cells with a soft edge, dust or masks. */
#ifndef GLINT_FLARE_GHOST_PARTS_H
#define GLINT_FLARE_GHOST_PARTS_H

#include "flare/edges/cuts.h"
#include "flare/edges/ghost_edges.h"

/* Bits of a node after the bits of the barrels: the ray is invalid, or the node
 * lies off-screen beyond one side of the picture. The left side has no bit, as
 * edges there still add light to the picture. */
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

/* Returns node (I, J), which must be in one of the two stored rows. */
static inline const struct glint_vertex *
ghost_node(const struct glint_ghost_edges *g, int i, int j)
{
    return &g->row[j & 1][i];
}

/* Adds the edges of the bundle for the stop's hard outline; soft edges of its
 * shade are ignored. */
void glint_ghost_emit_hard_outline(struct glint_ghost_edges *g);

/* Fills row J of the nodes; it stays valid until row J + 2 is filled. */
void glint_ghost_fill_node_row(struct glint_ghost_edges *g, int j);

/* Returns the packed light, rounded to steps, of a cell that has IRRADIANCE at
 * energy 1. */
int32_t glint_ghost_pack_cell_light(struct glint_ghost_edges *g,
                                    int64_t irradiance_q22, int64_t energy_q16,
                                    int sign);

/* Draws the part that the cuts leave of a convex primitive of N corners, whose
 * flux is 2^SHARE_LOG2 of a cell's. If it is thin, its light is spread over a
 * strip a sixteenth of a pixel wide. */
void glint_ghost_add_clipped_primitive(struct glint_ghost_edges *g,
                                       const struct glint_vertex *const *corner,
                                       int n, int share_log2);

#endif
