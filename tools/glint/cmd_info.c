/* SPDX-License-Identifier: MIT
 *
 * glint info: prints the data of a lens table, model, scene, environment,
 * motion or translucent medium.
 */
#include <stdlib.h>
#include <string.h>

#include "model/coating.h"
#include "options/command_line.h"
#include "options/json_writer.h"
#include "model/model_file.h"
#include "model/model_report.h"
#include "model/table_file.h"
#include "model/zoom_option.h"
#include "options/tool.h"
#include "scenes/baked_scene.h"
#include "scenes/environment_file.h"
#include "motions/motion_file.h"
#include "stones/stone_file.h"

static const char help[] =
    "glint info LENS|MODEL|SCENE|ENVIRONMENT|TRANSLUCENT|MOTION [--json] [-v]\n"
    "           [--zoom Z] [--focus M] [--f-number N] [--coating C]\n"
    "           [--poses FILE.csv]\n"
    "\n"
    "Prints the contents of a file:\n"
    "scene (NAME.scene or baked): objects, triangles, bytes of each section\n"
    "environment (panorama or baked): texels, lights\n"
    "translucent medium (NAME.translucent or baked): model, bits, bytes per "
    "texel\n"
    "motion (recording .json or baked): frames, landmarks, residuals\n"
    "lens: focal length, back focal length, entrance pupil, stop radius at "
    "the\n"
    "    f-number, surfaces, and ghosts with their pairs of surfaces (counted "
    "from\n"
    "    0 at the front, without the stop); first-order values are for the d "
    "line,\n"
    "    587.56 nm\n"
    "baked model: also the band of wavelengths, the angles, the cost of each "
    "ghost\n"
    "    and the errors of its integers against exact rays: rms is the root "
    "mean\n"
    "    square over all zones, p50 a mean over zones; p99, max, bound and "
    "rounding\n"
    "    are those of the worst zone. bound: proven limit of all intermediate\n"
    "    results, which the integers can hold; rounding: proven limit of the "
    "error of\n"
    "    rounding. Sensor positions are in pixels of a picture 1920 pixels "
    "wide\n"
    "\n"
    "  --f-number N        stop the lens down to f/N first; not for a "
    "model\n" ZOOM_HELP COATING_HELP
    "  --poses FILE.csv    write the poses of a motion, one line per frame\n"
    "  -v                  of a table: list the films of each surface; of a "
    "model:\n"
    "                      list each zone\n"
    "  --json              print one JSON object\n";

struct info {
    struct glint_prescription lens;
    struct glint_optics optics;
    struct glint_ghost ghost[GLINT_MAX_GHOSTS];
    int n_ghosts;
};

static void print_lens_json(const struct info *info)
{
    const struct glint_prescription *const l = &info->lens;
    const struct glint_optics *const o = &info->optics;
    struct json_writer json = {.to = stdout};

    json_write(&json,
               "{name: %s, source: %s, focal_length_mm: %.6f, "
               "back_focal_length_mm: %.6f, entrance_pupil_radius_mm: %.6f, "
               "entrance_pupil_z_mm: %.6f, stop_radius_mm: %.6f, f_number: %g, "
               "widest_f_number: %.4g, length_mm: %.6f, image_scale_mm: %.6f, "
               "squeeze: %.6f, focal_length_across_mm: %.6f, positions_mm: [",
               l->name, l->source, o->focal_mm, o->back_focal_mm,
               o->entrance_radius_mm, o->entrance_z_mm, o->stop_radius_mm,
               l->f_number, glint_prescription_widest(l), o->length_mm,
               o->scale_mm, o->squeeze, o->focal_mm / o->squeeze);
    for (int k = 0; k < l->zoom.n_positions; k++)
        json_write(&json, "%.6f", l->zoom.focal_mm[k]);
    json_write(&json,
               "], film_mm: [%g, %g], surfaces: %d, surfaces_before_stop: %d, "
               "ghosts: %d, ghost_pairs: [",
               l->film_width_mm, l->film_height_mm, l->n_surfaces,
               l->stop_after, info->n_ghosts);
    for (int k = 0; k < info->n_ghosts; k++)
        json_write(&json, "[%d, %d]", info->ghost[k].i, info->ghost[k].j);
    json_write(&json, "]}\n");
}

static void print_zoom_and_focus(const struct glint_prescription *l,
                                 const struct glint_optics *o)
{
    const struct glint_zoom *const z = &l->zoom;

    if (z->n_positions) {
        printf(
            "zoom                %10.4f of its range; columns of the table at",
            l->zoom_along);
        for (int k = 0; k < z->n_positions; k++)
            printf("%s %.3f", k ? "," : "", z->focal_mm[k]);
        printf(" mm\n");
    }
    if (l->focus_m > 0)
        printf("focus               %10.4g m from the sensor, by moving %s\n"
               "image scale         %10.3f mm, the focal length of an "
               "equivalent lens at infinity\n",
               l->focus_m, l->n_focus ? "a group" : "the whole lens",
               o->scale_mm);
}

