/* SPDX-License-Identifier: MIT
 *
 * glint render: draws a flare without an input image, in linear light.
 */
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "overlay/apart.h"
#include "desk/render_file.h"
#include "glint/area.h"
#include "lamp_files/lamp_list.h"
#include "glint/measure.h"
#include "posix/error.h"
#include "model/settings.h"
#include "options/command_line.h"
#include "render/render_scene.h"

static const char help[] =
    "glint render LENS|MODEL -o OUT --light "
    "THETA,PHI[,POWER[,R,G,B[,SIZE]]]... [options]\n"
    "glint render LENS|MODEL -o OUT --lights FILE [options]\n"
    "glint render NAME.scene|BAKED -o OUT [options]; see glint render x.scene "
    "--help\n"
    "\n"
    "Draws the ghosts of a lens alone, from its table by exact rays, or from "
    "its\n"
    "baked model. Values are linear: a\n"
    "light of POWER 1 with its in-focus image on one pixel gives 1. OUT is "
    ".pfm,\n"
    "or with the image plug-in .exr or .hdr: linear values. A .ppm, .png or "
    ".jpg\n"
    "is encoded to sRGB with the 99.9th percentile of luminance at 1, or by\n"
    "--exposure.\n"
    "\n"
    "  -o, --output OUT\n"
    "  --size WxH          default 960x540\n"
    "  --light LIST        degrees off the axis, degrees about it (0 = right,\n"
    "                      90 = up), power (default 1), colour; repeatable\n"
    "  --lights FILE       lights of frame 0 of a list (format: glint "
    "overlay), up\n"
    "                      to a million\n"
    "  --engine E          model: the integer run time (default)\n"
    "                      exact: the reference renderer, every ray in "
    "double\n";

struct render {
    struct settings settings;
    struct opened_lens lens;
    const char *output;
    struct json_writer json;
    bool linear; /* the output format stores floats */
    int width, height;
    bool exact;
    const char *lights_file;
    int n_lamps;
    /* lamps of --light, at most SETTINGS_MAX_LAMPS, then those of the --lights
     * file */
    struct glint_lamp *lamp;
    struct glint_float_image image;
    double ms;
};

static int parse_option(struct tool *tool, struct render *r, int c)
{
    static const char *const engines[] = {"model", "exact", NULL};
    int word;

    switch (c) {
    case 'o':
        r->output = optarg;
        return -1;
    case 's':
        if (tool_parse_size(optarg, &r->width, &r->height))
            return -1;
        return tool_usage(tool,
                          "--size must be WxH of 1 to %d pixels, not '%s'",
                          GLINT_MAX_SIDE, optarg);
    case 'l':
        if (r->n_lamps == SETTINGS_MAX_LAMPS)
            return tool_usage(tool, "more than %d lights", SETTINGS_MAX_LAMPS);
        if (glint_option_light(optarg, &r->lamp[r->n_lamps++])) {
            r->settings.max_deg =
                fmax(r->settings.max_deg, r->lamp[r->n_lamps - 1].theta_deg);
            return -1;
        }
        return tool_usage(tool,
                          "--light must be THETA,PHI[,POWER[,R,G,B[,SIZE]]] "
                          "with THETA 0 to 89.9, not '%s'",
                          optarg);
    case 'f':
        r->lights_file = optarg;
        return -1;
    case 'e':
        word = tool_find_word_index(optarg, engines);
        r->exact = word == 1;
        if (r->exact)
            r->settings.options.rays = GLINT_RAYS_EXACT;
        GLINT_OPTION_GIVEN(&r->settings.options, rays) = true;
        return word >= 0 ? -1 : tool_report_bad_value(tool, "engine", optarg);
    default:
        return tool_apply_option(tool, c, optarg);
    }
}

static int parse_options(struct tool *tool, int argc, char **argv,
                         struct render *r)
{
    static const struct option own[] = {
        {"output", required_argument, NULL, 'o'},
        {"size", required_argument, NULL, 's'},
        {"light", required_argument, NULL, 'l'},
        {"lights", required_argument, NULL, 'f'},
        {"engine", required_argument, NULL, 'e'},
        {NULL, 0, NULL, 0}};
    const struct option *const options =
        engine_build_options(tool, ENGINE_DRAWING, &r->settings.options, own);
    int c, code;

    while ((c = tool_getopt(argc, argv, "o:" TOOL_COMMON_SHORT, options,
                            NULL)) >= 0) {
        code = settings_apply_option(tool, &r->settings, c, optarg);
        if (code == -2)
            code = parse_option(tool, r, c);
        if (code >= 0)
            return code;
    }
    code = tool_check_inputs(tool, argc, argv, 1, "expects one lens");
    if (code >= 0)
        return code;
    if (!r->output)
        return tool_usage(tool, "needs -o OUT");
    if (r->n_lamps == 0 && !r->lights_file)
        return tool_usage(tool, "needs a --light or --lights");
    if (r->settings.options.memory &&
        r->settings.options.rays == GLINT_RAYS_EXACT)
        return tool_usage(tool,
                          "--memory applies to models, not to exact rays");
    return -1;
}

