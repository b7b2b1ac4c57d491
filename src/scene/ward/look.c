/* SPDX-License-Identifier: MIT
 *
 * Looks up the light of an environment: bilinear in a level, blended between
 * two. */
#include "base/divide.h"
#include "base/q.h"
#include "glint/scene/ward.h"

/* (c / 31)^2 and (c / 63)^2, q16 but for 1, which is 65535. */
/* clang-format off */
static const uint16_t root5[32] = {
    0, 68, 273, 614, 1091, 1705, 2455, 3342, 4364, 5524, 6819, 8252, 9820,
    11525, 13366, 15344, 17458, 19708, 22095, 24618, 27278, 30074, 33006,
    36075, 39280, 42622, 46100, 49714, 53465, 57352, 61375, 65535};
static const uint16_t root6[64] = {
    0, 17, 66, 149, 264, 413, 594, 809, 1057, 1337, 1651, 1998, 2378, 2790,
    3236, 3715, 4227, 4772, 5350, 5961, 6605, 7282, 7992, 8735, 9511, 10320,
    11162, 12037, 12945, 13886, 14861, 15868, 16908, 17981, 19088, 20227,
    21399, 22605, 23843, 25114, 26419, 27756, 29127, 30530, 31967, 33436,
    34939, 36474, 38043, 39645, 41279, 42947, 44648, 46381, 48148, 49948,
    51781, 53647, 55545, 57477, 59442, 61440, 63471, 65535};
/* clang-format on */

/* Four texels, and what each counts: weights sum to 2^16. */
struct corners {
    uint32_t at[4], weight_q16[4];
};

/* Returns the index of texel (X, Y), each -1 .. side, as the edges of an
 * unfolded octahedron meet. */
static uint32_t index_of(int32_t x, int32_t y, int32_t side)
{
    if (x < 0 || x >= side) {
        x = x < 0 ? 0 : side - 1;
        y = side - 1 - y;
    }
    if (y < 0 || y >= side) {
        y = y < 0 ? 0 : side - 1;
        x = side - 1 - x;
    }
    return (uint32_t)(y * side + x);
}

/* Sets C to the texels about (U, V), q17, 0 .. 2^17 across and down. */
static void find(int32_t u_q17, int32_t v_q17, uint32_t side_log2,
                 struct corners *c)
{
    const int32_t side = 1 << side_log2;
    /* From the middle of the first texel, -128 .. 2^18. */
    const int32_t x_q8 = (int32_t)(u_q17 << side_log2 >> 9) - 128;
    const int32_t y_q8 = (int32_t)(v_q17 << side_log2 >> 9) - 128;
    const int32_t x = x_q8 >> 8, y = y_q8 >> 8;
    const uint32_t a = (uint32_t)x_q8 & 255, b = (uint32_t)y_q8 & 255;

    c->weight_q16[0] = (256 - a) * (256 - b);
    c->weight_q16[1] = a * (256 - b);
    c->weight_q16[2] = (256 - a) * b;
    c->weight_q16[3] = a * b;
    if (x >= 0 && y >= 0 && x + 1 < side && y + 1 < side) {
        c->at[0] = (uint32_t)(y * side + x);
        c->at[1] = c->at[0] + 1;
        c->at[2] = c->at[0] + (uint32_t)side;
        c->at[3] = c->at[2] + 1;
        return;
    }
    for (int k = 0; k < 4; k++)
        c->at[k] = index_of(x + (k & 1), y + (k >> 1), side);
}

/* Sums of four codes below 2^16 with weights of 2^16 are below 2^32, and times
 * a scale of at most 2^28 below 2^60. */
