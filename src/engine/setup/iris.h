/* SPDX-License-Identifier: MIT
 *
 * Computes the outline of a stop, in doubles. Its sides are straight or arcs,
 * or it is a circle. Lengths are in stop radii; x is to the right, y up. */
#ifndef GLINT_ENGINE_SETUP_IRIS_H
#define GLINT_ENGINE_SETUP_IRIS_H

#include <stdbool.h>

#include "glint/setup.h"

/* The sides of a stop, which connect corners on the unit circle. */
struct glint_iris_sides {
    int n; /* number of sides; 0: circle */
    bool arcs;
    double apothem;
    double round, off; /* round: curvature of the sides, 0 for straight sides.
                          off: distance of the arcs' centres from the stop's
                          centre times the curvature, 1 for straight sides. */
    double normal[GLINT_MAX_BLADES][2]; /* outward unit normal of each side */
};

void glint_iris_compute_sides(struct glint_iris_sides *sides,
                              const struct glint_setup *setup);

/* Returns the signed distance of (X, Y) from side SIDE, positive inside. Exact
 * near the side; for arcs an approximation farther away. */
double glint_iris_compute_side_distance(const struct glint_iris_sides *sides,
                                        int side, double x, double y);

/* Returns the signed distance of (X, Y) from the nearest side, positive inside
 * the stop. */
double glint_iris_compute_edge_distance(const struct glint_iris_sides *sides,
                                        double x, double y);

#endif
