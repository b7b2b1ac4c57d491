/* SPDX-License-Identifier: MIT
 *
 * glint trace: prints rays as a table, traced exactly or computed by a model.
 */
#include <stdlib.h>
#include <string.h>
#include <math.h>

#include "model/coating.h"
#include "model/model_file.h"
#include "model/table_file.h"
#include "model/zoom_option.h"
#include "options/command_line.h"
#include "options/tool.h"

static const char help[] =
    "glint trace LENS --ghost K --angle DEG --wavelength NM --grid N\n"
    "            [--pupil] [--model MODEL] [--coating C] [--zoom Z] [--focus "
    "M]\n"
    "\n"
    "Prints one line per ray of an N x N grid over the square around the "
    "clear\n"
    "aperture of the front element, x fastest:\n"
    "  px,py,status,stop_x,stop_y,sensor_x,sensor_y,energy,rel_radius\n"
    "Positions are in mm; energy is the fraction 0 .. 1 of the ray's light "
    "that is\n"
    "left; rel_radius is the max over the surfaces of (distance from the axis "
    "/\n"
    "semi-diameter). Status 0: ok, 1: missed a surface, 2: total reflection; "
    "for\n"
    "1 and 2 the columns after it are empty. The light lies in the x-z "
    "plane.\n"
    "\n"
    "  --ghost K        number of the ghost in 'glint info'; -1: the direct "
    "path\n"
    "                   (default 0)\n"
    "  --angle DEG      angle off the axis in degrees, below 90 (default 0)\n"
    "  --wavelength NM  default 532\n"
    "  --grid N         1 to 4096 rays a side (default 17)\n"
    "  --pupil          span the grid over the entrance pupil of this path "
    "only,\n"
    "                   in wide lenses a small fraction of the front element\n"
    "  --model MODEL    trace the rays by MODEL, baked from LENS, with the "
    "integers\n"
    "                   of render and overlay. Status 1: the ray is outside "
    "the\n"
    "                   pupil or the angles of the ghost in MODEL; rel_radius\n"
    "                   is that of the limiting barrels, 0 without "
    "any\n" ZOOM_HELP COATING_HELP;

struct options {
    const char *model;
    struct coating coating;
    struct zoom_option zoom;
    int ghost, grid;
    /* whether the grid covers only the entrance pupil, not the front element */
    bool pupil;
    double angle_deg, wavelength_nm;
};

static int parse_option(struct tool *tool, void *ctx, int c, const char *value)
{
    struct options *const o = ctx;
    bool good = true;

    if (c == 'g')
        good = tool_parse_integer(value, -1, GLINT_MAX_GHOSTS, &o->ghost);
    else if (c == 'a')
        good =
            tool_parse_number(value, &o->angle_deg) && fabs(o->angle_deg) < 90;
    else if (c == 'w')
        good = tool_parse_number(value, &o->wavelength_nm) &&
               o->wavelength_nm >= 300 && o->wavelength_nm <= 1100;
    else if (c == 'n')
        good = tool_parse_integer(value, 1, 4096, &o->grid);
    else if (c == 'z')
        good = zoom_option_parse(&o->zoom, value);
    else if (c == 'F')
        good = zoom_option_parse_focus(&o->zoom, value);
    else if (c == 'm')
        o->model = value;
    else if (c == 'p')
        o->pupil = true;
    else
        return c == 'C' ? coating_parse_option(tool, &o->coating, value)
                        : tool_apply_option(tool, c, value);
    return good ? -1 : -2;
}

static int parse_options(struct tool *tool, int argc, char **argv,
                         struct options *o)
{
    static const struct option options[] = {
        {"ghost", required_argument, NULL, 'g'},
        {"angle", required_argument, NULL, 'a'},
        {"wavelength", required_argument, NULL, 'w'},
        {"grid", required_argument, NULL, 'n'},
        {"model", required_argument, NULL, 'm'},
        {"pupil", no_argument, NULL, 'p'},
        {"coating", required_argument, NULL, 'C'},
        ZOOM_OPTIONS('z', 'F'),
        TOOL_COMMON_OPTIONS};
    const int code = tool_parse_options(tool, argc, argv, TOOL_COMMON_SHORT,
                                        options, parse_option, o);

