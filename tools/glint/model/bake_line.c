/* SPDX-License-Identifier: MIT */
#include "model/bake_line.h"

#include <string.h>

#include "options/command_line.h"

int bake_line_parse(struct tool *tool, const char *help, int argc, char **argv,
                    const struct option *options, bake_line_fn *take,
                    void *line, const char *text)
{
    int c, code, index = 0;

    tool->help = help;
    tool->help_end = COMMON_HELP;
    while ((c = tool_getopt(argc, argv, "o:" TOOL_COMMON_SHORT, options,
                            &index)) >= 0) {
        if (c == 'o') {
            tool->written = optarg;
            continue;
        }
        code = take ? take(tool, line, c, options[index].name)
                    : tool_apply_option(tool, c, optarg);
        if (code >= 0)
            return code;
    }
    code = tool_check_inputs(tool, argc, argv, 1, text);
    if (code >= 0)
        return code;
    if (!tool->written)
        return tool_usage(tool, "needs -o OUT");
    return tool_check_output(tool, tool->written) == EXIT_OK ? -1 : EXIT_OUTPUT;
}

bool bake_line_prints_report(const struct tool *tool)
{
    return strcmp(tool->written, "-") != 0 && !tool->quiet;
}
