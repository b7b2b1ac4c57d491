/* SPDX-License-Identifier: MIT
 *
 * Dust and masks over a part of a ghost: a convex polygon (patch) in which each
 * pixel is dimmed by the shade at that point of the stop through which its ray
 * passes.
 *
 * Edges draw the polygon as if the stop were clear, or without light. The patch
 * adds to each pixel the difference between the light that edges draw and the
 * light through the shade. The map from pixels to the stop is linear over a
 * patch, so it has six coefficients. A pixel on a side of the polygon is
 * weighted by the fraction of its area inside; this equals the fraction
 * computed for edges, except where two sides meet in a pixel.
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
    struct glint_box box; /* bounding box, pixels of the picture */
    int32_t light;        /* packed light through a clear stop */
    int level;            /* mip level of the stop's transmission whose nodes
                             are about a pixel apart */
    int clear;            /* 1: edges draw the polygon as if the stop were
                             clear; 0: as if it were opaque */
    /* Map from pixels to positions in the stop, stop radii. at: position for
     * the centre of the box's first pixel. across, down: change per pixel to
     * the right and per pixel downwards. */
    int32_t at_q24[2], across_q24[2], down_q24[2];
    const struct glint_vertex *cell[4]; /* corners of the cell under the patch;
                                           not stored in the edge array */
    int n; /* number of corners, in cyclic order with a positive area */
    int32_t x_q8[GLINT_OUTLINE_CORNERS], y_q8[GLINT_OUTLINE_CORNERS];
};

/* Returns the number of elements of the edge array that a patch of N corners
 * occupies. */
static inline int glint_patch_count_slots(int n)
{
    return 1 + (7 + 2 * n + 6) / 7;
}

/* Stores patch P of ray bundle number BUNDLE in elements of the edge array,
 * from EDGE on. */
void glint_patch_write_slots(struct glint_edge *edge,
                             const struct glint_patch *p, unsigned bundle);

void glint_patch_read_slots(struct glint_patch *p,
                            const struct glint_edge *edge);

/* Draws a patch (member draw of struct glint_shade_method). */
glint_patch_fn glint_patch_draw;

/* Turns the N array elements EDGE into continuations of a patch, which draw
 * nothing. */
void glint_patch_fill_empty_slots(struct glint_edge *edge, int n);

#endif
