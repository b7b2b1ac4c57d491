/* SPDX-License-Identifier: MIT
 *
 * takes.h - the values that each option takes, in words, for error messages.
 *
 * One table for all commands, in takes.c: a new option with a value gets a line
 * there, or tests/cli/doors says that it has none.
 */
#ifndef GLINT_TOOLS_OPTIONS_TAKES_H
#define GLINT_TOOLS_OPTIONS_TAKES_H

#include "options/tool.h"

/* Returns in words what OPTION, without dashes, of COMMAND takes, or NULL. */
const char *takes_of(const char *command, const char *option);

/* Prints that OPTION does not take VALUE, and what it takes. Returns the code
 * of tool_usage(). */
int tool_refuse(const struct tool *tool, const char *option, const char *value);

#endif
