/* SPDX-License-Identifier: MIT
 *
 * What changes a compositor from frame to frame: key frames, masks, the
 * distance from the picture, and scenes. */
#include "overlay/compositor.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lamp_files/lamp_keys.h"

/* ---------------------------------------------------------------------- keys
 */

/* The quality of a preview: as draft. */
static const double preview_quality = 0.25;

/* Asks for the least f-number of the key frames, if SIGN is 1, which the model
 * has to serve, or for the largest, if it is -1. */
static void ask_stop(struct compositor *c, int sign)
{
    const struct key_value *key = c->keys.key[KEYS_F_NUMBER];

    for (int i = 1; i < c->keys.n[KEYS_F_NUMBER]; i++)
        if (sign * c->keys.key[KEYS_F_NUMBER][i].value < sign * key->value)
            key = &c->keys.key[KEYS_F_NUMBER][i];
    snprintf(c->keys_line, sizeof c->keys_line, "%.200s:%d",
             c->settings.options.keys, key->line);
    c->settings.f_number_from = c->keys_line;
    c->settings.options.f_number = key->value;
}

/* Checks that the lens, which is open, stops down as far as the key frames
 * say. */
static int check_narrowest(const struct tool *tool, struct compositor *c)
{
    struct settings *const s = &c->settings;
    const double widest = s->options.f_number;
    struct glint_error error = {""};
    int code = EXIT_OK;

    if (!keys_has(&c->keys, KEYS_F_NUMBER))
        return EXIT_OK;
    ask_stop(c, -1);
    if (settings_stop(s, s->options.f_number, &error) != GLINT_OK)
        code = settings_refuse_stop(tool, s, error.text);
    else
        settings_stop(s, widest, &error);
    s->f_number_from = NULL;
    return code;
}

/* Lowers the quality of a preview unless one was chosen; the model stays the
 * same. */
static void turn_down(struct settings *s)
{
    struct glint_options *const o = &s->options;
    const double tolerance = s->tolerance;

    if (settings_has_grid(s) || o->budget > 0)
        return;
    settings_set_quality(s, preview_quality);
    GLINT_OPTION_GIVEN(o, quality) = false;
    s->tolerance = tolerance;
    if (!o->area_samples)
        o->area_samples = 1;
}

/* Refuses stops that change where none can. */
static int open_stop_keys(const struct tool *tool, struct compositor *c)
{
    const bool is_stopped = keys_has(&c->keys, KEYS_F_NUMBER);
    const bool is_round = keys_has(&c->keys, KEYS_ROUND);

    if (!is_stopped && !is_round && !keys_has(&c->keys, KEYS_TURN))
        return EXIT_OK;
    if (c->settings.options.rays == GLINT_RAYS_EXACT)
        return tool_usage(tool, "--keys: stops that change need a model, not "
                                "--rays exact");
    if (is_stopped)
        ask_stop(c, 1);
    return EXIT_OK;
}

