/* SPDX-License-Identifier: MIT
 *
 * Lines of control: those that steer a scene, and those that change the flare.
 */

#include "overlay/over_scene.h"

/* Returns whether LINE can be obeyed, but not whether the flare can have the
 * value. */
static enum glint_status check_line(const struct over_scene *over,
                                    const struct control_line *line,
                                    const char *where,
                                    struct glint_error *error)
{
    if (line->verb == CONTROL_OPTION)
        return over->set_option
                   ? GLINT_OK
                   : control_fail(error, where, 1,
                                  "that changes a flare, and --lens none has "
                                  "none");
    return over->is_open
               ? steer_check(&over->steer, line, where, error)
               : control_fail(error, where, 1,
                              "that steers --scene, and there is none");
}

int over_scene_open_control(struct over_scene *over)
{
    struct glint_error error = {""};
    enum glint_status status;
    const struct control_line *line;

    status = controls_open(&over->control, over->control_file, over->is_live,
                           &error);
    for (int i = 0;
         status == GLINT_OK && (line = controls_row(&over->control, i)); i++) {
        char where[CONTROL_WHERE];

        controls_where(&over->control, i, where);
        status = check_line(over, line, where, &error);
    }
    if (status != GLINT_OK)
        return tool_fail(over->tool, status, error.text);
    if (over->control.is_keys && !over->tool->quiet)
        fprintf(stderr, "%s\n", keyboard_help);
    return EXIT_OK;
}

static enum glint_status obey(struct over_scene *over,
                              const struct control_line *line,
                              struct glint_error *error)
{
    struct glint_error cause = {""};
    char where[CONTROL_WHERE];
    enum glint_status status;

    controls_where(&over->control, -1, where);
    if (line->verb == CONTROL_OPTION && over->set_option) {
        status =
            over->set_option(over->set_ctx, line->name[0], line->v[0], &cause);
        return status == GLINT_OK ? status
                                  : control_fail(error, where, line->column,
                                                 "%.120s", cause.text);
    }
    if (line->verb == CONTROL_OPTION || !over->is_open)
        return line->is_change ? GLINT_OK
                               : check_line(over, line, where, error);
    return playback_take(&over->playback, line)
               ? GLINT_OK
               : steer_take(&over->steer, over->frame.scene, line, where,
                            error);
}

/* A mistake is said, one a picture at most, and ends nothing. */
void over_scene_obey(struct over_scene *over, int frame)
{
    const long before = over->control.n_bad;
    const struct control_line *line;

    if (!over->control.is_open || (over->is_open && !over->is_sized))
        return;
    while ((line = controls_next(&over->control, frame))) {
        struct glint_error error;

        if (obey(over, line, &error) != GLINT_OK)
            controls_refuse(&over->control, &error);
    }
    if (over->control.n_bad > before && !over->tool->quiet)
        fprintf(stderr, "glint %s: %s\n", over->tool->name,
                over->control.bad.text);
}
