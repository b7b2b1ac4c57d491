/* SPDX-License-Identifier: MIT
 *
 * glint bake of translucent media: bakes how light spreads below a surface, for
 * drawing objects made of the medium.
 */
#include "model/bake_line.h"
#include "options/command_line.h"
#include "stones/stone_file.h"

static const char help[] =
    "glint bake NAME.translucent -o OUT.glint [options]\n"
    "\n"
    "Computes how light spreads below the surface of a translucent medium\n"
    "(tools/examples/scenes/README.md), fits a few kernels to it, and writes "
    "them\n"
    "as integers for 'material .. translucent OUT.glint' of a scene. Prints "
    "the\n"
    "difference from the full table. Takes about a minute; the result is "
    "cached.\n"
    "\n"
    "  -o, --output OUT\n"
    "  --model M           clustered: one kernel per cluster of texels, 7 "
    "bytes per\n"
    "                      texel (default)\n"
    "                      factored: a sum of terms, 3 bytes each\n"
    "                      albedo: one kernel, 3 bytes\n";

/* options of the command line; -1: the option is not given */
struct line {
    int model;
};

static void override_medium_text(void *ctx, struct glint_stone_text *t)
{
    const struct line *l = ctx;

    if (l->model >= 0) {
        const int rank = t->fit.rank;

        glint_scatter_defaults(&t->fit, (enum glint_scatter_model)l->model);
        t->fit.rank = rank;
    }
}

static int parse_medium_option(struct tool *tool, void *line, int c,
                               const char *name)
{
    static const char *const models[] = {"clustered", "factored", "albedo",
                                         NULL};
    struct line *l = line;
    bool ok = true;

    switch (c) {
    case 'm':
        l->model = tool_find_word_index(optarg, models);
        ok = l->model >= 0;
        break;
    default:
        return tool_apply_option(tool, c, optarg);
    }
    return ok ? -1 : tool_report_bad_value(tool, name, optarg);
}

int cmd_bake_stone(struct tool *tool, int argc, char **argv)
{
    static const struct option options[] = {
        BAKE_LINE_OPTIONS,
        {"model", required_argument, NULL, 'm'},
        TOOL_COMMON_OPTIONS};
    struct line line = {.model = -1};
    struct glint_error error = {""};
    struct stone_file file;
    enum glint_status status;
    int code;

    code = bake_line_parse(tool, help, argc, argv, options, parse_medium_option,
                           &line, "expects one translucent medium");
    if (code >= 0)
        return code;
    status = stone_file_read(tool, argv[optind], override_medium_text, &line,
                             true, NULL, &file, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    code = tool_save_file(tool, tool->written, GLINT_OUTPUT_BINARY, file.data,
                          file.bytes);
    if (code == EXIT_OK && bake_line_prints_report(tool))
        stone_file_print_contents(tool, &file);
    stone_file_close(&file);
    return code;
}
