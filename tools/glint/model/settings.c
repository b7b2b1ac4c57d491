/* SPDX-License-Identifier: MIT */
#include "model/settings.h"

#include <math.h>

/* ------------------------------------------------------------------ options */

/* Computes the members of S that depend on its options, which must be valid. */
static void compute_derived_settings(struct settings *s)
{
    const struct glint_options *const o = &s->options;
    const struct glint_quality quality = glint_options_quality(o);
    struct glint_engine_config cfg;

    s->dials = quality.dials;
    s->quantum = quality.quantum;
    s->tolerance = quality.tolerance;
    s->zoom =
        (struct zoom_option){o->zoom, o->focus, GLINT_OPTION_GIVEN(o, zoom),
                             GLINT_OPTION_GIVEN(o, focus)};
    glint_engine_defaults(&cfg, 1, 1);
    cfg.camera.iris.roundness = s->roundness;
    glint_engine_configure(&cfg, o);
    s->camera = cfg.camera;
    s->has_stop = o->stop != NULL;
    s->n_wavelengths = glint_waves_list(&s->camera.waves, s->wavelength_nm);
}

void settings_set_defaults(struct settings *settings)
{
    struct glint_options *const o = &settings->options;

    *settings = (struct settings){.roundness = 0};
    glint_options_defaults(o);
    o->starburst = 0;
    o->wavelengths = "650,532,450";
    compute_derived_settings(settings);
}

void settings_set_photo_defaults(struct settings *settings)
{
    settings_set_defaults(settings);
    glint_options_defaults(&settings->options);
    settings->roundness = PHOTO_ROUNDNESS;
    compute_derived_settings(settings);
}

int settings_apply_option(const struct tool *tool, struct settings *settings,
                          int option, const char *value)
{
    int code = engine_apply_option(tool, &settings->options, option, value);

    if (code == -1 && option == ENGINE_OPTION_OF(coating))
        code = coating_parse_option(tool, &settings->coating, value);
    if (code == -1)
        compute_derived_settings(settings);
    return code;
}

bool settings_set_text(struct settings *settings, const char *name,
                       const char *text)
{
    struct glint_error error;

    if (glint_options_set_text(&settings->options, name, text, &error) !=
        GLINT_OK)
        return false;
    compute_derived_settings(settings);
    return true;
}

bool settings_set_number(struct settings *settings, const char *name,
                         double value)
{
    struct glint_error error;

    if (glint_options_set(&settings->options, name, value, &error) != GLINT_OK)
        return false;
    compute_derived_settings(settings);
    return true;
}

void settings_set_quality(struct settings *settings, double quality)
{
    settings_set_number(settings, "quality", quality);
}

bool settings_has_grid_option(const struct settings *settings)
{
    const struct glint_options *const o = &settings->options;

    return GLINT_OPTION_GIVEN(o, grid) || GLINT_OPTION_GIVEN(o, quality) ||
           GLINT_OPTION_GIVEN(o, error);
}

int settings_report_bad_stop(const struct tool *tool, const struct settings *s,
                             const char *text)
{
    struct tool there = *tool;

    if (!s->f_number_from)
        return tool_fail(tool, GLINT_E_ARGUMENT, text);
    there.where = s->f_number_from;
    return tool_usage(&there, "%s", text);
}

bool settings_has_veil(const struct settings *settings)
{
    return settings->options.veil > 0 || settings->options.haze > 0 ||
           settings->camera.front_dirt.dust > 0 || settings->options.front_mask;
}

enum settings_unbaked
settings_choose_method_without_model(const struct settings *settings)
{
    const struct glint_options *const o = &settings->options;
    const bool is_chosen = GLINT_OPTION_GIVEN(o, rays) || o->memory ||
                           o->keys || o->control || o->budget > 0 ||
                           settings->dials.flags & GLINT_DIAL_ALWAYS_HALF;

    return is_chosen ? SETTINGS_BAKE : SETTINGS_TRACE;
}

int settings_get_selected_ghost(const struct settings *settings)
{
    return GLINT_OPTION_GIVEN(&settings->options, ghost)
               ? settings->options.ghost
               : -1;
}

