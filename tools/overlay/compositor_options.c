/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "desk/styles.h"
#include "engine/frame/area.h"
#include "options/takes.h"
#include "overlay/compositor.h"

/* Curvature of the blades, unless a shape is said: spikes of straight ones are
 * thinner and longer than those of lamps in photographs. */
static const double photo_roundness = 0.2;

void compositor_defaults(struct compositor *compositor)
{
    *compositor = (struct compositor){.lens = "nikon-zoom-short",
                                      .headroom_ev = -1,
                                      .threshold_ev = {-0.1, -0.15},
                                      .white = 1};
    settings_defaults(&compositor->settings);
    compositor->settings.starburst = 1;
    compositor->settings.stop.iris.roundness = photo_roundness;
    compositor->settings.coating.kind = COATING_MIXED;
    compositor->settings.waves = SETTINGS_WAVES_AUTO;
    glint_strength_defaults(&compositor->strength);
}

/* Stops by which a lamp's region extends below its threshold, by default. */
#define EXTENDS_EV 0.05

static bool take_threshold(const char *text, double threshold_ev[2])
{
    double v[2];
    const int n = tool_numbers(text, v, 2);

    if (n == 1)
        v[1] = fmax(v[0] - EXTENDS_EV, -20);
    if (n == 0 || !(v[0] <= 0) || !(v[1] >= -20 && v[1] <= v[0]))
        return false;
    memcpy(threshold_ev, v, sizeof v);
    return true;
}

static bool take_light(struct compositor *compositor, const char *text)
{
    struct glint_lamp *lamp = &compositor->hand[compositor->n_hand];

    if (compositor->n_hand == SETTINGS_MAX_LAMPS || !settings_lamp(text, lamp))
        return false;
    compositor->settings.max_deg =
        fmax(compositor->settings.max_deg, lamp->theta_deg);
    compositor->n_hand++;
    return true;
}

/* Adds the lamp TEXT, "X,Y[,EV]". Returns false if it is malformed, out of
 * range, or one too many. */
static bool take_light_at(struct compositor *compositor, const char *text)
{
    double v[3] = {0, 0, COMPOSITOR_LIGHT_EV};
    const int n = tool_numbers(text, v, 3);
    const struct lamp_row row = {.frame = -1,
                                 .x = v[0],
                                 .y = v[1],
                                 .power = exp2(v[2]),
                                 .rgb = {1, 1, 1},
                                 .shape = 1,
                                 .level = 1,
                                 .next = -1};

    return n >= 2 && fabs(v[0]) <= 1e6 && fabs(v[1]) <= 1e6 && v[2] >= -40 &&
           v[2] <= 90 && compositor->at.n < SETTINGS_MAX_LAMPS &&
           lamp_list_add(&compositor->at, &row) == GLINT_OK;
}

/* Notes the file VALUE of OPTION; returns false if that names no file. */
static bool take_file(struct compositor *compositor, int option,
                      const char *value)
{
    switch (option) {
    case OPT_SAVE_LIGHTS:
        compositor->save_file = value;
        return true;
    case OPT_MASK:
        compositor->occlusion.file = value;
        return true;
    case OPT_KEYS:
        compositor->keys_file = value;
        return true;
    case OPT_SCENE:
        compositor->scene.file = value;
        return true;
    case OPT_POSE:
        compositor->scene.pose_file = value;
        return true;
    case OPT_CONTROL:
        compositor->scene.control_file = value;
        return true;
    default:
        return false;
    }
}

bool compositor_is_dial(int option)
{
    return option >= OPT_EDGE_SAMPLES && option <= OPT_HIGHLIGHTS;
}

