/* SPDX-License-Identifier: MIT
 *
 * takes.h - taking options of a line, and refusing their values.
 */
#ifndef GLINT_TOOLS_OPTIONS_TAKES_H
#define GLINT_TOOLS_OPTIONS_TAKES_H

#include "options/tool.h"

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