/* ------------------------------------------------------------------ engines */

/* Returns the point lights that represent the lamps, several for a lamp of
 * visible extent. The caller frees them. Sets *N to their number. Returns NULL
 * without memory. */
static struct glint_lamp *split_lamps_into_points(const struct render *r,
                                                  int *n)
{
    const struct glint_view view =
        opened_lens_compute_view(&r->lens, &r->settings, r->width, r->height);
    const double pixels =
        fabs(r->lens.setup.optics.focal_mm) * view.width / view.sensor_width_mm;
    struct glint_lamp *points;
    struct glint_area area;
    int total;
    const struct glint_area_rule rule = glint_area_rule_of(
        r->lamp, r->n_lamps, pixels,
        r->settings.options.area_samples ? r->settings.options.area_samples
                                         : r->settings.dials.area_points,
        INT_MAX, &total);

    *n = 0;
    points = malloc(((size_t)total + 1) * sizeof *points);
    for (int lamp = 0; points && lamp < r->n_lamps; lamp++) {
        const int more = glint_area_plan(&area, &r->lamp[lamp], &rule);

        for (int i = 0; i < more; i++)
            points[(*n)++] = glint_area_point(&area, i);
    }
    return points;
}

static int render_exact_rays(struct tool *tool, struct render *r)
{
    const size_t n = 3 * (size_t)r->width * (size_t)r->height;
    struct tool_progress progress;
    int n_points = 0;
    struct glint_lamp *points = split_lamps_into_points(r, &n_points);
    struct glint_exact_config cfg = {
        .setup = &r->lens.setup,
        .view = opened_lens_compute_view(&r->lens, &r->settings, r->width,
                                         r->height),
        .lamps = points,
        .n_lamps = n_points,
        .grid = settings_has_grid_option(&r->settings)
                    ? (r->settings.dials.fineness + 1) / 2 * 2
                    : 512,
        .only_ghost = settings_get_selected_ghost(&r->settings),
        .tints = r->lens.tints,
        .workers = tool->workers,
        .progress = tool_progress_show,
        .progress_ctx = &progress};
    const int n_ghosts = settings_get_selected_ghost(&r->settings) < 0
                             ? r->lens.setup.n_ghosts
                             : 1;
    double *rgb = malloc(n * sizeof *rgb);
    enum glint_status status = GLINT_E_MEMORY;

    tool_progress_start(&progress, tool, "exact");
    if (rgb && points)
        status = glint_exact_render(&cfg, rgb);
    tool_progress_end(&progress);
    for (size_t i = 0; status == GLINT_OK && i < n; i++)
        r->image.rgb[i] =
            (float)(rgb[i] * settings_compute_brightness_scale(&r->settings));
    free(rgb);
    free(points);
    if (status != GLINT_OK)
        return tool_fail(tool, status, NULL);
    if (tool->json)
        json_write(&r->json,
                   "{engine: %s, grid: %d, lights: %d, ghosts: %d, "
                   "bundles: %" PRId64 ", primitives: 0, tiles: 0, "
                   "arena_bytes: 0, star_bytes: 0",
                   "exact", cfg.grid, r->n_lamps, n_ghosts,
                   (int64_t)r->n_lamps * n_ghosts * r->settings.n_wavelengths);
    return EXIT_OK;
}

static void print_light_statistics(const struct tool *tool,
                                   const struct glint_engine_report *report)
{
    char lights[64];

    settings_print_light_warnings(tool, report);
    if (!tool->verbose || tool->quiet)
        return;
    settings_write_light_counts(report, lights);
    fprintf(stderr,
            "%s, %d ghosts, %d edges of ray cells; flare memory %zu bytes\n",
            lights, report->ghosts, report->stats.primitives,
            report->arena_bytes + report->star_bytes);
}

static const char *get_ray_method_name(const struct render *r,
                                       const char *model, const char *exact)
{
    return r->lens.model.data ? model : exact;
}

static int render_model_flare(struct tool *tool, struct render *r)
{
    struct glint_engine_report report = {.lights = 0};
    struct glint_engine_config cfg;
    struct glint_engine *engine;
    struct glint_error error = {""};
    struct tool_progress progress;
    enum glint_status status;

    tool_progress_start(&progress, tool, "exact rays");
    progress.least_s = 3;
    progress.waits = true;
    opened_lens_configure_engine(tool, &r->lens, &r->settings, r->width,
                                 r->height, &cfg);
    cfg.light.by_hand = 1;
    cfg.search.max_found = 0;
    cfg.drawing.is_fresh = 1;
    cfg.search.more_lamps = r->n_lamps;
    cfg.search.max_drawn = cfg.drawing.dials.max_lights;
    if (!r->lens.model.data) {
        cfg.drawing.progress = tool_progress_show;
        cfg.drawing.progress_ctx = &progress;
    }
    status = glint_engine_create(&engine, &cfg, &error);
    if (status == GLINT_OK)
        status = glint_engine_render(
            engine, r->lamp, r->n_lamps,
            settings_compute_brightness_scale(&r->settings),
            GLINT_ENGINE_ALL | GLINT_ENGINE_CORES, r->image.rgb, &report);
    glint_engine_destroy(engine);
    tool_progress_end(&progress);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    if (tool->json) {
        json_write(&r->json, "{engine: %s, rays: %s", "model",
                   get_ray_method_name(r, "model", "exact"));
        settings_write_json(&r->json, &report);
    }
    print_light_statistics(tool, &report);
    return EXIT_OK;
}

