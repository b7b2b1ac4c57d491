/* SPDX-License-Identifier: MIT
 *
 * Rigid motions in double precision: least-squares fits of point sets.
 */
#ifndef GLINT_BAKE_MOTION_RIGID_H
#define GLINT_BAKE_MOTION_RIGID_H

#include <stdbool.h>

/* A rigid motion: it moves point p to R p + at, where R is the rotation
 * turn. */
struct glint_rigid {
    double at[3];
    double turn[4];   /* unit quaternion w, x, y, z; w is not negative */
    double row[3][3]; /* the same rotation as a matrix */
};

/* Points count as lying on a line if the squared area that they span is below
 * this fraction of its upper bound. */
#define GLINT_RIGID_LEAST 0x1p-20

/* Finds the motion that moves N points from FROM to TO with the smallest sum of
 * squared errors [Horn87]. Returns false if N < 3 or if the points lie on a
 * line: the squared area that they span is below GLINT_RIGID_LEAST of its upper
 * bound. */
bool glint_rigid_fit_points(int n, const double (*from)[3],
                            const double (*to)[3], struct glint_rigid *rigid);

/* Sets the rotation of RIGID to the rotation nearest to the matrix ROW. */
void glint_rigid_set_nearest_rotation(const double row[3][3],
                                      struct glint_rigid *rigid);

/* Sets TO to POINT moved by RIGID. */
void glint_rigid_transform_point(const struct glint_rigid *rigid,
                                 const double point[3], double to[3]);

#endif
