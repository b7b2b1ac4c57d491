/* SPDX-License-Identifier: MIT
 *
 * Internal functions shared by ghost_rows.c, which computes rows of nodes,
 * ghost_edges.c, which converts cells to edges, and ghost_shade.c, which dims
 * cells by a soft edge, dust or masks. */
#ifndef GLINT_FLARE_GHOST_PARTS_H
#define GLINT_FLARE_GHOST_PARTS_H

#include "flare/edges/cuts.h"
#include "flare/edges/ghost_edges.h"

/* Bits of a node in member barrels of struct glint_ghost_rows. NODE_BARRELS:
 * mask of the bits of the barrel apertures. NODE_LOST: the ray is invalid. All
 * others: the node lies off-screen on the named side of the picture. The left
 * side has no bit, as edges left of the picture still add light to the
 * picture. */
enum {
    NODE_BARRELS = 3,
    NODE_LOST = 4,
    NODE_ABOVE = 8,
    NODE_BELOW = 16,
    NODE_RIGHT = 32
};

struct glint_ghost_cell {
    const struct glint_vertex *corner[4]; /* corners of the cell, in cyclic
                                             order */
    struct glint_outside at[4];
};

/* Returns node (I, J) of the grid; J must be one of the two stored rows. */
static inline const struct glint_vertex *
get_ghost_node(const struct glint_ghost_edges *g, int i, int j)
{
    return &g->row[j & 1][i];
}

/* Adds the edges of the ray bundle with a hard outline of the stop: a soft edge
 * is ignored. */
void glint_ghost_emit_hard_outline(struct glint_ghost_edges *g);

/* Computes row J of nodes, which is valid until row J + 2 is computed. */
void glint_ghost_fill_node_row(struct glint_ghost_edges *g, int j);

/* Returns the packed light of a cell, rounded to steps. The light is
 * IRRADIANCE, the cell's irradiance at energy 1, times ENERGY and times
 * SIGN. */
int32_t glint_ghost_pack_cell_light(struct glint_ghost_edges *g,
                                    int64_t irradiance_q22, int64_t energy_q16,
                                    int sign);

/* Adds the edges of a convex primitive of N corners, clipped by the stop and
 * the barrel apertures. The flux of the primitive is 2^SHARE_LOG2 times that of
 * a cell. The light of a thin primitive is spread over a strip that is a
 * sixteenth of a pixel wide. */
void glint_ghost_add_clipped_primitive(struct glint_ghost_edges *g,
                                       const struct glint_vertex *const *corner,
                                       int n, int share_log2);

#endif
