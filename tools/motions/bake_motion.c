/* SPDX-License-Identifier: MIT
 *
 * glint bake of motions: localises what a body recorded. */
#include <string.h>

#include "options/settings.h"
#include "options/takes.h"
#include "posix/output.h"
#include "motions/motion_file.h"

static const char help[] =
    "glint bake NAME.json -o OUT.motion [options]\n"
    "\n"
    "Finds where a body was that recorded, frame by frame, where things "
    "around\n"
    "it were in its own axes, and writes its poses, its sensors and where the\n"
    "things are, for scenes (tools/examples/scenes/README.md has the words of\n"
    "a recording). Frames are read one by one.\n"
    "\n"
    "  -o, --output OUT\n"
    "  --fit F             all: the rigid motion nearest to all (default)\n"
    "                      best4, first4, chain: as published, baselines\n"
    "  --average A         life: the place of a thing is a mean over its life\n"
    "                      (default); none\n";

struct line {
    const char *output;
    struct glint_motion_options options;
};

static int take(struct tool *tool, struct line *l, int c, const char *name)
{
    static const char *const fits[] = {"all", "best4", "first4", "chain", NULL};
    static const char *const averages[] = {"none", "life", NULL};
    int word;

    switch (c) {
    case 'o':
        l->output = optarg;
        return -1;
    case 'f':
        word = tool_word(optarg, fits);
        if (word < 0)
            return tool_refuse(tool, name, optarg);
        l->options.fit = (enum glint_motion_fit)word;
        return -1;
    case 'a':
        word = tool_word(optarg, averages);
        if (word < 0)
            return tool_refuse(tool, name, optarg);
        l->options.average = word;
        return -1;
    default:
        return tool_option(tool, c, optarg);
    }
}

static int parse(struct tool *tool, int argc, char **argv, struct line *l)
{
    static const struct option options[] = {
        {"output", required_argument, NULL, 'o'},
        {"fit", required_argument, NULL, 'f'},
        {"average", required_argument, NULL, 'a'},
        TOOL_COMMON_OPTIONS};
    int c, code, index = 0;

    while ((c = tool_getopt(argc, argv, "o:" TOOL_COMMON_SHORT, options,
                            &index)) >= 0)
        if ((code = take(tool, l, c, options[index].name)) >= 0)
            return code;
    code = tool_inputs(tool, argc, argv, 1, "takes one recording");
    if (code >= 0)
        return code;
    return l->output ? -1 : tool_usage(tool, "needs -o OUT");
}

int cmd_bake_motion(int argc, char **argv)
{
    struct tool tool = {.name = "bake", .help = help, .help_end = COMMON_HELP};
    struct line line = {.output = NULL};
    struct glint_error error;
    struct motion_file file;
    struct glint_output out;
    enum glint_status status;
    int code;

    glint_motion_defaults(&line.options);
    code = parse(&tool, argc, argv, &line);
    if (code >= 0 || !line.output)
        return code;
    tool.written = line.output;
    if (tool_check_output(&tool, line.output) != EXIT_OK)
        return EXIT_OUTPUT;
    code = motion_file_open(&tool, argv[optind], &line.options, &file);
    if (code != EXIT_OK)
        return code;
    status = glint_output_open(&out, line.output, GLINT_OUTPUT_BINARY, &error);
    if (status == GLINT_OK)
        status = glint_output_finish(&out, file.data, file.bytes, &error);
    if (status != GLINT_OK)
        code = tool_fail(&tool, status, error.text);
    else if (strcmp(line.output, "-") != 0 && !tool.quiet)
        motion_file_print(&tool, &file);
    motion_file_close(&file);
    return code;
}
