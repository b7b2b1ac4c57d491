/* SPDX-License-Identifier: MIT
 *
 * glint styles: draws one photograph in each style, as a contact sheet.
 */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "overlay/apart.h"
#include "desk/render_file.h"
#include "desk/sheet.h"
#include "desk/styles.h"
#include "formats/picture.h"
#include "model/lens_files.h"
#include "options/command_line.h"
#include "overlay/drawing.h"
#include "overlay/overlay_line.h"
#include "posix/error.h"

static const char help[] =
    "glint styles [IN] [-o OUT] [options]\n"
    "\n"
    "Lists the values of --style of overlay, live and explain. With -o draws "
    "a\n"
    "contact sheet: IN, or a photograph that comes with glint, in each style.\n"
    "\n"
    "  -o, --output OUT    the sheet, a picture of 8 bits\n"
    "  --width N           width of each picture on it, 64 to 2048 (default "
    "640)\n"
    "Options of overlay apply to all styles: --light-at, --gain, --quality "
    "...\n"
    "--lens, --stop or --strength replace the value of every style.\n";

enum { OPT_WIDTH = ENGINE_OPTIONS_END, PATH_BYTES = 4096, CAPTION_BYTES = 160 };

static const struct option own[] = {
    {"output", required_argument, NULL, 'o'},
    {"width", required_argument, NULL, OPT_WIDTH},
    {NULL, 0, NULL, 0}};

static const char shorts[] = "o:" TOOL_COMMON_SHORT;

struct styles_command {
    int argc;
    char **argv;
    const char *input, *output;
    int width;
    struct glint_image image; /* input image, and a copy to draw on */
    struct glint_image drawn;
};

/* Parses the command line into C and the options of glint overlay into
 * DRAWING. */
static int parse_options(struct tool *tool, struct styles_command *c,
                         struct drawing *drawing)
{
    const struct option *const options = engine_build_options(
        tool, ENGINE_ALL, &drawing->line.settings.options, own);
    int option, code;

    optind = 0;
    while ((option = tool_getopt(c->argc, c->argv, shorts, options, NULL)) >=
           0) {
        code = drawing_line_set_option(tool, &drawing->line, option, optarg);
        if (code == -2 && option == 'o') {
            c->output = optarg;
            code = -1;
        } else if (code == -2 && option == OPT_WIDTH) {
            code = -1;
            if (!tool_parse_integer(optarg, 64, 2048, &c->width))
                return tool_report_bad_value(tool, "width", optarg);
        } else if (code == -2)
            code = tool_apply_option(tool, option, optarg);
        if (code >= 0)
            return code;
    }
    c->input = optind < c->argc ? c->argv[optind] : NULL;
    return optind + 1 < c->argc ? tool_usage(tool, "takes one picture") : -1;
}

/* Loads the sample photograph installed with glint: the large one, or the small
 * one if the image plug-in is missing. Returns GLINT_E_ARGUMENT if neither is
 * installed. */
static enum glint_status load_sample_photograph(struct glint_image *image,
                                                struct glint_error *error)
{
    static const char *const places[] = {
        "../bridge.jpg", "../tests/data/bridge.jpg", "../bridge.ppm",
        "../tests/data/bridge.ppm"};
    char folder[PATH_BYTES - 40], path[PATH_BYTES];
    enum glint_status status = glint_error_report(
        error, GLINT_E_ARGUMENT, "bridge.ppm",
        "the sample photograph of glint is not installed; name a picture");

    for (int k = 0; k < 4; k++)
        for (int i = 0; lens_find_folder(i, "lenses", folder, sizeof folder);
             i++) {
            snprintf(path, PATH_BYTES, "%s/%s", folder, places[k]);
            if (!*folder || access(path, R_OK) != 0)
                continue;
            status = glint_picture_load(path, image, error);
            if (status == GLINT_OK)
                return status;
        }
    return status;
}

static int load_input_image(struct tool *tool, struct styles_command *c)
{
    struct glint_error error = {""};
    const enum glint_status status =
        c->input ? glint_picture_load(c->input, &c->image, &error)
                 : load_sample_photograph(&c->image, &error);
    uint8_t *copy;

    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    copy =
        malloc(glint_image_bytes(GLINT_RGB24, c->image.width, c->image.height));
    if (!copy)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    c->drawn = (struct glint_image){.format = GLINT_RGB24,
                                    .width = c->image.width,
                                    .height = c->image.height};
    glint_image_place(&c->drawn, copy);
    return EXIT_OK;
}

static void write_style_caption(char text[CAPTION_BYTES],
                                const struct style *style)
{
    snprintf(text, CAPTION_BYTES, "%s: %s", style->name, style->about);
}

/* Opens SHEET for N images of the size of SMALL, with space for the longest
 * caption. */
static enum glint_status open_contact_sheet(struct sheet *sheet, int n,
                                            const struct glint_image *small)
{
    char text[CAPTION_BYTES];
    int most = 1;

    for (int k = 0; k < n; k++) {
        int rows;

        write_style_caption(text, &styles[k]);
        rows = sheet_count_caption_lines(small->width, text);
        most = rows > most ? rows : most;
    }
    return sheet_open(sheet, n, small->width, small->height, most);
}

static void copy_image_rows(const struct glint_image *to,
                            const struct glint_image *from)
{
    for (int y = 0; y < to->height; y++)
        memcpy(to->plane[0] + y * to->stride_bytes[0],
               from->plane[0] + y * from->stride_bytes[0],
               3 * (size_t)to->width);
}

