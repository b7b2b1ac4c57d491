/* SPDX-License-Identifier: MIT
 *
 * command_line.h - reading a command line: the options that all commands have,
 * help, and what an unknown option may mean. */
#ifndef GLINT_TOOLS_OPTIONS_COMMAND_LINE_H
#define GLINT_TOOLS_OPTIONS_COMMAND_LINE_H

#include <getopt.h>

#include "options/engine_options.h"

/* Codes of options that no letter is for. */
enum { TOOL_HELP_ALL = 900, TOOL_OPTIONS };

/* Options that every command takes, for its struct option array. */
#define TOOL_COMMON_SHORT "hVqvj:"
#define TOOL_COMMON_OPTIONS                                                    \
    {"help", no_argument, NULL, 'h'}, {"version", no_argument, NULL, 'V'},     \
        {"quiet", no_argument, NULL, 'q'},                                     \
        {"verbose", no_argument, NULL, 'v'}, {"json", no_argument, NULL, 'J'}, \
        {"threads", required_argument, NULL, 'j'},                             \
        {"kernels", required_argument, NULL, 'K'},                             \
        {"seed", required_argument, NULL, 'S'},                                \
        {"help-all", no_argument, NULL, TOOL_HELP_ALL},                        \
        {"options", optional_argument, NULL, TOOL_OPTIONS},                    \
    {                                                                          \
        NULL, 0, NULL, 0                                                       \
    }

/* Notes the command line, so that tool_option() can suggest what an unknown
 * option may mean. */
void tool_line(char **argv);

/* Gives TOOL the GROUPS of options, of which DEFAULTS, copied, are the values
 * before any is set. Returns OWN, which a row without a name ends, these
 * options, and the common ones, in one array until the next call. Where a name
 * occurs twice, OWN counts. */
const struct option *engine_getopt(struct tool *tool, unsigned groups,
                                   const struct glint_options *defaults,
                                   const struct option *own);

/* Does as getopt_long(), and notes OPTIONS for --options, by which shells
 * complete. */
int tool_getopt(int argc, char *const *argv, const char *shorts,
                const struct option *options, int *index);

/* Takes a common option. Returns -1 to continue, else the exit code to leave
 * with (EXIT_OK after --help and its like). An unknown option is a usage error.
 */
int tool_option(struct tool *tool, int option, const char *value);

/* Returns the value of the last option in ARGV that getopt_long() would
 * return as OPTION, or NULL. Takes no option: getopt_long() starts afresh
 * afterwards. */
const char *tool_value_of(int argc, char **argv, const char *shorts,
                          const struct option *options, int option);

/* Checks that getopt_long() has left N words of ARGV. Returns -1, or after
 * saying TEXT the code of tool_usage(); of a line with fewer words it states
 * which one the last option took for its value. */
int tool_inputs(const struct tool *tool, int argc, char **argv, int n,
                const char *text);

/* Takes option C of a command whose own CTX is. Returns -1 to continue, -2 if
 * VALUE is refused, or an exit code. */
typedef int tool_take_fn(struct tool *tool, void *ctx, int c,
                         const char *value);

/* Parses the options of a line, SHORTS besides the common ones. Returns -1, or
 * an exit code after printing why. */
int tool_take(struct tool *tool, int argc, char **argv, const char *shorts,
              const struct option *options, tool_take_fn *take, void *ctx);

#endif
