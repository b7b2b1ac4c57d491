/* SPDX-License-Identifier: MIT
 *
 * glint bake NAME.scene: bakes the text of a scene into the file that is read
 * when the scene is drawn.
 */
#include "model/bake_line.h"
#include "scenes/baked_scene.h"

static const char help[] =
    "glint bake NAME.scene -o OUT.glint [--json]\n"
    "\n"
    "Writes a scene (tools/examples/scenes/README.md) with the meshes and "
    "pictures\n"
    "that it names as one file of integers, which render and info accept in "
    "place\n"
    "of NAME.scene. Prints the contents and their bytes.\n"
    "\n"
    "  -o, --output OUT\n";

int cmd_bake_scene(struct tool *tool, int argc, char **argv)
{
    static const struct option options[] = {BAKE_LINE_OPTIONS,
                                            TOOL_COMMON_OPTIONS};
    struct baked_scene scene = {.data = NULL};
    int code;

    code = bake_line_parse(tool, help, argc, argv, options, NULL, NULL,
                           "expects one scene");
    if (code >= 0)
        return code;
    tool->is_bake = true;
    code = baked_scene_open(tool, argv[optind], &scene);
    if (code != EXIT_OK)
        return code;
    code = tool_save_file(tool, tool->written, GLINT_OUTPUT_BINARY, scene.data,
                          scene.bytes);
    if (code == EXIT_OK && bake_line_prints_report(tool))
        baked_scene_print_contents(tool, &scene);
    baked_scene_close(&scene);
    return code;
}
