/* SPDX-License-Identifier: MIT
 *
 * controls.h - reads control lines, commands that change a running scene or
 * flare, from a file, a pipe, or the keys of a terminal.
 *
 *     controls_open(&input, path, is_live, &error);
 *     while ((line = controls_next_line(&input, picture)))    each picture
 *         ...
 *     controls_close(&input);
 *
 * Lines are executed in order. A line that begins with a frame number, and all
 * lines after it, wait for that frame.
 *
 * The terminal is set to return keys at once, without echo; its settings are
 * restored however the process ends. No key is read while the process is in the
 * background.
 *
 * Examples of lines:
 *
 *     [FRAME] orbit 30 10
 *     [FRAME] set steel alpha .05 .2
 *     [FRAME] play 25
 *
 * A line has words, then numbers, separated by blanks; # begins a comment.
 * Every command that changes a scene is a row of the table control_forms, which
 * states its arguments: a new command needs a row there and a case in steer.c.
 * Commands that change a flare are the numeric options in glint/options.inc
 * that take effect with the next frame, such as: strength 0.4.
 */
#ifndef GLINT_TOOLS_CONTROL_CONTROLS_H
#define GLINT_TOOLS_CONTROL_CONTROLS_H

#include "glint/options.h"
#include "options/timed_text.h"

enum {
    CONTROL_LINE = 256, /* max bytes of a line with its terminator */
    CONTROL_NAME = 32,  /* max bytes of a name with its terminator */
    CONTROL_VALUES = 3,
    CONTROL_MOST_FRAME = TEXT_MAX_FRAME
};

enum control_verb {
    CONTROL_NONE, /* empty line, no command */
    /* Camera: */
    /* orbits the camera about a point ahead of the camera: yaw to the right,
     * pitch up, degrees */
    CONTROL_ORBIT,
    /* sets the distance from the centre of the orbit, scene units */
    CONTROL_DISTANCE,
    /* moves the camera to sensor K of the recorded motion; K counts from 1 */
    CONTROL_SENSOR,
    CONTROL_SCENE, /* returns the camera to its pose in the scene file */
    CONTROL_WALK,  /* moves the camera right, up and ahead, scene units */
    /* rotates the camera: yaw to the right, pitch up, roll clockwise,
     * degrees */
    CONTROL_LOOK,
    /* Materials, by name: */
    /* sets alpha (roughness) of a brushed metal; 1 value: of both axes */
    CONTROL_ALPHA,
    /* sets the colour of a Phong material, or the specular colour of a brushed
     * metal */
    CONTROL_COLOUR,
    CONTROL_DIFFUSE, /* sets the diffuse colour of a brushed metal */
    /* assigns a material to an object: names of object and material */
    CONTROL_MATERIAL,
    /* Objects, or types of objects of a recorded motion, by name: */
    CONTROL_SHOW,
    CONTROL_HIDE,
    CONTROL_SIZE, /* sets the radius of a ball, scene units */
    /* Environment light: */
    /* sets the rotation of the environment to the right, degrees */
    CONTROL_TURN,
    CONTROL_SCALE,    /* sets the factor on all light of the environment */
    CONTROL_MAP,      /* selects an environment of the scene by name */
    CONTROL_NEXT_MAP, /* selects the next environment */
    /* Time of pose files and recorded motions: */
    /* moves by N frames, default 1; negative: backwards */
    CONTROL_STEP,
    CONTROL_JUMP, /* moves to a frame */
    /* sets the playback rate, frames per second; without a number each picture
     * shows the next frame */
    CONTROL_PLAY,
    CONTROL_PAUSE,
    CONTROL_STOP, /* jumps to frame 0 and pauses */
    /* Sets an engine option that takes effect with the next frame: NAME[0] is
     * its name, V[0] its value. */
    CONTROL_OPTION,
    CONTROL_VERBS
};

