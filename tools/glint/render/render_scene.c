/* SPDX-License-Identifier: MIT
 *
 * glint render of scenes: draws the objects of a scene in linear light.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "desk/render_file.h"
#include "options/command_line.h"
#include "overlay/overlay.h"
#include "render/render_scene.h"
#include "scenes/baked_scene.h"
#include "scenes/account.h"
#include "scenes/budget.h"
#include "scenes/scene_frame.h"

static const char help[] =
    "glint render NAME.scene|BAKED -o OUT [options]\n"
    "\n"
    "Draws the objects of a scene (tools/examples/scenes/README.md describes "
    "the\n"
    "format) over black with integer arithmetic. Values are linear; 1 is "
    "display\n"
    "white. OUT is .pfm, or with the image plug-in .exr or .hdr: linear "
    "values.\n"
    "A .ppm, .png or .jpg is encoded to sRGB; 1 and above are white. BAKED is "
    "a\n"
    "scene baked by glint bake; NAME.scene is baked first.\n"
    "\n"
    "  -o, --output OUT\n"
    "  --size WxH          size of the picture (default 960x540)\n"
    "  --samples N         samples per pixel at outlines: 1, 4 (default), 8 "
    "or\n"
    "                      16\n"
    "  --quality Q         0 to 1, or least ... finest: sets the options that "
    "are\n"
    "                      not given, and the quality of the flare\n"
    "  --exposure EV       multiply all light by 2^EV (default 0)\n"
    "  --pose FILE         move objects and camera by FILE, see glint overlay\n"
    "  --control FILE      change the scene by the commands in FILE, see\n"
    "                      glint overlay\n"
    "  --frame N           draw frame N of --pose and --control (default 0)\n"
    "  --frames A-B        draw frames A to B; OUT is .y4m, - or has a %04d\n"
    "  --fps N             frame rate of .y4m, and of the tracking of lamps\n"
    "                      (default 25)\n"
    "  --lens LENS|none    add the flare of LENS for the lights of a scene "
    "that\n"
    "                      has 'flare lights' (default none); the options of "
    "glint\n"
    "                      overlay apply to it: --strength, --coating, "
    "--stop,\n"
    "                      --quality, --light-at ...\n";

enum { MOST_FRAME = 1000000000 };

#define NEEDS_LENS \
    "%s: 'camera lens' needs the lens of a flare; use 'camera fov'"

enum {
    OPT_FRAME = ENGINE_OPTIONS_END,
    OPT_FRAMES,
    OPT_FPS,
    OPT_SIZE,
    OPT_SAMPLES,
    OPT_EXPOSURE_OF
};

/* Parses "A-B", the first and last frame. */
static bool parse_frame_range(struct render_scene *r, const char *text)
{
    const char *const dash = strchr(text, '-');
    char first[16];

    if (!dash || dash - text >= (ptrdiff_t)sizeof first)
        return false;
    snprintf(first, sizeof first, "%.*s", (int)(dash - text), text);
    r->is_video = r->is_frames = true;
    return tool_parse_integer(first, 0, MOST_FRAME, &r->first) &&
           tool_parse_integer(dash + 1, r->first, MOST_FRAME, &r->last);
}

/* Parses option C if it belongs to the animation. Returns -1 on success, -2 for
 * other options, else an exit code. */
static int parse_animation_option(struct tool *tool, struct render_scene *r,
                                  int c)
{
    switch (c) {
    case OPT_FRAME:
        r->is_frames = true;
        if (!tool_parse_integer(optarg, 0, MOST_FRAME, &r->first))
            return tool_report_bad_value(tool, "frame", optarg);
        r->last = r->first;
        return -1;
    case OPT_FRAMES:
        return parse_frame_range(r, optarg)
                   ? -1
                   : tool_report_bad_value(tool, "frames", optarg);
    case OPT_FPS:
        return tool_parse_number(optarg, &r->fps) && r->fps >= 1 &&
                       r->fps <= 1000
                   ? -1
                   : tool_report_bad_value(tool, "fps", optarg);
    default:
        return -2;
    }
}

static int parse_scene_option(struct tool *tool, struct render_scene *r, int c)
{
    switch (c) {
    case 'o':
        r->output = optarg;
        return -1;
    case OPT_SIZE:
        return tool_parse_size(optarg, &r->width, &r->height)
                   ? -1
                   : tool_report_bad_value(tool, "size", optarg);
    case OPT_SAMPLES:
        return tool_parse_integer(optarg, 1, 16, &r->samples)
                   ? -1
                   : tool_usage(tool,
                                "--samples accepts 1, 4, 8 or 16, not '%s'",
                                optarg);
    case OPT_EXPOSURE_OF:
        return tool_parse_number(optarg, &r->exposure_ev) &&
                       fabs(r->exposure_ev) <= 100
                   ? -1
                   : tool_report_bad_value(tool, "exposure", optarg);
    default:
        return tool_apply_option(tool, c, optarg);
    }
}