    return code >= 0
               ? code
               : tool_check_inputs(tool, argc, argv, 1, "expects one lens");
}

/* -------------------------------------------------------------- exact rays */

/* Traces rays that start at (PX_MM, PY_MM) in the vertex plane of the front
 * element to the sensor, exactly or by a model. */
struct tracer {
    enum glint_ray_status (*trace)(const struct tracer *t, double px_mm,
                                   double py_mm, struct glint_ray *ray);
    double angle_deg;
    /* surfaces that an exact ray passes or is reflected at, in this order */
    struct glint_path path;
    /* parts of the ghost's pupil for which the model has polynomials at this
     * angle */
    struct glint_transfer *part;
    int n_parts;
    double stop_radius_mm;
};

static enum glint_ray_status trace_exact_ray(const struct tracer *t,
                                             double px_mm, double py_mm,
                                             struct glint_ray *ray)
{
    const double angle = t->angle_deg * GLINT_PI / 180;
    const double direction[3] = {sin(angle), 0, cos(angle)};

    return glint_trace(&t->path, px_mm, py_mm, direction, ray, NULL);
}

/* --------------------------------------------------------- rays of a model */

static double evaluate_model_output(const struct glint_transfer *t,
                                    const struct glint_outputs *out, int kind)
{
    return ldexp(out->at[kind], t->exponent[kind]);
}

static double compute_max_relative_radius(const struct glint_transfer *t,
                                          const struct glint_outputs *out)
{
    double most = evaluate_model_output(t, out, GLINT_OUT_RADIUS);

    for (int kind = GLINT_OUT_BARREL_0; kind < GLINT_OUT_KINDS; kind++)
        if (t->outputs >> kind & 1)
            most = fmax(
                most,
                sqrt(fmax(0, 2 * evaluate_model_output(t, out, kind) - 1)));
    return most;
}

/* Sets (U, V) to the start of a ray relative to the bounding box of pupil part
 * T; the box spans -1 .. 1. Returns whether the ray is in the part. */
static bool is_ray_in_pupil_box(const struct glint_transfer *t, double px_mm,
                                double py_mm, double *u, double *v)
{
    const double unit = ldexp(1, t->box_exponent);

    *u = (px_mm / unit - t->box[0]) / t->box[1];
    *v = (py_mm / unit - t->box[3]) / t->box[2];
    return fabs(*u) <= 1 && fabs(*v) <= 1 &&
           fabs(*v) >= ldexp(glint_transfer_v(t, 0, 1), -30);
}

/* Sets SIDE to the signs, 1 or -1, that mirror x and y of a ray into pupil part
 * T. Models of round lenses store only angles >= 0 and rays with y >= 0. Models
 * of other lenses store only lights on one side of a symmetry plane. */
static void find_pupil_signs(const struct glint_transfer *t, double angle_deg,
                             double py_mm, double side[2])
{
    side[0] = t->whole ? t->sign : angle_deg < 0 ? -1 : 1;
    side[1] = t->whole ? t->side ? -t->sign : t->sign : py_mm < 0 ? -1 : 1;
}

static enum glint_ray_status trace_model_ray(const struct tracer *t,
                                             double px_mm, double py_mm,
                                             struct glint_ray *ray)
{
    const double stop = t->stop_radius_mm;
    const struct glint_transfer *p = t->part;
    struct glint_outputs out;
    double u = 0, v = 0, side[2] = {1, 1};

    for (; p < t->part + t->n_parts; p++) {
        find_pupil_signs(p, t->angle_deg, py_mm, side);
        if (is_ray_in_pupil_box(p, side[0] * px_mm, side[1] * py_mm, &u, &v))
            break;
    }
    if (p == t->part + t->n_parts)
        return GLINT_RAY_MISSED;
    glint_transfer_ray(p, (int32_t)lrint(ldexp(u, 30)),
                       (int32_t)lrint(ldexp(v, 30)), &out);
    *ray = (struct glint_ray){
        .stop_x_mm =
            side[0] * stop * evaluate_model_output(p, &out, GLINT_OUT_STOP_X),
        .stop_y_mm =
            side[1] * stop * evaluate_model_output(p, &out, GLINT_OUT_STOP_Y),
        .sensor_x_mm =
            side[0] * evaluate_model_output(p, &out, GLINT_OUT_SENSOR_X),
        .sensor_y_mm =
            side[1] * evaluate_model_output(p, &out, GLINT_OUT_SENSOR_Y),
        .energy = evaluate_model_output(p, &out, GLINT_OUT_ENERGY),
        .rel_radius = compute_max_relative_radius(p, &out)};
    return GLINT_RAY_OK;
}

