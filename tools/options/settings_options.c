/* SPDX-License-Identifier: MIT */
#include "options/settings.h"

#include <math.h>
#include <string.h>

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

int settings_refuse_stop(const struct tool *tool, const struct settings *s,
                         const char *text)
{
    struct tool there = *tool;

    if (!s->f_number_from)
        return tool_fail(tool, GLINT_E_ARGUMENT, text);
    there.where = s->f_number_from;
    return tool_usage(&there, "%s", text);
}
