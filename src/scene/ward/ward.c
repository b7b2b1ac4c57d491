/* SPDX-License-Identifier: MIT
 *
 * Evaluates Ward's reflection lobe over an environment: the light of a point is
 * a sum of lookups in the environment's mip levels, one per sampled half
 * vector. */
#include "glint/scene/ward.h"
#include "scene/vector.h"
#include "scene/ward/send.h"

enum { MOST_LIGHT = 1 << 30 };

/* Returns X * 2^LOG2, clamped to 2^30. X must be 0 .. 2^61. */
static int32_t scale_by_power_of_two(uint64_t x, int log2)
{
    if (log2 <= 0)
        return log2 < -62
                   ? 0
                   : q_clamp_sat(q_shift((int64_t)x, -log2), 0, MOST_LIGHT);
    if (x == 0)
        return 0;
    return log2 > 30 || x >> (30 - log2) > 0 ? MOST_LIGHT
                                             : (int32_t)(x << log2);
}

/* Sets the root of PLACE to 1 / sqrt(n.o), where n is the normal and o the
 * direction to the eye. */
static void set_inverse_root_of_cosine(struct glint_ward_place *place)
{
    const uint32_t root_q21 =
        glint_compute_square_root((uint64_t)(uint32_t)place->out_q14[2] << 28);
    const int bits = bit_length(root_q21); /* 15 .. 22 */

    place->root_q14 =
        glint_divide_rounded(UINT64_C(1) << (bits + 14), root_q21);
    place->root_log2 = 21 - bits;
}

void glint_ward_compute_light(const struct glint_ward_lobe *lobe,
                              const struct glint_environment *environment,
                              struct glint_ward_place *place,
                              int32_t rgb_q15[3])
{
    uint64_t sum_q12[3]; /* below 32 * 8 * 2^12 * 2^28 = 2^48 */

    if (place->out_q14[2] <= 0) {
        for (int k = 0; k < 3; k++)
            rgb_q15[k] = 0;
        return;
    }
    if (lobe->norm == GLINT_WARD_1992)
        set_inverse_root_of_cosine(place);
    lobe->sum(lobe, &environment->texels, place, sum_q12);
    for (int k = 0; k < 3; k++) {
        /* The mean is below 2^45 and is multiplied by a colour of at most
         * 2^15. */
        const uint64_t mean_q12 =
            (sum_q12[k] >> 16) * (uint32_t)lobe->share_q16 +
            ((sum_q12[k] & 0xffff) * (uint32_t)lobe->share_q16 >> 16);

        rgb_q15[k] = scale_by_power_of_two(
            mean_q12 * (uint32_t)lobe->specular_q15[k], lobe->unit_log2 - 12);
    }
}

void glint_ward_light(const struct glint_ward_lobe *lobe,
                      const struct glint_environment *environment,
                      const int32_t frame_q14[3][3], const int32_t view_q14[3],
                      int32_t rgb_q15[3])
{
    struct glint_ward_place place;

    for (int k = 0; k < 3; k++) {
        for (int j = 0; j < 3; j++)
            place.frame_q14[k][j] = frame_q14[k][j];
        place.out_q14[k] = (int32_t)q_shift(v3_dot(frame_q14[k], view_q14), 14);
    }
    glint_ward_compute_light(lobe, environment, &place, rgb_q15);
}
