/* SPDX-License-Identifier: MIT */
#include "overlay/drawing_files.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lamp_files/lamp_keys.h"
#include "model/table_file.h"

/* --------------------------------------------------------------- key frames */

/* Sets the f-number of S to the smallest one (SIGN 1) or the largest one (SIGN
 * -1) of the key frames. Stores the location of this key frame for errors. */
static void set_f_number_to_key(struct settings *s, struct drawing_files *f,
                                int sign)
{
    const struct key_value *key = f->keys.key[KEYS_F_NUMBER];

    for (int i = 1; i < f->keys.n[KEYS_F_NUMBER]; i++)
        if (sign * f->keys.key[KEYS_F_NUMBER][i].value < sign * key->value)
            key = &f->keys.key[KEYS_F_NUMBER][i];
    snprintf(f->keys_line, sizeof f->keys_line, "%.200s:%d", s->options.keys,
             key->line);
    s->f_number_from = f->keys_line;
    s->options.f_number = key->value;
}

/* Rejects key frames that change the stop of a lens drawn by exact rays.
 * Otherwise sets the f-number of S, with which the lens is then opened, to the
 * smallest one of the key frames. */
static int check_stop_keys(const struct tool *tool, struct settings *s,
                           struct drawing_files *f)
{
    const bool is_stopped = key_frames_have_column(&f->keys, KEYS_F_NUMBER);
    const bool is_round = key_frames_have_column(&f->keys, KEYS_ROUND);

    if (!is_stopped && !is_round &&
        !key_frames_have_column(&f->keys, KEYS_TURN))
        return EXIT_OK;
    if (s->options.rays == GLINT_RAYS_EXACT)
        return tool_usage(tool, "--keys: changing the stop between frames "
                                "needs a model, not --rays exact");
    if (is_stopped)
        set_f_number_to_key(s, f, 1);
    return EXIT_OK;
}

static int open_key_file(const struct tool *tool, struct drawing_line *line,
                         struct drawing_files *f)
{
    struct glint_options *const o = &line->settings.options;
    struct glint_error error = {""};
    enum glint_status status;

    if (!o->keys)
        return EXIT_OK;
    status = key_frames_read_file(&f->keys, o->keys, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    if (key_frames_have_column(&f->keys, KEYS_EXPOSURE)) {
        if (line->dial == ENGINE_OPTION_OF(strength))
            return tool_usage(tool,
                              "--strength excludes the column exposure of "
                              "--keys %s, since both set the exposure",
                              o->keys);
        GLINT_OPTION_GIVEN(o, exposure) = true;
    }
    return check_stop_keys(tool, &line->settings, f);
}

/* Checks that the open lens supports the largest f-number of the key frames.
 * Returns an exit code. */
static int check_narrowest_stop(const struct tool *tool, struct settings *s,
                                struct drawing_files *f)
{
    const double widest = s->options.f_number;
    struct glint_error error = {""};
    int code = EXIT_OK;

    if (!key_frames_have_column(&f->keys, KEYS_F_NUMBER))
        return EXIT_OK;
    set_f_number_to_key(s, f, -1);
    if (opened_lens_set_stop(&f->lens, s, &error) != GLINT_OK)
        code = settings_report_bad_stop(tool, s, error.text);
    s->options.f_number = widest;
    if (code == EXIT_OK)
        opened_lens_set_stop(&f->lens, s, &error);
    s->f_number_from = NULL;
    return code;
}

/* --------------------------------------------------------------------- zoom */

/* Returns the key frame column of the option that LINE sets, or -1 if LINE sets
 * no option. */
static int find_key_column(const struct control_line *line)
{
    return line->verb == CONTROL_OPTION ? key_frames_find_column(line->name[0])
                                        : -1;
}

/* Prints CAUSE as an error in control line I. Returns an exit code. */
static int report_bad_control_line(const struct tool *tool,
                                   const struct over_scene *scene, int i,
                                   const char *cause)
{
    struct glint_error shown = {""};
    char where[CONTROL_WHERE];

    controls_format_location(&scene->control, i, where);
    control_set_line_error(&shown, where,
                           controls_get_line(&scene->control, i)->column, "%s",
                           cause);
    return tool_fail(tool, GLINT_E_FORMAT, shown.text);
}

/* Checks that the lens supports each zoom and f-number of the control lines, by
 * setting each value, and then restores the lens. Returns an exit code. */
static int check_control_lines(const struct tool *tool, struct settings *s,
                               struct drawing_files *f)
{
    const struct over_scene *const scene = &f->scene;
    const double zoom = s->zoom.zoom, f_number = s->options.f_number;
    const struct control_line *line;
    struct glint_error error = {""};
    int code = EXIT_OK;