/* Parses option C, an option of scenes or of the flare. Returns -1 or an exit
 * code. */
static int parse_any_option(struct tool *tool, struct render_scene *r, int c)
{
    int code = drawing_line_set_option(tool, &r->drawing.line, c, optarg);

    if (code == -1) {
        const enum glint_option_group group =
            glint_option(c - ENGINE_OPTION)->group;
        const bool moves =
            c == ENGINE_OPTION_OF(pose) || c == ENGINE_OPTION_OF(control);
        const bool is_lens = c == ENGINE_OPTION_OF(lens);

        r->is_frames = r->is_frames || moves || is_lens;
        r->is_lit = r->is_lit ||
                    (!is_lens && !moves && group != GLINT_OPTIONS_SHADING &&
                     c != ENGINE_OPTION_OF(highlights) &&
                     c != ENGINE_OPTION_OF(quality));
    }
    if (code == -2)
        code = parse_animation_option(tool, r, c);
    return code == -2 ? parse_scene_option(tool, r, c) : code;
}

static int parse_command_line(struct tool *tool, int argc, char **argv,
                              struct render_scene *r)
{
    static const struct option own[] = {
        {"output", required_argument, NULL, 'o'},
        {"size", required_argument, NULL, OPT_SIZE},
        {"samples", required_argument, NULL, OPT_SAMPLES},
        {"exposure", required_argument, NULL, OPT_EXPOSURE_OF},
        {"frame", required_argument, NULL, OPT_FRAME},
        {"frames", required_argument, NULL, OPT_FRAMES},
        {"fps", required_argument, NULL, OPT_FPS},
        {NULL, 0, NULL, 0}};
    const struct option *const options = engine_build_options(
        tool, ENGINE_ALL, &r->drawing.line.settings.options, own);
    struct scene_dials *const asked = &r->drawing.line.scene_dials;
    int c, code = drawing_line_apply_command_style(tool, &r->drawing.line, argc,
                                                   argv, "o:" TOOL_COMMON_SHORT,
                                                   options);

    if (code >= 0)
        return code;
    while ((c = tool_getopt(argc, argv, "o:" TOOL_COMMON_SHORT, options,
                            NULL)) >= 0)
        if ((code = parse_any_option(tool, r, c)) >= 0)
            return code;
    code = tool_check_inputs(tool, argc, argv, 1, "expects one scene");
    if (code >= 0)
        return code;
    if (!r->output)
        return tool_usage(tool, "needs -o OUT");
    if (r->samples && r->samples != 1 && r->samples != 4 && r->samples != 8 &&
        r->samples != 16)
        return tool_usage(tool, "--samples accepts 1, 4, 8 or 16, not %d",
                          r->samples);
    if (!GLINT_OPTION_GIVEN(&r->drawing.line.settings.options, quality)) {
        r->samples = r->samples ? r->samples : 4;
        asked->is_bounded = !asked->shadow_points;
        if (!asked->shadow_points)
            asked->shadow_points = 4;
    }
    if (strcmp(r->drawing.line.settings.options.lens, "none") != 0)
        r->is_frames = true;
    else if (r->is_lit)
        return tool_usage(tool, "flare options need --lens LENS");
    return -1;
}

/* ---------------------------------------------------------- the run time */

/* Returns the number of scene lights that add to the flare but are completely
 * occluded. */
static int count_hidden_lights(const struct scene_frame *frame)
{
    struct glint_scene_lamp lamp[GLINT_SCENE_MAX_LIGHTS];
    const int n = glint_scene_lights(frame->scene, lamp);
    int hidden = 0;

    for (int i = 0; i < n; i++)
        hidden += lamp[i].share == 0;
    return hidden;
}

static void print_frame_json(const struct tool *tool,
                             const struct scene_frame *frame,
                             const struct scene_dials *dials, double ms)
{
    struct json_writer json = {.to = stdout};
    struct scene_budget budget;

    if (!tool->json)
        return;
    scene_budget_init(&budget, dials);
    json_write(&json, "{engine: %s, scene: {", "model");
    scene_account_write_json(&json, frame, frame->model->header->bytes);
    json_write(&json, "quality: %.3f, lights: %u",
               scene_budget_get_flare_quality(&budget),
               frame->model->header->n_lights);
    scene_write_highlights_json(&json, frame);
    json_write(&json, "lamps_hidden: %d}, ms: %.3f}\n",
               count_hidden_lights(frame), ms);
}

