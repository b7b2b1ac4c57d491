/* SPDX-License-Identifier: MIT
 *
 * What a command line, a style or a host's parameters say of flares to draw.
 * Nothing here is opened: strings are those of the line and must outlive it.
 *
 *     drawing_line_defaults(&line);
 *     drawing_line_option(&tool, &line, option, optarg);   each option
 */
#ifndef GLINT_TOOLS_OVERLAY_DRAWING_LINE_H
#define GLINT_TOOLS_OVERLAY_DRAWING_LINE_H

#include "lamp_files/lamp_list.h"
#include "model/settings.h"
#include "options/command_line.h"
#include "scenes/scene_frame.h"

struct drawing_line {
    struct settings settings;
    const char *style; /* name of the chosen style, or NULL */
    /* Key frames in place of those of a file, whose name --keys is then in
     * messages; NULL: none. */
    const char *keys_text;
    struct scene_dials scene_dials; /* by options; without size and camera */
    struct lamp_list at;            /* lamps given by pixel */
    int n_hand;                     /* lamps given by angle */
    struct glint_lamp hand[SETTINGS_MAX_LAMPS];
    /* Bytes reserved for frames, which take no more; 0: as many as they
     * need. */
    size_t reserve_bytes;
    bool show_lights, show_time_line;
    bool is_unsearched; /* no lamps are found: --lights none */
    bool is_still; /* pictures are independent, and there is time for them */
    bool is_live;  /* does not wait for a FIFO of poses or control */
    int dial;      /* code of the option that set the brightness, --strength or
                      --exposure; 0: none */
};

void drawing_line_defaults(struct drawing_line *line);

/* Sets the engine's option of code OPTION. Returns -1, or -2 if it is none of
 * these, or an exit code after printing what is wrong. VALUE must outlive
 * LINE. */
int drawing_line_option(const struct tool *tool, struct drawing_line *line,
                        int option, const char *value);

/* Set the engine's option NAME, which exists, to a text as
 * drawing_line_option() does, or to a number as glint_options_set() does.
 * Return -1 or an exit code after printing what the option accepts. */
int drawing_line_set_text(const struct tool *tool, struct drawing_line *line,
                          const char *name, const char *text);
int drawing_line_set_number(const struct tool *tool, struct drawing_line *line,
                            const char *name, double value);

/* Adds a lamp at a pixel of all frames, EV stops over white, as --light-at.
 * Returns false without memory, or if it is one too many. */
bool drawing_line_add_light(struct drawing_line *line, double x, double y,
                            double ev);

/* Sets the options of the style NAME. Returns -1 or an exit code. */
int drawing_line_style(const struct tool *tool, struct drawing_line *line,
                       const char *name);

/* Sets the style that a command line has, wherever it stands, so that all other
 * options replace what it sets. The arguments are those of tool_value_of().
 * Returns -1 or an exit code. */
int drawing_line_style_of(const struct tool *tool, struct drawing_line *line,
                          int argc, char **argv, const char *shorts,
                          const struct option *options);

/* Ends the options of a file: those of the command line may choose again
 * between --strength and --exposure. */
void drawing_line_end(struct drawing_line *line);

#endif
