/* SPDX-License-Identifier: MIT
 *
 * Rigid motions in double precision. */
#ifndef GLINT_BAKE_MOTION_RIGID_H
#define GLINT_BAKE_MOTION_RIGID_H

#include <stdbool.h>

/* Takes point p of the body to at + turn p. */
struct glint_rigid {
    double at[3];
    double turn[4];   /* unit quaternion w, x, y, z; w is not negative */
    double row[3][3]; /* the same as a matrix */
};

/* Min determinant of a base, as a fraction of its bound. */
#define GLINT_RIGID_LEAST 0x1p-20

/* Finds the motion that moves N points FROM to TO with the least sum of squares
 * [Horn87]. Returns false if N < 3 or the points lie on a line: the square of
 * the area that they span is below GLINT_RIGID_LEAST of its bound. */
bool glint_rigid_fit(int n, const double (*from)[3], const double (*to)[3],
                     struct glint_rigid *rigid);

/* Sets the turn of RIGID to the rotation nearest to ROW. */
void glint_rigid_nearest(const double row[3][3], struct glint_rigid *rigid);

/* Sets TO to POINT moved by RIGID. */
void glint_rigid_take(const struct glint_rigid *rigid, const double point[3],
                      double to[3]);

#endif
