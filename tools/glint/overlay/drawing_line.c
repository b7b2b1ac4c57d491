/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "desk/styles.h"
#include "model/model_file.h"
#include "overlay/drawing_line.h"

/* Adds a lamp by the value of --light, TEXT, which must be valid. Returns false
 * if there are too many lamps. */
static bool add_lamp_by_angle(struct drawing_line *line, const char *text)
{
    struct glint_lamp *const lamp = &line->hand[line->n_hand];

    if (line->n_hand == SETTINGS_MAX_LAMPS)
        return false;
    glint_option_light(text, lamp);
    line->settings.max_deg = fmax(line->settings.max_deg, lamp->theta_deg);
    line->n_hand++;
    return true;
}

bool drawing_line_add_light(struct drawing_line *line,
                            const struct glint_light_at *at)
{
    if (line->n_at == SETTINGS_MAX_LAMPS)
        return false;
    line->at[line->n_at++] = *at;
    return true;
}

/* Adds a lamp by the value of --light-at, TEXT, which must be valid. Returns
 * false if there are too many lamps. */
static bool add_lamp_by_pixel(struct drawing_line *line, const char *text)
{
    struct glint_light_at at;

    glint_option_light_at(text, &at);
    return drawing_line_add_light(line, &at);
}

static bool is_text_option(const char *text, const char *word)
{
    return text && strcmp(text, word) == 0;
}

/* Computes the members of LINE that depend on several options. */
static void resolve_derived_members(struct drawing_line *line)
{
    struct glint_options *const o = &line->settings.options;

    if (is_text_option(o->lights, "auto") || is_text_option(o->lights, "none"))
        o->lights = NULL;
    if (o->memory)
        line->reserve_bytes = (size_t)o->memory << 20;
    scene_dials_set_defaults(&line->scene_dials, o);
}

void drawing_line_set_defaults(struct drawing_line *line)
{
    *line = (struct drawing_line){.n_hand = 0};
    settings_set_photo_defaults(&line->settings);
    resolve_derived_members(line);
}

int drawing_line_apply_style(const struct tool *tool, struct drawing_line *line,
                             const char *name)
{
    const struct style *const style = find_style_by_name(name);
    int code = -1;

    if (!style)
        return tool_report_bad_value(tool, "style", name);
    for (int i = 0; style->set[i].option && code == -1; i++)
        code = drawing_line_set_text(tool, line, style->set[i].option,
                                     style->set[i].value);
    drawing_line_end_file(line);
    /* A style may set coatings. Unlike --coating, this must not be an error if
     * the lens is a model, whose coatings are fixed. */
    line->settings.coating.given = false;
    line->style = style->name;
    return code;
}

int drawing_line_apply_command_style(const struct tool *tool,
                                     struct drawing_line *line, int argc,
                                     char **argv, const char *shorts,
                                     const struct option *options)
{
    const char *const name = tool_find_option_value(argc, argv, shorts, options,
                                                    ENGINE_OPTION_OF(style));

    return name ? drawing_line_apply_style(tool, line, name) : -1;
}

/* Records OPTION if it is --strength or --exposure, which exclude each other.
 * Returns false if the other one was set before, in the same file or on the
 * command line. */
static bool record_brightness_option(struct drawing_line *line, int option)
{
    if (option != ENGINE_OPTION_OF(strength) &&
        option != ENGINE_OPTION_OF(exposure))
        return true;
    if (line->dial && line->dial != option)
        return false;
    line->dial = option;
    return true;
}

/* Max focal lengths, mm for 35 mm film, for the short and middle position of
 * the default lens: geometric means of those of the positions, 57.2, 93.0 and
 * 143.1 mm */
static const double max_short_mm = 72.9, max_mid_mm = 115.4;
/* Larger f-numbers in a file are errors. */
static const double max_photo_f_number = 100;

void drawing_line_follow_photo(struct drawing_line *line, double f_number,
                               double focal_mm)
{
    struct settings *const s = &line->settings;

    if (s->unbaked != SETTINGS_TRACE && s->options.rays != GLINT_RAYS_EXACT)
        return;
    if (line->style || tool_is_model(s->options.lens))
        return;
    s->photo_f_number = f_number < max_photo_f_number ? f_number : 0;
    if (GLINT_OPTION_GIVEN(&s->options, lens) || !(focal_mm > 0))
        return;
    line->photo_focal_mm = focal_mm;
    s->options.lens = focal_mm <= max_short_mm ? "nikon-zoom-short"
                      : focal_mm <= max_mid_mm ? "nikon-zoom-mid"
                                               : "nikon-zoom-long";
}

void drawing_line_end_file(struct drawing_line *line)
{
    line->dial = 0;
}

int drawing_line_set_option(const struct tool *tool, struct drawing_line *line,
                            int option, const char *value)
{
    bool is_room = true;
    int code;

    if (!record_brightness_option(line, option))
        return tool_usage(
            tool, "--strength sets the exposure, so it excludes --exposure");
    if (option == ENGINE_OPTION_OF(style))
        /* A style in a file is applied here. The style of the command line was
         * applied before its other options. */
        return tool->where ? drawing_line_apply_style(tool, line, value) : -1;
    code = settings_apply_option(tool, &line->settings, option, value);
    if (code != -1)
        return code;
    if (option == ENGINE_OPTION_OF(lights))
        line->is_unsearched = is_text_option(value, "none");
    resolve_derived_members(line);
    if (option == ENGINE_OPTION_OF(show)) {
        line->show_lights |= is_text_option(value, "lights");
        line->show_time_line |= is_text_option(value, "timeline");
    }
    if (option == ENGINE_OPTION_OF(light))
        is_room = add_lamp_by_angle(line, value);
    if (option == ENGINE_OPTION_OF(light_at))
        is_room = add_lamp_by_pixel(line, value);
    return is_room
               ? -1
               : tool_usage(tool, "more than %d lights", SETTINGS_MAX_LAMPS);
}

int drawing_line_set_text(const struct tool *tool, struct drawing_line *line,
                          const char *name, const char *text)
{
    const struct glint_option *const row = glint_option_named(name);

    return drawing_line_set_option(
        tool, line, ENGINE_OPTION + (int)(row - glint_option(0)), text);
}

int drawing_line_set_number(const struct tool *tool, struct drawing_line *line,
                            const char *name, double value)
{
    char text[32];

    if (!settings_set_number(&line->settings, name, value)) {
        snprintf(text, sizeof text, "%g", value);
        return tool_report_bad_value(tool, name, text);
    }
    resolve_derived_members(line);
    return -1;
}
