/* SPDX-License-Identifier: MIT */
#include "model/opened_lens.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/ghost_file.h"
#include "model/opened_table.h"
#include "posix/error.h"

/* ---------------------------------------------------------------- the setup */

struct glint_engine_camera
opened_lens_make_camera(const struct opened_lens *lens,
                        const struct settings *settings)
{
    struct glint_engine_camera camera = settings->camera;

    if (!settings->has_stop && lens->table.stop_is_circle) {
        camera.n_blades = 0;
        camera.iris.roundness = 0;
    }
    camera.iris.mask = lens->mask.luma;
    camera.iris.mask_width = lens->mask.width;
    camera.iris.mask_height = lens->mask.height;
    camera.f_number = settings->options.f_number;
    return camera;
}

enum glint_status opened_lens_set_stop(struct opened_lens *lens,
                                       const struct settings *s,
                                       struct glint_error *error)
{
    const struct glint_engine_camera camera = opened_lens_make_camera(lens, s);
    const struct glint_lens *const model =
        lens->model.data ? &lens->model.lens : NULL;
    struct glint_dirt *dirt;
    enum glint_status status =
        model ? GLINT_OK : opened_table_make_setup(lens, &camera, error);

    if (status == GLINT_OK)
        status = glint_engine_setup(&lens->setup, model, &camera, &dirt, error);
    if (status != GLINT_OK)
        return status;
    glint_dirt_free(lens->dirt);
    lens->dirt = dirt;
    return GLINT_OK;
}

enum glint_status opened_lens_set_zoom(struct opened_lens *lens,
                                       const struct settings *settings,
                                       double zoom, struct glint_error *error)
{
    enum glint_status status;

    if (!lens->model.zoom)
        return glint_error_report(
            error, GLINT_E_ARGUMENT, lens->table.name,
            settings->options.rays == GLINT_RAYS_EXACT
                ? "exact rays cannot zoom between frames; use a model"
            : lens->table.zoom.n_positions
                ? "a lens table is baked for one zoom position; zooming needs "
                  "a model of 'glint bake LENS --positions N'"
            : lens->table.n_surfaces
                ? "does not zoom: its table has one zoom position"
                : "does not zoom: its model has one zoom position");
    status = model_file_set_zoom(&lens->model, zoom, error);
    return status == GLINT_OK ? opened_lens_set_stop(lens, settings, error)
                              : status;
}

/* ------------------------------------------------------------------ opening */

static int check_wavelength_band(const struct tool *tool,
                                 const struct opened_lens *lens,
                                 const struct settings *settings)
{
    const struct glint_model_header *h = lens->model.lens.header;
    const double lo = 1e3 / sqrt(h->wave_hi_q24 * 0x1p-24);
    const double hi = 1e3 / sqrt(h->wave_lo_q24 * 0x1p-24);

    for (int i = 0; i < settings->n_wavelengths; i++)
        if (settings->wavelength_nm[i] < lo - 0.5 ||
            settings->wavelength_nm[i] > hi + 0.5)
            return tool_usage(tool,
                              "%g nm lies outside the %.0f to %.0f nm that "
                              "the model of %s was baked for (bake --band)",
                              settings->wavelength_nm[i], lo, hi, h->name);
    return EXIT_OK;
}

/* Prints a warning if the image is larger than the field for which the model
 * was baked. */
static void warn_of_small_field(const struct tool *tool,
                                const struct opened_lens *lens,
                                const struct glint_engine_camera *camera)
{
    const double diagonal =
        hypot(camera->sensor_width_mm, camera->sensor_height_mm);
    const double field =
        model_convert_real_to_double(lens->model.lens.header->field_mm);

    if (!tool->quiet && 0.5 * diagonal > field)
        fprintf(stderr,
                "glint %s: the model was baked for a field of radius %.1f mm; "
                "flares outside this field may be wrong (glint bake --field)\n",
                tool->name, field);
}

