/* SPDX-License-Identifier: MIT
 *
 * Computes texture coordinates u and v on balls. */
#include "scene/state.h"

/* Returns atan(Y / X) / 2 pi, _q30, with an error of 2^-19, by a polynomial
 * for ratios up to 1. X and Y must not be negative, nor both 0. */
static int32_t compute_quadrant_angle(int32_t x, int32_t y)
{
    const int is_steep = y > x;
    const uint64_t small = (uint64_t)(is_steep ? x : y);
    const uint64_t large = (uint64_t)(is_steep ? y : x);
    const int32_t r_q30 = glint_divide_rounded(small << 30, large);
    const int32_t s_q30 = q_mul(r_q30, r_q30, 30);
    int32_t a_q30 = Q_CONST(0.0208351 / 6.2831853, 30);

    a_q30 = q_mul(a_q30, s_q30, 30) - Q_CONST(0.0851330 / 6.2831853, 30);
    a_q30 = q_mul(a_q30, s_q30, 30) + Q_CONST(0.1801410 / 6.2831853, 30);
    a_q30 = q_mul(a_q30, s_q30, 30) - Q_CONST(0.3302995 / 6.2831853, 30);
    a_q30 = q_mul(a_q30, s_q30, 30) + Q_CONST(0.9998660 / 6.2831853, 30);
    a_q30 = q_mul(a_q30, r_q30, 30);
    return is_steep ? (1 << 28) - a_q30 : a_q30;
}

/* Returns the angle of the vector (X, Y) in turns, -1/2 .. 1/2, _q30. */
static int32_t compute_angle_in_turns(int32_t x, int32_t y)
{
    int32_t a_q30;

    if (x == 0 && y == 0)
        return 0;
    a_q30 = compute_quadrant_angle(x < 0 ? -x : x, y < 0 ? -y : y);
    a_q30 = x < 0 ? (1 << 29) - a_q30 : a_q30;
    return y < 0 ? -a_q30 : a_q30;
}

void glint_compute_ball_uv(const struct glint_placed *p,
                           const struct glint_met_surface *s, int32_t uv_q16[2])
{
    int32_t n_q30[3], across;

    v3_rotate_back(&p->turn, s->face_q30, n_q30);
    for (int k = 0; k < 3 && s->is_inside; k++)
        n_q30[k] = -n_q30[k];
    across = (int32_t)glint_compute_square_root((
        uint64_t)((int64_t)n_q30[0] * n_q30[0] + (int64_t)n_q30[2] * n_q30[2]));
    uv_q16[0] = (int32_t)q_shift(
        (1 << 29) + compute_angle_in_turns(-n_q30[2], n_q30[0]), 14);
    uv_q16[1] = (int32_t)q_shift(compute_angle_in_turns(n_q30[1], across), 13);
}
