/* SPDX-License-Identifier: MIT
 *
 * Vectors of three, roots and ratios, without division.
 *
 * A place is int32 steps within +-2^28, a difference of places within +-2^29,
 * and a direction int32 _q30, of length 1. */
#ifndef GLINT_SCENE_VECTOR_H
#define GLINT_SCENE_VECTOR_H

#include "base/q.h"

/* No distance between two places is as long: 2^29 sqrt(3). */
#define GLINT_FAR (INT32_C(1) << 30)

/* Returns A . B exactly; elements within +-2^30, so below 3 * 2^60. */
static inline int64_t v3_dot(const int32_t a[3], const int32_t b[3])
{
    return (int64_t)a[0] * b[0] + (int64_t)a[1] * b[1] + (int64_t)a[2] * b[2];
}

/* Sets TO to A x B exactly; elements within +-2^30, so within +-2^61. */
static inline void v3_cross(const int32_t a[3], const int32_t b[3],
                            int64_t to[3])
{
    to[0] = (int64_t)a[1] * b[2] - (int64_t)a[2] * b[1];
    to[1] = (int64_t)a[2] * b[0] - (int64_t)a[0] * b[2];
    to[2] = (int64_t)a[0] * b[1] - (int64_t)a[1] * b[0];
}

static inline void v3_minus(const int32_t a[3], const int32_t b[3],
                            int32_t to[3])
{
    for (int k = 0; k < 3; k++)
        to[k] = q_narrow((int64_t)a[k] - b[k]);
}

/* Returns A . B of two directions, q30. */
static inline int32_t v3_cosine_q30(const int32_t a_q30[3],
                                    const int32_t b_q30[3])
{
    return (int32_t)q_shift(v3_dot(a_q30, b_q30), 30);
}

/* A turn of space: its rows are directions at right angles. */
struct glint_scene_turn {
    int32_t row_q30[3][3];
};

/* Sets TO to M V. |V| is below 2^30, and so is |TO|. */
static inline void v3_turn(const struct glint_scene_turn *m, const int32_t v[3],
                           int32_t to[3])
{
    for (int k = 0; k < 3; k++)
        to[k] = q_narrow(q_shift(v3_dot(m->row_q30[k], v), 30));
}

/* The same of M transposed, which turns back. */
static inline void v3_turn_back(const struct glint_scene_turn *m,
                                const int32_t v[3], int32_t to[3])
{
    for (int k = 0; k < 3; k++) {
        const int32_t column_q30[3] = {m->row_q30[0][k], m->row_q30[1][k],
                                       m->row_q30[2][k]};

        to[k] = q_narrow(q_shift(v3_dot(column_q30, v), 30));
    }
}

enum { GLINT_ROOT_FIRST = 32 };

/* 2^7 / sqrt(S) in the middle of each 128th of S = 1/4 .. 1. */
extern const uint8_t glint_root_start_q7[128 - GLINT_ROOT_FIRST];

/* Returns the same for number I of these, 32 .. 127; off by 2^-6.9. */
static inline uint32_t glint_inverse_root_start(uint32_t i)
{
    return glint_root_start_q7[i - GLINT_ROOT_FIRST];
}

/* Returns the root of X, rounded down, without a loop over its bits. */
uint32_t glint_root(uint64_t x);

/* Sets UNIT_Q30 to V / |V|, each element off by 1 step at most; by 1.1 if one
 * of V is 2^30 or more. Elements of V are within +-2^62. Returns 0, and sets
 * nothing, if V is 0. */
int glint_unit(const int64_t v[3], int32_t unit_q30[3]);

/* Returns N / D, rounded, off by 2^-29 of itself more; GLINT_FAR if it is that
 * or more, or D is 0. */
int32_t glint_ratio(uint64_t n, uint64_t d);

#endif
