/* SPDX-License-Identifier: MIT
 *
 * Fills the configuration of an engine from the options of glint/options.h. */
#include "engine/options/texts.h"
#include "engine/engine_parts.h"
#include "glint/options.h"

/* default max number of lamps per picture; most pictures have many more, but
 * the others are barely visible */
enum { FOUND = 16 };

static unsigned select_flare_parts(int only)
{
    switch (only) {
    case GLINT_ONLY_GHOSTS:
        return GLINT_ENGINE_GHOSTS;
    case GLINT_ONLY_STARBURST:
        return GLINT_ENGINE_STAR;
    case GLINT_ONLY_VEIL:
        return GLINT_ENGINE_VEIL;
    default:
        return GLINT_ENGINE_ALL;
    }
}

/* Returns the factor on the brightness of starbursts. If a single ghost is
 * drawn, it is 0 unless option starburst is set. */
static double choose_starburst_brightness_factor(const struct glint_options *o)
{
    if (GLINT_OPTION_GIVEN(o, starburst))
        return o->starburst;
    if (o->only == GLINT_ONLY_STARBURST)
        return 1;
    return GLINT_OPTION_GIVEN(o, ghost) ? 0 : o->starburst;
}

static struct glint_engine_drawing
make_drawing_config(const struct glint_options *o)
{
    const bool has_grid = GLINT_OPTION_GIVEN(o, grid) ||
                          GLINT_OPTION_GIVEN(o, quality) ||
                          GLINT_OPTION_GIVEN(o, error);
    struct glint_engine_drawing d = {
        .dials = glint_options_quality(o).dials,
        .budget_ms = o->budget,
        /* A requested fineness of grids disables the limit of work (0), as the
         * limit could make grids coarser. */
        .most_minsn =
            has_grid && !GLINT_OPTION_GIVEN(o, work) ? 0 : 1000 * o->work,
        .apart_px = o->apart,
        .tile_log2 = 3 + o->tile,
        .parts = select_flare_parts(o->only),
        .only_ghost = GLINT_OPTION_GIVEN(o, ghost) ? o->ghost : -1,
        .keep_points = o->area_samples != 0,
        .keep_lights = o->max_lights != 0};

    if (o->area_samples)
        d.dials.area_points = o->area_samples;
    if (o->max_lights)
        d.dials.max_lights = o->max_lights;
    return d;
}

void glint_engine_configure_stop(struct glint_engine_camera *camera,
                                 const struct glint_options *o)
{
    struct glint_iris *const iris = &camera->iris;
    struct glint_stop_shape shape;

    camera->stops = &glint_engine_all_stops;
    if (o->stop && glint_option_stop(o->stop, &shape)) {
        camera->n_blades = shape.n_blades;
        camera->blade_rotation_deg = shape.rotation_deg;
        iris->roundness = shape.roundness;
        iris->softness = shape.softness;
    }
    if (o->dust)
        glint_option_dust(o->dust, &iris->dust, &iris->dust_seed);
}

static void set_camera_config(struct glint_engine_camera *camera,
                              const struct glint_options *o)
{
    struct glint_front *const front = &camera->front_dirt;
    double mm[2] = {0, 0};

    glint_engine_configure_stop(camera, o);
    camera->f_number = o->f_number;
    glint_option_waves(o->wavelengths, &camera->waves);
    camera->balance = o->balance;
    if (o->sensor)
        glint_option_sensor(o->sensor, mm);
    camera->sensor_width_mm = mm[0];
    camera->sensor_height_mm = mm[1];
    if (o->front_dust)
        glint_option_dust(o->front_dust, &front->dust, &front->dust_seed);
}

void glint_engine_configure(struct glint_engine_config *cfg,
                            const struct glint_options *options)
{
    const struct glint_options whole =
        glint_options_complete_with_defaults(options);
    const struct glint_options *const o = &whole;
    const int found = o->max_lights ? o->max_lights : FOUND;

    cfg->light = (struct glint_engine_light){
        .strength = o->strength,
        .exposure_ev = o->exposure,
        .gain = o->gain,
        .by_hand = GLINT_OPTION_GIVEN(o, exposure),
        .starburst = choose_starburst_brightness_factor(o),
        .veil = o->veil,
        .haze = o->haze};
    glint_option_threshold(o->threshold, cfg->search.threshold_ev);
    cfg->search.headroom_ev =
        GLINT_OPTION_GIVEN(o, headroom) ? o->headroom : -1;
    cfg->search.max_found =
        found < GLINT_ENGINE_MAX_LAMPS ? found : GLINT_ENGINE_MAX_LAMPS;
    cfg->drawing = make_drawing_config(o);
    set_camera_config(&cfg->camera, o);
    cfg->arena_bytes = (size_t)o->memory << 20;
    cfg->arena_has_all = 1;
}
