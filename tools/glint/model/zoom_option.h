/* SPDX-License-Identifier: MIT
 *
 * --zoom and --focus: positions of the moving groups of a lens table.
 */
#ifndef GLINT_TOOLS_MODEL_ZOOM_OPTION_H
#define GLINT_TOOLS_MODEL_ZOOM_OPTION_H

#include "options/tool.h"

struct zoom_option {
    /* focal length, mm, or 0 .. 1 from the first position to the last */
    double zoom;
    double focus_m; /* focus distance from the sensor, m; 0: infinity */
    /* whether --zoom was given; if not, the first position is used */
    bool is_zoomed;
    bool is_focused; /* whether --focus was given */
};

#define ZOOM_OPTIONS(zoom_code, focus_code)            \
    {"zoom", required_argument, NULL, zoom_code},      \
    {                                                  \
        "focus", required_argument, NULL, (focus_code) \
    }

#define ZOOM_HELP                                                              \
    "  --zoom Z            position of a zoom lens: focal length in mm, or 0 " \
    "to 1 of\n"                                                                \
    "                      the zoom range (default 0, the table's first "      \
    "column)\n"                                                                \
    "  --focus M           focus distance from the sensor in m, or inf "       \
    "(default)\n"

/* Parse TEXT as the value of --zoom or --focus. Return false if it is
 * malformed. */
bool zoom_option_parse(struct zoom_option *option, const char *text);
bool zoom_option_parse_focus(struct zoom_option *option, const char *text);

/* Moves the groups of LENS, which must be as read from its table, to zoom and
 * focus of OPTION. Returns an exit code, after printing the reason on
 * failure. */
int zoom_option_apply(const struct tool *tool, const struct zoom_option *option,
                      struct glint_prescription *lens);

/* Rejects --zoom and --focus for the model PATH: prints a usage error and
 * returns its exit code. Returns EXIT_OK if OPTION has neither. */
int zoom_option_reject_for_model(const struct tool *tool,
                                 const struct zoom_option *option,
                                 const char *path);

#endif