/* Draws the input in STYLE as image K of SHEET. The first call opens the sheet,
 * and states if the picture has no lamp. */
static int draw_style_image(struct tool *tool, struct styles_command *c,
                            struct drawing *drawing, const struct style *style,
                            struct sheet *sheet, int k, int n)
{
    struct glint_image small = {.plane = {NULL}};
    enum glint_status status;
    char text[CAPTION_BYTES];
    int code = drawing_allocate(tool, drawing, c->image.width, c->image.height);

    if (code != EXIT_OK)
        return code;
    copy_image_rows(&c->drawn, &c->image);
    status = drawing_draw_flare(drawing, &c->drawn, 0);
    if (status == GLINT_OK)
        status = sheet_reduce_image(&small, &c->drawn, c->width);
    if (status == GLINT_OK && k == 0)
        status = open_contact_sheet(sheet, n, &small);
    if (status == GLINT_OK) {
        const struct glint_image to = sheet_get_image(sheet, k);

        copy_image_rows(&to, &small);
        write_style_caption(text, style);
        sheet_draw_caption(sheet, k, text);
    }
    if (status == GLINT_OK && k == 0 && drawing->run.n_lamps == 0 &&
        !tool->quiet) {
        fputs("glint styles: ", stderr);
        overlay_print_no_lamp_found(drawing, false, stderr);
    }
    free(small.plane[0]);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, NULL);
}

/* Opens the lens of a style without baking a model. Returns an exit code. */
static int open_style_lens(const struct tool *tool, struct drawing *drawing)
{
    drawing->line.is_still = true;
    drawing->line.settings.unbaked =
        settings_choose_method_without_model(&drawing->line.settings);
    return drawing_open_lens(tool, drawing);
}

static int draw_all_styles(struct tool *tool, struct styles_command *c,
                           const struct style *style, struct sheet *sheet,
                           int k, int n)
{
    struct drawing *const drawing = calloc(1, sizeof *drawing);
    int code;

    if (!drawing)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    drawing_line_set_defaults(&drawing->line);
    code = drawing_line_apply_style(tool, &drawing->line, style->name);
    if (code < 0)
        code = parse_options(tool, c, drawing);
    if (code < 0)
        code = open_style_lens(tool, drawing);
    if (code == EXIT_OK)
        code = draw_style_image(tool, c, drawing, style, sheet, k, n);
    drawing_close(drawing);
    free(drawing);
    return code;
}

static int draw_contact_sheet(struct tool *tool, struct styles_command *c)
{
    struct glint_error error = {""};
    struct sheet sheet = {.columns = 0};
    enum glint_status status;
    int n = 0, code;

    while (styles[n].name)
        n++;
    code = load_input_image(tool, c);
    for (int k = 0; k < n && code == EXIT_OK; k++) {
        if (!tool->quiet)
            fprintf(stderr, "glint styles: %s\n", styles[k].name);
        code = draw_all_styles(tool, c, &styles[k], &sheet, k, n);
    }
    if (code == EXIT_OK) {
        status = glint_picture_save(c->output, &sheet.image, &error);
        if (status != GLINT_OK)
            code = tool_fail(tool, status, error.text);
    }
    sheet_close(&sheet);
    return code;
}

static void list_styles(void)
{
    for (const struct style *s = styles; s->name; s++) {
        printf("%-9s %s\n         ", s->name, s->about);
        for (const struct style_setting *set = s->set; set->option; set++)
            printf(" --%s %s", set->option, set->value);
        puts(s->set[0].option ? "" : " (the defaults)");
    }
}

static int check_output_differs_from_inputs(const struct tool *tool,
                                            const struct styles_command *c,
                                            const struct drawing *drawing)
{
    struct apart files = {.n_read = 0};

    file_conflicts_add_input(&files, NULL, c->input);
    file_conflicts_add_output(&files, "-o", c->output);
    file_conflicts_add_drawing_files(&files, &drawing->line);
    return file_conflicts_check_outputs(tool, &files);
}

/* Checks the command line before a lens is baked. */
static int check_style_options(struct tool *tool, struct styles_command *c)
{
    struct drawing *const drawing = calloc(1, sizeof *drawing);
    int code;

    if (!drawing)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    drawing_line_set_defaults(&drawing->line);
    code = parse_options(tool, c, drawing);
    if (code < 0 && drawing->line.style)
        code =
            tool_usage(tool, "draws every style and does not accept --style");
    if (code < 0 &&
        check_output_differs_from_inputs(tool, c, drawing) != EXIT_OK)
        code = EXIT_USAGE;
    drawing_close(drawing);
    free(drawing);
    if (code >= 0)
        return code;
    if (c->output)
        return render_file_check_codes(tool, c->output) == EXIT_OK
                   ? -1
                   : EXIT_OUTPUT;
    return c->input ? tool_usage(tool, "needs -o OUT for the sheet") : -1;
}

int cmd_styles(int argc, char **argv)
{
    struct tool tool = {
        .name = "styles", .help = help, .help_end = COMMON_HELP};
    struct styles_command c = {.argc = argc, .argv = argv, .width = 640};
    int code = check_style_options(&tool, &c);

    if (code >= 0)
        return code;
    if (!c.output) {
        list_styles();
        return EXIT_OK;
    }
    code = tool_start_threads(&tool);
    if (code == EXIT_OK)
        code = draw_contact_sheet(&tool, &c);
    tool_stop_threads(&tool);
    glint_picture_free(&c.image);
    free(c.drawn.plane[0]);
    return code;
}
