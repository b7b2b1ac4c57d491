/* SPDX-License-Identifier: MIT
 *
 * control.h - one line that changes a running scene.
 *
 *     [FRAME] orbit 30 10
 *     [FRAME] set steel alpha .05 .2
 *     [FRAME] play 25
 *
 * Words, then numbers, divided by blanks; a # begins a comment. Every command
 * is a row of one table, control_forms, which says what it takes: another
 * command is another row and another case where commands are obeyed.
 */
#ifndef GLINT_TOOLS_CONTROL_CONTROL_H
#define GLINT_TOOLS_CONTROL_CONTROL_H

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
    CONTROL_MATERIAL, /* name of a thing, name of its material */
    /* Things, or kinds of things of a motion: name. */
    CONTROL_SHOW,
    CONTROL_HIDE,
    CONTROL_SIZE, /* radius of a ball, units */
    /* Light from all around. */
    CONTROL_TURN,     /* to the right, degrees */
    CONTROL_SCALE,    /* factor of all its light */
    CONTROL_MAP,      /* another environment of the scene: name */
    CONTROL_NEXT_MAP, /* the one after that */
    /* Time of what moves by itself. */
    CONTROL_STEP, /* frames, 1 if not given; may be negative */
    CONTROL_JUMP, /* to a frame */
    CONTROL_PLAY, /* frames a second; none given: one a picture */
    CONTROL_PAUSE,
    CONTROL_STOP, /* pauses at frame 0 */
    /* The lens. */
    CONTROL_ZOOM, /* mm of focal length, or how far along, 0 .. 1 */
    CONTROL_VERBS
};

/* What a command takes. */
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

/* Sets LINE to what TEXT says. GLINT_E_FORMAT: ERROR says WHERE:COLUMN: cause,
 * and LINE is to be left alone. */
enum glint_status control_parse(const char *text, const char *where,
                                struct control_line *line,
                                struct glint_error *error);

/* Sets ERROR to WHERE:COLUMN: and a cause as of printf(). Returns
 * GLINT_E_FORMAT. */
enum glint_status control_fail(struct glint_error *error, const char *where,
                               int column, const char *format, ...)
    GLINT_PRINTF(4, 5);

#endif
