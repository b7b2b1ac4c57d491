/* SPDX-License-Identifier: MIT
 *
 * glint bake of recorded motions: computes the path of a body from a recording
 * of the landmarks ("foods") that its sensors located.
 */
#include "model/bake_line.h"
#include "motions/motion_file.h"
#include "options/command_line.h"

static const char help[] =
    "glint bake NAME.json -o OUT.motion [options]\n"
    "\n"
    "Computes the pose of a body in each frame of a recording from the "
    "objects\n"
    "that it located in its own axes, and writes the poses, the sensors and "
    "the\n"
    "positions of the objects for scenes (tools/examples/scenes/README.md\n"
    "describes recordings). Reads one frame at a time.\n"
    "\n"
    "  -o, --output OUT\n";

int cmd_bake_motion(struct tool *tool, int argc, char **argv)
{
    static const struct option options[] = {BAKE_LINE_OPTIONS,
                                            TOOL_COMMON_OPTIONS};
    struct motion_file file;
    int code;

    code = bake_line_parse(tool, help, argc, argv, options, NULL, NULL,
                           "expects one recording");
    if (code >= 0)
        return code;
    code = motion_file_open(tool, argv[optind], &file);
    if (code != EXIT_OK)
        return code;
    code = tool_save_file(tool, tool->written, GLINT_OUTPUT_BINARY, file.data,
                          file.bytes);
    if (code == EXIT_OK && bake_line_prints_report(tool))
        motion_file_print_contents(tool, &file);
    motion_file_close(&file);
    return code;
}
