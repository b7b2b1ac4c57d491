/* SPDX-License-Identifier: MIT
 *
 * command_line.h - parses command lines: the options that all commands have,
 * help, and suggestions for unknown options. */
#ifndef GLINT_TOOLS_OPTIONS_COMMAND_LINE_H
#define GLINT_TOOLS_OPTIONS_COMMAND_LINE_H

#include <getopt.h>

#include "options/engine_options.h"

/* getopt codes of options without a letter. */
enum { TOOL_HELP_ALL = 900, TOOL_OPTIONS };

/* Options of every command; each option table ends with them. */
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

/* Stores the command line, in which tool_apply_option() finds an unknown option
 * to suggest a similar one. */
void tool_set_command_line(char **argv);

/* Returns the option table of TOOL, valid until the next call: OWN, which must
 * end with a row without a name, then the engine options of GROUPS, then the
 * common options. An option of OWN hides that of GROUPS with the same name.
 * Stores GROUPS and their DEFAULTS in TOOL. */
const struct option *engine_build_options(struct tool *tool, unsigned groups,
                                          const struct glint_options *defaults,
                                          const struct option *own);

/* Calls getopt_long(). Stores OPTIONS, which the option --options prints for
 * shell completion. */
int tool_getopt(int argc, char *const *argv, const char *shorts,
                const struct option *options, int *index);

/* Applies OPTION, a common option, with VALUE. Returns -1 to continue, else the
 * exit code of the command: EXIT_OK after --help and similar options,
 * EXIT_USAGE for an unknown option. */
int tool_apply_option(struct tool *tool, int option, const char *value);

/* Returns the last value of OPTION in ARGV, or NULL if it is missing. No option
 * is applied, and getopt_long() starts again at the first argument. */
const char *tool_find_option_value(int argc, char **argv, const char *shorts,
                                   const struct option *options, int option);

/* Checks that N arguments of ARGV follow the options. Returns -1, or the code
 * of tool_usage() after printing TEXT. If arguments are missing, the message
 * also states which word the last option consumed as its value. */
int tool_check_inputs(const struct tool *tool, int argc, char **argv, int n,
                      const char *text);

/* Applies option C of a command to its CTX. Returns -1 to continue, -2 if the
 * option does not accept VALUE, or an exit code. */
typedef int tool_take_fn(struct tool *tool, void *ctx, int c,
                         const char *value);

/* Parses the options of a command line. SHORTS are the option letters of the
 * command, without the common ones. Returns -1, or an exit code after printing
 * the reason. */
int tool_parse_options(struct tool *tool, int argc, char **argv,
                       const char *shorts, const struct option *options,
                       tool_take_fn *take, void *ctx);

#endif
