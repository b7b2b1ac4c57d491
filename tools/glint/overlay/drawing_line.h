/* SPDX-License-Identifier: MIT
 *
 * The options of a drawing, from a command line, a style or the parameters of a
 * host. No file is opened here. Strings are not copied and must outlive the
 * line.
 *
 *     drawing_line_set_defaults(&line);
 *     drawing_line_set_option(&tool, &line, option, optarg);   each option
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
    /* quality parameters of the scene that options set; the size of the picture
     * and the camera are set later */
    struct scene_dials scene_dials;
    int n_at; /* number of lamps given by --light-at */
    struct glint_light_at at[SETTINGS_MAX_LAMPS];
    int n_hand; /* number of lamps given by --light */
    struct glint_lamp hand[SETTINGS_MAX_LAMPS];
    /* bytes allocated for drawing at the start; 0: as many as needed */
    size_t reserve_bytes;
    bool show_lights, show_time_line;
    /* whether --lights none disables the detection of lamps */
    bool is_unsearched;
    /* whether frames are independent pictures, for which quality has priority
     * over time */
    bool is_still;
    /* whether poses and control lines are read from a FIFO, without waiting for
     * data */
    bool is_live;
    /* focal length of the photograph's camera, mm, by which the default lens
     * was chosen; 0: none */
    double photo_focal_mm;
    /* getopt code of the option that set the brightness, --strength or
     * --exposure; 0: none */
    int dial;
};

void drawing_line_set_defaults(struct drawing_line *line);

/* Sets the engine option with getopt code OPTION to VALUE, which must outlive
 * LINE. Returns -1, or -2 if OPTION is not an engine option, or an exit code
 * after printing the error. */
int drawing_line_set_option(const struct tool *tool, struct drawing_line *line,
                            int option, const char *value);

/* Set the engine option NAME, which must exist, to a text as
 * drawing_line_set_option() does, or to a number as glint_options_set() does.
 * Return -1, or an exit code after printing which values the option accepts. */
int drawing_line_set_text(const struct tool *tool, struct drawing_line *line,
                          const char *name, const char *text);
int drawing_line_set_number(const struct tool *tool, struct drawing_line *line,
                            const char *name, double value);

/* Adds the lamp AT to all frames, like --light-at. Returns false if there are
 * too many lamps. */
bool drawing_line_add_light(struct drawing_line *line,
                            const struct glint_light_at *at);

/* Sets all options of the style NAME. Returns -1 or an exit code. */
int drawing_line_apply_style(const struct tool *tool, struct drawing_line *line,
                             const char *name);

/* Applies the style that a command line names, so that all other options
 * override it, wherever they stand. The arguments are those of
 * tool_find_option_value(). Returns -1 or an exit code. */
int drawing_line_apply_command_style(const struct tool *tool,
                                     struct drawing_line *line, int argc,
                                     char **argv, const char *shorts,
                                     const struct option *options);

/* Sets stop and zoom position of a lens drawn by exact rays to the F_NUMBER and
 * focal length of a photograph's camera, 0: unknown, as far as no option sets
 * them. The position is that of the default lens. */
void drawing_line_follow_photo(struct drawing_line *line, double f_number,
                               double focal_mm);

/* Marks the end of the options of a configuration file. The command line may
 * then set --strength or --exposure again. */
void drawing_line_end_file(struct drawing_line *line);

#endif
