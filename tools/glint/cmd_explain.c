/* SPDX-License-Identifier: MIT
 *
 * glint explain: reports what one frame draws, what it drops and why, and the
 * cost and light of each ghost, light and wavelength.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "desk/render_file.h"
#include "explain/explain.h"
#include "explain/explain_scene.h"
#include "model/ghost_file.h"
#include "overlay/apart.h"
#include "overlay/drawing.h"
#include "overlay/overlay_line.h"
#include "overlay/show_lights.h"
#include "glint/measure.h"
#include "options/command_line.h"
#include "formats/picture.h"
#include "posix/error.h"

static const char help[] =
    "glint explain IN [-o OUT] [options]\n"
    "glint explain --size WxH --light THETA,PHI[,POWER[,R,G,B[,SIZE]]]... [-o "
    "OUT]\n"
    "              [options]\n"
    "\n"
    "Lists the lights and ghosts of one frame: for each ghost the pair of\n"
    "surfaces that reflect it, its size and centre in pixels, its fraction of\n"
    "the flare's light and its brightest pixel (white = 1). It also lists the\n"
    "ghosts that were not drawn and why, and bright regions that were not "
    "taken\n"
    "for lamps. The frame is that of glint overlay with picture IN, or that "
    "of\n"
    "glint render with --size, whose brightness is in units of the lamps' "
    "power.\n"
    "A lens table is drawn by exact rays. A model (--rays model) adds the\n"
    "fraction of the drawing cost (estimated instructions, all of them with\n"
    "--json). With --scene it first lists the state of each object (drawn,\n"
    "hidden, behind the camera, off-screen, occluded, below a pixel) and "
    "light;\n"
    "--lens none lists these only.\n"
    "\n"
    "  -o, --output OUT    write a picture: tiles with flare shaded, ghosts\n"
    "                      outlined and numbered, a legend, and white boxes\n"
    "                      around up to three rejected regions\n"
    "  --save-ghosts FILE  write the ghosts for --ghosts FILE of overlay, "
    "live\n"
    "                      and render\n"
    "  --size WxH          size of the frame without IN\n"
    "  --top N             list and mark N ghosts and lights (default 20)\n";

enum { OPT_TOP = ENGINE_OPTIONS_END, OPT_SIZE, OPT_SAVE_GHOSTS };

struct explain_command {
    struct drawing drawing;
    const char *input, *output, *ghosts;
    int width, height; /* --size, pixels; 0: size of the input */
    int top;
    struct glint_kept kept; /* the input */
    /* the picture on which the flare is drawn: the samples of the input, or an
     * 8-bit copy in MEM */
    struct glint_image image;
    uint8_t *mem;
};

static const struct option own[] = {
    {"output", required_argument, NULL, 'o'},
    {"size", required_argument, NULL, OPT_SIZE},
    {"top", required_argument, NULL, OPT_TOP},
    {"save-ghosts", required_argument, NULL, OPT_SAVE_GHOSTS},
    {NULL, 0, NULL, 0}};

static bool parse_option(struct explain_command *c, int option,
                         const char *value)
{
    switch (option) {
    case 'o':
        c->output = value;
        return true;
    case OPT_SAVE_GHOSTS:
        c->ghosts = value;
        return *value != '\0';
    case OPT_SIZE:
        return tool_parse_size(value, &c->width, &c->height);
    case OPT_TOP:
        return tool_parse_integer(value, 0, GLINT_MAX_GHOSTS, &c->top);
    }
    return false;
}

/* Returns whether the frame is that of glint render, in linear light. */
static bool is_linear(const struct explain_command *c)
{
    return c->width && !c->drawing.line.settings.options.scene;
}

