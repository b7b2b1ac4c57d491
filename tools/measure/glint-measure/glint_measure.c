/* SPDX-License-Identifier: MIT
 *
 * glint-measure --row metrics=NAME,... lens=LENS PARAMETER=VALUE... - measures
 * one row of a figure and prints its metrics as JSON. tools/measure/figure runs
 * it for the rows that tools/measure/recipes defines.
 */
#include <stdio.h>
#include <string.h>

#include "measure/glint-measure/row.h"

int main(int argc, char **argv)
{
    static struct figure_row row;
    struct tool tool = {.name = "measure", .quiet = true};
    int code;

    if (argc < 2 || strcmp(argv[1], "--row") != 0) {
        fprintf(stderr, "usage: glint-measure --row PARAMETER=VALUE...\n");
        return EXIT_USAGE;
    }
    code = row_parse(&row, &tool, argc - 2, argv + 2);
    if (code == EXIT_OK)
        code = tool_start_threads(&tool);
    if (code == EXIT_OK)
        code = row_measure(&row);
    opened_lens_close(&row.opened);
    tool_stop_threads(&tool);
    return code;
}
