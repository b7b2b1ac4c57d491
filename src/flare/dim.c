/* SPDX-License-Identifier: MIT
 *
 * Between two nodes logarithms are interpolated, so that what a ghost counts
 * for is steady as its light moves or fades. A ghost that some wave does not
 * get through at a node counts as bright beside it. */
#include "flare/dim.h"

/* Returns value K of the ghost of PLANNED at its light, or GLINT_DIM_DARK. */
static int32_t value_at(const struct glint_flare_frame *frame,
                        const struct glint_light *light, int ghost, int k)
{
    const int32_t at_q16 = glint_dim_node_q16(frame, light);
    const int node = at_q16 >> 16;
    const int32_t a = glint_dim_values(frame, node, ghost)[k];
    const int32_t b = glint_dim_values(frame, node + 1, ghost)[k];

    if (a == GLINT_DIM_DARK || b == GLINT_DIM_DARK)
        return GLINT_DIM_DARK;
    return a + q_narrow(q_shift((int64_t)(b - a) * (at_q16 & 65535), 16));
}

/* Returns whether all waves get through at node NODE, or there is none. */
static int is_known(const struct glint_flare_frame *frame, int ghost, int node)
{
    const int16_t *value;

    if (node < 0 || node > GLINT_DIM_LAST)
        return 1;
    value = glint_dim_values(frame, node, ghost);
    for (int wave = 0; wave < GLINT_DIM_WAVES; wave++)
        if (value[1 + wave] == GLINT_DIM_DARK)
            return 0;
    return 1;
}

/* Where the next range of angles is not known, all of the light is kept from
 * there on, and ever less of it towards the middle of this one. */
int glint_dim_share_q8(const struct glint_flare_frame *frame,
                       const struct glint_light *light, int ghost)
{
    const int32_t at_q16 = glint_dim_node_q16(frame, light);
    const int node = at_q16 >> 16;
    const int from_q8 = (at_q16 & 65535) >> 7;
    int32_t share_q8;

    if (!is_known(frame, ghost, node) || !is_known(frame, ghost, node + 1))
        return GLINT_DIM_WHOLE_Q8;
    share_q8 = value_at(frame, light, ghost, 0) +
               glint_dim_log2_q8(light->power) -
               glint_dim_log2_q8(frame->dimmest);
    if (!is_known(frame, ghost, node - 1) &&
        share_q8 < GLINT_DIM_WHOLE_Q8 - from_q8)
        share_q8 = GLINT_DIM_WHOLE_Q8 - from_q8;
    if (!is_known(frame, ghost, node + 2) &&
        share_q8 < from_q8 - GLINT_DIM_WHOLE_Q8)
        share_q8 = from_q8 - GLINT_DIM_WHOLE_Q8;
    return q_clamp_sat(share_q8, 0, GLINT_DIM_WHOLE_Q8);
}

int64_t glint_dim_ratio_q16(const struct glint_flare_frame *frame,
                            const struct glint_light *light, int ghost,
                            int wave)
{
    const int32_t log2 =
        q_clamp_sat(value_at(frame, light, ghost, 1 + wave) -
                        value_at(frame, light, ghost, 1 + GLINT_DIM_WAVE),
                    -16 * 256, 11 * 256);
    const int64_t one_q16 = (256 + (log2 & 255)) << 8;
    const int octaves = log2 >> 8;

    return octaves < 0 ? one_q16 >> -octaves : one_q16 << octaves;
}