static int check_options(struct tool *tool, const struct explain_command *c)
{
    if (c->input && c->width)
        return tool_usage(tool, "needs one input picture, or --size WxH");
    if (c->drawing.line.show_lights)
        return tool_usage(tool, "--show lights applies to overlay and live "
                                "only");
    if (strcmp(c->drawing.line.settings.options.lens, "none") == 0) {
        if (!c->drawing.line.settings.options.scene)
            return tool_usage(tool,
                              "--lens none without --scene leaves nothing to "
                              "explain; add --scene FILE");
        if (c->output)
            return tool_usage(tool, "-o shows the flare of a lens; remove "
                                    "--lens none");
    }
    if (!c->input && !c->drawing.line.settings.options.scene &&
        c->drawing.line.n_hand == 0 && c->drawing.line.n_at == 0 &&
        !c->drawing.line.settings.options.lights)
        return tool_usage(tool, "--size needs a --light or --lights FILE");
    for (int i = 0; i < c->drawing.line.n_at && is_linear(c); i++)
        if (isinf(c->drawing.line.at[i].ev))
            return tool_usage(tool,
                              "--light-at X,Y,off removes a lamp found in "
                              "the picture, and --size searches for "
                              "none");
    return -1;
}

static int parse_options(struct tool *tool, int argc, char **argv,
                         struct explain_command *c)
{
    const struct option *const options = engine_build_options(
        tool, ENGINE_ALL, &c->drawing.line.settings.options, own);
    int option, index = 0;
    int code = drawing_line_apply_command_style(
        tool, &c->drawing.line, argc, argv, "o:" TOOL_COMMON_SHORT, options);

    if (code >= 0)
        return code;
    while ((option = tool_getopt(argc, argv, "o:" TOOL_COMMON_SHORT, options,
                                 &index)) >= 0) {
        code = drawing_line_set_option(tool, &c->drawing.line, option, optarg);
        if (code == -2 && (option == 'o' || option >= ENGINE_OPTIONS_END)) {
            code = -1;
            if (!parse_option(c, option, optarg))
                return tool_report_bad_value(tool, options[index].name, optarg);
        } else if (code == -2)
            code = tool_apply_option(tool, option, optarg);
        if (code >= 0)
            return code;
    }
    code = c->width && optind == argc
               ? -1
               : tool_check_inputs(tool, argc, argv, 1,
                                   "needs one input picture, or --size WxH");
    if (code >= 0)
        return code;
    c->input = argv[optind]; /* NULL if there is no argument */
    code = check_options(tool, c);
    if (code < 0 && is_linear(c) &&
        strcmp(c->drawing.line.settings.options.wavelengths, "auto") == 0)
        code = drawing_line_set_text(tool, &c->drawing.line, "wavelengths",
                                     "650,532,450"); /* default of render */
    return code;
}

/* ------------------------------------------------------------------- frame */

/* Loads the input and sets the lens to its camera, as overlay does; without an
 * input makes a black image. */
static int load_input_image(struct tool *tool, struct explain_command *c)
{
    struct glint_error error = {""};
    enum glint_status status;
    double white;

    if (c->input) {
        status = glint_kept_open(&c->kept, c->input, &error);
        if (status != GLINT_OK)
            return tool_fail(tool, status, error.text);
        drawing_line_follow_photo(&c->drawing.line, c->kept.f_number,
                                  c->kept.focal_mm);
        if (glint_samples_get_image(&c->kept.samples, &c->image))
            return EXIT_OK;
        status = glint_samples_make_proxy(&c->kept.samples, &c->image, &white);
        c->mem = c->image.plane[0];
        return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, NULL);
    }
    c->image = (struct glint_image){
        .format = GLINT_RGB24, .width = c->width, .height = c->height};
    c->mem = calloc(3 * (size_t)c->width, (size_t)c->height);
    if (!c->mem)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    glint_image_place(&c->image, c->mem);
    return EXIT_OK;
}

/* Draws the flare in linear light like glint render, and converts c->image to
 * the 8-bit image that glint render would save. */
static enum glint_status draw_linear_flare(struct explain_command *c)
{
    struct drawing *drawing = &c->drawing;
    const size_t n = (size_t)c->width * (size_t)c->height;
    const double start = tool_clock_s();
    struct glint_float_image light = {.width = c->width, .height = c->height};
    enum glint_status status = drawing_detect_lamps_only(drawing, &c->image, 0);
    struct glint_lamp *plain;
    uint8_t *codes;

