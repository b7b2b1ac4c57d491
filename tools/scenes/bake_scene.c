/* SPDX-License-Identifier: MIT
 *
 * glint bake NAME.scene: writes a scene as the run time takes it.
 */
#include <string.h>

#include "options/settings.h"
#include "posix/output.h"
#include "scenes/baked_scene.h"

static const char help[] =
    "glint bake NAME.scene -o OUT.glint [--json]\n"
    "\n"
    "Turns a scene (tools/examples/scenes/README.md) with the meshes and\n"
    "pictures that it names into one file of integers, which render and info\n"
    "take in its place. Prints what is in it, and its bytes.\n"
    "\n"
    "  -o, --output OUT\n";

static int parse(struct tool *tool, int argc, char **argv, const char **output)
{
    static const struct option options[] = {
        {"output", required_argument, NULL, 'o'}, TOOL_COMMON_OPTIONS};
    int c, code;

    while ((c = tool_getopt(argc, argv, "o:" TOOL_COMMON_SHORT, options,
                            NULL)) >= 0) {
        if (c == 'o')
            *output = optarg;
        else if ((code = tool_option(tool, c, optarg)) >= 0)
            return code;
    }
    code = tool_inputs(tool, argc, argv, 1, "takes one scene");
    if (code >= 0)
        return code;
    return *output ? -1 : tool_usage(tool, "needs -o OUT");
}

int cmd_bake_scene(int argc, char **argv)
{
    struct tool tool = {.name = "bake", .help = help, .help_end = COMMON_HELP};
    struct glint_error error = {""};
    struct baked_scene scene = {.data = NULL};
    const char *output = NULL;
    struct glint_output out;
    enum glint_status status;
    int code = parse(&tool, argc, argv, &output);

    if (code >= 0 || !output)
        return code;
    tool.written = output;
    if (tool_check_output(&tool, output) != EXIT_OK)
        return EXIT_OUTPUT;
    code = baked_scene_open(&tool, argv[optind], &scene);
    if (code != EXIT_OK)
        return code;
    status = glint_output_open(&out, output, GLINT_OUTPUT_BINARY, &error);
    if (status == GLINT_OK)
        status = glint_output_finish(&out, scene.data, scene.bytes, &error);
    if (status != GLINT_OK)
        code = tool_fail(&tool, status, error.text);
    else if (strcmp(output, "-") != 0 && !tool.quiet)
        baked_scene_print(&tool, &scene);
    baked_scene_close(&scene);
    return code;
}
