/* SPDX-License-Identifier: MIT
 *
 * help.h - the help of a command, complete or as much as fits on a screen, and
 * its options as lines for shells and manual pages.
 */
#ifndef GLINT_TOOLS_HELP_HELP_H
#define GLINT_TOOLS_HELP_HELP_H

#include <getopt.h>
#include <stdbool.h>

enum {
    HELP_SCREEN = 42, /* lines of a help that is shown whole */
    HELP_PARTS = 3
};

/* The help of COMMAND: strings one after the other; NULL ones are left out. */
struct help {
    const char *command;
    const char *part[HELP_PARTS];
};

/* Print HELP: all of it, or if it is longer than a screen the synopsis and the
 * most common options. */
void help_all(const struct help *help);
void help_screen(const struct help *help);

/* Prints a line for each of OPTIONS, as getopt_long() takes them: its name, "="
 * if it has a value, a tab, and the first line of what HELP says of it. */
void help_options(const struct help *help, const struct option *options);

/* Prints the version and the kernels that this machine runs. */
void help_version(bool is_json);

#endif