/* Prints a note if the scene has a shadow catcher, because its shadows are
 * invisible over black. */
static void print_catcher_note(const struct tool *tool,
                               const struct glint_scene_model *model)
{
    const struct glint_scene_object *catcher = NULL;

    for (uint32_t i = 0; i < model->header->n_objects; i++)
        if (model->object[i].catcher_q15)
            catcher = &model->object[i];
    if (catcher && model->header->background == GLINT_BACKGROUND_CAMERA &&
        !tool->quiet)
        fprintf(stderr,
                "glint render: '%s' receives shadows only, which are invisible "
                "over black; use glint overlay PHOTO --scene\n",
                catcher->name);
}

/* Renders MODEL over black into r->image, linear light. */
static int render_model_to_image(struct tool *tool, struct render_scene *r,
                                 const struct glint_scene_model *model)
{
    struct scene_dials dials = r->drawing.line.scene_dials;
    const size_t n = 3 * (size_t)r->width * (size_t)r->height;
    int32_t *light_q20 = calloc(n, sizeof *light_q20);
    const double start = tool_clock_s();
    struct scene_frame frame;
    int code;

    if (!light_q20)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    print_catcher_note(tool, model);
    dials.width = r->width;
    dials.height = r->height;
    dials.edge_samples = r->samples;
    if (GLINT_OPTION_GIVEN(&r->drawing.line.settings.options, quality))
        scene_dials_set_quality(&dials,
                                r->drawing.line.settings.options.quality);
    code = scene_frame_open(&frame, tool, model, &dials);
    if (code == EXIT_OK) {
        const struct glint_image linear =
            glint_image_over(light_q20, GLINT_LINEAR_Q20, r->width, r->height);

        code = scene_frame_draw(&frame, &linear);
        if (code == EXIT_OK)
            print_frame_json(tool, &frame, &dials,
                             1e3 * (tool_clock_s() - start));
        scene_frame_close(&frame);
    }
    for (size_t i = 0; code == EXIT_OK && i < n; i++)
        r->image.rgb[i] =
            (float)ldexp(exp2(r->exposure_ev) * light_q20[i], -20);
    free(light_q20);
    return code;
}

static int render_model_file(struct tool *tool, struct render_scene *r,
                             const char *path)
{
    struct baked_scene scene;
    int code = baked_scene_open(tool, path, &scene);

    if (code != EXIT_OK)
        return code;
    code = scene.model.header->camera.kind == GLINT_CAMERA_LENS
               ? tool_usage(tool, NEEDS_LENS, path)
               : render_model_to_image(tool, r, &scene.model);
    baked_scene_close(&scene);
    return code;
}

/* ----------------------------------------------------------- the command */

static int render_scene_file(struct tool *tool, struct render_scene *r,
                             const char *path)
{
    const double start = tool_clock_s();
    int code = r->is_frames && overlay_is_video(r->output)
                   ? EXIT_OK
                   : render_file_check_path(tool, r->output, &r->linear);

    tool->written = r->output;
    if (code != EXIT_OK)
        return code;
    r->image = (struct glint_float_image){
        r->width, r->height,
        malloc(3 * (size_t)r->width * (size_t)r->height * sizeof(float))};
    if (!r->image.rgb)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    if (r->is_frames)
        code = render_frames(tool, r, path);
    else
        code = render_model_file(tool, r, path);
    if (code == EXIT_OK && !r->is_frames)
        code = render_file_save(tool, r->output, r->linear, &r->image, 1);
    if (code == EXIT_OK && !r->is_frames)
        render_file_print_summary(tool, r->output, r->width, r->height, path,
                                  tool_clock_s() - start);
    free(r->image.rgb);
    return code;
}

bool render_has_scene(int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        if (argv[i][0] != '-' && baked_scene_is_file(argv[i]))
            return true;
    return false;
}

int cmd_render_scene(int argc, char **argv)
{
    struct tool tool = {
        .name = "render", .help = help, .help_end = COMMON_HELP};
    struct render_scene *const r = calloc(1, sizeof *r);
    int code;

    if (!r)
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    r->width = 960;
    r->height = 540;
    r->fps = 25;
    drawing_line_set_defaults(&r->drawing.line);
    r->drawing.line.settings.options.lens = "none";
    code = parse_command_line(&tool, argc, argv, r);
    if (code < 0) {
        code = tool_start_threads(&tool);
        if (code == EXIT_OK)
            code = render_scene_file(&tool, r, argv[optind]);
        tool_stop_threads(&tool);
    }
    drawing_close(&r->drawing);
    free(r);
    return code;
}
