/* SPDX-License-Identifier: MIT
 *
 * keyboard.h - keys of a terminal as lines of control.
 *
 * The terminal gives keys at once and shows none of them; however the process
 * ends it is as it was. While the process is in the background no key is read.
 */
#ifndef GLINT_TOOLS_CONTROL_KEYBOARD_H
#define GLINT_TOOLS_CONTROL_KEYBOARD_H

#include "control/control.h"

struct keyboard {
    int fd; /* -1: closed */

    /* Private. */
    char bytes[64];
    int at, n;
};

/* What the keys do, lines for people. */
extern const char keyboard_help[];

/* Takes the keys of terminal FD. GLINT_E_IO: it is none. */
enum glint_status keyboard_open(struct keyboard *keys, int fd);

/* Sets LINE to what the next key that was pressed does; returns false if there
 * is none. Other keys are passed over; q asks the process to end. */
bool keyboard_next(struct keyboard *keys, struct control_line *line);

/* Sets LINE to what the first key of TEXT[N] does, and returns how many bytes
 * that has; its verb is CONTROL_NONE if it does nothing. */
int keyboard_take(const char *text, int n, struct control_line *line);

void keyboard_close(struct keyboard *keys);

#endif
