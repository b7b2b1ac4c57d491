/* SPDX-License-Identifier: MIT */
#include "model/settings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/ghost_file.h"
#include "posix/error.h"
#include "model/stop_option.h"
#include "model/settings_table.h"

/* ------------------------------------------------------------------ options */

static void resolve_waves(struct settings *s)
{
    struct glint_waves waves = {GLINT_WAVES_AUTO, 0, {0}};

    glint_option_waves(s->options.wavelengths, &waves);
    s->waves = waves.kind;
    if (waves.kind == GLINT_WAVES_AUTO)
        return;
    s->n_wavelengths = waves.n;
    if (waves.kind == GLINT_WAVES_LIST)
        memcpy(s->wavelength_nm, waves.nm, sizeof waves.nm);
}

static void resolve_stop(struct settings *s)
{
    const struct glint_options *const o = &s->options;
    struct stop_option *const stop = &s->stop;
    struct glint_stop_shape shape = {8, 0, s->roundness, 0};

    stop->is_asked = o->stop && glint_option_stop(o->stop, &shape);
    stop->n_blades = shape.n_blades;
    stop->rotation_deg = shape.rotation_deg;
    stop->iris.roundness = shape.roundness;
    stop->iris.softness = shape.softness;
    stop->iris.dust = s->front.front.dust = 0;
    stop->mask_file = o->stop_mask;
    if (o->dust)
        glint_option_dust(o->dust, &stop->iris.dust, &stop->iris.dust_seed);
    s->front.mask_file = o->front_mask;
    if (o->front_dust)
        glint_option_dust(o->front_dust, &s->front.front.dust,
                          &s->front.front.dust_seed);
}

/* Sets what follows from the options, all of which are valid. */
static void resolve(struct settings *s)
{
    const struct glint_options *const o = &s->options;
    const struct glint_quality quality = glint_options_quality(o);

    s->dials = quality.dials;
    s->quantum = quality.quantum;
    s->tolerance = quality.tolerance;
    s->zoom =
        (struct zoom_option){o->zoom, o->focus, GLINT_OPTION_GIVEN(o, zoom),
                             GLINT_OPTION_GIVEN(o, focus)};
    s->sensor_mm[0] = s->sensor_mm[1] = 0;
    if (o->sensor)
        glint_option_sensor(o->sensor, s->sensor_mm);
    resolve_waves(s);
    resolve_stop(s);
}

void settings_defaults(struct settings *settings)
{
    struct glint_options *const o = &settings->options;

    *settings = (struct settings){.stop.n_blades = 8,
                                  .wavelength_nm = {650, 532, 450},
                                  .n_wavelengths = 3,
                                  .coating.kind = COATING_TABLE};
    glint_options_defaults(o);
    o->starburst = 0;
    o->coating = "table";
    o->wavelengths = "650,532,450";
    resolve(settings);
}

void settings_defaults_photo(struct settings *settings)
{
    settings_defaults(settings);
    glint_options_defaults(&settings->options);
    settings->coating.kind = COATING_MIXED;
    settings->roundness = PHOTO_ROUNDNESS;
    resolve(settings);
}

int settings_option(const struct tool *tool, struct settings *settings,
                    int option, const char *value)
{
    int code = engine_option(tool, &settings->options, option, value);

    if (code == -1 && option == ENGINE_OPTION_OF(coating))
        code = coating_take(tool, &settings->coating, value);
    if (code == -1)
        resolve(settings);
    return code;
}

bool settings_set(struct settings *settings, const char *name, const char *text)
{
    struct glint_error error;

    if (glint_options_set_text(&settings->options, name, text, &error) !=
        GLINT_OK)
        return false;
    resolve(settings);
    return true;
}

bool settings_set_number(struct settings *settings, const char *name,
                         double value)
{
    struct glint_error error;

    if (glint_options_set(&settings->options, name, value, &error) != GLINT_OK)
        return false;
    resolve(settings);
    return true;
}

void settings_set_quality(struct settings *settings, double quality)
{
    settings_set_number(settings, "quality", quality);
}

bool settings_has_grid(const struct settings *settings)
{
    const struct glint_options *const o = &settings->options;

    return GLINT_OPTION_GIVEN(o, grid) || GLINT_OPTION_GIVEN(o, quality) ||
           GLINT_OPTION_GIVEN(o, error);
}

