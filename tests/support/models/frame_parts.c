/* SPDX-License-Identifier: MIT */
#include "support/models/frame_parts.h"

#include <string.h>

#include "base/real.h"
#include "support/model_builder.h"

void set_frame_wavelengths(struct glint_wave wave[2])
{
    for (int i = 0; i < 2; i++)
        wave[i] = (struct glint_wave){i ? MODEL_WAVE_HI_Q24 : MODEL_WAVE_LO_Q24,
                                      {i ? 0 : 16384, i ? 16384 : 0, 0},
                                      real_of(1, 0)};
}

struct glint_light make_axial_light(void)
{
    return (struct glint_light){
        0, 1 << 30, 1 << 30, 0, real_of(1000, 0), {16384, 16384, 16384}, 0};
}

struct glint_flare_frame make_frame_rays(const struct glint_lens *lens,
                                         const struct glint_wave wave[2],
                                         int fineness)
{
    return (struct glint_flare_frame){.lens = lens,
                                      .wave = wave,
                                      .n_waves = 2,
                                      .pixels_per_mm = real_of(64, 0),
                                      .fineness = fineness,
                                      .only_ghost = -1};
}

struct glint_flare_config make_frame_config(int width, int height,
                                            int tile_log2)
{
    static const int32_t square[4][2] = {
        {1 << 30, 0}, {0, 1 << 30}, {-(1 << 30), 0}, {0, -(1 << 30)}};
    struct glint_flare_config config = {
        .width = width, .height = height, .tile_log2 = tile_log2};

    config.stop.n_blades = 4;
    config.stop.apothem_q16 = 26214;
    memcpy(config.stop.normal_q30, square, sizeof square);
    return config;
}
