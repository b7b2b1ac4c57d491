/* SPDX-License-Identifier: MIT
 *
 * Dims ghosts by the shade of the stop: its soft edge, dust and masks.
 *
 *   in   a cell of a ghost's grid, tables of the light that the stop lets
 *        through
 *   out  the light of the cell, and edges of what is in it
 *
 * A soft edge is a few outlines, one inside the other, of the same light each.
 *
 * The tables come in levels, each half as fine as the one before. A cell is as
 * wide as the nodes of one of them, and takes the light of that. Where finer
 * levels differ visibly from it, the cell is drawn in parts, down to a pixel:
 * as edges of each part's difference from the cell's clearest corner, so that
 * clear parts need no edges. No rays are computed for that, as between the rays
 * of a grid all is linear. */
#ifndef GLINT_FLARE_GHOST_SHADE_H
#define GLINT_FLARE_GHOST_SHADE_H

#include "flare/edges/ghost_parts.h"

enum { GLINT_SOFT_RINGS = 16 }; /* max outlines of a soft edge */

struct glint_shade_method {
    /* Turns a bundle into edges, for glint_ghost_edges_emit(). */
    void (*emit)(struct glint_ghost_edges *g);
    /* Draws what lies in a convex cell of TURN with the mean energy *ENERGY
     * that is crossed by CUTS cuts. Sets *ENERGY to that of the cell without
     * what was drawn; returns 0 if all of it was drawn, and the cell shares no
     * edges. */
    int (*cell)(struct glint_ghost_edges *g, const struct glint_corners *c,
                int turn, int cuts, int64_t *energy_q16);
    /* Adds the patch of a cell that is drawn by itself, over its outline. */
    void (*patch)(struct glint_ghost_edges *g, int32_t light);
    glint_patch_fn *draw;
    /* Dims the corners of a cell that is drawn by itself: DIMMED receives them,
     * and C refers to those. */
    void (*corners)(const struct glint_shade *shade, struct glint_ghost_cell *c,
                    struct glint_vertex dimmed[4]);
};

/* The member emit: once, or for each ring of a soft edge. */
void glint_rings_emit(struct glint_ghost_edges *g);

/* Returns whether SHADE is in range. */
static inline int glint_shade_ok(const struct glint_shade *shade)
{
    if (shade->soft_q16 < 0 || shade->soft_q16 > 1 << 16)
        return 0;
    return shade->log2 == 0 || (shade->log2 >= GLINT_SHADE_LEAST_LOG2 &&
                                shade->log2 <= GLINT_SHADE_MOST_LOG2);
}

#endif