struct stop_option settings_stop_shape(const struct settings *settings)
{
    struct stop_option stop = settings->stop;

    if (!stop.is_asked && settings->lens.stop_is_circle) {
        stop.n_blades = 0;
        stop.iris.roundness = 0;
    }
    return stop;
}

/* -------------------------------------------------------------- wavelengths */

void settings_choose_waves(struct settings *s)
{
    double rgb[GLINT_MAX_WAVELENGTHS][3], share[GLINT_MAX_WAVELENGTHS];

    if (s->waves == GLINT_WAVES_COUNT)
        glint_spectrum(s->n_wavelengths, s->wavelength_nm, rgb, share);
}

/* Sets the colours of the setup, once it is made: weighs the wavelengths if
 * only their number was given; for "auto" makes the sets of wavelengths that
 * ghosts choose from. A list stays as it is. */
static void weigh(struct settings *s)
{
    if (s->waves == GLINT_WAVES_COUNT)
        glint_setup_weigh(&s->setup);
    /* A model of the sparse basis holds its three wavelengths and no others. */
    else if (s->waves == GLINT_WAVES_AUTO && !s->model.data)
        glint_setup_spread(&s->setup, NULL);
    else if (s->waves == GLINT_WAVES_AUTO &&
             s->model.lens.header->basis != GLINT_BASIS_SPARSE)
        glint_setup_spread(&s->setup, &s->model.lens);
}

/* ------------------------------------------------------------------ opening */

static int check_band(const struct tool *tool, const struct settings *settings)
{
    const struct glint_model_header *h = settings->model.lens.header;
    const double lo = 1e3 / sqrt(h->wave_hi_q24 * 0x1p-24);
    const double hi = 1e3 / sqrt(h->wave_lo_q24 * 0x1p-24);

    for (int i = 0; i < settings->n_wavelengths; i++)
        if (settings->wavelength_nm[i] < lo - 0.5 ||
            settings->wavelength_nm[i] > hi + 0.5)
            return tool_usage(tool,
                              "%g nm lies outside the %.0f to %.0f nm that "
                              "the model of %s was baked for (bake --band)",
                              settings->wavelength_nm[i], lo, hi, h->name);
    return EXIT_OK;
}

/* Warns if the picture is larger than the field that the model was baked
 * for. */
static void warn_field(const struct tool *tool, const struct settings *settings)
{
    const double field = model_real_of(settings->model.lens.header->field_mm);
    const double *mm = settings->sensor_mm;

    if (!tool->quiet && 0.5 * hypot(mm[0], mm[1]) > field)
        fprintf(stderr,
                "glint %s: the model was baked for a field of %.1f mm around "
                "the middle; corners beyond are left to chance (bake --field)"
                "\n",
                tool->name, field);
}

/* Zooms the model of PATH to where the line says. */
static int zoom_model(const struct tool *tool, struct settings *settings,
                      const char *path)
{
    const struct zoom_option *const o = &settings->zoom;
    struct glint_error error = {""};

    if (!settings->model.zoom || o->is_focused)
        return zoom_option_of_model(tool, o, path);
    return !o->is_zoomed || model_file_zoom(&settings->model, o->zoom,
                                            &error) == GLINT_OK
               ? EXIT_OK
               : tool_usage(tool, "%s: %s", path, error.text);
}

static int open_model(const struct tool *tool, struct settings *settings,
                      const char *path)
{
    const struct glint_model_header *h;
    int code;

    if (settings->options.rays == GLINT_RAYS_EXACT)
        return tool_usage(tool, "%s is a model: exact rays need the lens table",
                          path);
    code = coating_of_model(tool, &settings->coating, path);
    if (code == EXIT_OK)
        code = tool_model(tool, path, &settings->model);
    if (code == EXIT_OK)
        code = zoom_model(tool, settings, path);
    if (code != EXIT_OK)
        return code;
    h = settings->model.lens.header;
    snprintf(settings->lens.name, sizeof settings->lens.name, "%s", h->name);
    settings->lens.film_width_mm = model_real_of(h->film_width_mm);
    settings->lens.film_height_mm = model_real_of(h->film_height_mm);
    settings->lens.stop_is_circle = false; /* models do not say */
    warn_field(tool, settings);
    return EXIT_OK;
}

