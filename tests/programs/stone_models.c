/* SPDX-License-Identifier: MIT
 *
 * stone_models NAME.translucent FOLDER - models of scattering, glint's and
 * published ones, side by side as a page with pictures; some minutes. */
#include "reference/scatter/stone_models.h"
#include "model/settings.h"
#include "options/command_line.h"
#include "stones/stone_file.h"

static const char help[] = "stone_models NAME.translucent FOLDER\n\n";

static int run(const struct tool *tool, const char *path, const char *folder)
{
    struct glint_error error = {""};
    struct glint_scatter_rows rows;
    const enum glint_status status = stone_file_rows(tool, path, &rows, &error);
    int code;

    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    code = stone_models_report(tool, path, &rows, folder);
    glint_scatter_close(&rows);
    return code;
}

int main(int argc, char **argv)
{
    static const struct option options[] = {TOOL_COMMON_OPTIONS};
    struct tool tool = {
        .name = "stone_models", .help = help, .help_end = COMMON_HELP};
    int c, code = -1;

    while (code < 0 &&
           (c = tool_getopt(argc, argv, TOOL_COMMON_SHORT, options, NULL)) >= 0)
        code = tool_option(&tool, c, optarg);
    if (code < 0 && argc - optind != 2)
        code = tool_usage(&tool, "takes a stone and a folder");
    if (code < 0)
        code = tool_start(&tool);
    if (code == EXIT_OK && tool.workers)
        code = run(&tool, argv[optind], argv[optind + 1]);
    tool_finish(&tool);
    return code;
}
