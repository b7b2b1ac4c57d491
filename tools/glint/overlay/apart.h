/* SPDX-License-Identifier: MIT
 *
 * apart.h - checks that no output file of a command line is also an input, or
 * another output.
 *
 *     struct apart files = {.n_read = 0};
 *     file_conflicts_add_drawing_files(&files, &drawing.line);
 *     file_conflicts_add_input(&files, NULL, "in.png");
 *     file_conflicts_add_output(&files, "-o", "out.png");
 *     code = file_conflicts_check_outputs(&tool, &files);
 *
 * Patterns of numbered files are compared as text. */
#ifndef GLINT_TOOLS_OVERLAY_APART_H
#define GLINT_TOOLS_OVERLAY_APART_H

#include "overlay/drawing_line.h"

enum { APART_FILES = 16 };

struct apart {
    struct apart_file {
        /* name of the option with dashes; NULL: PATH is the input */
        const char *option;
        const char *path;
    } read[APART_FILES], written[APART_FILES];
    int n_read, n_written;
};

/* Add PATH, the value of OPTION (NULL: the input), to the list of input or
 * output files, which have at most APART_FILES entries each. Do nothing if PATH
 * is NULL. */
void file_conflicts_add_input(struct apart *files, const char *option,
                              const char *path);
void file_conflicts_add_output(struct apart *files, const char *option,
                               const char *path);

/* Adds all input and output files named by the options of LINE. */
void file_conflicts_add_drawing_files(struct apart *files,
                                      const struct drawing_line *line);

/* Rejects a command line with an output file that is also an input, and would
 * overwrite it, or that is also another output. Returns an exit code. */
int file_conflicts_check_outputs(const struct tool *tool,
                                 const struct apart *files);

#endif