/* Makes the setup of S for its f-number. */
static enum glint_status make_setup(struct settings *s,
                                    struct glint_error *error)
{
    const struct stop_option stop = settings_stop_shape(s);
    struct glint_dirt *const before = s->stop.dirt;
    enum glint_status status =
        s->model.data
            ? glint_setup_from_model(&s->setup, &s->model.lens, stop.n_blades,
                                     stop.rotation_deg, s->wavelength_nm,
                                     s->n_wavelengths, error)
            : settings_table_setup(s, &stop, error);

    if (status == GLINT_OK && s->model.data && s->options.f_number > 0)
        status = glint_setup_stop_down(&s->setup, &s->model.lens,
                                       s->options.f_number, error);
    if (status == GLINT_OK)
        status = stop_option_set(&stop, &s->setup, &s->stop.dirt, error);
    if (status != GLINT_OK)
        return status;
    glint_dirt_free(before);
    weigh(s);
    if (s->options.balance)
        glint_setup_balance(&s->setup);
    return GLINT_OK;
}

enum glint_status settings_stop(struct settings *settings, double f_number,
                                struct glint_error *error)
{
    settings->options.f_number = f_number;
    return make_setup(settings, error);
}

enum glint_status settings_zoom(struct settings *settings, double zoom,
                                struct glint_error *error)
{
    enum glint_status status;

    if (!settings->model.zoom)
        return glint_error_report(
            error, GLINT_E_ARGUMENT, settings->lens.name,
            settings->options.rays == GLINT_RAYS_EXACT
                ? "exact rays do not zoom from frame to frame"
            : settings->lens.zoom.n_positions
                ? "a table is baked for one position: zoom a model that "
                  "'glint bake LENS --positions N' made"
            : settings->lens.n_surfaces
                ? "does not zoom: its table has one position"
                : "does not zoom: its model is of one position");
    status = model_file_zoom(&settings->model, zoom, error);
    return status == GLINT_OK ? make_setup(settings, error) : status;
}

