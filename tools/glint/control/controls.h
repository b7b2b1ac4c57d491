/* SPDX-License-Identifier: MIT
 *
 * controls.h - where lines of control come from: a file, a pipe, or the
 * keys of a terminal.
 *
 *     controls_open(&input, path, is_live, &error);
 *     while ((line = controls_next(&input, picture)))    each picture
 *         ...
 *     controls_close(&input);
 *
 * Lines are obeyed in their order; one that begins with a frame waits for the
 * picture of that number, and those behind it with it.
 *
 * The terminal gives keys at once and shows none of them; however the process
 * ends it is as it was. While the process is in the background no key is read.
 *
 * One line changes a running scene:
 *
 *     [FRAME] orbit 30 10
 *     [FRAME] set steel alpha .05 .2
 *     [FRAME] play 25
 *
 * Words, then numbers, divided by blanks; a # begins a comment. Every command
 * that changes a scene is a row of one table, control_forms, which states what
 * it accepts: another command is another row and another case where commands
 * are obeyed. Those that change a flare are the rows of glint/options.inc that
 * take effect with the next frame and have a number: strength 0.4.
 */
#ifndef GLINT_TOOLS_CONTROL_CONTROLS_H
#define GLINT_TOOLS_CONTROL_CONTROLS_H

#include "glint/options.h"
#include "options/timed_text.h"

enum {
    CONTROL_LINE = 256, /* bytes of a line with its end, at most */
    CONTROL_NAME = 32,  /* bytes of a name with its end */
    CONTROL_VALUES = 3,
    CONTROL_MOST_FRAME = TEXT_MAX_FRAME
};

enum control_verb {
    CONTROL_NONE, /* an empty line */
    /* The camera. */
    CONTROL_ORBIT,    /* yaw to the right and pitch up about its middle, deg */
    CONTROL_DISTANCE, /* from that, units */
    CONTROL_SENSOR,   /* into a sensor of the motion, from 1 */
    CONTROL_SCENE,    /* back to where the scene has it */
    CONTROL_WALK,     /* units to the right, up and ahead of it */
    CONTROL_LOOK,     /* yaw to the right, pitch up, roll clockwise, deg */
    /* Materials: name. */
    CONTROL_ALPHA,    /* of brushed metal; one value: both */
    CONTROL_COLOUR,   /* of Phong, or specular of brushed metal */
    CONTROL_DIFFUSE,  /* of brushed metal */
    CONTROL_MATERIAL, /* name of an object, name of its material */
    /* Objects, or kinds of objects of a motion: name. */
    CONTROL_SHOW,
    CONTROL_HIDE,
    CONTROL_SIZE, /* radius of a ball, units */
    /* Environment light. */
    CONTROL_TURN,     /* to the right, degrees */
    CONTROL_SCALE,    /* factor of all its light */
    CONTROL_MAP,      /* another environment of the scene: name */
    CONTROL_NEXT_MAP, /* the one after that */
    /* Time of poses and recorded motions. */
    CONTROL_STEP, /* frames, 1 if not given; may be negative */
    CONTROL_JUMP, /* to a frame */
    CONTROL_PLAY, /* frames a second; none given: one a picture */
    CONTROL_PAUSE,
    CONTROL_STOP, /* pauses at frame 0 */
    /* The flare: name[0] is an option of the engine that changes with the next
     * frame, the value its new one. */
    CONTROL_OPTION,
    CONTROL_VERBS
};

/* Arguments of a command. */
struct control_form {
    enum control_verb verb;
    const char *word;   /* with which it begins */
    const char *clause; /* which follows the names, or NULL */
    int names;          /* 0 .. 2, the same of all forms of a word */
    int behind;         /* names behind the clause, instead */
    int least, most;    /* numbers */
    double lowest, highest;
    bool is_whole; /* numbers are whole ones */
    const char *usage;
};

extern const struct control_form control_forms[];

extern const int control_n_forms;

/* Returns whether OPTION can be changed by lines of control and by key frames.
 */
bool control_changes(const struct glint_option *option);

struct control_line {
    int number; /* of the line in its file, from 1 */
    int frame;  /* -1: none is given */
    enum control_verb verb;
    bool is_change; /* of a key: degrees are added to what there is, other
                       values are factors of it */
    char name[2][CONTROL_NAME];
    int name_column[2], column; /* bytes from 1; of the first value */
    int n;                      /* values */
    double v[CONTROL_VALUES];
};

struct keyboard {
    int fd; /* -1: closed */

    /* Private. */
    char bytes[64];
    int at, n;
};

/* What the keys do, lines for people. */
extern const char keyboard_help[];

enum { CONTROL_WHERE = 200 }; /* bytes of a place with its end */

struct controls {
    long n_bad;             /* lines that were skipped */
    struct glint_error bad; /* the last of them */

    /* Private. */
    bool is_open, is_keys, has_ahead;
    struct text_lines lines;  /* closed at the end of a file */
    struct control_line *row; /* of a file */
    int n, next;
    int read_at; /* picture at which a pipe was read last */
    struct control_line ahead;
    struct keyboard keys;
};

/* Sets LINE to what TEXT says. GLINT_E_FORMAT: ERROR states WHERE:COLUMN:
 * cause, and LINE is to be left alone. */
enum glint_status control_parse(const char *text, const char *where,
                                struct control_line *line,
                                struct glint_error *error);

/* Sets ERROR to WHERE:COLUMN: and a cause as of printf(). Returns
 * GLINT_E_FORMAT. */
enum glint_status control_fail(struct glint_error *error, const char *where,
                               int column, const char *format, ...)
    GLINT_PRINTF(4, 5);

/* Takes the keys of terminal FD. GLINT_E_IO: it is none. */
enum glint_status keyboard_open(struct keyboard *k, int fd);

/* Sets LINE to what the next key that was pressed does; returns false if there
 * is none. Other keys are skipped; q asks the process to end. */
bool keyboard_next(struct keyboard *k, struct control_line *line);

void keyboard_close(struct keyboard *k);

/* Sets LINE to what the first key of TEXT[N] does, and returns how many bytes
 * that has; its verb is CONTROL_NONE if it does nothing. */
int keyboard_take(const char *text, int n, struct control_line *line);

/* Opens PATH, which must outlive INPUT; - is standard input. IS_LIVE: of a FIFO
 * and of standard input lines are taken as they come, and keys if that is a
 * terminal; else all is read at once. GLINT_E_IO; GLINT_E_FORMAT, ERROR then
 * says FILE:LINE:COLUMN: cause; GLINT_E_MEMORY. */
enum glint_status controls_open(struct controls *input, const char *path,
                                bool is_live, struct glint_error *error);

/* Returns the next line that PICTURE, which rises, has or had, or NULL. */
const struct control_line *controls_next(struct controls *input, int picture);

/* Returns line I of a file; NULL: it has no so many. */
const struct control_line *controls_row(const struct controls *input, int i);

/* Writes to WHERE[CONTROL_WHERE] where line I of a file stands, or the line
 * returned last if I is below 0: FILE:LINE. */
void controls_where(const struct controls *input, int i, char *where);

/* Notes that the line returned last was not obeyed, as ERROR states. */
void controls_refuse(struct controls *input, const struct glint_error *error);

void controls_close(struct controls *input);

#endif
