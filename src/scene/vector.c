/* SPDX-License-Identifier: MIT */
#include "scene/vector.h"

#include "base/divide.h"

/* clang-format off */
const uint8_t glint_root_start_q7[96] = {
    254, 250, 247, 243, 240, 236, 233, 230, 228, 225, 222, 220, 217, 215,
    212, 210, 208, 206, 204, 202, 200, 198, 196, 194, 193, 191, 189, 188,
    186, 185, 183, 182, 180, 179, 178, 176, 175, 174, 172, 171, 170, 169,
    168, 167, 166, 164, 163, 162, 161, 160, 159, 158, 158, 157, 156, 155,
    154, 153, 152, 151, 151, 150, 149, 148, 147, 147, 146, 145, 144, 144,
    143, 142, 142, 141, 140, 140, 139, 138, 138, 137, 137, 136, 135, 135,
    134, 134, 133, 132, 132, 131, 131, 130, 130, 129, 129, 128};
/* clang-format on */

/* Returns 2^31 / sqrt(S), for S = S_Q64 / 2^64, 1/4 <= S < 1. The result is
 * 2^31 .. 2^32 - 1, with a relative error of at most 2^-31. The table has an
 * error of 2^-6.9. Each of three Newton steps squares the error and multiplies
 * it by 3/2: it falls to 2^-13.2, 2^-25.9, and then to rounding errors. */
static uint32_t compute_inverse_root_q31(uint64_t s_q64)
{
    const uint32_t hi = (uint32_t)(s_q64 >> 32), lo = (uint32_t)s_q64;
    uint64_t r_q31 =
        (uint64_t)glint_look_up_inverse_root((uint32_t)(s_q64 >> 57)) << 24;

    for (int i = 0; i < 3; i++) {
        /* r is the current approximation of 1 / sqrt(S), so S r approximates
         * sqrt(S), _q32, at most 1.01. The Newton step is r (3 - S r^2) / 2. */
        const uint64_t root_q32 = (hi * r_q31 + (lo * r_q31 >> 32)) >> 31;
        const int64_t rest_q62 =
            (INT64_C(1) << 62) - (int64_t)(root_q32 * r_q31 >> 1);
        const int64_t rest_q31 = rest_q62 >> 31;

        r_q31 += (uint64_t)q_shift((int64_t)r_q31 * rest_q31, 32);
        if (r_q31 > UINT32_MAX)
            r_q31 = UINT32_MAX;
    }
    return (uint32_t)r_q31;
}

uint32_t glint_compute_square_root(uint64_t x)
{
    const int down = (64 - bit_length(x | 1)) / 2;
    const uint64_t s_q64 = x << 2 * down;
    uint64_t root;

    if (x < 2)
        return (uint32_t)x;
    root = (s_q64 >> 32) * compute_inverse_root_q31(s_q64) >> (31 + down);
    if (root > UINT32_MAX)
        root = UINT32_MAX;
    while (root * root > x)
        root--;
    while (root < UINT32_MAX && (root + 1) * (root + 1) <= x)
        root++;
    return (uint32_t)root;
}

int glint_normalise_vector(const int64_t v[3], int32_t unit_q30[3])
{
    const uint64_t any =
        q_magnitude(v[0]) | q_magnitude(v[1]) | q_magnitude(v[2]);
    const int up = 31 - bit_length(any);
    int64_t w[3];
    uint64_t square = 0;
    uint32_t r_q31;
    int is_short;

    if (any == 0)
        return 0;
    for (int k = 0; k < 3 && up >= 0; k++)
        w[k] = (int64_t)((uint64_t)v[k] << up);
    for (int k = 0; k < 3 && up < 0; k++)
        w[k] = q_shift(v[k], -up);
    for (int k = 0; k < 3; k++)
        square += (uint64_t)(w[k] * w[k]); /* below 3 * 2^62 */
    is_short = square < UINT64_C(1) << 62; /* the square is at least 2^60 */
    r_q31 = compute_inverse_root_q31(square << 2 * is_short);
    for (int k = 0; k < 3; k++)
        unit_q30[k] = (int32_t)q_clamp_sat(
            (w[k] * (int64_t)r_q31 + (INT64_C(1) << (32 - is_short))) >>
                (33 - is_short),
            -(1 << 30), 1 << 30);
    return 1;
}

int32_t glint_divide_rounded(uint64_t n, uint64_t d)
{
    const int up_n = q_count_normalising_shift(n),
              up_d = q_count_normalising_shift(d);
    const int down = 62 - up_d + up_n;
    uint64_t q;

    if (n == 0)
        return 0;
    if (d == 0 || down < 32)
        return GLINT_FAR;
    if (down > 63)
        return 0;
    q = (uint64_t)q_shift_to_32_bits(n, up_n) *
            q_reciprocal(q_shift_to_32_bits(d, up_d)) >>
        1;
    q = ((q >> (down - 1)) + 1) >> 1;
    return q < GLINT_FAR ? (int32_t)q : GLINT_FAR;
}
