/* SPDX-License-Identifier: MIT
 *
 * Finds where the stop's sides and the barrels cut the edges of a grid.
 *
 *   in   the rays at the ends of an edge, or at the corners of a cell
 *   out  the visible part of the edge; where two cuts cross in a cell
 *
 * Every cut is linear along an edge, between its two ends; in a cell it is
 * approximated by the plane that fits its values at the corners best. The
 * visible part of an edge depends on the edge's two ends alone, in the order of
 * the grid, so that both cells at an edge find the same part. */
#ifndef GLINT_FLARE_CUTS_H
#define GLINT_FLARE_CUTS_H

#include <stdint.h>

#include "glint/bundle.h"
#include "glint/light.h"

/* The cuts that a node lies on or outside: a bit for each side of the stop (bit
 * 0 for a round stop), and a bit for each barrel. */
struct glint_outside {
    uint64_t sides;
    uint8_t barrels;
};

/* Sets SIDES and BARRELS of N nodes in a row. They are undefined for invalid
 * nodes. */
void glint_cuts_classify_row(const struct glint_stop *stop,
                             const struct glint_vertex *row, int n,
                             uint64_t *sides, uint8_t *barrels);

/* Returns the number of cuts in O, or 3 if there are more. */
int glint_cuts_count_crossed(struct glint_outside o);

/* The visible part of the edge between two neighbouring nodes; the order of its
 * ends is the order of the nodes in the grid. */
struct glint_edge_part {
    int32_t end_q8[2][2];
    int cut[2]; /* the cut at each end; GLINT_CUT_NOTHING: the end is the node
                   itself */
    int visible;
};

enum { GLINT_CUT_NOTHING = -1 };

void glint_cuts_find_visible_part(const struct glint_stop *stop,
                                  const struct glint_vertex *a,
                                  struct glint_outside at_a,
                                  const struct glint_vertex *b,
                                  struct glint_outside at_b,
                                  struct glint_edge_part *part);

/* Finds the point where the cuts A and B, numbered as in struct
 * glint_edge_part, cross within the cell with the corners CORNER, in order.
 * Returns 0 if they do not cross in the cell. */
int glint_cuts_find_crossing(const struct glint_stop *stop,
                             const struct glint_vertex *const corner[4], int a,
                             int b, int32_t at_q8[2]);

#endif