/* Prints a warning if pictures by the model of LENS are inaccurate. */
static void warn_of_inaccurate_model(const struct tool *tool,
                                     const struct opened_lens *lens)
{
    const struct glint_model_note *const note =
        lens->model.data ? model_get_note(&lens->model.lens) : NULL;
    const double psnr_db = note ? ldexp(note->psnr_q8, -8) : 0;

    if (!tool->quiet && note && note->n > 0 && psnr_db < PICTURE_CHECK_DB)
        fprintf(stderr,
                "glint %s: pictures by the model of %s have down to %.1f dB "
                "PSNR against exact rays, with the light %.1f degrees off the "
                "axis, below %g dB; use the lens table with --rays exact\n",
                tool->name, lens->table.name, psnr_db,
                ldexp(note->angle_q8, -8), PICTURE_CHECK_DB);
}

/* Moves the zoom lens of the model PATH to the position that --zoom
 * requests. */
static int zoom_model_to_option(const struct tool *tool,
                                struct model_file *model,
                                const struct zoom_option *o, const char *path)
{
    struct glint_error error = {""};

    if (!model->zoom || o->is_focused)
        return zoom_option_reject_for_model(tool, o, path);
    return !o->is_zoomed ||
                   model_file_set_zoom(model, o->zoom, &error) == GLINT_OK
               ? EXIT_OK
               : tool_usage(tool, "%s: %s", path, error.text);
}

static int open_model_file(const struct tool *tool, struct opened_lens *lens,
                           const struct settings *settings, const char *path)
{
    const struct glint_model_header *h;
    int code;

    if (settings->options.rays == GLINT_RAYS_EXACT)
        return tool_usage(tool, "%s is a model: exact rays need the lens table",
                          path);
    code = coating_reject_option_for_model(tool, &settings->coating, path);
    if (code == EXIT_OK)
        code = tool_open_model(tool, path, &lens->model);
    if (code == EXIT_OK)
        code = zoom_model_to_option(tool, &lens->model, &settings->zoom, path);
    if (code != EXIT_OK)
        return code;
    h = lens->model.lens.header;
    snprintf(lens->table.name, sizeof lens->table.name, "%s", h->name);
    lens->table.film_width_mm = model_convert_real_to_double(h->film_width_mm);
    lens->table.film_height_mm =
        model_convert_real_to_double(h->film_height_mm);
    /* A model does not store whether the stop is a circle. */
    lens->table.stop_is_circle = false;
    warn_of_small_field(tool, lens, &settings->camera);
    return EXIT_OK;
}

