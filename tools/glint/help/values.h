/* SPDX-License-Identifier: MIT
 *
 * values.h - the values that options take, in words, for error messages and for
 * shells, which complete the fixed words among them.
 *
 * One table for all commands, in values.c: a new option with a value gets a
 * line there, or tests/cli/doors states that it has none.
 */
#ifndef GLINT_TOOLS_HELP_VALUES_H
#define GLINT_TOOLS_HELP_VALUES_H

/* Returns in words what OPTION, without dashes, of COMMAND accepts, or NULL;
 * until the next call. Options of the engine are those of glint/options.h. */
const char *values_of(const char *command, const char *option);

/* Prints the fixed words among the values of OPTION, one per line; nothing if
 * OPTION is NULL. */
void values_print_words(const char *command, const char *option);

#endif
