/* SPDX-License-Identifier: MIT
 *
 * The outline of a stop, in doubles: straight sides, arcs or a circle. Lengths
 * are stop radii, x right, y up. */
#ifndef GLINT_ENGINE_SETUP_IRIS_H
#define GLINT_ENGINE_SETUP_IRIS_H

#include <stdbool.h>

#include "glint/setup.h"

/* The sides of a stop between corners on the unit circle. */
struct glint_iris_sides {
    int n; /* 0: circle */
    bool arcs;
    double apothem;
    double round, off; /* curvature of arcs; distance of their centres from the
                          stop's, times that; 0 and 1 for straight sides */
    double normal[GLINT_MAX_BLADES][2]; /* outwards */
};

void glint_iris_compute_sides(struct glint_iris_sides *sides,
                              const struct glint_setup *setup);

/* Returns how far (X, Y) lies inside side SIDE: the distance where that is
 * small, and less than that beyond a corner. */
double glint_iris_side_distance(const struct glint_iris_sides *sides, int side,
                                double x, double y);

/* Returns how far (X, Y) lies inside the nearest side. */
double glint_iris_edge_distance(const struct glint_iris_sides *sides, double x,
                                double y);

#endif
