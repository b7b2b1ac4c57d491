/* SPDX-License-Identifier: MIT
 *
 * glint bake of environments: writes light from all around as the run time
 * takes it.
 */
#include "model/bake_line.h"
#include "options/command_line.h"
#include "scenes/environment_file.h"

static const char help[] =
    "glint bake PICTURE|NAME.environment -o OUT.env [options]\n"
    "\n"
    "Turns a picture of all around, .exr, .hdr, .dds (by the image plug-in) "
    "or\n"
    ".pfm, twice as wide as high or 3 x 2 faces of a cube, into one file for\n"
    "scenes: the light blurred to several levels, what it lights, and its\n"
    "brightest spots as lights. Negative and not finite pixels are held and\n"
    "counted. A text (tools/examples/scenes/README.md) names the picture and\n"
    "has the same options; those of the line come before.\n"
    "\n"
    "  -o, --output OUT\n"
    "  --size N            texels along a side: 16 to 1024, a power of two\n"
    "                      (default 256)\n"
    "  --levels L          gauss: blurred on the sphere (default)\n"
    "                      mip: means of 2 x 2, the baseline\n"
    "  --lights N          0 to 16 (default 16)\n"
    "  --turn DEG          about the vertical, to the right\n"
    "  --scale X           factor of all light\n";

/* What the line says; -1, or has_ false: nothing. */
struct line {
    int side_log2, levels, lights;
    bool has_turn, has_scale;
    double turn, scale;
};

static void over(void *ctx, struct glint_environment_options *o)
{
    const struct line *l = ctx;

    if (l->side_log2 >= 0)
        o->side_log2 = l->side_log2;
    if (l->levels >= 0)
        o->levels = l->levels ? GLINT_ENVIRONMENT_MIP : GLINT_ENVIRONMENT_GAUSS;
    if (l->lights >= 0)
        o->max_lights = l->lights;
    if (l->has_turn)
        o->turn_deg = l->turn;
    if (l->has_scale)
        o->scale = l->scale;
}

static int take(struct tool *tool, void *line, int c, const char *name)
{
    static const char *const sizes[] = {"16",  "32",  "64",   "128",
                                        "256", "512", "1024", NULL};
    static const char *const levels[] = {"gauss", "mip", NULL};
    struct line *l = line;
    bool ok = true;

    switch (c) {
    case 's':
        l->side_log2 = tool_word(optarg, sizes);
        ok = l->side_log2 >= 0;
        l->side_log2 += GLINT_ENVIRONMENT_LEAST_LOG2;
        break;
    case 'l':
        l->levels = tool_word(optarg, levels);
        ok = l->levels >= 0;
        break;
    case 'n':
        ok = tool_integer(optarg, 0, GLINT_ENVIRONMENT_MAX_LIGHTS, &l->lights);
        break;
    case 't':
        ok = l->has_turn =
            tool_number(optarg, &l->turn) && l->turn >= -360 && l->turn <= 360;
        break;
    case 'x':
        ok = l->has_scale = tool_number(optarg, &l->scale) &&
                            l->scale >= 1e-6 && l->scale <= 1e6;
        break;
    default:
        return tool_option(tool, c, optarg);
    }
    return ok ? -1 : tool_refuse(tool, name, optarg);
}

int cmd_bake_environment(struct tool *tool, int argc, char **argv)
{
    static const struct option options[] = {
        BAKE_LINE_OPTIONS,
        {"size", required_argument, NULL, 's'},
        {"levels", required_argument, NULL, 'l'},
        {"lights", required_argument, NULL, 'n'},
        {"turn", required_argument, NULL, 't'},
        {"scale", required_argument, NULL, 'x'},
        TOOL_COMMON_OPTIONS};
    struct line line = {.side_log2 = -1, .levels = -1, .lights = -1};
    struct environment_file file;
    int code;

    code = bake_line_begin(tool, help, argc, argv, options, take, &line,
                           "takes one environment");
    if (code >= 0)
        return code;
    code = environment_file_open(tool, argv[optind], over, &line, &file);
    if (code != EXIT_OK)
        return code;
    code = bake_line_write(tool, file.data, file.bytes);
    if (code == EXIT_OK && bake_line_tells(tool))
        environment_file_print(tool, &file);
    environment_file_close(&file);
    return code;
}