/* Appends the lamps of frame 0 of the --lights file to those of --light. */
static int append_lamps_of_file(struct tool *tool, struct render *r)
{
    const struct glint_view view =
        opened_lens_compute_view(&r->lens, &r->settings, r->width, r->height);
    struct glint_error error = {""};
    struct lamp_list list;
    const enum glint_status status =
        lamp_list_read(&list, r->lights_file, &error);
    struct glint_engine_lamp *read;
    struct glint_lamp *all;
    int code;

    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    all = realloc(r->lamp,
                  ((size_t)r->n_lamps + (size_t)list.n + 1) * sizeof *all);
    r->lamp = all ? all : r->lamp;
    read = malloc(((size_t)list.n + 1) * sizeof *read);
    if (all && read) {
        const int n = lamp_list_get_frame(
            &list, 0, &view, r->lens.setup.optics.focal_mm, read, list.n);

        for (int i = 0; i < n; i++)
            r->lamp[r->n_lamps++] = read[i].lamp;
    }
    code = all && read ? EXIT_OK : tool_fail(tool, GLINT_E_MEMORY, NULL);
    free(read);
    lamp_list_free(&list);
    return code;
}

/* Rejects an output that would overwrite LENS or an input file of an option. */
static int check_output_differs_from_inputs(const struct tool *tool,
                                            const struct render *r,
                                            const char *lens)
{
    struct apart files = {.n_read = 0};

    file_conflicts_add_input(&files, NULL, lens);
    file_conflicts_add_input(&files, "--lights", r->lights_file);
    file_conflicts_add_input(&files, "--ghosts", r->settings.options.ghosts);
    file_conflicts_add_input(&files, "--stop-mask",
                             r->settings.options.stop_mask);
    file_conflicts_add_output(&files, "-o", r->output);
    return file_conflicts_check_outputs(tool, &files);
}

static int render_lens_flare(struct tool *tool, struct render *r,
                             const char *lens)
{
    int code = check_output_differs_from_inputs(tool, r, lens);
    char what[sizeof r->lens.table.name + 16];
    double start;

    if (code == EXIT_OK)
        code = render_file_check_path(tool, r->output, &r->linear);
    r->settings.unbaked = settings_choose_method_without_model(&r->settings);
    if (code == EXIT_OK)
        code = opened_lens_open(tool, &r->lens, &r->settings, lens);
    if (code == EXIT_OK && r->lights_file)
        code = append_lamps_of_file(tool, r);
    if (code != EXIT_OK)
        return code;
    start = tool_clock_s();
    r->image.width = r->width;
    r->image.height = r->height;
    r->image.rgb =
        calloc(3 * (size_t)r->width * (size_t)r->height, sizeof(float));
    if (!r->image.rgb)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    code = r->exact ? render_exact_rays(tool, r) : render_model_flare(tool, r);
    if (code == EXIT_OK)
        code = render_file_save(
            tool, r->output, r->linear, &r->image,
            GLINT_OPTION_GIVEN(&r->settings.options, exposure) ? 1 : 0);
    if (code == EXIT_OK && tool->json)
        json_write(&r->json, "ms: %.3f}\n", 1e3 * (tool_clock_s() - start));
    snprintf(what, sizeof what, "%s, %s", r->lens.table.name,
             get_ray_method_name(r, "baked model", "exact rays"));
    if (code == EXIT_OK)
        render_file_print_summary(tool, r->output, r->width, r->height, what,
                                  tool_clock_s() - start);
    free(r->image.rgb);
    return code;
}

int cmd_render(int argc, char **argv)
{
    struct tool tool = {
        .name = "render", .help = help, .help_end = COMMON_HELP};
    struct render *r = NULL;
    int code;

    if (render_has_scene(argc, argv))
        return cmd_render_scene(argc, argv);
    r = calloc(1, sizeof *r);
    if (!r || !(r->lamp = malloc(SETTINGS_MAX_LAMPS * sizeof *r->lamp))) {
        free(r);
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    }
    settings_set_defaults(&r->settings);
    r->json.to = stdout;
    r->width = 960;
    r->height = 540;
    code = parse_options(&tool, argc, argv, r);
    if (code < 0) {
        code = tool_start_threads(&tool);
        if (code == EXIT_OK)
            code = render_lens_flare(&tool, r, argv[optind]);
        tool_stop_threads(&tool);
    }
    opened_lens_close(&r->lens);
    free(r->lamp);
    free(r);
    return code;
}