/* Returns whether A, stored in a model with a 31-bit mantissa, equals B up to a
 * relative error of 1e-8. */
static bool is_model_number_close(struct glint_real a, double b)
{
    return fabs(model_convert_real_to_double(a) - b) <= 1e-8 * fabs(b);
}

static bool is_model_entry_of_ghost(const struct glint_lens *model,
                                    uint32_t entry, uint32_t ghost)
{
    return model->ghost[entry].i == model->ghost[ghost].i &&
           model->ghost[entry].j == model->ghost[ghost].j;
}

/* Stores in TRACER the parts of GHOST's pupil for which MODEL has polynomials
 * at the tracer's angle and at WAVE_Q24, 1 / wavelength^2. Returns
 * GLINT_E_MEMORY on failure. */
static enum glint_status find_ghost_parts(const struct glint_lens *model,
                                          uint32_t ghost, int32_t sine_q30,
                                          int32_t wave_q24,
                                          struct tracer *tracer)
{
    const int32_t one_q30 = INT32_C(1) << 30;
    const struct glint_azimuth azimuth = {
        tracer->angle_deg < 0 ? -one_q30 : one_q30, 0};
    const uint32_t end = model->header->n_ghosts;
    size_t n = 0;

    for (uint32_t k = ghost; k < end; k++)
        n += is_model_entry_of_ghost(model, k, ghost);
    tracer->part = calloc(n, sizeof *tracer->part);
    if (!tracer->part)
        return GLINT_E_MEMORY;
    for (uint32_t k = ghost; k < end; k++)
        if (is_model_entry_of_ghost(model, k, ghost))
            tracer->n_parts +=
                glint_transfer_init_at(&tracer->part[tracer->n_parts], model,
                                       (int)k, sine_q30, azimuth, wave_q24);
    return GLINT_OK;
}

static int prepare_model_tracer(const struct tool *tool,
                                const struct options *o,
                                const struct glint_prescription *lens,
                                int n_ghosts, const struct glint_lens *model,
                                struct tracer *tracer)
{
    const struct glint_model_header *h = model->header;
    const int32_t wave_q24 =
        (int32_t)lrint(ldexp(1e6 / (o->wavelength_nm * o->wavelength_nm), 24));
    struct glint_optics optics;

    glint_optics_of(lens, &optics);
    if (!is_model_number_close(h->focal_mm, optics.scale_mm) ||
        h->n_ghosts - h->n_parts != (uint32_t)n_ghosts)
        return tool_fail(tool, GLINT_E_LENS,
                         "the model was baked from another lens");
    if (o->ghost < 0)
        return tool_usage(tool, "a model has ghosts only, not the direct path");
    if (wave_q24 < h->wave_lo_q24 || wave_q24 > h->wave_hi_q24)
        return tool_usage(tool, "%g nm is outside the model's band",
                          o->wavelength_nm);
    tracer->trace = trace_model_ray;
    tracer->stop_radius_mm = model_convert_real_to_double(h->stop_radius_mm);
    if (find_ghost_parts(
            model, (uint32_t)o->ghost,
            (int32_t)lrint(ldexp(sin(fabs(o->angle_deg) * GLINT_PI / 180), 30)),
            wave_q24, tracer) != GLINT_OK)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    return EXIT_OK;
}

/* ---------------------------------------------------------------- ray grid */

/* Sets AREA to the rectangle, mm, in the vertex plane of the front element
 * where the rays start. Returns an exit code. */
static int find_ray_grid_area(const struct tool *tool, const struct options *o,
                              const struct glint_prescription *lens,
                              const struct tracer *tracer,
                              struct glint_pupil *area)
{
    const double semi = lens->surface[0].semi_mm;
    struct glint_optics optics;

