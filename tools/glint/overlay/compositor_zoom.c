/* SPDX-License-Identifier: MIT
 *
 * Changes a compositor's lens and light from frame to frame by lines of
 * control, and zooms it by key frames. */
#include "model/table_file.h"
#include "overlay/compositor.h"

/* Zooms to ZOOM; GLINT_E_ARGUMENT: it stays where it was. */
static enum glint_status zoom_to(struct compositor *c, double zoom,
                                 struct glint_error *error)
{
    struct settings *const s = &c->settings;
    const enum glint_status status = settings_zoom(s, zoom, error);

    if (status != GLINT_OK)
        return status;
    s->zoom.zoom = zoom;
    if (c->engine)
        glint_engine_update_stop(c->engine);
    return GLINT_OK;
}

/* Sets an option by a line of control. */
static enum glint_status set_option(void *ctx, const char *name, double value,
                                    struct glint_error *error)
{
    struct compositor *const c = ctx;
    struct settings *const s = &c->settings;
    const int column = keys_column(name);
    const double before = s->options.f_number;
    struct glint_error unused;
    enum glint_status status;

    if (keys_has(&c->keys, column)) {
        snprintf(error->text, sizeof error->text, "key frames set %s", name);
        return GLINT_E_ARGUMENT;
    }
    if (column == KEYS_ZOOM)
        return zoom_to(c, value, error);
    if (column != KEYS_F_NUMBER)
        return glint_options_set(&s->options, name, value, error);
    if (s->options.rays == GLINT_RAYS_EXACT) {
        snprintf(error->text, sizeof error->text,
                 "a stop that changes needs a model, not --rays exact");
        return GLINT_E_ARGUMENT;
    }
    status = settings_stop(s, value, error);
    if (status != GLINT_OK) {
        settings_stop(s, before, &unused);
        return status;
    }
    if (c->engine)
        glint_engine_update_stop(c->engine);
    return GLINT_OK;
}

/* Says what is wrong with a line of control. Returns an exit code. */
static int bad_line(const struct tool *tool, const char *where, int column,
                    const char *cause)
{
    struct glint_error error = {""};

    control_fail(&error, where, column, "%s", cause);
    return tool_fail(tool, GLINT_E_FORMAT, error.text);
}

/* Checks that the lens can do what the lines of control say, and leaves it
 * where it was. */
static int check_control(const struct tool *tool, struct compositor *c)
{
    struct settings *const s = &c->settings;
    const double zoom = s->zoom.zoom, f_number = s->options.f_number;
    const struct control_line *line;
    struct glint_error error = {""};
    int code = EXIT_OK;

    for (int i = 0;
         code == EXIT_OK && (line = controls_row(&c->scene.control, i)); i++) {
        const int column = line->verb == CONTROL_OPTION
                               ? keys_column(line->name[0])
                               : KEYS_FRAME;
        char where[CONTROL_WHERE];

        if ((column != KEYS_ZOOM && column != KEYS_F_NUMBER) ||
            set_option(c, line->name[0], line->v[0], &error) == GLINT_OK)
            continue;
        controls_where(&c->scene.control, i, where);
        code = bad_line(tool, where, line->column, error.text);
    }
    if (s->model.zoom)
        settings_zoom(s, zoom, &error);
    s->zoom.zoom = zoom;
    if (s->options.f_number != f_number)
        settings_stop(s, f_number, &error);
    return code;
}

/* Says what is wrong with the key frame of LINE, which is none of the user's if
 * glint wrote the text. Returns an exit code. */
static int refuse_key(const struct tool *tool, const struct compositor *c,
                      int line, const char *cause)
{
    return c->keys_text
               ? tool_usage(tool, "%.200s: %s", c->settings.options.keys, cause)
               : tool_usage(tool, "%.200s:%d: %s", c->settings.options.keys,
                            line, cause);
}

/* Checks the same of the key frames, and leaves it at the first of them. */
static int check_keys(const struct tool *tool, struct compositor *c)
{
    struct settings *const s = &c->settings;
    const struct key_value *const key = c->keys.key[KEYS_ZOOM];
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;

    for (int i = c->keys.n[KEYS_ZOOM] - 1; i >= 0 && status == GLINT_OK; i--) {
        status = settings_zoom(s, key[i].value, &error);
        if (status != GLINT_OK)
            return refuse_key(tool, c, key[i].line, error.text);
        s->zoom.zoom = key[i].value;
    }
    return EXIT_OK;
}

int compositor_zoom_lines(const struct tool *tool, const struct compositor *c)
{
    const struct control_line *line;
    char where[CONTROL_WHERE];

    if (tool_is_model(c->settings.options.lens))
        return EXIT_OK;
    for (int i = 0; (line = controls_row(&c->scene.control, i)); i++)
        if (line->verb == CONTROL_OPTION &&
            keys_column(line->name[0]) == KEYS_ZOOM) {
            controls_where(&c->scene.control, i, where);
            return bad_line(tool, where, line->column,
                            "lines of control zoom a model that 'glint bake "
                            "LENS --positions N' made, not a table");
        }
    return EXIT_OK;
}

int compositor_zoom_begin(const struct tool *tool, struct compositor *c)
{
    const bool is_table =
        c->has_lens && !tool_is_model(c->settings.options.lens);
    int code;

    if (c->has_lens)
        c->scene.set_option = set_option;
    if (!keys_has(&c->keys, KEYS_ZOOM) || !is_table)
        return EXIT_OK;
    code = tool_lens(tool, c->settings.options.lens, &c->settings.lens);
    return code == EXIT_OK ? check_keys(tool, c) : code;
}

int compositor_zoom_open(const struct tool *tool, struct compositor *c)
{
    const int code = check_control(tool, c);

    return code == EXIT_OK ? check_keys(tool, c) : code;
}

/* A frame at which the zoom does not go so far stays where the last one was,
 * which the first frames' check rules out. */
void compositor_zoom_turn(struct compositor *c)
{
    const double before = c->settings.zoom.zoom;
    const double zoom = keys_at(&c->keys, KEYS_ZOOM, c->n_frames, before);
    struct glint_error error;

    if (keys_has(&c->keys, KEYS_ZOOM) && zoom != before)
        zoom_to(c, zoom, &error);
}
