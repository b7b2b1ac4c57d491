/* SPDX-License-Identifier: MIT
 *
 * Clips the edges of a ray grid: finds where the stop's sides and the barrel
 * apertures of the lens cut them.
 *
 *   in   the rays at the ends of an edge, or at the corners of a cell
 *   out  the visible part of the edge; where two cuts cross in a cell
 *
 * A cut is the zero line of a function. Between the two ends of an edge the
 * function is interpolated linearly. In a cell it is approximated by the plane
 * that fits its values at the four corners best. The visible part of an edge
 * depends only on its two ends, in the order of the grid. So both cells at an
 * edge find the same part. */
#ifndef GLINT_FLARE_CUTS_H
#define GLINT_FLARE_CUTS_H

#include <stdint.h>

#include "glint/bundle.h"
#include "glint/light.h"

/* The cuts on or outside of which a node of the ray grid lies. sides: a bit for
 * each side of the stop (bit 0 for a round stop). barrels: a bit for each
 * barrel aperture. */
struct glint_outside {
    uint64_t sides;
    uint8_t barrels;
};

/* Sets SIDES[i] and BARRELS[i], as in struct glint_outside, for N nodes in a
 * row. The values of invalid nodes are undefined. */
void glint_cuts_classify_row(const struct glint_stop *stop,
                             const struct glint_vertex *row, int n,
                             uint64_t *sides, uint8_t *barrels);

/* Returns the number of bits set in O, clamped to 3. */
int glint_cuts_count_outside_bits(struct glint_outside o);

/* The visible part of the edge between two neighbouring nodes. Its ends are in
 * the order of the nodes in the grid. */
struct glint_edge_part {
    int32_t end_q8[2][2];
    int cut[2]; /* number of the cut at which this end lies; GLINT_CUT_NOTHING:
                   the end is the node itself */
    int visible;
};

enum { GLINT_CUT_NOTHING = -1 };

void glint_cuts_find_visible_part(const struct glint_stop *stop,
                                  const struct glint_vertex *a,
                                  struct glint_outside at_a,
                                  const struct glint_vertex *b,
                                  struct glint_outside at_b,
                                  struct glint_edge_part *part);

/* Sets AT, pixels, to the point where the cuts A and B cross within the cell
 * whose corners are CORNER, in cyclic order. Cuts are numbered as in struct
 * glint_edge_part. Returns 0 if they do not cross in the cell or within a
 * quarter of a cell around it. */
int glint_cuts_find_crossing(const struct glint_stop *stop,
                             const struct glint_vertex *const corner[4], int a,
                             int b, int32_t at_q8[2]);

#endif
