/* SPDX-License-Identifier: MIT
 *
 * Vectors of three doubles. */
#ifndef REFERENCE_SCENES_VEC_H
#define REFERENCE_SCENES_VEC_H

#include <math.h>

static inline double vec_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vec_cross(const double a[3], const double b[3], double c[3])
{
    const double x = a[1] * b[2] - a[2] * b[1];
    const double y = a[2] * b[0] - a[0] * b[2];

    c[2] = a[0] * b[1] - a[1] * b[0];
    c[0] = x;
    c[1] = y;
}

/* Sets C to the sum of A and S times B. */
static inline void vec_add_scaled(const double a[3], double s,
                                  const double b[3], double c[3])
{
    for (int i = 0; i < 3; i++)
        c[i] = a[i] + s * b[i];
}

/* Divides A by its length and returns the length; leaves A = 0 unchanged. */
static inline double vec_normalise(double a[3])
{
    const double length = sqrt(vec_dot(a, a));

    for (int i = 0; length > 0 && i < 3; i++)
        a[i] /= length;
    return length;
}

/* Sets B to A rotated by the unit quaternion Q (SIGN 1), or by its inverse
 * (SIGN -1). */
static inline void vec_rotate(const double q[4], double sign, const double a[3],
                              double b[3])
{
    const double v[3] = {sign * q[1], sign * q[2], sign * q[3]};
    double t[3], u[3];

    vec_cross(v, a, t);
    vec_cross(v, t, u);
    for (int i = 0; i < 3; i++)
        b[i] = a[i] + 2 * (q[0] * t[i] + u[i]);
}

#endif
