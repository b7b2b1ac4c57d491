/* SPDX-License-Identifier: MIT
 *
 * Opens a lens by its table; the model is read from the cache or baked.
 */
#include <math.h>

#include "model/model_cache.h"
#include "model/table_file.h"
#include "model/opened_table.h"

struct glint_bake_options
opened_table_bake_options(const struct glint_prescription *l,
                          const struct settings *settings)
{
    const double film = hypot(l->film_width_mm, l->film_height_mm);
    const double sensor = hypot(settings->camera.sensor_width_mm,
                                settings->camera.sensor_height_mm);
    struct glint_bake_options o;

    glint_bake_defaults(&o);
    o.tolerance = settings->tolerance;
    for (int i = 0; i < settings->n_wavelengths; i++) {
        const double nm = settings->wavelength_nm[i];

        o.band_nm[0] = fmin(o.band_nm[0], fmax(300, 10 * floor(nm / 10)));
        o.band_nm[1] = fmax(o.band_nm[1], fmin(1100, 10 * ceil(nm / 10)));
    }
    if (sensor > film)
        o.field_mm = 0.55 * sensor;
    if (settings->max_deg > o.max_deg)
        o.max_deg = 89;
    return o;
}

/* Sets the projection of LENS, and *DEG to the angle off the axis at a corner
 * of the image, degrees. */
static enum glint_status
set_lens_projection(struct opened_lens *lens,
                    const struct glint_engine_camera *c, double *deg,
                    struct glint_error *error)
{
    const struct glint_prescription *l = &lens->table;
    struct glint_optics optics;
    double miss_deg;
    const enum glint_status status =
        glint_projection_of(&lens->projection, l, &miss_deg, error);

    if (status != GLINT_OK)
        return status;
    glint_optics_of(l, &optics);
    *deg = glint_projection_deg(
        &lens->projection,
        0.5 *
            (c->sensor_width_mm > 0
                 ? hypot(c->sensor_width_mm, c->sensor_height_mm)
                 : hypot(l->film_width_mm, l->film_height_mm)) /
            fabs(optics.focal_mm));
    return GLINT_OK;
}

/* Sets the table of LENS to the f-number of SETTINGS. This is needed for exact
 * rays, which are traced through the stop of the table. */
static int set_table_f_number(const struct tool *tool, struct opened_lens *lens,
                              const struct settings *settings)
{
    const double f_number = settings->options.f_number;
    struct glint_error error = {""};

    if (!(f_number > 0) || glint_prescription_set_f_number(
                               &lens->table, f_number, &error) == GLINT_OK)
        return EXIT_OK;
    return settings_report_bad_stop(tool, settings, error.text);
}

/* Sets the table of LENS to the f-number of the input picture's camera, or to
 * the widest stop if that is wider than the lens allows. */
static enum glint_status set_photo_f_number(struct opened_lens *lens,
                                            double f_number,
                                            struct glint_error *error)
{
    return glint_prescription_set_f_number(
        &lens->table, fmax(f_number, glint_prescription_widest(&lens->table)),
        error);
}

/* Limit of ghosts * surfaces for exact rays of a lens file outside glint's
 * folders, unless --rays exact is given. A surface that is not spherical counts
 * as SHAPED surfaces. At this limit two lamps take about 30 s of processor
 * time. */
#define MOST_PATHS 50000
enum { SHAPED = 7 };

static int check_path_count(const struct tool *tool,
                            const struct glint_prescription *lens,
                            const char *name)
{
    const int ghosts = lens->n_surfaces * (lens->n_surfaces - 1) / 2;
    int surfaces = 0;

    for (int k = 0; k < lens->n_surfaces; k++)
        surfaces += glint_surface_is_shaped(&lens->surface[k]) ? SHAPED : 1;
    if (ghosts * surfaces <= MOST_PATHS || !model_is_lens_from_file(lens, name))
        return EXIT_OK;
    tool_error(tool,
               "%.200s: exact rays of a lens of %d ghosts take more than about "
               "30 s of processor time; --rays exact lifts this limit, and a "
               "model of glint bake is faster",
               name, ghosts);
    return EXIT_LENS;
}

/* Opens the model of LENS, named NAME, for lights up to DEG off the axis, and
 * bakes it if it is missing. Instead sets lens->is_unbaked if settings->unbaked
 * requests exact rays, or if it waits for a lamp and the model is missing.
 * Returns an exit code. */
static int find_or_bake_model(const struct tool *tool, struct opened_lens *lens,
                              const struct settings *settings, const char *name,
                              double deg)
{
    struct glint_bake_options options =
        opened_table_bake_options(&lens->table, settings);
    int code = EXIT_OK;

    if (deg > options.max_deg)
        options.max_deg = 89;
    lens->is_unbaked = settings->unbaked == SETTINGS_TRACE ||
                       (settings->unbaked != SETTINGS_BAKE &&
                        !model_is_cached(&lens->table, &options));
    if (!lens->is_unbaked)
        return model_open_cached(tool, &lens->table, name, options,
                                 &settings->coating, &lens->model);
    if (settings->unbaked == SETTINGS_TRACE)
        code = check_path_count(tool, &lens->table, name);
    return code == EXIT_OK ? set_table_f_number(tool, lens, settings) : code;
}

int opened_table_open(const struct tool *tool, struct opened_lens *lens,
                      const struct settings *settings, const char *name)
{
    const struct glint_options *const o = &settings->options;
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;
    double deg = 0;
    int code = tool_read_lens(tool, name, &lens->table);

    if (code == EXIT_OK)
        code = zoom_option_apply(tool, &settings->zoom, &lens->table);
    if (code != EXIT_OK)
        return code;
    coating_apply(&settings->coating, &lens->table);
    /* A model may be drawn with a larger f-number than it was baked for, so
     * only a smaller one changes the table. */
    if (o->rays == GLINT_RAYS_EXACT || o->f_number < lens->table.f_number)
        code = set_table_f_number(tool, lens, settings);
    if (code != EXIT_OK)
        return code;
    if (settings->photo_f_number > 0 && !(o->f_number > 0))
        status = set_photo_f_number(lens, settings->photo_f_number, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    if (o->projection == GLINT_PROJECTION_LENS)
        status = set_lens_projection(lens, &settings->camera, &deg, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    return o->rays == GLINT_RAYS_EXACT
               ? EXIT_OK
               : find_or_bake_model(tool, lens, settings, name, deg);
}

const struct glint_frame_rays *opened_table_ray_functions(void)
{
    return &glint_frame_traces;
}

enum glint_status
opened_table_make_setup(struct opened_lens *lens,
                        const struct glint_engine_camera *camera,
                        struct glint_error *error)
{
    double nm[GLINT_MAX_WAVELENGTHS];
    const int n = glint_waves_list(&camera->waves, nm);

    return glint_setup_init(&lens->setup, &lens->table, camera->n_blades,
                            camera->blade_rotation_deg, nm, n, error);
}
