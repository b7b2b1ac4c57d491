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

/* Options of every command, to end its struct option array with. */
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

/* Stores the command line, for suggestions of tool_apply_option() on unknown
 * options. */
void tool_set_command_line(char **argv);

/* Sets the GROUPS of engine options that TOOL accepts, and copies their
 * DEFAULTS. Returns an option array, valid until the next call: OWN, which must
 * end with a row without a name, the options of GROUPS, and the common options.
 * A name in both OWN and GROUPS is that of OWN. */
const struct option *engine_build_options(struct tool *tool, unsigned groups,
                                          const struct glint_options *defaults,
                                          const struct option *own);

/* Calls getopt_long(). Stores OPTIONS for --options, which shell completion
 * uses. */
int tool_getopt(int argc, char *const *argv, const char *shorts,
                const struct option *options, int *index);

/* Applies a common option. Returns -1 to continue, else the exit code to end
 * with (EXIT_OK after --help and similar options). An unknown option is a usage
 * error. */
int tool_apply_option(struct tool *tool, int option, const char *value);

/* Returns the value of the last occurrence of OPTION in ARGV, or NULL. Applies
 * no option, and resets getopt_long() to the first argument. */
const char *tool_find_option_value(int argc, char **argv, const char *shorts,
                                   const struct option *options, int option);

/* Checks that N arguments remain in ARGV after the options. Returns -1, or the
 * code of tool_usage() after printing TEXT; if arguments are missing, the
 * message also names the word that the last option consumed as its value. */
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
