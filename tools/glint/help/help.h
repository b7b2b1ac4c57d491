/* SPDX-License-Identifier: MIT
 *
 * help.h - prints the help of a command, complete or shortened to a screen, and
 * its options as lines for shells and manual pages. */
#ifndef GLINT_TOOLS_HELP_HELP_H
#define GLINT_TOOLS_HELP_HELP_H

#include <getopt.h>
#include <stdbool.h>

enum {
    HELP_SCREEN = 42, /* max lines of a help text; a longer one is shortened */
    HELP_PARTS = 3
};

/* Help text of COMMAND: the strings of PART, one after another. NULL parts are
 * skipped. */
struct help {
    const char *command;
    const char *part[HELP_PARTS];
};

/* Print HELP. help_print_complete() prints the whole text. help_print_screen()
 * prints only the synopsis and the most common options if the whole text has
 * more than HELP_SCREEN lines. */
void help_print_complete(const struct help *help);
void help_print_screen(const struct help *help);

/* Prints a line for each of OPTIONS, an array for getopt_long(): the name, "="
 * if the option has a value, a tab, and the first line of the option's
 * description in HELP. */
void help_print_options(const struct help *help, const struct option *options);

#endif
