/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "desk/styles.h"
#include "options/command_line.h"
#include "overlay/compositor.h"

/* Adds the lamp TEXT, which is valid, of --light. Returns false if it is one
 * too many. */
static bool add_light(struct compositor *compositor, const char *text)
{
    struct glint_lamp *const lamp = &compositor->hand[compositor->n_hand];

    if (compositor->n_hand == SETTINGS_MAX_LAMPS)
        return false;
    glint_option_light(text, lamp);
    compositor->settings.max_deg =
        fmax(compositor->settings.max_deg, lamp->theta_deg);
    compositor->n_hand++;
    return true;
}

bool compositor_add_light(struct compositor *compositor, double x, double y,
                          double ev)
{
    const struct lamp_row row = {.frame = -1,
                                 .x = x,
                                 .y = y,
                                 .power = exp2(ev),
                                 .rgb = {1, 1, 1},
                                 .shape = 1,
                                 .level = 1,
                                 .next = -1};

    return compositor->at.n < SETTINGS_MAX_LAMPS &&
           lamp_list_add(&compositor->at, &row) == GLINT_OK;
}

/* The same of --light-at. */
static bool add_light_at(struct compositor *compositor, const char *text)
{
    double v[3];

    glint_option_light_at(text, v);
    return compositor_add_light(compositor, v[0], v[1], v[2]);
}

static bool is_text(const char *text, const char *word)
{
    return text && strcmp(text, word) == 0;
}

/* Sets what follows from the options. */
static void resolve(struct compositor *c)
{
    struct glint_options *const o = &c->settings.options;

    if (is_text(o->lights, "auto"))
        o->lights = NULL;
    if (o->memory)
        c->reserve_bytes = (size_t)o->memory << 20;
    c->occlusion.file = o->mask;
    c->occlusion.fade_px = o->edge_fade;
    c->scene.file = o->scene;
    c->scene.pose_file = o->pose;
    c->scene.control_file = o->control;
    scene_dials_choose(&c->scene.asked, o);
}

void compositor_defaults(struct compositor *compositor)
{
    *compositor = (struct compositor){.white = 1};
    settings_defaults_photo(&compositor->settings);
    resolve(compositor);
}

int compositor_style(const struct tool *tool, struct compositor *compositor,
                     const char *name)
{
    const struct style *const style = style_of(name);
    int code = -1;

    if (!style)
        return tool_refuse(tool, "style", name);
    for (int i = 0; style->set[i].option && code == -1; i++)
        code = compositor_set_text(tool, compositor, style->set[i].option,
                                   style->set[i].value);
    compositor_options_end(compositor);
    /* A model has its own, and is no mistake with a style. */
    compositor->settings.coating.given = false;
    compositor->style = style->name;
    return code;
}

int compositor_style_of(const struct tool *tool, struct compositor *compositor,
                        int argc, char **argv, const char *shorts,
                        const struct option *options)
{
    const char *const name =
        tool_value_of(argc, argv, shorts, options, ENGINE_OPTION_OF(style));

    return name ? compositor_style(tool, compositor, name) : -1;
}

/* Notes OPTION if it is --strength or --exposure. Returns false if the other of
 * the two was given before in the same place. */
static bool note_brightness(struct compositor *compositor, int option)
{
    if (option != ENGINE_OPTION_OF(strength) &&
        option != ENGINE_OPTION_OF(exposure))
        return true;
    if (compositor->dial && compositor->dial != option)
        return false;
    compositor->dial = option;
    return true;
}

void compositor_options_end(struct compositor *compositor)
{
    compositor->dial = 0;
}

int compositor_option(const struct tool *tool, struct compositor *compositor,
                      int option, const char *value)
{
    bool is_room = true;
    int code;

    if (!note_brightness(compositor, option))
        return tool_usage(tool, "--strength chooses the exposure; "
                                "give one of it and --exposure");
    if (option == ENGINE_OPTION_OF(style))
        /* The command line's style was set before its other options. */
        return tool->where ? compositor_style(tool, compositor, value) : -1;
    code = settings_option(tool, &compositor->settings, option, value);
    if (code != -1)
        return code;
    resolve(compositor);
    if (option == ENGINE_OPTION_OF(show)) {
        compositor->show_lights |= is_text(value, "lights");
        compositor->scene.has_time_line |= is_text(value, "timeline");
    }
    if (option == ENGINE_OPTION_OF(light))
        is_room = add_light(compositor, value);
    if (option == ENGINE_OPTION_OF(light_at))
        is_room = add_light_at(compositor, value);
    return is_room
               ? -1
               : tool_usage(tool, "more than %d lights", SETTINGS_MAX_LAMPS);
}

int compositor_set_text(const struct tool *tool, struct compositor *compositor,
                        const char *name, const char *text)
{
    const struct glint_option *const row = glint_option_named(name);

    return compositor_option(
        tool, compositor, ENGINE_OPTION + (int)(row - glint_option(0)), text);
}

int compositor_set_number(const struct tool *tool,
                          struct compositor *compositor, const char *name,
                          double value)
{
    char text[32];

    if (!settings_set_number(&compositor->settings, name, value)) {
        snprintf(text, sizeof text, "%g", value);
        return tool_refuse(tool, name, text);
    }
    resolve(compositor);
    return -1;
}
