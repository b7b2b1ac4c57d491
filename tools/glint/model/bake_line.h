/* SPDX-License-Identifier: MIT
 *
 * Parses the command lines "glint bake INPUT -o OUT" of scenes, environments,
 * motions and translucent media: the options and the names of the files.
 *
 *     code = bake_line_parse(&tool, help, argc, argv, options, take, &line,
 *                            "one input");
 *     if (code >= 0 || !tool.written)
 *         return code;
 *     ... bake argv[optind] ...
 *     code = tool_save_file(&tool, tool.written, GLINT_OUTPUT_BINARY, data,
 *                           bytes);
 */
#ifndef GLINT_TOOLS_MODEL_BAKE_LINE_H
#define GLINT_TOOLS_MODEL_BAKE_LINE_H

#include <getopt.h>

#include "model/settings.h"
#include "options/command_line.h"

/* Options of all these commands; each command begins its own option table with
 * them. */
#define BAKE_LINE_OPTIONS                      \
    {                                          \
        "output", required_argument, NULL, 'o' \
    }

/* Applies option NAME, whose code is C, with the value optarg. Returns -1,
 * or an exit code after printing the error. */
typedef int bake_line_fn(struct tool *tool, void *line, int c,
                         const char *name);

/* Parses the command line. Calls TAKE (may be NULL) with each option except -o.
 * Prints TEXT as a usage error unless there is exactly one input. Sets
 * TOOL->written to the output file and checks that it can be created. Returns
 * -1, or an exit code. */
int bake_line_parse(struct tool *tool, const char *help, int argc, char **argv,
                    const struct option *options, bake_line_fn *take,
                    void *line, const char *text);

/* Returns whether a report may be printed to standard output. It may not if the
 * baked file is written there. */
bool bake_line_prints_report(const struct tool *tool);

#endif
