/* SPDX-License-Identifier: MIT
 *
 * glint explain: tells what one frame models, what it leaves out and why, and
 * what each part of it costs and gives.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "command/explain.h"
#include "overlay/compositor.h"
#include "overlay/overlay_line.h"
#include "engine/measure.h"
#include "options/takes.h"
#include "formats/picture.h"
#include "posix/error.h"

static const char help[] =
    "glint explain IN [-o OUT] [options]\n"
    "glint explain --size WxH --light THETA,PHI[,POWER[,R,G,B[,SIZE]]]... [-o "
    "OUT] "
    "[options]\n"
    "\n"
    "Says of one frame which lights, wavelengths and ghosts are drawn, with\n"
    "which barrels and terms, what each takes (vertices, edges, rows of\n"
    "pixels, lit pixels, tiles; of the frame's work) and gives (share of the\n"
    "light that reaches the picture; its brightest pixel, white = 1), and "
    "what\n"
    "is left out, and why. IN is a picture as of glint overlay; with --size "
    "the\n"
    "frame is one of glint render. Work counts instructions by rule of thumb;\n"
    "pixels that are lit are nobody's own and in no ghost's share.\n"
    "\n"
    "  -o, --output OUT    a picture: touched tiles shaded, ghosts outlined "
    "and\n"
    "                      numbered, a legend\n"
    "  --size WxH          without IN: of the frame\n"
    "  --picture P         codes: as drawn over 8 bits (with IN, or on "
    "black);\n"
    "                      linear: to the full (default with --size)\n"
    "  --sort KEY          light (default) | work | number\n"
    "  --top N             list and mark N ghosts and lights (default 20)\n"
    "  --memory MIB        of the arena, 1 to 1024, as of glint live; "
    "default:\n"
    "                      as much as it takes\n" COMPOSITOR_HELP;

static const char help_end[] = SETTINGS_HELP;
static const char help_last[] = SPEED_HELP COMMON_HELP;

enum {
    OPT_PICTURE = OPT_COMPOSITOR_LAST,
    OPT_SORT,
    OPT_TOP,
    OPT_MEMORY,
    OPT_SIZE
};

enum { AUTO, CODES, LINEAR };

struct explain_command {
    struct compositor compositor;
    const char *input, *output;
    int width, height; /* 0: those of the input */
    int picture, order, top;
    struct glint_image image; /* the input, over which the flare is drawn */
};

static const struct option options[] = {
    {"output", required_argument, NULL, 'o'},
    {"size", required_argument, NULL, OPT_SIZE},
    {"picture", required_argument, NULL, OPT_PICTURE},
    {"sort", required_argument, NULL, OPT_SORT},
    {"top", required_argument, NULL, OPT_TOP},
    {"memory", required_argument, NULL, OPT_MEMORY},
    COMPOSITOR_OPTIONS,
    TOOL_COMMON_OPTIONS};

static bool take(struct explain_command *c, int option, const char *value)
{
    static const char *const pictures[] = {"codes", "linear", NULL};
    static const char *const orders[] = {"light", "work", "number", NULL};
    int n;

    switch (option) {
    case 'o':
        c->output = value;
        return true;
    case OPT_SIZE:
        return tool_size(value, &c->width, &c->height);
    case OPT_PICTURE:
        c->picture = tool_word(value, pictures) + 1;
        return c->picture > 0;
    case OPT_SORT:
        c->order = tool_word(value, orders);
        return c->order >= 0;
    case OPT_TOP:
        return tool_integer(value, 0, GLINT_MAX_GHOSTS, &c->top);
    default: /* OPT_MEMORY */
        if (!tool_integer(value, 1, 1024, &n))
            return false;
        c->compositor.reserve_bytes = (size_t)n << 20;
        return true;
    }
}

static int check(struct tool *tool, const struct explain_command *c)
{
    const struct settings *s = &c->compositor.settings;

    if (!c->input == !c->width)
        return tool_usage(tool, "takes one picture, or --size");
    if (c->input && c->picture == LINEAR)
        return tool_usage(tool, "--picture linear goes with --size");
    if (!c->input && c->compositor.n_hand == 0 && c->compositor.at.n == 0 &&
        !c->compositor.lights_file)
        return tool_usage(tool, "--size needs a --light or --lights FILE");
    if (s->raster || s->mask_nodes || s->rays != SETTINGS_RAYS_MODEL)
        return tool_usage(tool, "explains what is drawn by edges from a model, "
                                "not --raster cells, --mask, --rays exact");
    return -1;
}

static int parse(struct tool *tool, int argc, char **argv,
                 struct explain_command *c)
{
    int option, code, index = 0;

    while ((option = getopt_long(argc, argv, "o:" TOOL_COMMON_SHORT, options,
                                 &index)) >= 0) {
        code = compositor_option(tool, &c->compositor, option, optarg);
        if (code == -2 && (option == 'o' || option >= OPT_COMPOSITOR_LAST)) {
            code = -1;
            if (!take(c, option, optarg))
                return tool_refuse(tool, options[index].name, optarg);
        } else if (code == -2)
            code = tool_option(tool, option, optarg);
        if (code >= 0)
            return code;
    }
    if (optind < argc)
        c->input = argv[optind++];
    if (optind < argc)
        return tool_usage(tool, "takes one picture");
    return check(tool, c);
}