int compositor_desk_open_keys(const struct tool *tool, struct compositor *c)
{
    struct glint_error error = {""};
    enum glint_status status;

    if (c->settings.options.preview)
        turn_down(&c->settings);
    if (!c->settings.options.keys)
        return EXIT_OK;
    status = c->keys_text
                 ? keys_parse(&c->keys, c->settings.options.keys, c->keys_text,
                              strlen(c->keys_text), &error)
                 : keys_read(&c->keys, c->settings.options.keys, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    if (keys_has(&c->keys, KEYS_EXPOSURE)) {
        if (c->dial == ENGINE_OPTION_OF(strength))
            return tool_usage(tool,
                              "--strength chooses the exposure; "
                              "--keys %s has one",
                              c->settings.options.keys);
        GLINT_OPTION_GIVEN(&c->settings.options, exposure) = true;
    }
    return open_stop_keys(tool, c);
}

/* Adds the lamp of the key frames to the list. */
static enum glint_status add_lamp(struct compositor *c)
{
    const struct lamp_row row = {.frame = -1,
                                 .power = 1,
                                 .rgb = {1, 1, 1},
                                 .shape = 1,
                                 .level = 1,
                                 .next = -1};

    if (!keys_has(&c->keys, KEYS_X) || !keys_has(&c->keys, KEYS_Y))
        return GLINT_OK;
    c->is_listed = true;
    return lamp_list_add(&c->list, &row);
}

static void move_lamp(struct compositor *c)
{
    struct lamp_row *row;

    if (!keys_has(&c->keys, KEYS_X) || !keys_has(&c->keys, KEYS_Y))
        return;
    row = &c->list.row[c->list.n - 1];
    row->x = keys_at(&c->keys, KEYS_X, c->n_frames, 0);
    row->y = keys_at(&c->keys, KEYS_Y, c->n_frames, 0);
    row->power =
        exp2(keys_at(&c->keys, KEYS_EV, c->n_frames, GLINT_LIGHT_AT_EV));
}

/* Stops the lens as the key frames say; the exposure stays that of the widest
 * stop. */
static void turn_stop(struct compositor *c)
{
    struct settings *const s = &c->settings;
    struct stop_option *const stop = &s->stop;
    const int frame = c->n_frames;
    const double f_number =
        keys_at(&c->keys, KEYS_F_NUMBER, frame, s->options.f_number);
    const double turn = keys_at(&c->keys, KEYS_TURN, frame, stop->rotation_deg);
    const double round =
        keys_at(&c->keys, KEYS_ROUND, frame, stop->iris.roundness);
    struct glint_error error;

    if (f_number == s->options.f_number && turn == stop->rotation_deg &&
        round == stop->iris.roundness)
        return;
    stop->rotation_deg = turn;
    stop->iris.roundness = round;
    if (settings_stop(s, f_number, &error) != GLINT_OK)
        return;
    glint_engine_update_stop(c->engine);
}

void compositor_desk_turn(struct compositor *c)
{
    const int frame = c->n_frames;
    struct settings *const s = &c->settings;

    c->scene.set_ctx = c;
    over_scene_obey(&c->scene, frame);
    if (!c->settings.options.keys)
        return;
    s->options.exposure =
        keys_at(&c->keys, KEYS_EXPOSURE, frame, s->options.exposure);
    s->options.gain = keys_at(&c->keys, KEYS_GAIN, frame, s->options.gain);
    s->options.strength =
        keys_at(&c->keys, KEYS_STRENGTH, frame, s->options.strength);
    if (keys_has(&c->keys, KEYS_STARBURST)) {
        GLINT_OPTION_GIVEN(&s->options, starburst) = true;
        s->options.starburst = keys_at(&c->keys, KEYS_STARBURST, frame, 1);
    }
    compositor_zoom_turn(c);
    turn_stop(c);
    move_lamp(c);
}

/* ----------------------------------------------------------------- occlusion
 */

int compositor_desk_open(const struct tool *tool, struct compositor *c)
{
    struct glint_error error = {""};
    enum glint_status status = occlusion_open(&c->occlusion, &error);
    int code;

    if (status == GLINT_OK)
        status = add_lamp(c);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    code = compositor_zoom_open(tool, c);
    return code == EXIT_OK ? check_narrowest(tool, c) : code;
}

void compositor_desk_hide(struct compositor *c, int n)
{
    occlusion_apply(&c->occlusion, c->n_frames, &c->view,
                    c->settings.setup.optics.focal_mm, c->lamp, n);
}

void compositor_desk_close(struct compositor *c)
{
    keys_free(&c->keys);
    occlusion_close(&c->occlusion);
}

/* --------------------------------------------------------------------- scene
 */

/* Share of a budget that the flare has at least. */
#define LEAST_SHARE 0.1

/* Points of a light's disc that shadows are drawn by, where there is time. */
enum { STILL_POINTS = 16, VIDEO_POINTS = 4 };

int compositor_scene_size(struct compositor *c, int width, int height)
{
    struct scene_dials dials = c->scene.asked;

    if (GLINT_OPTION_GIVEN(&c->settings.options, quality) ||
        c->settings.options.preview)
        scene_dials_be(&dials, GLINT_OPTION_GIVEN(&c->settings.options, quality)
                                   ? c->settings.options.quality
                                   : preview_quality);
    dials.width = width;
    dials.height = height;
    if (c->has_lens)
        dials.focal_px = 1 / glint_view_pixel_tangent(
                                 &c->view, c->settings.setup.optics.focal_mm);
    if (!dials.shadow_points)
        dials.shadow_points = c->is_still ? STILL_POINTS : VIDEO_POINTS;
    dials.tile_log2 = 3 + c->settings.options.tile;
    dials.dither = c->settings.options.dither;
    return over_scene_size(&c->scene, &dials);
}

enum glint_status compositor_scene(struct compositor *c,
                                   const struct glint_image *image)
{
    const double focal_mm = c->settings.setup.optics.focal_mm;
    const double budget_ms = c->settings.options.budget;
    const int n = c->n_lamps;
    enum glint_status status;

    c->n_own = n;
    if (!c->scene.is_open)
        return GLINT_OK;
    if (budget_ms > 0)
        c->scene.budget_ms =
            c->has_lens
                ? scene_budget_limit(budget_ms, c->flare_ms, c->report.quality)
                : budget_ms;
    status = over_scene_draw(&c->scene, image, c->n_frames);
    /* The flare has what the scene leaves. */
    if (budget_ms > 0 && c->has_lens)
        glint_engine_set_budget(
            c->engine,
            budget_ms * fmax(LEAST_SHARE, 1 - c->scene.ms / budget_ms));
    if (status != GLINT_OK || !c->has_lens)
        return status;
    c->n_lamps = glint_engine_add_scene(c->engine, c->scene.frame.scene,
                                        c->lamp, n, &c->scene.lamps_hidden);
    c->scene.lights = c->n_lamps - n;
    c->n_lamps +=
        over_scene_glints(&c->scene, &c->view, focal_mm, c->lamp + c->n_lamps);
    glint_engine_apply_shares(c->lamp, c->n_lamps, c->is_still);
    return GLINT_OK;
}
