/* SPDX-License-Identifier: MIT */
#include "base/q.h"
#include "glint/flare.h"

/* Default max number of edges per light, per ray bundle, and per frame. The
 * bins have two entries per edge, so up to 131072 per light; the lenses of this
 * repository need up to 67000 (1280x720, linear light). */
enum { EDGES = 1 << 16, EDGES_OF_BUNDLE = 1 << 10, MOST_EDGES = 1 << 24 };

void glint_flare_defaults(struct glint_flare_config *cfg, int width, int height)
{
    *cfg = (struct glint_flare_config){.width = width,
                                       .height = height,
                                       .tile_log2 = 6,
                                       .irradiance_steps = 69};
}

void glint_flare_capacities(struct glint_flare_config *cfg,
                            const struct glint_lens *lens, int n_lights,
                            int n_waves)
{
    const int64_t of_light = (int64_t)lens->header->n_ghosts * n_waves;
    const int64_t edges =
        of_light < EDGES / EDGES_OF_BUNDLE ? of_light * EDGES_OF_BUNDLE : EDGES;
    const int64_t all = n_lights * edges;

    cfg->max_bundles = q_narrow(q_clamp_sat(n_lights * of_light, 0, 1 << 20));
    cfg->max_primitives = q_narrow(q_clamp_sat(all, 0, MOST_EDGES));
    cfg->max_refs = 2 * cfg->max_primitives;
    cfg->max_vertices = 0;
}

void glint_flare_frame_defaults(struct glint_flare_frame *frame,
                                const struct glint_lens *lens)
{
    /* light of 1/8 code near black in 8-bit sRGB: 0.125 / 255 / 12.92 */
    static const struct glint_real faintest = {1334925791, -45};

    *frame = (struct glint_flare_frame){.lens = lens,
                                        .fineness = 64,
                                        .only_ghost = -1,
                                        .faintest = faintest,
                                        .snap_codes_q8 = 4 << 8};
}