static void print_lens_text(const struct info *info)
{
    const struct glint_prescription *l = &info->lens;
    const struct glint_optics *o = &info->optics;

    printf("%s\n%s\n\n", l->name, l->source);
    printf("focal length        %10.3f mm", o->focal_mm);
    if (!glint_prescription_is_round(l))
        printf(" up and down, %.3f mm across: squeeze %.4g",
               o->focal_mm / o->squeeze, o->squeeze);
    printf("\n");
    print_zoom_and_focus(l, o);
    printf("back focal length   %10.3f mm\n", o->back_focal_mm);
    printf("entrance pupil      %10.3f mm radius, %.3f mm behind the front\n",
           o->entrance_radius_mm, o->entrance_z_mm);
    printf("stop                %10.4f mm radius at f/%g, opens to f/%.3g\n",
           o->stop_radius_mm, l->f_number, glint_prescription_widest(l));
    printf("front to sensor     %10.3f mm\n", o->length_mm);
    printf("film                %6gx%g mm\n", l->film_width_mm,
           l->film_height_mm);
    printf("surfaces            %6d before the stop, %d after\n", l->stop_after,
           l->n_surfaces - l->stop_after);
    printf("ghosts              %6d: ", info->n_ghosts);
    for (int k = 0; k < info->n_ghosts; k++)
        printf("%s%d:%d-%d",
               k == 0  ? ""
               : k % 8 ? "  "
                       : "\n"
                         "        ",
               k, info->ghost[k].i, info->ghost[k].j);
    printf("\n");
}

static void print_lens_coatings(const struct glint_prescription *l)
{
    printf("\nsurface  reflects of 450, 550, 650 nm    film\n");
    for (int k = 0; k < l->n_surfaces; k++) {
        static const double nm[3] = {450, 550, 650};
        const struct glint_surface *s = &l->surface[k], *before = s - 1;
        struct glint_film_at film[GLINT_MAX_FILMS];

        printf("%7d ", k);
        for (int i = 0; i < 3; i++)
            printf(" %6.2f %%",
                   100 * glint_reflectance(
                             k ? glint_surface_index(before, nm[i]) : 1,
                             glint_surface_index(s, nm[i]), 1, film,
                             glint_coating_at(&s->coating, nm[i], film)));
        printf("    ");
        coating_print(stdout, &s->coating);
        printf("\n");
    }
}

static int print_model_info(const struct tool *tool, const char *path,
                            const struct zoom_option *zoom)
{
    struct model_file model;
    int code = tool_open_model(tool, path, &model);

    if (code != EXIT_OK)
        return code;
    if (model.zoom && zoom->is_zoomed)
        code = tool_usage(tool,
                          "%s is a zoom model: info prints its first position "
                          "and does not accept --zoom",
                          path);
    else
        code = zoom_option_reject_for_model(tool, zoom, path);
    if (code == EXIT_OK)
        model_report_print_info(tool, &model);
    model_file_close(&model);
    return code;
}

static int print_scene_info(const struct tool *tool, const char *path)
{
    struct baked_scene scene;
    const int code = baked_scene_open(tool, path, &scene);

    if (code != EXIT_OK)
        return code;
    baked_scene_print_contents(tool, &scene);
    baked_scene_close(&scene);
    return EXIT_OK;
}

static int print_environment_info(const struct tool *tool, const char *path)
{
    struct environment_file file;
    const int code = environment_file_open(tool, path, NULL, NULL, &file);

    if (code != EXIT_OK)
        return code;
    environment_file_print_contents(tool, &file);
    environment_file_close(&file);
    return EXIT_OK;
}

static int print_motion_info(const struct tool *tool, const char *path,
                             const char *poses)
{
    struct motion_file file;
    int code = motion_file_open(tool, path, &file);

    if (code != EXIT_OK)
        return code;
    if (poses)
        code = motion_file_write_poses(tool, &file, poses);
    if (code == EXIT_OK && !(poses && strcmp(poses, "-") == 0))
        motion_file_print_contents(tool, &file);
    motion_file_close(&file);
    return code;
}

struct asked {
    double f_number; /* --f-number; 0: that of the table */
    struct coating coating;
    struct zoom_option zoom;
    const char *poses; /* --poses: file for the poses of a motion; NULL: none */
};

