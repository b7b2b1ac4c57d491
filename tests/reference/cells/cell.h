/* SPDX-License-Identifier: MIT
 *
 * The primitives of the rasteriser of cells: convex quads and triangles over
 * the vertices of the ray grids, each with one irradiance. */
#ifndef REFERENCE_CELLS_CELL_H
#define REFERENCE_CELLS_CELL_H

#include "flare/edges/primitive.h"

enum {
    GLINT_POINT = 4,  /* far smaller than a pixel: all its light goes to the
                         pixel that its middle lies in */
    GLINT_SAMPLED = 8 /* the ghost has cells of a few pixels: light is taken at
                         4 x 4 places of each pixel */
};

struct glint_primitive {
    int32_t vertex[4]; /* indices of the corners in order, area positive; -1 at
                          the end for a triangle */
    int32_t irradiance_q20; /* display white, at energy 1; of a GLINT_POINT the
                               light that it adds to its pixel */
    int8_t share_log2; /* log2 of the number of cells whose light it has; -1:
                          half a cell */
    uint8_t flags;     /* GLINT_CUT_, GLINT_POINT, GLINT_SAMPLED */
};

/* Sets CORNERS to the N vertices of V with the indices VERTEX. */
void glint_corners_gather(struct glint_corners *corners,
                          const struct glint_vertex *v, const int32_t *vertex,
                          int n);

/* Returns the pixel in which the mean of CORNERS lies, as a box; empty if that
 * is outside the picture. */
struct glint_box glint_corners_pixel(const struct glint_corners *corners,
                                     int width, int height);

/* Returns the pixels that primitive P with CORNERS may light, by its flags. */
struct glint_box glint_primitive_box(const struct glint_primitive *p,
                                     const struct glint_corners *corners,
                                     int width, int height);

static inline int glint_primitive_corners(const struct glint_primitive *p)
{
    return p->vertex[3] < 0 ? 3 : 4;
}

#endif