static int set_up(const struct tool *tool, struct settings *s)
{
    struct glint_error error = {""};
    enum glint_status status = make_setup(s, &error);

    if (status == GLINT_E_ARGUMENT && s->options.f_number > 0)
        return settings_refuse_stop(tool, s, error.text);
    if (status == GLINT_OK && s->options.ghosts)
        status = ghost_file_read(&s->tints, s->options.ghosts, &s->setup,
                                 s->lens.name, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    if (settings_only_ghost(s) >= s->setup.n_ghosts - s->setup.n_parts)
        return tool_usage(tool, "%s has %d ghosts, there is no %d",
                          s->lens.name, s->setup.n_ghosts - s->setup.n_parts,
                          s->options.ghost);
    return EXIT_OK;
}

int settings_open(const struct tool *tool, struct settings *settings,
                  const char *lens)
{
    int code = EXIT_OK;

    if ((settings->dials.flags & GLINT_DIAL_ALWAYS_HALF) &&
        settings->options.rays == GLINT_RAYS_EXACT)
        return tool_usage(tool, "--half is not for exact rays");
    if (settings->options.only == GLINT_ONLY_VEIL &&
        !settings_has_veil(settings))
        code = tool_usage(tool, "--only veil needs a --veil, --haze or "
                                "--front-dust to draw");
    if (code == EXIT_OK)
        code = settings->stop.mask_file
                   ? stop_option_open(tool, &settings->stop)
                   : EXIT_OK;
    if (code == EXIT_OK)
        code = front_option_open(tool, &settings->front);
    if (code != EXIT_OK)
        return code;
    if (settings->options.projection == GLINT_PROJECTION_LENS &&
        tool_is_model(lens))
        return tool_usage(tool, "--projection lens needs a lens table: a "
                                "baked model has no chief rays");
    settings_choose_waves(settings);
    code = tool_is_model(lens) ? open_model(tool, settings, lens)
                               : settings_open_table(tool, settings, lens);

    if (code == EXIT_OK && settings->model.data &&
        settings->waves == GLINT_WAVES_LIST)
        code = check_band(tool, settings);
    return code == EXIT_OK ? set_up(tool, settings) : code;
}

void settings_close(struct settings *settings)
{
    model_file_close(&settings->model);
    free(settings->tints);
    settings->tints = NULL;
    stop_option_close(&settings->stop);
    front_option_close(&settings->front);
}

struct glint_view settings_view(const struct settings *settings, int width,
                                int height)
{
    const double *mm = settings->sensor_mm;

    struct glint_view view = glint_view_fit(
        width, height, mm[0] > 0 ? mm[0] : settings->lens.film_width_mm,
        mm[0] > 0 ? mm[1] : settings->lens.film_height_mm);

    view.projection = settings->projection;
    return view;
}

void settings_engine(const struct tool *tool, const struct settings *settings,
                     int width, int height, struct glint_engine_config *cfg)
{
    glint_engine_defaults(cfg, width, height);
    glint_engine_configure(cfg, &settings->options);
    cfg->model = settings->model.data ? &settings->model.lens : NULL;
    cfg->workers = tool->workers;
    cfg->sets = tool_sets(tool);
    cfg->clock = tool_seconds;
    cfg->camera.setup = &settings->setup;
    cfg->camera.rays = settings_table_rays();
    cfg->camera.tints = settings->tints;
    cfg->camera.front = settings->front.dirt;
    cfg->camera.projection = &settings->projection;
    if (cfg->camera.sensor_width_mm > 0)
        return;
    cfg->camera.sensor_width_mm = settings->lens.film_width_mm;
    cfg->camera.sensor_height_mm = settings->lens.film_height_mm;
}

bool settings_has_veil(const struct settings *settings)
{
    return settings->options.veil > 0 || settings->options.haze > 0 ||
           front_option_asked(&settings->front);
}

int settings_only_ghost(const struct settings *settings)
{
    return GLINT_OPTION_GIVEN(&settings->options, ghost)
               ? settings->options.ghost
               : -1;
}

double settings_scale(const struct settings *settings)
{
    return settings->options.gain * exp2(settings->options.exposure);
}

void settings_json(struct json_writer *json,
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

void settings_lights_text(const struct glint_engine_report *r, char text[64])
{
    if (r->drawn_lights < r->lights - r->beyond_lights)
        snprintf(text, 64, "%d lights, %d after merging", r->lights,
                 r->drawn_lights);
    else
        snprintf(text, 64, "%d lights", r->lights);
}

void settings_warn_lights(const struct tool *tool,
                          const struct glint_engine_report *r)
{
    if (r->tight)
        fprintf(stderr,
                "glint %s: the frame could take more memory than it may, by an "
                "estimate that does not depend on --threads; it is drawn "
                "coarser (a larger --memory, up to 1024 MiB, allows more)\n",
                tool->name);
    else if (r->coarsened)
        fprintf(stderr,
                "glint %s: the frame would have taken more work than --work "
                "allows; it is drawn coarser\n",
                tool->name);
    if (!tool->quiet && r->blurred)
        fprintf(stderr,
                "glint %s: dust and masks of the stop are drawn blurred, as %s "
                "allows no more\n",
                tool->name, r->quality >= 0 ? "--budget" : "--work");
    if (!tool->quiet && r->unveiled)
        fprintf(stderr, "glint %s: --budget has no time for the veil\n",
                tool->name);
    if (!tool->quiet && r->beyond_lights > 0)
        fprintf(stderr,
                "glint %s: %d of %d lights lie beyond the angle that the model "
                "was baked for; they give nothing (bake --max-angle)\n",
                tool->name, r->beyond_lights, r->lights);
    if (!tool->quiet && r->drawn_lights < r->apart_lights)
        fprintf(stderr,
                "glint %s: %d distinct lights were merged into "
                "%d, the faint ones first (--max-lights)\n",
                tool->name, r->apart_lights, r->drawn_lights);
    if (r->stats.dropped_bundles > 0)
        fprintf(stderr,
                "glint %s: there was no room for %d bundles of rays, which are "
                "missing: a larger --memory, fewer lights or a smaller --grid "
                "would fit\n",
                tool->name, r->stats.dropped_bundles);
    if (tool->verbose && r->stats.dropped_cells > 0)
        fprintf(stderr,
                "glint %s: %d cells of rays give no light: a corner of each "
                "lies too far outside to be drawn\n",
                tool->name, r->stats.dropped_cells);
}