double settings_compute_brightness_scale(const struct settings *settings)
{
    return settings->options.gain * exp2(settings->options.exposure);
}

void settings_write_json(struct json_writer *json,
                         const struct glint_engine_report *r)
{
    json_write(
        json,
        "lights: %d, beyond_lights: %d, apart_lights: %d, drawn_lights: %d, "
        "ghosts: %d, bundles: %d, primitives: %d, tiles: %d, arena_bytes: %zu, "
        "peak_bytes: %zu, star_bytes: %zu, refs: %d, "
        "dropped_bundles: %d, dropped_cells: %d, held_cells: %d, "
        "held_samples: %d, coarsened: %c, plan_ms: %.3f, trace_ms: %.3f, "
        "bin_ms: %.3f, draw_ms: %.3f",
        r->lights, r->beyond_lights, r->apart_lights, r->drawn_lights,
        r->ghosts, r->stats.bundles, r->stats.primitives, r->tiles,
        r->arena_bytes, r->peak_bytes, r->star_bytes, r->stats.refs,
        r->stats.dropped_bundles, r->stats.dropped_cells, r->stats.held_cells,
        r->held_samples, r->coarsened, r->plan_ms, r->trace_ms, r->bin_ms,
        r->draw_ms);
    if (r->quality >= 0)
        json_write(json,
                   "quality: %.4f, predicted_ms: %.3f, calibrated_minsn: %.4f, "
                   "dim: %g, dust_blurred: %c, veil_left_out: %c",
                   r->quality, r->predicted_ms, r->calibrated_minsn,
                   r->dials.dim_codes, r->blurred, r->unveiled);
}

void settings_write_light_counts(const struct glint_engine_report *r,
                                 char text[64])
{
    if (r->drawn_lights < r->lights - r->beyond_lights)
        snprintf(text, 64, "%d lights, %d after merging", r->lights,
                 r->drawn_lights);
    else
        snprintf(text, 64, "%d light%s", r->lights, r->lights == 1 ? "" : "s");
}

void settings_print_light_warnings(const struct tool *tool,
                                   const struct glint_engine_report *r)
{
    if (r->tight)
        fprintf(
            stderr,
            "glint %s: the estimated memory of the frame exceeds --memory, so "
            "the frame is drawn coarser (--memory accepts up to 1024 MiB)\n",
            tool->name);
    else if (r->coarsened)
        fprintf(stderr,
                "glint %s: the cost of the frame exceeds --work, so the frame "
                "is drawn coarser\n",
                tool->name);
    if (!tool->quiet && r->blurred)
        fprintf(stderr,
                "glint %s: dust and masks of the stop are drawn blurred to "
                "stay within %s\n",
                tool->name, r->quality >= 0 ? "--budget" : "--work");
    if (!tool->quiet && r->unveiled)
        fprintf(stderr,
                "glint %s: the veil is left out to stay within --budget\n",
                tool->name);
    if (!tool->quiet && r->beyond_lights > 0)
        fprintf(stderr,
                "glint %s: %d of %d lights lie outside the angles of the model "
                "and cause no ghosts; move them towards the centre, or bake "
                "with a larger --max-angle\n",
                tool->name, r->beyond_lights, r->lights);
    if (!tool->quiet && r->drawn_lights < r->apart_lights)
        fprintf(stderr,
                "glint %s: %d distinct lights were merged into "
                "%d, the faint ones first (--max-lights)\n",
                tool->name, r->apart_lights, r->drawn_lights);
    if (r->stats.dropped_bundles > 0)
        fprintf(
            stderr,
            "glint %s: %d bundles of rays are missing because --memory is too "
            "small; increase it, or use fewer lights or a smaller --grid\n",
            tool->name, r->stats.dropped_bundles);
    if (tool->verbose && r->stats.dropped_cells > 0)
        fprintf(stderr,
                "glint %s: %d cells of rays are missing because a corner of "
                "each lies too far outside the picture\n",
                tool->name, r->stats.dropped_cells);
}
