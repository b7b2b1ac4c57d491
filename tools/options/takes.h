/* SPDX-License-Identifier: MIT
 *
 * takes.h - taking options of a line, and the values that each takes, in words,
 * for error messages.
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

/* Takes option C of a command whose own CTX is. Returns -1 to go on, -2 if
 * VALUE is refused, or an exit code. */
typedef int tool_take_fn(struct tool *tool, void *ctx, int c,
                         const char *value);

/* Takes the options of a line, SHORTS beside the common ones. Returns -1, or an
 * exit code after printing why. */
int tool_take(struct tool *tool, int argc, char **argv, const char *shorts,
              const struct option *options, tool_take_fn *take, void *ctx);

#endif