    *area = (struct glint_pupil){
        .x0_mm = -semi, .x1_mm = semi, .y0_mm = -semi, .y1_mm = semi};
    if (!o->pupil)
        return EXIT_OK;
    glint_optics_of(lens, &optics);
    if (!glint_pupil_find(area, &tracer->path, o->angle_deg,
                          optics.stop_radius_mm, NULL))
        return tool_fail(
            tool, GLINT_E_LENS,
            "no light of this path passes the stop and the barrels");
    if (area->mirrored)
        area->y0_mm = -area->y1_mm;
    return EXIT_OK;
}

static double compute_ray_grid_coordinate(double from, double to, int k,
                                          int last)
{
    return last ? from + (to - from) * k / last : 0.5 * (from + to);
}

static void print_traced_rays(const struct tool *tool, const struct options *o,
                              const struct glint_pupil *area,
                              const struct tracer *tracer)
{
    const int last = o->grid - 1;
    int n = 0;

    printf("px,py,status,stop_x,stop_y,sensor_x,sensor_y,energy,rel_radius\n");
    for (int k = 0; k < o->grid * o->grid && !ferror(stdout); k++) {
        const double x = compute_ray_grid_coordinate(area->x0_mm, area->x1_mm,
                                                     k % o->grid, last);
        const double y = compute_ray_grid_coordinate(area->y0_mm, area->y1_mm,
                                                     k / o->grid, last);
        struct glint_ray ray;
        const enum glint_ray_status status = tracer->trace(tracer, x, y, &ray);

        printf("%.12g,%.12g,%d,", x, y, (int)status);
        n += status == GLINT_RAY_OK;
        if (status == GLINT_RAY_OK)
            printf("%.12g,%.12g,%.12g,%.12g,%.12g,%.12g\n", ray.stop_x_mm,
                   ray.stop_y_mm, ray.sensor_x_mm, ray.sensor_y_mm, ray.energy,
                   ray.rel_radius);
        else
            printf(",,,,,\n");
    }
    if (n == 0 && !ferror(stdout) && !o->pupil && !tool->quiet)
        fprintf(stderr, "glint trace: no ray of this grid reaches the sensor; "
                        "--pupil limits the grid to the entrance pupil\n");
}

static int trace_ray_grid(const struct tool *tool, const struct options *o,
                          const struct glint_prescription *lens)
{
    static struct glint_ghost ghosts[GLINT_MAX_GHOSTS];
    static struct tracer tracer;
    const int n = glint_ghost_list(lens, ghosts, GLINT_MAX_GHOSTS);
    struct model_file model = {.data = NULL};
    struct glint_pupil area;
    int code = EXIT_OK;

    if (o->ghost >= n)
        return tool_usage(tool, "%s has %d ghosts; number %d does not exist",
                          lens->name, n, o->ghost);
    tracer.angle_deg = o->angle_deg;
    tracer.trace = trace_exact_ray;
    glint_path_init(&tracer.path, lens, o->ghost < 0 ? NULL : &ghosts[o->ghost],
                    o->wavelength_nm);
    if (o->model)
        code = tool_open_model(tool, o->model, &model);
    if (o->model && code == EXIT_OK)
        code = prepare_model_tracer(tool, o, lens, n, &model.lens, &tracer);
    if (code == EXIT_OK)
        code = find_ray_grid_area(tool, o, lens, &tracer, &area);
    if (code == EXIT_OK)
        print_traced_rays(tool, o, &area, &tracer);
    free(tracer.part);
    model_file_close(&model);
    return code;
}

int cmd_trace(int argc, char **argv)
{
    static struct glint_prescription lens;
    struct tool tool = {.name = "trace", .help = help};
    struct options o = {.grid = 17, .wavelength_nm = 532};
    int code = parse_options(&tool, argc, argv, &o);

    if (code >= 0)
        return code;
    code = o.model ? coating_reject_option_for_model(&tool, &o.coating, o.model)
                   : EXIT_OK;
    if (code == EXIT_OK)
        code = tool_read_lens(&tool, argv[optind], &lens);
    if (code == EXIT_OK)
        code = zoom_option_apply(&tool, &o.zoom, &lens);
    if (code != EXIT_OK)
        return code;
    coating_apply(&o.coating, &lens);
    return trace_ray_grid(&tool, &o, &lens);
}
