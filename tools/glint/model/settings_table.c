/* SPDX-License-Identifier: MIT
 *
 * Settings with a lens table, whose model is baked, or found where it is kept.
 */
#include <math.h>

#include "formats/picture.h"
#include "model/model_cache.h"
#include "model/table_file.h"
#include "model/settings_table.h"

struct glint_bake_options settings_bake_options(const struct settings *settings)
{
    const struct glint_prescription *l = &settings->lens;
    const double film = hypot(l->film_width_mm, l->film_height_mm);
    const double sensor = hypot(settings->sensor_mm[0], settings->sensor_mm[1]);
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

/* Sets how the lens images angles, and the largest angle of the picture. */
static enum glint_status set_projection(struct settings *settings,
                                        struct glint_error *error)
{
    const struct glint_prescription *l = &settings->lens;
    const double *mm = settings->sensor_mm;
    struct glint_optics optics;
    double miss_deg;
    const enum glint_status status =
        glint_projection_of(&settings->projection, l, &miss_deg, error);

    if (status != GLINT_OK)
        return status;
    glint_optics_of(l, &optics);
    settings->max_deg =
        fmax(settings->max_deg,
             glint_projection_deg(
                 &settings->projection,
                 0.5 *
                     (mm[0] > 0 ? hypot(mm[0], mm[1])
                                : hypot(l->film_width_mm, l->film_height_mm)) /
                     fabs(optics.focal_mm)));
    return GLINT_OK;
}

/* Rejects inputs that are not pictures before anything is baked. */
static int check_picture(const struct tool *tool,
                         const struct settings *settings)
{
    const struct glint_bake_options options = settings_bake_options(settings);
    struct glint_error error = {""};
    enum glint_status status;
    struct glint_kept kept;

    if (!settings->picture || model_is_cached(&settings->lens, &options))
        return EXIT_OK;
    status = glint_kept_open(&kept, settings->picture, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    glint_kept_close(&kept);
    return EXIT_OK;
}

int settings_open_table(const struct tool *tool, struct settings *settings,
                        const char *name)
{
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;
    int code = tool_lens(tool, name, &settings->lens);

    if (code == EXIT_OK)
        code = zoom_option_apply(tool, &settings->zoom, &settings->lens);
    if (code != EXIT_OK)
        return code;
    coating_apply(&settings->coating, &settings->lens);
    /* A model serves all stops narrower than its own. */
    if (settings->options.f_number > 0 &&
        (settings->options.rays == GLINT_RAYS_EXACT ||
         settings->options.f_number < settings->lens.f_number))
        status = glint_prescription_set_f_number(
            &settings->lens, settings->options.f_number, &error);
    if (status != GLINT_OK)
        return settings_refuse_stop(tool, settings, error.text);
    if (settings->options.projection == GLINT_PROJECTION_LENS)
        status = set_projection(settings, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    if (settings->options.rays == GLINT_RAYS_EXACT)
        return EXIT_OK;
    code = check_picture(tool, settings);
    return code != EXIT_OK ? code
                           : model_cached(tool, &settings->lens,
                                          settings_bake_options(settings),
                                          &settings->model);
}

const struct glint_frame_rays *settings_table_rays(void)
{
    return &glint_frame_traces;
}

enum glint_status settings_table_setup(struct settings *s,
                                       const struct stop_option *stop,
                                       struct glint_error *error)
{
    return glint_setup_init(&s->setup, &s->lens, stop->n_blades,
                            stop->rotation_deg, s->wavelength_nm,
                            s->n_wavelengths, error);
}
