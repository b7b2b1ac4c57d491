/* SPDX-License-Identifier: MIT
 *
 * Dust and masks over a part of a ghost: a convex polygon in which each pixel
 * is dimmed by the shade at the point of the stop that its ray crosses.
 *
 * Edges give the polygon the light of a clear stop, or no light; a patch adds
 * to each pixel the difference from that to the light through the shade. The
 * map from pixels to the stop is linear over a patch, so it has six
 * coefficients. A pixel on a side counts by the fraction of its area inside the
 * patch; this equals the fraction computed for edges except where two sides
 * meet in a pixel.
 *
 * A patch is stored in several consecutive slots of the array of edges. The
 * first slot has the bounding box, by which the patch is sorted into tiles; the
 * others carry data words and are not sorted into tiles. */
#ifndef GLINT_FLARE_PATCH_H
#define GLINT_FLARE_PATCH_H

#include "flare/edges/edge.h"
#include "flare/edges/outline.h"
#include "tile/box.h"

struct glint_patch {
    struct glint_box box; /* pixels of the picture that the patch may touch */
    int32_t light;        /* packed light through a clear stop */
    int level;            /* level of the shade's tables that is as fine as the
                             pixels */
    int clear;            /* 1: edges give the polygon light, 0: they give it no
                             light */
    /* Position in the stop, in stop radii, of the middle of the box's first
     * pixel, and its change per pixel across and down. */
    int32_t at_q24[2], across_q24[2], down_q24[2];
    const struct glint_vertex *cell[4]; /* corners of the patch's cell; not
                                           stored */
    int n;                              /* number of corners, in the order of
                                           positive area */
    int32_t x_q8[GLINT_OUTLINE_CORNERS], y_q8[GLINT_OUTLINE_CORNERS];
};

/* Returns the number of edge slots of a patch of N corners. */
static inline int glint_patch_places(int n)
{
    return 1 + (7 + 2 * n + 6) / 7;
}

/* Writes P, which belongs to bundle number BUNDLE, to the slots from EDGE
 * on. */
void glint_patch_write_slots(struct glint_edge *edge,
                             const struct glint_patch *p, unsigned bundle);

void glint_patch_read_slots(struct glint_patch *p,
                            const struct glint_edge *edge);

/* The member draw of struct glint_shade_method. */
glint_patch_fn glint_patch_draw;

/* Fills EDGE[N] with slots that draw nothing. */
void glint_patch_fill_empty_slots(struct glint_edge *edge, int n);

#endif