static void read_565(const uint16_t *texel, int32_t scale,
                     const struct corners *c, int32_t rgb[3])
{
    uint32_t sum_q32[3] = {0, 0, 0};

    for (int k = 0; k < 4; k++) {
        const uint32_t code = texel[c->at[k]], w = c->weight_q16[k];

        sum_q32[0] += w * root5[code >> 11];
        sum_q32[1] += w * root6[code >> 5 & 63];
        sum_q32[2] += w * root5[code & 31];
    }
    for (int j = 0; j < 3; j++)
        rgb[j] = (int32_t)((uint64_t)sum_q32[j] * (uint32_t)scale >> 32);
}

/* Mantissas below 2^9, exponents to 2^31 and weights of 2^16 in all: 2^56. */
static void read_9e5(const uint32_t *texel, const struct corners *c,
                     int32_t rgb[3])
{
    uint64_t sum_q28[3] = {0, 0, 0};

    for (int k = 0; k < 4; k++) {
        const uint32_t code = texel[c->at[k]], w = c->weight_q16[k];

        for (int j = 0; j < 3; j++)
            sum_q28[j] += (uint64_t)(w * (code >> (9 * j) & 511))
                          << (code >> 27);
    }
    for (int j = 0; j < 3; j++)
        rgb[j] = (int32_t)(sum_q28[j] >> 28);
}

static void read_level(const struct glint_environment *e, int level,
                       int32_t u_q17, int32_t v_q17, int32_t rgb[3])
{
    const struct glint_environment_level *l = &e->level[level];
    struct corners c;

    find(u_q17, v_q17, l->side_log2, &c);
    if (e->header->code == GLINT_ENVIRONMENT_565)
        read_565(e->texel[level], l->scale, &c, rgb);
    else
        read_9e5(e->texel[level], &c, rgb);
}

/* Sets U and V to the place of TOWARD in the square. */
static void place(const int32_t toward[3], int32_t *u_q17, int32_t *v_q17)
{
    const uint32_t x = (uint32_t)q_magnitude(toward[0]);
    const uint32_t y = (uint32_t)q_magnitude(toward[1]);
    const uint32_t z = (uint32_t)q_magnitude(toward[2]);
    const uint32_t sum = x + y + z;
    int32_t p_q16 = q_part_q30(x, sum ? sum : 1) >> 14;
    int32_t q_q16 = q_part_q30(z, sum ? sum : 1) >> 14;

    if (toward[1] < 0) {
        const int32_t unfolded_q16 = 65536 - q_q16;

        q_q16 = 65536 - p_q16;
        p_q16 = unfolded_q16;
    }
    *u_q17 = 65536 + (toward[0] < 0 ? -p_q16 : p_q16);
    *v_q17 = 65536 + (toward[2] < 0 ? -q_q16 : q_q16);
}

void glint_environment_irradiance(const struct glint_environment *environment,
                                  const int32_t normal[3], int32_t rgb[3])
{
    int32_t u_q17, v_q17;
    struct corners c;

    place(normal, &u_q17, &v_q17);
    find(u_q17, v_q17, GLINT_ENVIRONMENT_IRRADIANCE_LOG2, &c);
    read_9e5(environment->irradiance, &c, rgb);
}

void glint_environment_look(const struct glint_environment *environment,
                            const int32_t toward[3], int32_t level_q8,
                            int nearest, int32_t rgb[3])
{
    const int32_t last_q8 = (int32_t)(environment->header->n_levels - 1) << 8;
    int32_t u_q17, v_q17, blend_q8, next[3];

    place(toward, &u_q17, &v_q17);
    level_q8 = level_q8 < 0 ? 0 : level_q8 > last_q8 ? last_q8 : level_q8;
    if (nearest)
        level_q8 = (level_q8 + 128) & ~255;
    blend_q8 = level_q8 & 255;
    read_level(environment, level_q8 >> 8, u_q17, v_q17, rgb);
    if (blend_q8 == 0)
        return;
    read_level(environment, (level_q8 >> 8) + 1, u_q17, v_q17, next);
    for (int j = 0; j < 3; j++)
        rgb[j] += (int32_t)(((int64_t)next[j] - rgb[j]) * blend_q8 >> 8);
}
