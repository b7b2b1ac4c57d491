/* SPDX-License-Identifier: MIT
 *
 * --zoom and --focus: where a lens table's moving groups are. */
#ifndef GLINT_TOOLS_MODEL_ZOOM_OPTION_H
#define GLINT_TOOLS_MODEL_ZOOM_OPTION_H

#include "options/tool.h"

struct zoom_option {
    double zoom;     /* focal length in mm, or 0 .. 1: position from the table's
                        first to last */
    double focus_m;  /* 0: infinity */
    bool is_zoomed;  /* --zoom was given; else the first position of the
                        table */
    bool is_focused; /* --focus was given */
};

#define ZOOM_OPTIONS(zoom_code, focus_code)            \
    {"zoom", required_argument, NULL, zoom_code},      \
    {                                                  \
        "focus", required_argument, NULL, (focus_code) \
    }

#define ZOOM_HELP                                                            \
    "  --zoom Z            of a zoom lens: its focal length in mm, or how "  \
    "far\n"                                                                  \
    "                      along it is, 0 to 1 (default 0, its table's "     \
    "first)\n"                                                               \
    "  --focus M           metres from the sensor to what is sharp, or inf " \
    "(default)\n"

/* Parse TEXT as the value of --zoom or --focus. Return false if it is
 * malformed. */
bool zoom_option_take(struct zoom_option *option, const char *text);
bool zoom_option_focus(struct zoom_option *option, const char *text);

/* Zooms and focuses LENS, which was just read. Returns an exit code after
 * printing what is wrong. */
int zoom_option_apply(const struct tool *tool, const struct zoom_option *option,
                      struct glint_prescription *lens);

/* Returns EXIT_OK if OPTION has neither --zoom nor --focus; else prints a usage
 * error that names the model PATH and returns its code. */
int zoom_option_of_model(const struct tool *tool,
                         const struct zoom_option *option, const char *path);

#endif
