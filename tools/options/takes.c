/* SPDX-License-Identifier: MIT */
#include "options/takes.h"

#include "help/values.h"

int tool_refuse(const struct tool *tool, const char *option, const char *value)
{
    const char *takes = values_of(tool->name, option);

    return tool_usage(tool, "--%s: '%s' is not something it takes%s%s", option,
                      value, takes ? ": " : "", takes ? takes : "");
}

int tool_take(struct tool *tool, int argc, char **argv, const char *shorts,
              const struct option *options, tool_take_fn *take, void *ctx)
{
    int c, code, index = 0;

    while ((c = tool_getopt(argc, argv, shorts, options, &index)) >= 0) {
        code = take(tool, ctx, c, optarg);
        if (code == -2)
            return tool_refuse(tool, options[index].name, optarg);
        if (code >= 0)
            return code;
    }
    return -1;
}