static int set_up_opened_lens(const struct tool *tool, struct opened_lens *lens,
                              const struct settings *s)
{
    struct glint_error error = {""};
    enum glint_status status = opened_lens_set_stop(lens, s, &error);

    if (status == GLINT_E_ARGUMENT && s->options.f_number > 0)
        return settings_report_bad_stop(tool, s, error.text);
    if (status == GLINT_OK && s->options.ghosts)
        status = ghost_file_read(&lens->tints, s->options.ghosts, &lens->setup,
                                 lens->table.name, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    if (settings_get_selected_ghost(s) >=
        lens->setup.n_ghosts - lens->setup.n_parts)
        return tool_usage(tool, "%s has %d ghosts; number %d does not exist",
                          lens->table.name,
                          lens->setup.n_ghosts - lens->setup.n_parts,
                          s->options.ghost);
    return EXIT_OK;
}

int opened_lens_set_front_dirt(const struct tool *tool,
                               struct opened_lens *lens,
                               const struct glint_engine_camera *camera,
                               const char *file)
{
    struct glint_front front = camera->front_dirt;
    struct stop_mask mask = {NULL, 0, 0};
    struct glint_error error = {""};
    enum glint_status status;
    const int code = file ? stop_mask_read_image(tool, file, &mask) : EXIT_OK;

    if (code != EXIT_OK)
        return code;
    front.mask = mask.luma;
    front.mask_width = mask.width;
    front.mask_height = mask.height;
    glint_front_free(lens->front);
    status = glint_front_make(&lens->front, &front, &error);
    free(mask.luma);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

int opened_lens_open(const struct tool *tool, struct opened_lens *lens,
                     const struct settings *settings, const char *name)
{
    int code = EXIT_OK;

    if ((settings->dials.flags & GLINT_DIAL_ALWAYS_HALF) &&
        settings->options.rays == GLINT_RAYS_EXACT)
        return tool_usage(tool, "--half does not apply to exact rays");
    if (settings->options.only == GLINT_ONLY_VEIL &&
        !settings_has_veil(settings))
        code = tool_usage(tool,
                          "--only veil needs --veil, --haze or --front-dust");
    if (code == EXIT_OK && settings->options.stop_mask)
        code = stop_mask_read_image(tool, settings->options.stop_mask,
                                    &lens->mask);
    if (code == EXIT_OK)
        code = opened_lens_set_front_dirt(tool, lens, &settings->camera,
                                          settings->options.front_mask);
    if (code != EXIT_OK)
        return code;
    if (settings->options.projection == GLINT_PROJECTION_LENS &&
        tool_is_model(name))
        return tool_usage(tool, "--projection lens needs a lens table: a "
                                "baked model has no chief rays");
    code = tool_is_model(name) ? open_model_file(tool, lens, settings, name)
                               : opened_table_open(tool, lens, settings, name);

    if (code == EXIT_OK && lens->model.data &&
        settings->camera.waves.kind == GLINT_WAVES_LIST)
        code = check_wavelength_band(tool, lens, settings);
    if (code == EXIT_OK)
        warn_of_inaccurate_model(tool, lens);
    return code == EXIT_OK ? set_up_opened_lens(tool, lens, settings) : code;
}

void opened_lens_close(struct opened_lens *lens)
{
    model_file_close(&lens->model);
    free(lens->tints);
    glint_dirt_free(lens->dirt);
    free(lens->mask.luma);
    glint_front_free(lens->front);
    *lens = (struct opened_lens){.tints = NULL};
}

void opened_lens_update_table_pointer(struct opened_lens *lens)
{
    if (lens->setup.lens)
        lens->setup.lens = &lens->table;
}

/* ------------------------------------------------------------------ drawing */

struct glint_view opened_lens_compute_view(const struct opened_lens *lens,
                                           const struct settings *settings,
                                           int width, int height)
{
    const struct glint_engine_camera *const c = &settings->camera;
    const bool has_sensor = c->sensor_width_mm > 0;
    struct glint_view view = glint_view_fit(
        width, height,
        has_sensor ? c->sensor_width_mm : lens->table.film_width_mm,
        has_sensor ? c->sensor_height_mm : lens->table.film_height_mm);

    view.projection = lens->projection;
    return view;
}

void opened_lens_configure_engine(const struct tool *tool,
                                  const struct opened_lens *lens,
                                  const struct settings *settings, int width,
                                  int height, struct glint_engine_config *cfg)
{
    glint_engine_defaults(cfg, width, height);
    glint_engine_configure(cfg, &settings->options);
    cfg->model = lens->model.data ? &lens->model.lens : NULL;
    cfg->workers = tool->workers;
    cfg->sets = tool_enabled_instruction_sets(tool);
    cfg->clock = tool_clock_s;
    cfg->camera.setup = &lens->setup;
    cfg->camera.rays = opened_table_ray_functions();
    cfg->camera.tints = lens->tints;
    cfg->camera.front = lens->front;
    cfg->camera.projection = &lens->projection;
    if (cfg->camera.sensor_width_mm > 0)
        return;
    cfg->camera.sensor_width_mm = lens->table.film_width_mm;
    cfg->camera.sensor_height_mm = lens->table.film_height_mm;
}
