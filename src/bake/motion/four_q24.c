/* SPDX-License-Identifier: MIT
 *
 * Four points in int32: edges below 2^30, their cross products below 2^61.
 * These are cut to 29 bits before they are multiplied once more, so that a
 * determinant is below 3 * 2^59 < 2^61. */
#include "bake/motion/four.h"

#include "base/divide.h"

enum { CROSS_BITS = 29, WEIGHT_BITS = 28 };

static int bits_of(int64_t x)
{
    return bit_length(q_magnitude(x));
}

/* Sets TO to A x B. */
static void cross(const int32_t a[3], const int32_t b[3], int64_t to[3])
{
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;

        to[k] = (int64_t)a[i] * b[j] - (int64_t)a[j] * b[i];
    }
}

static int64_t dot(const int32_t a[3], const int64_t b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Shortens N, below 2^61, to CROSS_BITS. */
static void shorten(int64_t n[3])
{
    int longest = 0;

    for (int k = 0; k < 3; k++)
        longest = q_larger(longest, bits_of(n[k]));
    for (int k = 0; k < 3 && longest > CROSS_BITS; k++)
        n[k] = q_shift(n[k], longest - CROSS_BITS);
}

/* A weight in 2^-FRACTION, below 2^31. */
struct weight {
    int64_t x;
    int fraction;
};

/* Sets W to PART / ALL, off by half a step; both are below 2^61. Returns false
 * if ALL is 0, or the ratio 2^29 or more. */
static bool divide(int64_t part, int64_t all, struct weight *w)
{
    const int down = q_larger(0, bits_of(all) - 31);
    const int64_t d = q_shift(all, down);
    const int64_t half = (int64_t)(q_magnitude(d) >> 1);
    const int bits = bits_of(part);
    int up;

    if (all == 0)
        return false;
    /* part 2^(fraction - down) is below 2^61 */
    w->fraction = q_smaller(WEIGHT_BITS, 61 - bits + down);
    w->fraction = q_smaller(w->fraction, 30 - bits + bits_of(all));
    if (w->fraction < 1)
        return false;
    up = w->fraction - down;
    part = up < 0 ? q_shift(part, -up) : part * (INT64_C(1) << up);
    w->x = q_divide(part + (part < 0 ? -half : half), d);
    return true;
}

/* Sets WEIGHT to those of POINT in the first three of FROM. Weight i is how far
 * the point is off the plane of the other edges, over how far edge i is: both
 * times the plane's normal, whatever its length. */
static bool weigh(const int32_t from[4][3], const int32_t point[3],
                  struct weight weight[3])
{
    int32_t edge[3][3], to[3];

    for (int k = 0; k < 3; k++) {
        to[k] = q_narrow((int64_t)point[k] - from[3][k]);
        for (int i = 0; i < 3; i++)
            edge[i][k] = q_narrow((int64_t)from[i][k] - from[3][k]);
    }
    for (int i = 0; i < 3; i++) {
        int64_t normal[3];

        cross(edge[(i + 1) % 3], edge[(i + 2) % 3], normal);
        shorten(normal);
        if (!divide(dot(to, normal), dot(edge[i], normal), &weight[i]))
            return false;
    }
    return true;
}

bool glint_four_place_q24(const int32_t from_q24[4][3],
                          const int32_t to_q24[4][3],
                          const int32_t point_q24[3], int32_t place_q24[3])
{
    struct weight weight[3];

    if (!weigh(from_q24, point_q24, weight))
        return false;
    for (int k = 0; k < 3; k++) {
        int64_t sum = to_q24[3][k];

        /* a weight below 2^31 times an edge below 2^30 */
        for (int i = 0; i < 3; i++)
            sum += q_shift(weight[i].x * ((int64_t)to_q24[i][k] - to_q24[3][k]),
                           weight[i].fraction);
        if (q_magnitude(sum) >= UINT64_C(1) << 30)
            return false;
        place_q24[k] = (int32_t)sum;
    }
    return true;
}