static int parse_option(struct tool *tool, void *ctx, int c, const char *value)
{
    struct asked *const asked = ctx;
    bool good = true;

    if (c == 'f')
        good = tool_parse_number(value, &asked->f_number);
    else if (c == 'z')
        good = zoom_option_parse(&asked->zoom, value);
    else if (c == 'F')
        good = zoom_option_parse_focus(&asked->zoom, value);
    else if (c == 'p')
        asked->poses = value;
    else
        return c == 'c' ? coating_parse_option(tool, &asked->coating, value)
                        : tool_apply_option(tool, c, value);
    return good ? -1 : -2;
}

static int parse_options(struct tool *tool, int argc, char **argv,
                         struct asked *asked)
{
    static const struct option options[] = {
        {"f-number", required_argument, NULL, 'f'},
        {"coating", required_argument, NULL, 'c'},
        ZOOM_OPTIONS('z', 'F'),
        {"poses", required_argument, NULL, 'p'},
        TOOL_COMMON_OPTIONS};
    const int code = tool_parse_options(tool, argc, argv, TOOL_COMMON_SHORT,
                                        options, parse_option, asked);

    return code >= 0
               ? code
               : tool_check_inputs(tool, argc, argv, 1, "expects one lens");
}

static int print_medium_info(const struct tool *tool, const char *path)
{
    struct glint_error error = {""};
    struct stone_file file;
    const enum glint_status status =
        stone_file_read(tool, path, NULL, NULL, false, NULL, &file, &error);

    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    stone_file_print_contents(tool, &file);
    stone_file_close(&file);
    return EXIT_OK;
}

/* Prints the contents of PATH if it is a model, scene, environment, medium or
 * motion. STOP: whether the command line has lens options; such files reject
 * them. Returns an exit code, or -1 if PATH is none of these files. */
static int print_non_lens_file_info(const struct tool *tool, const char *path,
                                    bool stop, const char *poses)
{
    const bool is_motion =
        motion_file_is_source(path) || motion_file_is_baked(path);
    const bool is_scene = !is_motion && baked_scene_is_file(path);
    const bool is_around =
        !is_motion && !is_scene &&
        (environment_file_is_source(path) || environment_file_is_baked(path));
    const bool is_stone =
        !is_motion && !is_scene && !is_around &&
        (stone_file_is_text(path) || stone_file_is_baked(path));

    if (stop && (is_motion || is_scene || is_around || is_stone))
        return tool_usage(
            tool, "%s is not a lens: --f-number and --coating do not apply",
            is_motion   ? "a motion"
            : is_scene  ? "a scene"
            : is_around ? "an environment"
                        : "a translucent medium");
    if (is_motion)
        return print_motion_info(tool, path, poses);
    if (poses)
        return tool_usage(tool, "--poses needs a motion");
    return is_scene    ? print_scene_info(tool, path)
           : is_around ? print_environment_info(tool, path)
           : is_stone  ? print_medium_info(tool, path)
                       : -1;
}

static int print_lens_table_info(const struct tool *tool, const char *path,
                                 const struct asked *asked, struct info *info)
{
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;
    int code = tool_read_lens(tool, path, &info->lens);

    if (code == EXIT_OK)
        code = zoom_option_apply(tool, &asked->zoom, &info->lens);
    if (code != EXIT_OK)
        return code;
    coating_apply(&asked->coating, &info->lens);
    if (asked->f_number != 0)
        status = glint_prescription_set_f_number(&info->lens, asked->f_number,
                                                 &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    glint_optics_of(&info->lens, &info->optics);
    info->n_ghosts =
        glint_ghost_list(&info->lens, info->ghost, GLINT_MAX_GHOSTS);
    (tool->json ? print_lens_json : print_lens_text)(info);
    if (!tool->json && tool->verbose)
        print_lens_coatings(&info->lens);
    return EXIT_OK;
}

int cmd_info(int argc, char **argv)
{
    struct tool tool = {.name = "info", .help = help};
    struct asked asked = {.f_number = 0};
    struct info *info;
    int code = parse_options(&tool, argc, argv, &asked);

    if (code >= 0)
        return code;
    code = print_non_lens_file_info(
        &tool, argv[optind],
        asked.f_number != 0 || asked.zoom.is_zoomed || asked.zoom.is_focused ||
            asked.coating.given,
        asked.poses);
    if (code >= 0)
        return code;
    if (tool_is_model(argv[optind]) &&
        coating_reject_option_for_model(&tool, &asked.coating, argv[optind]) !=
            EXIT_OK)
        return EXIT_USAGE;
    if (tool_is_model(argv[optind]))
        return asked.f_number != 0
                   ? tool_usage(&tool, "the f-number of a model is fixed by "
                                       "its bake (glint bake --f-number)")
                   : print_model_info(&tool, argv[optind], &asked.zoom);
    info = calloc(1, sizeof *info);
    if (!info)
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    code = print_lens_table_info(&tool, argv[optind], &asked, info);
    free(info);
    return code;
}
