/* SPDX-License-Identifier: MIT
 *
 * apart.h - the files of a command line, of which none that is written may be
 * one that is read, or another that is written.
 *
 *     struct apart files = {.n_read = 0};
 *     apart_line(&files, &drawing.line);      what its options name
 *     apart_read(&files, NULL, "in.png");         the input
 *     apart_write(&files, "-o", "out.png");
 *     code = apart_check(&tool, &files);
 *
 * Patterns of sequences are compared as they are spelled.
 */
#ifndef GLINT_TOOLS_OVERLAY_APART_H
#define GLINT_TOOLS_OVERLAY_APART_H

#include "overlay/drawing_line.h"

enum { APART_FILES = 16 };

struct apart {
    struct apart_file {
        const char *option; /* with dashes; NULL: the input */
        const char *path;
    } read[APART_FILES], written[APART_FILES];
    int n_read, n_written;
};

/* Adds PATH, which OPTION names (NULL: the input), to the files that are read
 * or written, APART_FILES of each at most. Does nothing if it is NULL. */
void apart_read(struct apart *files, const char *option, const char *path);
void apart_write(struct apart *files, const char *option, const char *path);

/* Adds the files that DRAWING's options name. */
void apart_line(struct apart *files, const struct drawing_line *line);

/* Refuses a file that is written over one that is read, which would be lost, or
 * over another that is written. Returns an exit code. */
int apart_check(const struct tool *tool, const struct apart *files);

#endif