    for (int i = 0;
         code == EXIT_OK && (line = controls_get_line(&scene->control, i));
         i++) {
        const int column = find_key_column(line);

        if ((column == KEYS_ZOOM || column == KEYS_F_NUMBER) &&
            scene->set_option(scene->set_ctx, line->name[0], line->v[0],
                              &error) != GLINT_OK)
            code = report_bad_control_line(tool, scene, i, error.text);
    }
    if (f->lens.model.zoom)
        opened_lens_set_zoom(&f->lens, s, zoom, &error);
    s->zoom.zoom = zoom;
    if (s->options.f_number != f_number) {
        s->options.f_number = f_number;
        opened_lens_set_stop(&f->lens, s, &error);
    }
    return code;
}

/* Rejects control lines that zoom a lens table. The check precedes the opening
 * of the lens, which may take a bake. */
static int reject_zoom_control_lines(const struct tool *tool,
                                     const struct settings *s,
                                     const struct over_scene *scene)
{
    const struct control_line *line;

    if (tool_is_model(s->options.lens))
        return EXIT_OK;
    for (int i = 0; (line = controls_get_line(&scene->control, i)); i++)
        if (find_key_column(line) == KEYS_ZOOM)
            return report_bad_control_line(
                tool, scene, i,
                "control lines cannot zoom a lens table; use a model of "
                "'glint bake LENS --positions N'");
    return EXIT_OK;
}

/* Checks that the lens supports all zoom values of the key frames, and sets the
 * lens to the first one. */
static int check_zoom_keys(const struct tool *tool, struct drawing_line *line,
                           struct drawing_files *f)
{
    struct settings *const s = &line->settings;
    const struct key_value *const key = f->keys.key[KEYS_ZOOM];
    struct glint_error error = {""};

    for (int i = f->keys.n[KEYS_ZOOM] - 1; i >= 0; i--) {
        if (opened_lens_set_zoom(&f->lens, s, key[i].value, &error) != GLINT_OK)
            return tool_usage(tool, "%.200s:%d: %s", s->options.keys,
                              key[i].line, error.text);
        s->zoom.zoom = key[i].value;
    }
    return EXIT_OK;
}

/* If the lens is a table, checks that it supports all zoom values of the key
 * frames, before scene and lens are opened. Without a lens, prevents control
 * lines from setting options. */
static int check_table_zoom_keys(const struct tool *tool,
                                 struct drawing_line *line,
                                 struct drawing_files *f)
{
    struct settings *const s = &line->settings;
    int code;

    if (!f->has_lens)
        f->scene.set_option = NULL;
    if (!key_frames_have_column(&f->keys, KEYS_ZOOM) || !f->has_lens ||
        tool_is_model(s->options.lens))
        return EXIT_OK;
    code = tool_read_lens(tool, s->options.lens, &f->lens.table);
    return code == EXIT_OK ? check_zoom_keys(tool, line, f) : code;
}

/* -------------------------------------------------------------------- lamps */

/* Reads the list of lamps and appends the lamps of --light-at, whose positions
 * are set when the picture's size is known. With --interpolate links the rows
 * of each lamp. */
static enum glint_status open_lamp_list(const struct drawing_line *line,
                                        struct drawing_files *f,
                                        struct glint_error *error)
{
    const struct glint_options *const o = &line->settings.options;
    enum glint_status status = GLINT_OK;

    if (o->lights)
        status = lamp_list_read(&f->list, o->lights, error);
    if (status == GLINT_OK && o->interpolate)
        status = lamp_keys_link_rows(&f->list);
    f->first_at = f->list.n;
    for (int i = 0; i < line->n_at && status == GLINT_OK; i++) {
        const struct lamp_row row = {.frame = -1,
                                     .power = exp2(line->at[i].ev),
                                     .rgb = {1, 1, 1},
                                     .shape = 1,
                                     .level = 1,
                                     .next = -1};

        status = lamp_list_add(&f->list, &row);
    }
    f->is_listed = o->lights || line->is_unsearched;
    return status;
}

/* Appends to the list the lamp that the key frames define. */
static enum glint_status add_key_lamp(struct drawing_files *f)
{
    const struct lamp_row row = {.frame = -1,
                                 .power = 1,
                                 .rgb = {1, 1, 1},
                                 .shape = 1,
                                 .level = 1,
                                 .next = -1};