    if (status != GLINT_OK)
        return status;
    status = GLINT_E_MEMORY;
    plain = malloc(((size_t)drawing->run.n_lamps + 1) * sizeof *plain);
    for (int i = 0; i < drawing->run.n_lamps && plain; i++)
        plain[i] = drawing->run.lamp[i].lamp;
    light.rgb = calloc(3 * n, sizeof *light.rgb);
    drawing_start_flare(drawing);
    if (light.rgb && plain)
        status = glint_engine_render(
            drawing->run.engine, plain, drawing->run.n_lamps,
            settings_compute_brightness_scale(&drawing->line.settings),
            GLINT_ENGINE_ALL, light.rgb, &drawing->run.report);
    drawing_end_flare(&drawing->run, start);
    free(plain);
    if (status == GLINT_OK) {
        codes = glint_measure_encode(
            &light,
            GLINT_OPTION_GIVEN(&drawing->line.settings.options, exposure)
                ? 1
                : glint_measure_exposure(&light));
        if (codes)
            memcpy(c->image.plane[0], codes, 3 * n);
        else
            status = GLINT_E_MEMORY;
        free(codes);
    }
    free(light.rgb);
    return status;
}

/* ------------------------------------------------------------------ result */

static int save_picture(struct tool *tool, const struct explain_command *c,
                        struct glint_explain *e,
                        const struct explain_title *title)
{
    struct glint_error error = {""};
    struct glint_image marked = {.plane = {NULL}};
    struct glint_spot spot;
    enum glint_status status = explain_draw_marks(e, title, &c->image, &marked);

    for (int i = 0;
         status == GLINT_OK && drawing_get_candidate(&c->drawing, i, &spot);
         i++)
        show_candidate_mark(&marked, &spot);
    if (status == GLINT_OK)
        status = glint_picture_save(c->output, &marked, &error);
    free(marked.plane[0]);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

static int save_ghosts(struct tool *tool, const struct explain_command *c,
                       const struct glint_explain *e)
{
    struct glint_error error = {""};
    const enum glint_status status =
        ghost_file_save(e, c->ghosts, c->drawing.files.lens.table.name, &error);

    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

/* Prints the explanation of the scene, followed by that of FLARE unless that
 * is NULL. */
static int print_scene_explanation(struct tool *tool,
                                   const struct explain_command *c,
                                   struct glint_explain *flare)
{
    struct json_writer json = {.to = stdout};
    struct explained_scene scene;
    const enum glint_status status =
        explained_scene_open(&scene, &c->drawing, flare);

    if (status != GLINT_OK)
        return tool_fail(tool, status, NULL);
    if (tool->json) {
        json_write(&json, "{scene: ");
        explain_scene_write_json(&json, &scene);
        json_write(&json, flare ? "flare: " : "}\n");
    } else {
        explain_scene_print_tables(&scene);
        printf(flare ? "\n" : "");
    }
    explained_scene_close(&scene);
    return EXIT_OK;
}

/* Measures the ghosts and lights of the last picture, which takes seconds with
 * exact rays, and shows the progress. */
static enum glint_status open_explanation(const struct tool *tool,
                                          struct explain_command *c,
                                          bool linear, struct glint_explain *e)
{
    const struct drawing *const drawing = &c->drawing;
    struct tool_progress progress;
    const struct glint_explain_config cfg = {
        .gain = linear
                    ? settings_compute_brightness_scale(&drawing->line.settings)
                    : 0,
        .lamps = drawing->run.lamp,
        .n_lamps = drawing->run.n_lamps,
        .progress = tool_progress_show,
        .progress_ctx = &progress};
    enum glint_status status;

    tool_progress_start(&progress, tool, "ghosts");
    status = glint_explain_open(e, drawing->run.engine, &cfg);
    tool_progress_end(&progress);
    return status;
}

static int print_explanation(struct tool *tool, struct explain_command *c,
                             bool linear)
{
    struct drawing *drawing = &c->drawing;
    const struct explain_title title = {
        .lens = drawing->files.lens.table.name,
        .lamp = drawing->run.lamp,
        .n_lamps = drawing->run.n_lamps,
        .linear = linear,
        .top = c->top,
        .report = &drawing->run.report,
        .engine = drawing->files.is_listed || drawing->line.n_hand > 0
                      ? NULL
                      : drawing->run.engine};
    struct glint_explain e;
    const enum glint_status status = open_explanation(tool, c, linear, &e);
    int code = EXIT_OK;

    if (status == GLINT_OK && drawing->files.scene.is_open)
        code = print_scene_explanation(tool, c, &e);
    if (status != GLINT_OK)
        code = tool_fail(tool, status, NULL);
    else if (tool->json)
        explain_write_json(&e, &title);
    else
        explain_print_tables(&e, &title);
    if (code == EXIT_OK && tool->json && drawing->files.scene.is_open)
        printf("}\n");
    if (status == GLINT_OK && drawing->run.n_lamps == 0 && !tool->quiet) {
        fflush(
            stdout); /* writes the report before messages on standard error */
        overlay_print_no_lamp_found(drawing, false, stderr);
    }
    if (code == EXIT_OK && c->output)
        code = save_picture(tool, c, &e, &title);
    if (code == EXIT_OK && c->ghosts)
        code = save_ghosts(tool, c, &e);
    glint_explain_close(&e);
    return code;
}

static int check_outputs_differ_from_inputs(const struct tool *tool,
                                            const struct explain_command *c)
{
    struct apart files = {.n_read = 0};

    file_conflicts_add_input(&files, NULL, c->input);
    file_conflicts_add_output(&files, "-o", c->output);
    file_conflicts_add_output(&files, "--save-ghosts", c->ghosts);
    file_conflicts_add_drawing_files(&files, &c->drawing.line);
    return file_conflicts_check_outputs(tool, &files);
}

static int explain_frame(struct tool *tool, struct explain_command *c)
{
    const bool linear = is_linear(c);
    enum glint_status status;
    int code;

    if ((c->output && render_file_check_codes(tool, c->output) != EXIT_OK) ||
        (c->ghosts && tool_check_output(tool, c->ghosts) != EXIT_OK))
        return EXIT_OUTPUT;
    code = check_outputs_differ_from_inputs(tool, c);
    c->drawing.line.settings.unbaked =
        settings_choose_method_without_model(&c->drawing.line.settings);
    if (code == EXIT_OK)
        code = load_input_image(tool, c);
    if (code == EXIT_OK)
        code = drawing_open(tool, &c->drawing);
    if (code == EXIT_OK)
        code = drawing_allocate(tool, &c->drawing, c->image.width,
                                c->image.height);
    if (code != EXIT_OK)
        return code;
    status = linear ? draw_linear_flare(c)
                    : drawing_draw_flare(&c->drawing, &c->image, 0);
    if (status != GLINT_OK)
        return tool_fail(tool, status, NULL);
    code = drawing_finish_lamp_file(tool, &c->drawing);
    if (code == EXIT_OK)
        code = c->drawing.files.has_lens
                   ? print_explanation(tool, c, linear)
                   : print_scene_explanation(tool, c, NULL);
    return code;
}

int cmd_explain(int argc, char **argv)
{
    struct tool tool = {
        .name = "explain", .help = help, .help_end = COMMON_HELP};
    struct explain_command *c = calloc(1, sizeof *c);
    int code;

    if (!c)
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    drawing_line_set_defaults(&c->drawing.line);
    c->drawing.line.is_still = true;
    c->top = 20;
    code = parse_options(&tool, argc, argv, c);
    if (code < 0) {
        code = tool_start_threads(&tool);
        if (code == EXIT_OK)
            code = explain_frame(&tool, c);
        tool_stop_threads(&tool);
    }
    drawing_close(&c->drawing);
    free(c->mem);
    glint_kept_close(&c->kept);
    free(c);
    return code;
}
