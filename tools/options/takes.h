/* SPDX-License-Identifier: MIT
 *
 * takes.h - what each option takes, for those who gave it something else.
 *
 * One table for all commands, in takes.c: a new option with a value gets a line
 * there, or tests/cli/doors says that it has none.
 */
#ifndef GLINT_TOOLS_OPTIONS_TAKES_H
#define GLINT_TOOLS_OPTIONS_TAKES_H

#include "options/tool.h"

/* Returns in words what OPTION, without dashes, of COMMAND takes, or NULL. */
const char *takes_of(const char *command, const char *option);

/* Says that VALUE is not something OPTION takes, and what is. Returns the code
 * of tool_usage(). */
int tool_refuse(const struct tool *tool, const char *option, const char *value);

#endif
