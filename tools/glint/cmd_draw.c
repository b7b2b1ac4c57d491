/* SPDX-License-Identifier: MIT
 *
 * glint draw: draws the cross section of a lens as SVG.
 */
#include <stdlib.h>
#include <string.h>

#include "overlay/apart.h"
#include "lens_pages/drawing.h"
#include "model/table_file.h"
#include "posix/output.h"

static const char help[] =
    "glint draw LENS -o FILE.svg [--ghost K [--angle DEG]] [--rays N]\n"
    "           [--plane x|y] [--no-spots] [--f-number N] [--zoom Z] [--focus "
    "M]\n"
    "\n"
    "Draws a section through the lens for a browser or a paper: glasses, "
    "barrels,\n"
    "stop, sensor, and rays of the d line from the centre, 0.7 and the edge of "
    "the\n"
    "field. Spot diagrams below show where rays of 450, 546 and 650 nm meet "
    "the\n"
    "sensor. The light comes from infinity at any focus.\n"
    "\n"
    "  -o, --output FILE   the .svg, or - for standard output\n"
    "  --ghost K           draw the path of ghost K (numbers of glint info -v) "
    "and\n"
    "                      mark its two mirrors, instead of the rays\n"
    "  --angle DEG         angle of the ghost's light, 0 .. 89 (default: half "
    "of\n"
    "                      the field)\n"
    "  --rays N            rays of each fan, 1 .. 41 (default 7)\n"
    "  --plane x|y         plane of the section of an anamorphic lens (default "
    "x)\n"
    "  --no-spots          draw no spot diagrams\n"
    "  --f-number N        f-number (default: that of the table)\n" ZOOM_HELP;

static const char help_end[] = COMMON_HELP;

struct draw {
    struct glint_prescription lens;
    struct lens_drawing drawing;
    const char *output;
    struct zoom_option zoom;
    double f_number; /* --f-number; 0: the f-number of the table */
};

static int parse_option(struct tool *tool, void *ctx, int c, const char *value)
{
    struct draw *o = ctx;
    bool good = true;

    if (c == 'o')
        o->output = value;
    else if (c == 'g')
        good = tool_parse_integer(value, 0, GLINT_MAX_GHOSTS - 1,
                                  &o->drawing.ghost);
    else if (c == 'a')
        good = tool_parse_number(value, &o->drawing.angle_deg) &&
               o->drawing.angle_deg >= 0 && o->drawing.angle_deg <= 89;
    else if (c == 'r')
        good = tool_parse_integer(value, 1, DRAWING_MAX_RAYS, &o->drawing.rays);
    else if (c == 'p') {
        good = strcmp(value, "x") == 0 || strcmp(value, "y") == 0;
        o->drawing.plane_deg = *value == 'y' ? 90 : 0;
    } else if (c == 's')
        o->drawing.spots = false;
    else if (c == 'z')
        good = zoom_option_parse(&o->zoom, value);
    else if (c == 'F')
        good = zoom_option_parse_focus(&o->zoom, value);
    else if (c == 'f')
        good = tool_parse_number(value, &o->f_number) && o->f_number > 0;
    else
        return tool_apply_option(tool, c, value);
    return good ? -1 : -2;
}

static int parse_options(struct tool *tool, int argc, char **argv,
                         struct draw *o)
{
    static const struct option options[] = {
        {"output", required_argument, NULL, 'o'},
        {"ghost", required_argument, NULL, 'g'},
        {"angle", required_argument, NULL, 'a'},
        {"rays", required_argument, NULL, 'r'},
        {"plane", required_argument, NULL, 'p'},
        {"no-spots", no_argument, NULL, 's'},
        {"f-number", required_argument, NULL, 'f'},
        ZOOM_OPTIONS('z', 'F'),
        TOOL_COMMON_OPTIONS};
    struct apart files = {.n_read = 0};
    int code = tool_parse_options(
        tool, argc, argv, TOOL_COMMON_SHORT "o:", options, parse_option, o);

    if (code < 0)
        code = tool_check_inputs(tool, argc, argv, 1, "expects one lens");
    if (code >= 0)
        return code;
    if (!o->output)
        return tool_usage(tool, "needs -o, a .svg");
    if (o->drawing.angle_deg >= 0 && o->drawing.ghost < 0)
        return tool_usage(tool, "--angle needs --ghost");
    file_conflicts_add_input(&files, NULL, argv[optind]);
    file_conflicts_add_output(&files, "-o", o->output);
    code = file_conflicts_check_outputs(tool, &files);
    if (code == EXIT_OK)
        code = tool_check_ending(tool, o->output, ".svg", "a figure");
    if (code == EXIT_OK)
        code = tool_check_output(tool, o->output);
    return code == EXIT_OK ? -1 : code;
}

static int save_lens_drawing(const struct tool *tool, const struct draw *o)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *file = glint_memory_file_open(&text, &bytes);
    const int shown = file ? lens_drawing_write(&o->drawing, file) : 0;
    const int code = tool_save_text(tool, o->output, file, &text, &bytes);

    if (code != EXIT_OK)
        return code;
    if (shown == 0 && !tool->quiet)
        fprintf(stderr, "glint draw: no ray reaches the sensor; try a smaller "
                        "--angle, or another ghost\n");
    if (tool->json)
        json_write(&(struct json_writer){.to = stdout}, "{rays: %d}\n", shown);
    return EXIT_OK;
}

static int draw_lens_section(struct tool *tool, struct draw *o,
                             const char *name)
{
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;
    int code = tool_read_lens(tool, name, &o->lens), n;

    if (code == EXIT_OK)
        code = zoom_option_apply(tool, &o->zoom, &o->lens);
    if (code != EXIT_OK)
        return code;
    if (o->f_number > 0)
        status = glint_prescription_set_f_number(&o->lens, o->f_number, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    o->drawing.focus_m = o->zoom.focus_m;
    n = glint_ghost_list(&o->lens, NULL, 0);
    if (o->drawing.ghost >= n)
        return tool_usage(tool, "%s has %d ghosts, numbered 0 .. %d",
                          o->lens.name, n, n - 1);
    return save_lens_drawing(tool, o);
}

int cmd_draw(int argc, char **argv)
{
    struct tool tool = {.name = "draw", .help = help, .help_end = help_end};
    struct draw o = {.output = NULL};
    int code;

    lens_drawing_set_defaults(&o.drawing, &o.lens);
    code = parse_options(&tool, argc, argv, &o);
    if (code >= 0)
        return code;
    code = tool_start_threads(&tool);
    if (code == EXIT_OK)
        code = draw_lens_section(&tool, &o, argv[optind]);
    tool_stop_threads(&tool);
    return code;
}
