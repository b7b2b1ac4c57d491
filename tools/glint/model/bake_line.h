/* SPDX-License-Identifier: MIT
 *
 * The commands "glint bake INPUT -o OUT" for files of scenes: their options,
 * and the file that they write.
 *
 *     code = bake_line_begin(&tool, argc, argv, options, take, &line, "one");
 *     if (code >= 0 || !tool.written)
 *         return code;
 *     ... bakes argv[optind] ...
 *     code = tool_save(&tool, tool.written, GLINT_OUTPUT_BINARY, data, bytes);
 */
#ifndef GLINT_TOOLS_MODEL_BAKE_LINE_H
#define GLINT_TOOLS_MODEL_BAKE_LINE_H

#include <getopt.h>

#include "model/settings.h"
#include "options/command_line.h"

/* Options that all of them have, at the begin of OPTIONS. */
#define BAKE_LINE_OPTIONS                      \
    {                                          \
        "output", required_argument, NULL, 'o' \
    }

/* Takes option C, NAME, with the value optarg; returns -1, or an exit code
 * after saying what is wrong. */
typedef int bake_line_fn(struct tool *tool, void *line, int c,
                         const char *name);

/* Reads the line; TAKE, unless NULL, takes options but -o and the common ones.
 * TEXT says of a line with other than one input what it takes. Sets
 * TOOL->written to what -o names, where a file can be. Returns -1, or an exit
 * code. */
int bake_line_begin(struct tool *tool, const char *help, int argc, char **argv,
                    const struct option *options, bake_line_fn *take,
                    void *line, const char *text);

/* Returns whether standard output is free for a report. */
bool bake_line_tells(const struct tool *tool);

#endif
