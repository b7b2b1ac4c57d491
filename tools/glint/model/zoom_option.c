/* SPDX-License-Identifier: MIT */
#include "model/zoom_option.h"

#include <string.h>

/* Max distance of --focus, metres; larger values mean infinity. */
#define FARTHEST_M 1e6

bool zoom_option_parse(struct zoom_option *option, const char *text)
{
    option->is_zoomed = true;
    return tool_parse_number(text, &option->zoom) && option->zoom >= 0;
}

bool zoom_option_parse_focus(struct zoom_option *option, const char *text)
{
    option->is_focused = true;
    option->focus_m = 0;
    if (strcmp(text, "inf") == 0)
        return true;
    return tool_parse_number(text, &option->focus_m) && option->focus_m > 0 &&
           option->focus_m <= FARTHEST_M;
}

int zoom_option_apply(const struct tool *tool, const struct zoom_option *option,
                      struct glint_prescription *lens)
{
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;
    double along = option->zoom;

    if (option->is_zoomed && along > 1)
        status = glint_prescription_zoom_to(lens, option->zoom, &along, &error);
    if (status == GLINT_OK && option->is_zoomed)
        status = glint_prescription_zoom(lens, along, &error);
    if (status == GLINT_OK && option->focus_m > 0)
        status = glint_prescription_focus(lens, option->focus_m, &error);
    return status == GLINT_OK ? EXIT_OK : tool_usage(tool, "%s", error.text);
}

int zoom_option_reject_for_model(const struct tool *tool,
                                 const struct zoom_option *option,
                                 const char *path)
{
    if (!option->is_zoomed && !option->is_focused)
        return EXIT_OK;
    return tool_usage(tool, "%s is a model: its %s was fixed when it was baked",
                      path, option->is_focused ? "focus" : "zoom");
}
