/* SPDX-License-Identifier: MIT
 *
 * glint bake of motions: localises what a body recorded. */
#include "model/bake_line.h"
#include "motions/motion_file.h"
#include "options/command_line.h"

static const char help[] =
    "glint bake NAME.json -o OUT.motion [options]\n"
    "\n"
    "Finds where a body was that recorded, frame by frame, where objects "
    "around\n"
    "it were in its own axes, and writes its poses, its sensors and where the\n"
    "objects are, for scenes (tools/examples/scenes/README.md has the words "
    "of\n"
    "a recording). Frames are read one by one.\n"
    "\n"
    "  -o, --output OUT\n"
    "  --fit F             all: the rigid motion nearest to all (default)\n"
    "                      best4, first4, chain: as published, baselines\n"
    "  --average A         life: the place of an object is a mean over its "
    "life\n"
    "                      (default); none\n";

static int take(struct tool *tool, void *line, int c, const char *name)
{
    static const char *const fits[] = {"all", "best4", "first4", "chain", NULL};
    static const char *const averages[] = {"none", "life", NULL};
    struct glint_motion_options *o = line;
    int word;

    switch (c) {
    case 'f':
        word = tool_word(optarg, fits);
        if (word < 0)
            return tool_refuse(tool, name, optarg);
        o->fit = (enum glint_motion_fit)word;
        return -1;
    case 'a':
        word = tool_word(optarg, averages);
        if (word < 0)
            return tool_refuse(tool, name, optarg);
        o->average = word;
        return -1;
    default:
        return tool_option(tool, c, optarg);
    }
}

int cmd_bake_motion(struct tool *tool, int argc, char **argv)
{
    static const struct option options[] = {
        BAKE_LINE_OPTIONS,
        {"fit", required_argument, NULL, 'f'},
        {"average", required_argument, NULL, 'a'},
        TOOL_COMMON_OPTIONS};
    struct glint_motion_options o;
    struct motion_file file;
    int code;

    glint_motion_defaults(&o);
    code = bake_line_begin(tool, help, argc, argv, options, take, &o,
                           "takes one recording");
    if (code >= 0)
        return code;
    code = motion_file_open(tool, argv[optind], &o, &file);
    if (code != EXIT_OK)
        return code;
    code = tool_save(tool, tool->written, GLINT_OUTPUT_BINARY, file.data,
                     file.bytes);
    if (code == EXIT_OK && bake_line_tells(tool))
        motion_file_print(tool, &file);
    motion_file_close(&file);
    return code;
}
