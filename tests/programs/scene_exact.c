/* SPDX-License-Identifier: MIT
 *
 * scene_exact NAME.scene -o OUT - draws a scene on black with the reference
 * renderer, which traces every ray in double precision.
 */
#include <stdlib.h>

#include "desk/render_file.h"
#include "model/settings.h"
#include "options/command_line.h"
#include "reference/scenes/twin.h"
#include "scenes/scene_file.h"

static const char help[] =
    "scene_exact NAME.scene -o OUT [options]\n"
    "\n"
    "  -o, --output OUT    .pfm: linear; .ppm: sRGB\n"
    "  --size WxH          default 960x540\n"
    "  --samples N         N x N points of a pixel, 1 to 16 (default 4)\n"
    "  --shadow-points N   1, 4 or 16 of a light's disc (default 4)\n"
    "  --ward-samples N    1 to 32 lookups of the environment for a place on\n"
    "                      brushed metal\n";

struct exact {
    const char *output;
    int width, height, samples, shadow_points, ward_samples;
};

static int parse_option(const struct tool *tool, struct exact *e, int c,
                        const char *name)
{
    bool ok = true;

    switch (c) {
    case 'o':
        e->output = optarg;
        break;
    case 's':
        ok = tool_parse_size(optarg, &e->width, &e->height);
        break;
    case 'n':
        ok = tool_parse_integer(optarg, 1, 16, &e->samples);
        break;
    case 'p':
        ok = tool_parse_integer(optarg, 1, 16, &e->shadow_points);
        break;
    case 'w':
        ok = tool_parse_integer(optarg, 1, 32, &e->ward_samples);
        break;
    default:
        return -2;
    }
    return ok ? -1 : tool_report_bad_value(tool, name, optarg);
}

static int parse_options(struct tool *tool, int argc, char **argv,
                         struct exact *e)
{
    static const struct option options[] = {
        {"output", required_argument, NULL, 'o'},
        {"size", required_argument, NULL, 's'},
        {"samples", required_argument, NULL, 'n'},
        {"shadow-points", required_argument, NULL, 'p'},
        {"ward-samples", required_argument, NULL, 'w'},
        TOOL_COMMON_OPTIONS};
    int c, at = 0;

    while ((c = tool_getopt(argc, argv, "o:" TOOL_COMMON_SHORT, options,
                            &at)) >= 0) {
        int code = parse_option(tool, e, c, options[at].name);

        if (code == -2)
            code = tool_apply_option(tool, c, optarg);
        if (code >= 0)
            return code;
    }
    if (!e->output)
        return tool_usage(tool, "needs -o OUT");
    return tool_check_inputs(tool, argc, argv, 1, "expects one scene");
}

static void print_lights_as_json(const struct glint_description *scene,
                                 const struct twin_pixel *pixels, size_t n)
{
    size_t covered = 0;

    for (size_t i = 0; i < n; i++)
        covered += pixels[i].cover > 0;
    printf("{\"engine\": \"exact\", \"scene\": {\"objects\": %d, "
           "\"triangles\": %d, \"lights\": %d, \"covered_px\": %zu}}\n",
           scene->n_objects, scene->n_triangles, scene->n_lights, covered);
}

static int render_reference_scene(const struct tool *tool,
                                  const struct exact *e,
                                  const struct glint_description *scene)
{
    const struct twin_view view = {e->width, e->height, 0, e->samples};
    const size_t n = (size_t)e->width * (size_t)e->height;
    struct twin_pixel *const pixels = malloc(n * sizeof *pixels);
    const struct glint_float_image image = {e->width, e->height,
                                            malloc(3 * n * sizeof(float))};
    struct twin twin;
    bool is_linear;
    int code = render_file_check_path(tool, e->output, &is_linear);

    if (code == EXIT_OK &&
        (!pixels || !image.rgb || reference_open(&twin, scene) != GLINT_OK))
        code = tool_fail(tool, GLINT_E_MEMORY, NULL);
    if (code == EXIT_OK) {
        twin.shadow_points = e->shadow_points;
        if (e->ward_samples)
            twin.ward_samples = e->ward_samples;
        reference_render_image(&twin, &view, tool->workers, pixels);
        reference_close(&twin);
        for (size_t i = 0; i < 3 * n; i++)
            image.rgb[i] = pixels[i / 3].rgb[i % 3];
        if (tool->json)
            print_lights_as_json(scene, pixels, n);
        code = render_file_save(tool, e->output, is_linear, &image, 1);
    }
    free(pixels);
    free(image.rgb);
    return code;
}

int main(int argc, char **argv)
{
    struct tool tool = {
        .name = "scene_exact", .help = help, .help_end = COMMON_HELP};
    struct exact e = {
        .width = 960, .height = 540, .samples = 4, .shadow_points = 4};
    struct glint_description *const scene = calloc(1, sizeof *scene);
    int code = parse_options(&tool, argc, argv, &e);

    if (code < 0)
        code = tool_start_threads(&tool);
    if (code == EXIT_OK && tool.workers && scene) {
        code = tool_read_scene(&tool, argv[optind], scene, NULL);
        if (code == EXIT_OK) {
            code = render_reference_scene(&tool, &e, scene);
            glint_description_free(scene);
        }
    }
    tool_stop_threads(&tool);
    free(scene);
    return code;
}
