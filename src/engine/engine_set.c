/* SPDX-License-Identifier: MIT
 *
 * Sets options of an engine by name, between pictures. */
#include <stdio.h>

#include "engine/engine_parts.h"
#include "glint/options.h"

/* Applies OPTION, whose value in O is valid, to the following pictures. */
static enum glint_status apply_option(struct glint_engine *engine,
                                      const struct glint_option *option,
                                      const struct glint_options *o,
                                      struct glint_error *error)
{
    struct glint_engine_light light = engine->expose.light;
    struct glint_engine_camera camera = engine->optics.camera;

    switch ((int)(option - glint_option(0))) {
    case GLINT_OPTION_OF_strength:
        light.strength = o->strength;
        light.by_hand = 0;
        break;
    case GLINT_OPTION_OF_exposure:
        light.exposure_ev = o->exposure;
        light.by_hand = 1;
        break;
    case GLINT_OPTION_OF_gain:
        light.gain = o->gain;
        break;
    case GLINT_OPTION_OF_starburst:
        light.starburst = o->starburst;
        break;
    case GLINT_OPTION_OF_f_number:
        return glint_engine_stop(engine, o->f_number, error);
    case GLINT_OPTION_OF_stop:
    case GLINT_OPTION_OF_dust:
        glint_engine_configure_stop(&camera, o);
        return glint_engine_change_stop(engine, &camera, false, error);
    default:
        snprintf(error->text, sizeof error->text,
                 "%s can be set only when the engine is created", option->name);
        return GLINT_E_ARGUMENT;
    }
    glint_engine_set_light(engine, &light);
    return GLINT_OK;
}

/* Sets option NAME to the value of TEXT, or to VALUE if TEXT is NULL. */
static enum glint_status set_engine_option(struct glint_engine *engine,
                                           const char *name, const char *text,
                                           double value,
                                           struct glint_error *error)
{
    const struct glint_option *const option = glint_option_named(name);
    struct glint_options o;
    enum glint_status status;
    char accepts[160];

    glint_options_defaults(&o);
    status = text ? glint_options_set_text(&o, name, text, error)
                  : glint_options_set(&o, name, value, error);
    if (status == GLINT_OK)
        return apply_option(engine, option, &o, error);
    if (option && status == GLINT_E_ARGUMENT) {
        glint_option_accepts(option, accepts, sizeof accepts);
        snprintf(error->text, sizeof error->text, "%s accepts: %s", name,
                 accepts);
    }
    return status;
}

enum glint_status glint_engine_set(struct glint_engine *engine,
                                   const char *name, double value,
                                   struct glint_error *error)
{
    return set_engine_option(engine, name, NULL, value, error);
}

enum glint_status glint_engine_set_text(struct glint_engine *engine,
                                        const char *name, const char *text,
                                        struct glint_error *error)
{
    return set_engine_option(engine, name, text ? text : "", 0, error);
}
