/* SPDX-License-Identifier: MIT
 *
 * Vectors of three components, square roots and ratios, without division.
 *
 * Points are int32 steps within +-2^28, differences of points within +-2^29,
 * and directions int32 _q30 of length 1. */
#ifndef GLINT_SCENE_VECTOR_H
#define GLINT_SCENE_VECTOR_H

#include "base/q.h"

/* Represents infinity: exceeds the distance between any two points, which is at
 * most 2^29 sqrt(3). */
#define GLINT_FAR (INT32_C(1) << 30)

/* Returns the dot product A . B exactly. Components must be within +-2^30, so
 * that the result is within 3 * 2^60. */
static inline int64_t v3_dot(const int32_t a[3], const int32_t b[3])
{
    return (int64_t)a[0] * b[0] + (int64_t)a[1] * b[1] + (int64_t)a[2] * b[2];
}

/* Sets TO to the cross product A x B exactly. Components must be within +-2^30,
 * so that results are within +-2^61. */
static inline void v3_cross(const int32_t a[3], const int32_t b[3],
                            int64_t to[3])
{
    to[0] = (int64_t)a[1] * b[2] - (int64_t)a[2] * b[1];
    to[1] = (int64_t)a[2] * b[0] - (int64_t)a[0] * b[2];
    to[2] = (int64_t)a[0] * b[1] - (int64_t)a[1] * b[0];
}

static inline void v3_subtract(const int32_t a[3], const int32_t b[3],
                               int32_t to[3])
{
    for (int k = 0; k < 3; k++)
        to[k] = q_narrow((int64_t)a[k] - b[k]);
}

/* Returns the cosine of the angle between directions A and B, _q30. */
static inline int32_t v3_cosine_q30(const int32_t a_q30[3],
                                    const int32_t b_q30[3])
{
    return (int32_t)q_shift(v3_dot(a_q30, b_q30), 30);
}

/* A rotation matrix; its rows are perpendicular unit vectors. */
struct glint_scene_turn {
    int32_t row_q30[3][3];
};

/* Sets TO to M V. |V| must be below 2^30, so |TO| is, too. */
static inline void v3_rotate(const struct glint_scene_turn *m,
                             const int32_t v[3], int32_t to[3])
{
    for (int k = 0; k < 3; k++)
        to[k] = q_narrow(q_shift(v3_dot(m->row_q30[k], v), 30));
}

/* Sets TO to V rotated by the inverse (transpose) of M. */
static inline void v3_rotate_back(const struct glint_scene_turn *m,
                                  const int32_t v[3], int32_t to[3])
{
    for (int k = 0; k < 3; k++) {
        const int32_t column_q30[3] = {m->row_q30[0][k], m->row_q30[1][k],
                                       m->row_q30[2][k]};

        to[k] = q_narrow(q_shift(v3_dot(column_q30, v), 30));
    }
}

enum { GLINT_ROOT_FIRST = 32 };

/* Table of 2^7 / sqrt(S) at the middle of each interval of S of length 1/128,
 * for S = 1/4 .. 1. */
extern const uint8_t glint_root_start_q7[128 - GLINT_ROOT_FIRST];

/* Returns the table's value of 1 / sqrt(S) for interval I of S, 32 .. 127;
 * relative error at most 2^-6.9. */
static inline uint32_t glint_look_up_inverse_root(uint32_t i)
{
    return glint_root_start_q7[i - GLINT_ROOT_FIRST];
}

/* Returns the square root of X, rounded down, without a loop over the bits of
 * X. */
uint32_t glint_compute_square_root(uint64_t x);

/* Sets UNIT_Q30 to V / |V|. The error per component is at most 1 unit of _q30;
 * 1.1 units if a component of V is 2^30 or more. Components of V must be within
 * +-2^62. Returns 1; if V is 0, returns 0 and sets nothing. */
int glint_normalise_vector(const int64_t v[3], int32_t unit_q30[3]);

/* Returns N / D, rounded, with a relative error of at most 2^-29; GLINT_FAR if
 * the quotient is at least GLINT_FAR or D is 0. */
int32_t glint_divide_rounded(uint64_t n, uint64_t d);

#endif