static bool take(struct compositor *compositor, int option, const char *value)
{
    static const char *const layers[] = {"composite", "flare", "flare-alpha",
                                         NULL};
    static const char *const shows[] = {"lights", "timeline", NULL};
    int layer;

    if (take_file(compositor, option, value))
        return *value != '\0';
    if (compositor_is_dial(option))
        return scene_dials_choose(
            &compositor->scene.asked,
            (enum scene_choice)(option - OPT_EDGE_SAMPLES), value);
    switch (option) {
    case OPT_LENS:
        compositor->lens = value;
        return true;
    case OPT_LIGHTS:
        compositor->lights_file = strcmp(value, "auto") == 0 ? NULL : value;
        return true;
    case OPT_LIGHT:
        return take_light(compositor, value);
    case OPT_THRESHOLD:
        return take_threshold(value, compositor->threshold_ev);
    case OPT_HEADROOM:
        return tool_number(value, &compositor->headroom_ev) &&
               compositor->headroom_ev >= 0 && compositor->headroom_ev <= 40;
    case OPT_NO_TRACKING:
        return compositor->no_tracking = true;
    case OPT_STILL:
        return tool_number(value, &compositor->settings.dials.still_px) &&
               compositor->settings.dials.still_px >= 0 &&
               compositor->settings.dials.still_px <= 16;
    case OPT_LIGHT_AT:
        return take_light_at(compositor, value);
    case OPT_EDGE_FADE:
        return tool_number(value, &compositor->occlusion.fade_px) &&
               compositor->occlusion.fade_px > 0 &&
               compositor->occlusion.fade_px <= 1e6;
    case OPT_PREVIEW:
        return compositor->preview = true;
    case OPT_INTERPOLATE:
        return compositor->interpolate = true;
    case OPT_SHOW:
        layer = tool_word(value, shows);
        compositor->show_lights |= layer == 0;
        compositor->scene.has_time_line |= layer == 1;
        return layer >= 0;
    case OPT_STRENGTH:
        compositor->settings.has_exposure = false;
        return tool_number(value, &compositor->strength.asked) &&
               compositor->strength.asked >= 0 &&
               compositor->strength.asked <= 100;
    default:
        layer = tool_word(value, layers);
        compositor->flare_only = layer >= 1;
        compositor->flare_alpha = layer == 2;
        return layer >= 0;
    }
}

/* Notes OPTION if it is --strength or --exposure. Returns false if the other of
 * the two was given before. */
static bool take_dial(struct compositor *compositor, int option)
{
    if (option != OPT_STRENGTH && option != OPT_EXPOSURE)
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

static int option_of(const char *name)
{
    static const struct option all[] = {COMPOSITOR_OPTIONS, {NULL, 0, NULL, 0}};
    const struct option *o = all;

    while (o->name && strcmp(o->name, name) != 0)
        o++;
    return o->val;
}

int compositor_style(const struct tool *tool, struct compositor *compositor,
                     const char *name)
{
    const struct style *const style = style_of(name);
    int code = -1;

    if (!style)
        return tool_refuse(tool, "style", name);
    for (int i = 0; style->set[i].option && code == -1; i++)
        code =
            compositor_option(tool, compositor, option_of(style->set[i].option),
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
        tool_value_of(argc, argv, shorts, options, OPT_STYLE);

    return name ? compositor_style(tool, compositor, name) : -1;
}

int compositor_option(const struct tool *tool, struct compositor *compositor,
                      int option, const char *value)
{
    static const struct option names[] = {COMPOSITOR_OPTIONS};
    const int code =
        take_dial(compositor, option)
            ? settings_option(tool, &compositor->settings, option, value)
            : tool_usage(tool, "--strength chooses the exposure; "
                               "give one of it and --exposure");

    if (option == OPT_STYLE)
        /* The command line's style was taken before its other options. */
        return tool->where ? compositor_style(tool, compositor, value) : -1;
    if (code != -2 || option < OPT_LENS || option >= OPT_COMPOSITOR_LAST)
        return code;
    if (take(compositor, option, value))
        return -1;
    return tool_refuse(tool, names[option - OPT_LENS].name, value);
}
