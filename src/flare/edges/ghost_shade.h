/* SPDX-License-Identifier: MIT
 *
 * Dims ghosts by the shade of the stop. The shade is the fraction of light that
 * each point of the stop transmits, due to a soft edge, dust and masks.
 *
 *   in   a cell of a ghost's grid, tables of the light that the stop lets
 *        through
 *   out  the light of the cell, and patches of the details in it
 *
 * A soft edge is drawn as a few nested outlines of equal light.
 *
 * Dust and masks are tables of transmitted light, with levels as in a mipmap:
 * each level is half as fine as the one before. A cell gets its light from the
 * level whose nodes are about as far apart as the corners of the cell. Where
 * finer levels differ visibly from that level, a patch (patch.h) adds the
 * difference pixel by pixel. This needs no further rays, as everything is
 * linear between the rays of a grid. */
#ifndef GLINT_FLARE_GHOST_SHADE_H
#define GLINT_FLARE_GHOST_SHADE_H

#include "flare/edges/ghost_parts.h"

enum {
    GLINT_SOFT_RINGS = 16
}; /* max number of nested outlines that draw a soft edge */

struct glint_shade_method {
    /* Converts a ray bundle to edges. */
    void (*emit)(struct glint_ghost_edges *g);
    /* Applies dust and masks to a convex cell, whose area has the sign TURN.
     * CUTS: number of stop sides and barrel apertures that cross the cell.
     * *ENERGY: on entry the mean energy of the cell's corners, on return the
     * energy that the edges of the cell have to draw. Returns 0 if the cell was
     * drawn completely and shares no edges with its neighbours. */
    int (*cell)(struct glint_ghost_edges *g, const struct glint_corners *c,
                int turn, int cuts, int64_t *energy_q16);
    /* Stores the patch over the outline of a cell that is drawn separately.
     * LIGHT is the cell's packed light. */
    void (*patch)(struct glint_ghost_edges *g, int32_t light);
    glint_patch_fn *draw;
    /* Multiplies the energy at the corners of cell C, which is drawn
     * separately, by the transmission SHADE. Stores the new corners in DIMMED,
     * and sets C to point to them. */
    void (*corners)(const struct glint_shade *shade, struct glint_ghost_cell *c,
                    struct glint_vertex dimmed[4]);
};

/* Converts the ray bundle to edges: once if the stop has a hard outline,
 * otherwise once for each ring of its soft edge. Value of member emit. */
void glint_ghost_emit_soft_outline(struct glint_ghost_edges *g);

/* Returns whether softness and table size of SHADE are in range. */
static inline int glint_shade_is_valid(const struct glint_shade *shade)
{
    if (shade->soft_q16 < 0 || shade->soft_q16 > 1 << 16)
        return 0;
    return shade->log2 == 0 || (shade->log2 >= GLINT_SHADE_LEAST_LOG2 &&
                                shade->log2 <= GLINT_SHADE_MOST_LOG2);
}

#endif
