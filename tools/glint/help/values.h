/* SPDX-License-Identifier: MIT
 *
 * values.h - describes the values that options accept, for error messages and
 * for completion in shells.
 *
 * One table in values.c serves all commands. A new option with a value needs a
 * row there, or an exception in tests/cli/doors.
 */
#ifndef GLINT_TOOLS_HELP_VALUES_H
#define GLINT_TOOLS_HELP_VALUES_H

/* Returns a description of the values that OPTION (without dashes) of COMMAND
 * accepts, or NULL if the table lacks OPTION. The text is valid until the next
 * call. Engine options are described by glint/options.h. */
const char *values_describe(const char *command, const char *option);

/* Prints the fixed words among the values of OPTION, one per line; nothing if
 * OPTION is NULL. */
void values_print_words(const char *command, const char *option);

#endif
