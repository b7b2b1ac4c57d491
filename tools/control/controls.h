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
 */
#ifndef GLINT_TOOLS_CONTROL_CONTROLS_H
#define GLINT_TOOLS_CONTROL_CONTROLS_H

#include "control/control.h"

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
    long n_bad;             /* lines that were passed over */
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

/* Takes the keys of terminal FD. GLINT_E_IO: it is none. */
enum glint_status keyboard_open(struct keyboard *k, int fd);

/* Sets LINE to what the next key that was pressed does; returns false if there
 * is none. Other keys are passed over; q asks the process to end. */
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

/* Notes that the line returned last was not obeyed, as ERROR says. */
void controls_refuse(struct controls *input, const struct glint_error *error);

void controls_close(struct controls *input);

#endif
