/* SPDX-License-Identifier: MIT
 *
 * Dust and masks over a part of a ghost: a convex polygon in which each pixel
 * has the light of the shade where its rays cross the stop.
 *
 * Edges give the polygon the light of a clear stop, or none; a patch adds, to
 * each pixel, how much the shade differs from that. Rays are linear over it, so
 * that six numbers give each pixel's place in the stop. Pixels on a side count
 * by the fraction of them that is within it, which is the same as of edges but
 * where two sides meet in a pixel.
 *
 * A patch takes the places of several edges, one after the other: the first has
 * the box of its pixels, by which it is sorted into tiles, the others carry
 * words and go into no tile. */
#ifndef GLINT_FLARE_PATCH_H
#define GLINT_FLARE_PATCH_H

#include "flare/edges/edge.h"
#include "flare/edges/outline.h"
#include "tile/box.h"

struct glint_patch {
    struct glint_box box; /* pixels that it may touch, in the picture */
    int32_t light;        /* packed: of a clear stop */
    int level;            /* table of the shade that is as fine as pixels */
    int clear;            /* 1: edges give it LIGHT, 0: they give it none */
    /* Place in the stop of the middle of the box's first pixel, and its change
     * from pixel to pixel. */
    int32_t at_q24[2], across_q24[2], down_q24[2];
    const struct glint_vertex *cell[4]; /* corners of its cell; not written */
    int n;                              /* corners, of positive area */
    int32_t x_q8[GLINT_OUTLINE_CORNERS], y_q8[GLINT_OUTLINE_CORNERS];
};

/* Returns how many edges' places a patch of N corners takes. */
static inline int glint_patch_places(int n)
{
    return 1 + (7 + 2 * n + 6) / 7;
}

/* Writes P, of bundle number BUNDLE, to the places from EDGE on. */
void glint_patch_write(struct glint_edge *edge, const struct glint_patch *p,
                       unsigned bundle);

void glint_patch_read(struct glint_patch *p, const struct glint_edge *edge);

/* The member draw of struct glint_shade_method. */
glint_patch_fn glint_patch_draw;

/* Fills EDGE[N] with entries that draw nothing. */
void glint_patch_blank(struct glint_edge *edge, int n);

#endif