    if (!key_frames_have_column(&f->keys, KEYS_X) ||
        !key_frames_have_column(&f->keys, KEYS_Y))
        return GLINT_OK;
    return lamp_list_add(&f->list, &row);
}

static enum glint_status open_lamp_inputs(const struct drawing_line *line,
                                          struct drawing_files *f,
                                          struct glint_error *error)
{
    const char *const save = line->settings.options.save_lights;
    enum glint_status status = open_lamp_list(line, f, error);

    if (status == GLINT_OK && save)
        status = lamp_save_open(&f->save, save, error);
    if (status == GLINT_OK)
        status = occlusion_open(&f->occlusion, error);
    return status == GLINT_OK ? add_key_lamp(f) : status;
}

/* --------------------------------------------------------------- all files */

/* Opens the scene. With --lens none there must be a scene whose camera needs no
 * lens. Returns an exit code. */
static int open_scene_file(const struct tool *tool,
                           const struct glint_options *o,
                           struct drawing_files *f)
{
    const int code = over_scene_open(&f->scene, tool);

    if (code != EXIT_OK || f->has_lens)
        return code;
    if (!f->scene.is_open)
        return tool_usage(tool, "--lens none draws no flare; without --scene "
                                "there is nothing to draw");
    if (over_scene_needs_lens(&f->scene))
        return tool_usage(tool,
                          "%s: 'camera lens' uses the field of the lens, but "
                          "--lens is none; use 'camera fov'",
                          f->scene.file);
    return o->layer != GLINT_LAYER_COMPOSITE
               ? tool_usage(tool,
                            "--layer needs a lens: --lens none draws no flare")
               : EXIT_OK;
}

static void set_file_names(const struct drawing_line *line,
                           struct drawing_files *f)
{
    const struct glint_options *const o = &line->settings.options;

    f->has_lens = strcmp(o->lens, "none") != 0;
    f->occlusion.file = o->mask;
    f->occlusion.fade_px = o->edge_fade;
    f->scene.file = o->scene;
    f->scene.pose_file = o->pose;
    f->scene.control_file = o->control;
    f->scene.is_live = line->is_live;
}

/* Rejects --light-at X,Y,off if no lamps are searched for, of which it could
 * remove one. */
static int check_removed_lamps(const struct tool *tool,
                               const struct drawing_line *line)
{
    const bool is_listed = line->settings.options.lights || line->is_unsearched;

    for (int i = 0; i < line->n_at && (is_listed || line->n_hand > 0); i++)
        if (isinf(line->at[i].ev))
            return tool_usage(tool,
                              "--light-at X,Y,off removes a lamp found in the "
                              "picture, and %s searches for none",
                              is_listed ? "--lights" : "--light");
    return EXIT_OK;
}

int drawing_files_open(const struct tool *tool, struct drawing_line *line,
                       struct drawing_files *files)
{
    struct settings *const s = &line->settings;
    struct glint_error error = {""};
    enum glint_status status;
    int code;

    set_file_names(line, files);
    code = check_removed_lamps(tool, line);
    if (code == EXIT_OK)
        code = open_key_file(tool, line, files);
    if (code == EXIT_OK)
        code = check_table_zoom_keys(tool, line, files);
    if (code == EXIT_OK)
        code = open_scene_file(tool, &s->options, files);
    if (code == EXIT_OK && files->has_lens)
        code = reject_zoom_control_lines(tool, s, &files->scene);
    if (code == EXIT_OK && files->has_lens)
        code = opened_lens_open(tool, &files->lens, s, s->options.lens);
    if (code != EXIT_OK || !files->has_lens)
        return code;
    status = open_lamp_inputs(line, files, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    code = check_control_lines(tool, s, files);
    if (code == EXIT_OK)
        code = check_zoom_keys(tool, line, files);
    return code == EXIT_OK ? check_narrowest_stop(tool, s, files) : code;
}

void drawing_files_close(struct drawing_files *files)
{
    key_frames_free(&files->keys);
    occlusion_close(&files->occlusion);
    over_scene_close(&files->scene);
    lamp_save_abort(&files->save);
    lamp_list_free(&files->list);
    opened_lens_close(&files->lens);
}