/* ------------------------------------------------------------------- frame */

static int load(struct tool *tool, struct explain_command *c)
{
    struct glint_error error = {""};
    enum glint_status status;
    uint8_t *mem;

    if (c->input) {
        status = glint_picture_load(c->input, &c->image, &error);
        return status == GLINT_OK ? EXIT_OK
                                  : tool_fail(tool, status, error.text);
    }
    c->image = (struct glint_image){
        .format = GLINT_RGB24, .width = c->width, .height = c->height};
    mem = calloc(3 * (size_t)c->width, (size_t)c->height);
    if (!mem)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    glint_image_place(&c->image, mem);
    return EXIT_OK;
}

/* Draws the flare as glint render does, and sets c->image to the picture of 8
 * bits that glint render would save. */
static enum glint_status draw_linear(struct explain_command *c)
{
    struct compositor *compositor = &c->compositor;
    const size_t n = (size_t)c->width * (size_t)c->height;
    struct glint_float_image light = {.width = c->width, .height = c->height};
    enum glint_status status = GLINT_E_MEMORY;
    uint8_t *codes;

    compositor_lamps(compositor, &c->image, 0);
    light.rgb = calloc(3 * n, sizeof *light.rgb);
    if (light.rgb)
        status = glint_frame_draw_alone(&compositor->frame, compositor->lamp,
                                        compositor->n_lamps,
                                        settings_scale(&compositor->settings),
                                        light.rgb, &compositor->report);
    if (status == GLINT_OK) {
        codes =
            glint_measure_encode(&light, compositor->settings.has_exposure
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

static int save(struct tool *tool, const struct explain_command *c,
                struct glint_explain *e, const struct explain_title *title)
{
    struct glint_error error = {""};
    struct glint_image marked = {.plane = {NULL}};
    enum glint_status status = explain_mark(e, title, &c->image, &marked);

    if (status == GLINT_OK)
        status = glint_picture_save(c->output, &marked, &error);
    free(marked.plane[0]);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

static int tell(struct tool *tool, struct explain_command *c, bool linear)
{
    struct compositor *compositor = &c->compositor;
    const struct explain_title title = {.lens = compositor->settings.lens.name,
                                        .lamp = compositor->lamp,
                                        .n_lamps = compositor->n_lamps,
                                        .linear = linear,
                                        .order =
                                            (enum glint_explain_order)c->order,
                                        .top = c->top,
                                        .report = &compositor->report};
    const double unit =
        linear && compositor->frame.scale > 0
            ? settings_scale(&compositor->settings) / compositor->frame.scale
            : 1;
    struct glint_explain e;
    const enum glint_status status =
        glint_explain_open(&e, &compositor->frame, unit);
    int code = EXIT_OK;

    if (status != GLINT_OK)
        code = tool_fail(tool, status, NULL);
    else if (tool->json)
        explain_json(&e, &title);
    else
        explain_print(&e, &title);
    if (status == GLINT_OK && compositor->n_lamps == 0 && !tool->quiet)
        overlay_say_none(compositor, stderr);
    if (code == EXIT_OK && c->output)
        code = save(tool, c, &e, &title);
    glint_explain_close(&e);
    return code;
}

static int run(struct tool *tool, struct explain_command *c)
{
    const bool linear =
        c->picture == LINEAR || (c->picture == AUTO && c->width);
    struct glint_error error = {""};
    enum glint_status status;
    int code;

    if (c->output && tool_check_output(tool, c->output) != EXIT_OK)
        return EXIT_OUTPUT;
    if (c->output && glint_picture_check(c->output, GLINT_PICTURE_8BIT,
                                         &error) != GLINT_OK) {
        tool_fail(tool, GLINT_E_OUTPUT, error.text);
        return EXIT_OUTPUT;
    }
    code = compositor_open(tool, &c->compositor);
    if (code == EXIT_OK)
        code = load(tool, c);
    if (code == EXIT_OK)
        code = compositor_size(tool, &c->compositor, c->image.width,
                               c->image.height);
    if (code != EXIT_OK)
        return code;
    status =
        linear ? draw_linear(c) : compositor_draw(&c->compositor, &c->image, 0);
    if (status != GLINT_OK)
        return tool_fail(tool, status, NULL);
    code = compositor_finish(tool, &c->compositor);
    return code == EXIT_OK ? tell(tool, c, linear) : code;
}

int cmd_explain(int argc, char **argv)
{
    struct tool tool = {.name = "explain",
                        .help = help,
                        .help_end = help_end,
                        .help_last = help_last};
    struct explain_command *c = calloc(1, sizeof *c);
    int code;

    if (!c)
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    compositor_defaults(&c->compositor);
    c->top = 20;
    code = parse(&tool, argc, argv, c);
    if (code < 0) {
        code = tool_start(&tool);
        if (code == EXIT_OK)
            code = run(&tool, c);
        tool_finish(&tool);
    }
    compositor_close(&c->compositor);
    free(c->image.plane[0]);
    free(c);
    return code;
}
