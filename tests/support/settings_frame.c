/* SPDX-License-Identifier: MIT */
#include "support/settings_frame.h"

#include "model/opened_table.h"

static double make_starburst_from_settings(const struct settings *settings)
{
    const struct glint_options *const o = &settings->options;

    if (o->only == GLINT_ONLY_GHOSTS || o->only == GLINT_ONLY_VEIL)
        return 0;
    if (GLINT_OPTION_GIVEN(o, starburst))
        return o->starburst;
    if (o->only == GLINT_ONLY_STARBURST)
        return 1;
    return GLINT_OPTION_GIVEN(o, ghost) ? 0 : o->starburst;
}

int make_frame_from_settings(const struct tool *tool,
                             const struct opened *opened, int width, int height,
                             struct glint_frame *frame)
{
    const struct settings *const settings = &opened->settings;
    const struct opened_lens *const lens = &opened->lens;
    const struct glint_options *const o = &settings->options;

    glint_frame_init(frame, &lens->setup,
                     opened_lens_compute_view(lens, settings, width, height),
                     tool->workers);
    frame->cfg.sets = tool_enabled_instruction_sets(tool);
    frame->lens = lens->model.data ? &lens->model.lens : NULL;
    frame->trace = opened_table_ray_functions();
    frame->clock = tool_clock_s;
    frame->dials = settings->dials;
    frame->only_ghost = settings_get_selected_ghost(settings);
    frame->tints = lens->tints;
    /* A work limit could make the grid coarser than the option requests. */
    frame->limits.most_minsn =
        settings_has_grid_option(settings) && !GLINT_OPTION_GIVEN(o, work)
            ? 0
            : 1000 * o->work;
    frame->apart_px = o->apart;
    if (o->area_samples)
        frame->dials.area_points = o->area_samples;
    if (o->max_lights)
        frame->dials.max_lights = o->max_lights;
    frame->asked = frame->dials;
    frame->cfg.tile_log2 = 3 + o->tile;
    if (o->budget > 0 && frame->lens) {
        glint_budget_init(&frame->budget, o->budget);
        frame->dials =
            glint_budget_get_quality_parameters(&frame->budget, &frame->dials);
        if (glint_frame_calibrate_budget(frame) != GLINT_OK)
            return tool_fail(tool, GLINT_E_MEMORY, NULL);
    }
    frame->star.share = make_starburst_from_settings(settings);
    frame->star.is_alone =
        o->only == GLINT_ONLY_STARBURST || o->only == GLINT_ONLY_VEIL;
    if (o->only == GLINT_ONLY_VEIL || o->only == GLINT_ONLY_ALL) {
        frame->veil.glare = o->veil;
        frame->veil.haze = o->haze;
        frame->veil.front = lens->front;
    }
    return EXIT_OK;
}