/* Syntax of a command */
struct control_form {
    enum control_verb verb;
    const char *word; /* first word of the line */
    /* keyword after or between the names; NULL: none */
    const char *clause;
    /* number of names, 0 .. 2; equal in all forms with the same WORD */
    int names;
    int behind;      /* number of names after the clause */
    int least, most; /* min and max count of numbers */
    double lowest, highest;
    bool is_whole; /* whether numbers must be integers */
    const char *usage;
};

extern const struct control_form control_forms[];

extern const int control_n_forms;

struct control_line {
    int number; /* line number in the file, from 1 */
    int frame;  /* frame number; -1: not given */
    enum control_verb verb;
    /* true for a key: angles (degrees) are added to the present value, and
     * other numbers multiply the present value */
    bool is_change;
    char name[2][CONTROL_NAME];
    /* columns, in bytes from 1, of the names and of the first number */
    int name_column[2], column;
    int n; /* number of values */
    double v[CONTROL_VALUES];
};

struct keyboard {
    int fd; /* -1: closed */

    /* Private. */
    char bytes[64];
    int at, n;
};

/* Help text of the keys and their commands */
extern const char keyboard_help[];

enum {
    CONTROL_WHERE = 200
}; /* max bytes of a location "FILE:LINE" with its terminator */

struct controls {
    long n_bad;             /* number of lines that were skipped */
    struct glint_error bad; /* error message of the line skipped last */

    /* Private. */
    bool is_open, is_keys, has_ahead;
    /* lines of the pipe or file; closed once a file was read */
    struct text_lines lines;
    struct control_line *row;
    int n, next;
    int read_at; /* number of the picture at which the pipe was read last */
    struct control_line ahead;
    struct keyboard keys;
};

/* Parses TEXT into LINE. On GLINT_E_FORMAT, ERROR is "WHERE:COLUMN: cause", and
 * LINE is undefined. */
enum glint_status control_parse_line(const char *text, const char *where,
                                     struct control_line *line,
                                     struct glint_error *error);

/* Sets ERROR to "WHERE:COLUMN: cause", the cause by printf() format. Returns
 * GLINT_E_FORMAT. */
enum glint_status control_set_line_error(struct glint_error *error,
                                         const char *where, int column,
                                         const char *format, ...)
    GLINT_PRINTF(4, 5);

/* Starts reading keys from the terminal FD. Returns GLINT_E_IO if FD is not a
 * terminal. */
enum glint_status keyboard_open(struct keyboard *k, int fd);

/* Sets LINE to the command of the next key that was pressed. Returns false if
 * there is no key. Keys without a command are skipped; q requests the end of
 * the process. */
bool keyboard_next_command(struct keyboard *k, struct control_line *line);

/* Sets LINE to the command of the first key of TEXT[N], with verb CONTROL_NONE
 * if the key has no command. Returns the bytes of the key. */
int keyboard_parse_key(const char *text, int n, struct control_line *line);

/* Opens PATH, which must outlive INPUT; "-" is standard input. If IS_LIVE, a
 * FIFO and standard input are read line by line as data arrives, and a
 * terminal on standard input is read key by key; else everything is read at
 * once. Errors: GLINT_E_IO, GLINT_E_MEMORY, and GLINT_E_FORMAT with
 * "FILE:LINE:COLUMN: cause" in ERROR. */
enum glint_status controls_open(struct controls *input, const char *path,
                                bool is_live, struct glint_error *error);

/* Returns the next line for PICTURE or an earlier picture, or NULL if there are
 * no more. PICTURE must not decrease from call to call. */
const struct control_line *controls_next_line(struct controls *input,
                                              int picture);

/* Returns line I, from 0, of the lines that INPUT has read, or NULL if there
 * are fewer. */
const struct control_line *controls_get_line(const struct controls *input,
                                             int i);

/* Writes "FILE:LINE" of line I, from 0, of INPUT (I < 0: of the line
 * returned last) to WHERE[CONTROL_WHERE]. */
void controls_format_location(const struct controls *input, int i, char *where);

/* Counts the line returned last as skipped because of ERROR. */
void controls_reject_line(struct controls *input,
                          const struct glint_error *error);

void controls_close(struct controls *input);

#endif
