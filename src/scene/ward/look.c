/* SPDX-License-Identifier: MIT
 *
 * Looks up the light of an environment map: bilinear within a mip level,
 * blended between two levels. */
#include "base/divide.h"
#include "base/log2.h"
#include "glint/scene/ward.h"
#include "kernels/ward/texels.h"

/* Sets U and V to the position of direction TOWARD in the square environment
 * map. */
static void compute_map_position(const int32_t toward[3], int32_t *u_q17,
                                 int32_t *v_q17)
{
    const uint32_t x = (uint32_t)q_magnitude(toward[0]);
    const uint32_t y = (uint32_t)q_magnitude(toward[1]);
    const uint32_t z = (uint32_t)q_magnitude(toward[2]);
    const uint32_t sum = x + y + z;
    int32_t p_q16 = q_divide_to_fraction_q30(x, sum ? sum : 1) >> 14;
    int32_t q_q16 = q_divide_to_fraction_q30(z, sum ? sum : 1) >> 14;

    if (toward[1] < 0) {
        const int32_t unfolded_q16 = 65536 - q_q16;

        q_q16 = 65536 - p_q16;
        p_q16 = unfolded_q16;
    }
    *u_q17 = 65536 + (toward[0] < 0 ? -p_q16 : p_q16);
    *v_q17 = 65536 + (toward[2] < 0 ? -q_q16 : q_q16);
}

static void convert_texel_to_light(const struct glint_found *found,
                                   int32_t rgb[3])
{
    for (int j = 0; j < 3; j++)
        rgb[j] = (int32_t)(found->rgb[j] >> (34 - found->log2));
}

void glint_environment_irradiance(const struct glint_environment *environment,
                                  const int32_t normal[3], int32_t rgb[3])
{
    static const struct glint_texels_level level = {
        .side_log2 = GLINT_ENVIRONMENT_IRRADIANCE_LOG2};
    struct glint_reads reads;
    struct glint_found found;
    int32_t u_q17, v_q17;

    compute_map_position(normal, &u_q17, &v_q17);
    glint_choose_texels_to_read(&level, u_q17, v_q17, 256, reads.at,
                                reads.weight_q22);
    glint_sum_texel_light(environment->irradiance, &reads, 4, &found);
    convert_texel_to_light(&found, rgb);
}

/* Returns the weight of the next mip level in the blend of two levels. The
 * blend has the variance of a level OVER_Q8 / 256 levels above the first one,
 * as variance grows four times per level. */
static uint32_t compute_level_weight(int32_t over_q8)
{
    return (uint32_t)(q_exp2_q16(over_q8 * 512) - 65536) * 85 >> 16;
}

void glint_environment_look(const struct glint_environment *environment,
                            const int32_t toward[3], int32_t level_q8,
                            int32_t rgb[3])
{
    const struct glint_texels *texels = &environment->texels;
    const struct glint_texels_level *level;
    struct glint_reads reads;
    struct glint_found found;
    int32_t u_q17, v_q17;
    uint32_t share_q8;

    compute_map_position(toward, &u_q17, &v_q17);
    level_q8 = q_smaller(q_larger(level_q8, 0), texels->last << 8);
    share_q8 = compute_level_weight(level_q8 & 255);
    level = &texels->level[level_q8 >> 8];
    glint_choose_texels_to_read(level, u_q17, v_q17, 256 - share_q8, reads.at,
                                reads.weight_q22);
    if (share_q8)
        glint_choose_texels_to_read(level + 1, u_q17, v_q17, share_q8,
                                    reads.at + 4, reads.weight_q22 + 4);
    glint_sum_texel_light(texels->code, &reads, share_q8 ? 8 : 4, &found);
    convert_texel_to_light(&found, rgb);
}
