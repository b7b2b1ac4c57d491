/* SPDX-License-Identifier: MIT
 *
 * Reads the table of ghost brightness (dim.h). The table has logarithms at
 * sampled angles of the light (nodes), and they are interpolated between nodes.
 * So the fraction of a ghost that is drawn with rays of each wavelength changes
 * smoothly as the light moves or fades. If some wavelength of a ghost is
 * blocked at a node, the ghost counts as bright from the previous node to the
 * next one. */
#include "flare/dim.h"

enum { BRIGHT_Q8 = 1 << 16 };

/* Returns value K, a log2 of light (glint_dim_get_values()), of GHOST,
 * interpolated between the two nodes around the angle whose sine is SINE.
 * Returns GLINT_DIM_DARK if one of these has this value. */
static int32_t interpolate_dim_value(const struct glint_flare_frame *frame,
                                     int32_t sine_q30, int ghost, int k)
{
    const int32_t at_q16 = glint_dim_find_node_q16(frame, sine_q30);
    const int node = at_q16 >> 16;
    const int32_t a = glint_dim_get_values(frame, node, ghost)[k];
    const int32_t b = glint_dim_get_values(frame, node + 1, ghost)[k];

    if (a == GLINT_DIM_DARK || b == GLINT_DIM_DARK)
        return GLINT_DIM_DARK;
    return a + q_narrow(q_shift((int64_t)(b - a) * (at_q16 & 65535), 16));
}

/* Returns whether the table has the brightness of GHOST in all wavelengths at
 * node NODE, which it lacks where a wavelength is blocked. Returns 1 if NODE is
 * out of range. */
static int is_ghost_brightness_known(const struct glint_flare_frame *frame,
                                     int ghost, int node)
{
    const int16_t *value;

    if (node < 0 || node > GLINT_DIM_LAST)
        return 1;
    value = glint_dim_get_values(frame, node, ghost);
    for (int wave = 0; wave < GLINT_DIM_WAVES; wave++)
        if (value[1 + wave] == GLINT_DIM_DARK)
            return 0;
    return 1;
}

/* If the brightness is not known in the interval of nodes before or after the
 * current one, the ghost counts as bright there. The result is then at least a
 * linear function that falls from 1 at the node between both intervals to -1 at
 * the current interval's other node. */
int32_t
glint_dim_compute_brightness_log2_q8(const struct glint_flare_frame *frame,
                                     const struct glint_light *light, int ghost)
{
    const int32_t at_q16 = glint_dim_find_node_q16(frame, light->sine_q30);
    const int node = at_q16 >> 16;
    const int from_q8 = (at_q16 & 65535) >> 7;
    int32_t share_q8;

    if (!is_ghost_brightness_known(frame, ghost, node) ||
        !is_ghost_brightness_known(frame, ghost, node + 1))
        return BRIGHT_Q8;
    share_q8 = interpolate_dim_value(frame, light->sine_q30, ghost, 0) +
               glint_dim_compute_log2_q8(light->power) -
               glint_dim_compute_log2_q8(frame->dimmest);
    if (frame->tints)
        share_q8 += glint_dim_compute_log2_q8(frame->tints[ghost].gain);
    if (!is_ghost_brightness_known(frame, ghost, node - 1) &&
        share_q8 < GLINT_DIM_WHOLE_Q8 - from_q8)
        share_q8 = GLINT_DIM_WHOLE_Q8 - from_q8;
    if (!is_ghost_brightness_known(frame, ghost, node + 2) &&
        share_q8 < from_q8 - GLINT_DIM_WHOLE_Q8)
        share_q8 = from_q8 - GLINT_DIM_WHOLE_Q8;
    return share_q8;
}

int glint_dim_compute_own_rays_fraction_q8(
    const struct glint_flare_frame *frame, const struct glint_light *light,
    int ghost)
{
    return q_clamp_sat(
        glint_dim_compute_brightness_log2_q8(frame, light, ghost), 0,
        GLINT_DIM_WHOLE_Q8);
}

int64_t glint_dim_compute_wave_ratio_q16(const struct glint_flare_frame *frame,
                                         int32_t sine_q30, int ghost, int wave)
{
    const int32_t log2 = q_clamp_sat(
        interpolate_dim_value(frame, sine_q30, ghost, 1 + wave) -
            interpolate_dim_value(frame, sine_q30, ghost, 1 + GLINT_DIM_WAVE),
        -16 * 256, 11 * 256);
    const int64_t one_q16 = (int64_t)(256 + (log2 & 255)) << 8;
    const int octaves = log2 >> 8;

    return octaves < 0 ? one_q16 >> -octaves : one_q16 << octaves;
}
