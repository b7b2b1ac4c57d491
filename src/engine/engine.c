/* SPDX-License-Identifier: MIT
 *
 * Creates engines, and changes their settings between pictures. */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/engine_parts.h"
#include "glint/kernels.h"

/* size of struct glint_engine_config in the first version of the library;
 * programs must not pass a smaller size */
#define FIRST_SIZE offsetof(struct glint_engine_config, cache)

void glint_engine_defaults_sized(struct glint_engine_config *cfg, size_t size,
                                 int width, int height)
{
    const struct glint_engine_config all = {
        .size = size,
        .width = width,
        .height = height,
        .sets = glint_sets_here(),
        .camera = {.n_blades = 8},
        .search = {.threshold_ev = {-0.1, -0.15},
                   .headroom_ev = -1,
                   .max_found = 16},
        .light = {.strength = 0.5, .gain = 1, .starburst = 1},
        .drawing = {.dials = glint_dials_at(1 << 14),
                    .most_minsn = GLINT_FRAME_MOST_MINSN,
                    .apart_px = GLINT_FRAME_APART_PX,
                    .tile_log2 = 6,
                    .parts = GLINT_ENGINE_ALL,
                    .only_ghost = -1}};

    memcpy(cfg, &all, size < sizeof all ? size : sizeof all);
}

/* Returns whether the reserved members of C are 0. A program that was compiled
 * for a newer library may use them for settings that this library does not
 * have. */
static bool are_reserved_members_zero(const struct glint_engine_config *c)
{
    static const uint64_t zero[16];
#define UNSET(group) \
    (memcmp(c->group.reserved, zero, sizeof c->group.reserved) == 0)

    return UNSET(camera) && UNSET(search) && UNSET(light) && UNSET(drawing) &&
           UNSET(drawing.dials);
}

/* Returns a message that names a setting of C that is out of range, or NULL if
 * there is none. */
static const char *check_engine_config(const struct glint_engine_config *c)
{
    const struct glint_engine_light *l = &c->light;
    const struct glint_engine_search *s = &c->search;
    const struct glint_engine_drawing *d = &c->drawing;

    if (c->width < 1 || c->width > GLINT_MAX_SIDE || c->height < 1 ||
        c->height > GLINT_MAX_SIDE)
        return "width and height must be 1 to 32768 pixels";
    if (!c->model &&
        !(c->camera.setup && c->camera.rays && c->camera.sensor_width_mm > 0))
        return "set model, or camera.setup, camera.rays and "
               "camera.sensor_width_mm";
    if (s->max_found < 0 || s->max_found > GLINT_ENGINE_MAX_LAMPS)
        return "max_found must be 0 to 1024";
    if (s->more_lamps < 0 || s->more_lamps > 1 << 24 || s->max_drawn < 0 ||
        isnan(s->headroom_ev))
        return "more_lamps must be 0 to 16777216, max_drawn at least 0, and "
               "headroom_ev a number";
    if (!(l->strength >= 0 && l->strength <= 100) ||
        !(l->gain >= 0 && isfinite(l->gain)) || !(fabs(l->exposure_ev) <= 100))
        return "strength must be 0 to 100, gain at least 0, exposure_ev -100 "
               "to 100";
    if (d->tile_log2 < 3 || d->tile_log2 > 6 || !(d->apart_px >= 0))
        return "tile_log2 must be 3 to 6, and apart_px at least 0";
    if (c->arena && c->arena_has_all)
        return "arena must be NULL if arena_has_all is set";
    if (!(l->starburst >= 0 && l->starburst <= 1000))
        return "starburst must be 0 to 1000";
    if (!(l->veil >= 0 && l->haze >= 0 && l->veil + l->haze <= GLINT_MOST_VEIL))
        return "veil and haze must be at least 0, and their sum at most 0.9";
    if (!(s->threshold_ev[0] <= 0 && s->threshold_ev[0] >= -20 &&
          s->threshold_ev[1] >= -20 &&
          s->threshold_ev[1] <= s->threshold_ev[0]))
        return "threshold_ev[0] must be -20 to 0, and threshold_ev[1] -20 to "
               "threshold_ev[0]";
    return NULL;
}

/* ----------------------------------------------------------------- creation */

/* Returns whether IRIS has round blades, a soft edge, dust or a mask. */
static bool has_nondefault_iris(const struct glint_iris *iris)
{
    return iris->roundness != 0 || iris->softness != 0 || iris->dust != 0 ||
           iris->mask;
}

static enum glint_status
set_setup_iris(struct glint_setup *setup,
               const struct glint_engine_camera *camera,
               struct glint_dirt **dirt, struct glint_error *error)
{
    if (!has_nondefault_iris(&camera->iris))
        return GLINT_OK;
    if (camera->stops)
        return camera->stops->set_iris(setup, &camera->iris, dirt, error);
    snprintf(error->text, sizeof error->text,
             "camera.iris requires camera.stops = &glint_engine_all_stops");
    return GLINT_E_ARGUMENT;
}

enum glint_status glint_engine_setup(struct glint_setup *setup,
                                     const struct glint_lens *model,
                                     const struct glint_engine_camera *camera,
                                     struct glint_dirt **dirt,
                                     struct glint_error *error)
{
    const struct glint_waves *const waves = &camera->waves;
    double nm[GLINT_MAX_WAVELENGTHS];
    enum glint_status status = GLINT_OK;
    int n;

    *dirt = NULL;
    if (waves->kind != GLINT_WAVES_AUTO &&
        (waves->n < 1 || waves->n > GLINT_MAX_WAVELENGTHS)) {
        snprintf(error->text, sizeof error->text,
                 "camera.waves has %d wavelengths, but must have 1 to %d",
                 waves->n, GLINT_MAX_WAVELENGTHS);
        return GLINT_E_ARGUMENT;
    }
    n = glint_waves_list(waves, nm);
    if (model)
        status =
            glint_setup_from_model(setup, model, camera->n_blades,
                                   camera->blade_rotation_deg, nm, n, error);
    if (status == GLINT_OK && model && camera->f_number != 0)
        status = glint_setup_stop_down(setup, model, camera->f_number, error);
    if (status == GLINT_OK)
        status = set_setup_iris(setup, camera, dirt, error);
    if (status != GLINT_OK) {
        glint_dirt_free(*dirt);
        *dirt = NULL;
        return status;
    }
    if (waves->kind == GLINT_WAVES_COUNT)
        glint_setup_weigh(setup);
    else if (waves->kind == GLINT_WAVES_AUTO)
        glint_setup_spread(setup, model);
    if (camera->balance)
        glint_setup_balance(setup);
    return GLINT_OK;
}

/* Sets the dirt on the front element: camera->front if the caller has set it,
 * otherwise dirt that is computed from its description, camera->front_dirt. */
static enum glint_status
make_front_dirt(struct glint_engine_optics *o,
                const struct glint_engine_camera *camera,
                struct glint_error *error)
{
    const struct glint_front *const dirt = &camera->front_dirt;
    enum glint_status status = GLINT_OK;

    if (!camera->front && camera->stops) {
        status = camera->stops->make_front(&o->own_front, dirt, error);
    } else if (!camera->front && (dirt->dust != 0 || dirt->mask)) {
        snprintf(error->text, sizeof error->text,
                 "camera.front_dirt requires camera.stops = "
                 "&glint_engine_all_stops");
        status = GLINT_E_ARGUMENT;
    }
    o->front = camera->front ? camera->front : o->own_front;
    return status;
}

static struct glint_view make_camera_view(const struct glint_engine_config *c)
{
    const struct glint_engine_camera *camera = &c->camera;
    double mm[2] = {camera->sensor_width_mm, camera->sensor_height_mm};
    struct glint_view view;

    /* Configurations without a model have both sizes. */
    if (c->model && !(mm[0] > 0))
        mm[0] = glint_real_value(c->model->header->film_width_mm);
    if (c->model && !(mm[1] > 0))
        mm[1] = glint_real_value(c->model->header->film_height_mm);
    view = glint_view_fit(c->width, c->height, mm[0], mm[1]);
    if (camera->projection)
        view.projection = *camera->projection;
    return view;
}

static enum glint_status init_drawing_frame(struct glint_engine *e,
                                            const struct glint_engine_config *c)
{
    const struct glint_engine_drawing *d = &c->drawing;
    struct glint_frame *f = &e->paint.frame;

    glint_frame_init(f, e->optics.setup, make_camera_view(c), c->workers);
    f->lens = c->model;
    f->trace = c->camera.rays;
    f->progress = d->progress;
    f->progress_ctx = d->progress_ctx;
    f->clock = c->clock;
    f->only_ghost = d->only_ghost;
    f->tints = c->camera.tints;
    f->limits.most_minsn = d->most_minsn;
    f->apart_px = d->apart_px;
    f->cfg.sets = c->sets;
    f->cfg.reuse = d->is_fresh ? NULL : &glint_reuse;
    f->cfg.tile_log2 = d->tile_log2;
    f->dials = f->asked = d->dials;
    e->paint.parts = d->parts;
    e->paint.keep_points = d->keep_points != 0;
    e->paint.keep_lights = d->keep_lights != 0;
    if (d->budget_ms <= 0 || !c->clock || !f->lens)
        return GLINT_OK;
    glint_budget_init(&f->budget, d->budget_ms);
    f->dials = glint_budget_get_quality_parameters(&f->budget, &f->dials);
    return glint_frame_calibrate_budget(f);
}

static enum glint_status open_lamp_detector(struct glint_engine *e,
                                            const struct glint_engine_config *c)
{
    struct glint_lamp_detector *const d = &e->find.detector;

    if (c->search.max_found == 0)
        return GLINT_OK;
    d->headroom_ev = c->search.headroom_ev;
    d->max = c->search.max_found;
    return glint_lamp_detector_open_at(d, c->width, c->height,
                                       c->search.threshold_ev);
}

/* Allocates all memory for drawing, within the limits of C, so that drawing
 * allocates nothing. */
static enum glint_status
reserve_drawing_memory(struct glint_engine *e,
                       const struct glint_engine_config *c)
{
    const struct glint_engine_search *s = &c->search;
    struct glint_frame *f = &e->paint.frame;
    const int drawn =
        s->max_drawn ? s->max_drawn : 2 * s->max_found + s->more_lamps;
    enum glint_status status = GLINT_OK;
    size_t bytes = c->arena_bytes;

    if (bytes && !c->arena_has_all)
        status = glint_frame_reserve_memory(f, c->arena, bytes, e->most_lamps,
                                            drawn);
    if (status == GLINT_OK && (bytes || !c->arena_has_all))
        status = glint_frame_star_allocate(f, drawn);
    if (status == GLINT_OK && (bytes || !c->arena_has_all))
        status = glint_frame_veil_allocate(f);
    if (status != GLINT_OK || !bytes || !c->arena_has_all)
        return status;
    if (glint_frame_star_count_bytes(f) >= bytes)
        return GLINT_E_MEMORY;
    return glint_frame_reserve_memory(
        f, NULL, bytes - glint_frame_star_count_bytes(f), e->most_lamps, drawn);
}

/* Writes to ERROR why the engine could not be created. If the arena is too
 * small, also writes the required size. */
static void describe_creation_failure(struct glint_engine *e,
                                      const struct glint_engine_config *c,
                                      enum glint_status status,
                                      struct glint_error *error)
{
    struct glint_frame *const f = &e->paint.frame;
    const size_t mib = (size_t)1 << 20;

    snprintf(error->text, sizeof error->text, "%s", glint_status_text(status));
    if (status == GLINT_E_MEMORY && c->arena_bytes)
        snprintf(error->text, sizeof error->text,
                 "pictures of %dx%d with this lens need at least %zu MiB",
                 c->width, c->height,
                 (glint_frame_star_count_bytes(f) +
                  glint_frame_compute_min_bytes(f) + mib - 1) /
                     mib);
}

static enum glint_status init_engine(struct glint_engine *e,
                                     const struct glint_engine_config *c,
                                     struct glint_error *error)
{
    struct glint_engine_optics *const o = &e->optics;
    enum glint_status status = GLINT_OK;
    int n;

    o->camera = c->camera;
    o->setup = c->camera.setup ? c->camera.setup : &o->own;
    if (!c->camera.setup)
        status =
            glint_engine_setup(&o->own, c->model, &o->camera, &o->dirt, error);
    if (status == GLINT_OK)
        status = make_front_dirt(o, &c->camera, error);
    n = c->model ? (int)(c->model->header->n_ghosts - c->model->header->n_parts)
                 : o->setup->n_ghosts;
    if (status == GLINT_OK && c->drawing.only_ghost >= n) {
        snprintf(error->text, sizeof error->text,
                 "only_ghost must be less than %d, the lens's number of ghosts",
                 n);
        status = GLINT_E_ARGUMENT;
    }
    if (status != GLINT_OK)
        return status;
    e->most_lamps = c->search.more_lamps +
                    (c->search.max_found ? GLINT_ENGINE_MAX_LAMPS : 0);
    e->paint.lamp = malloc(((size_t)e->most_lamps + 1) * sizeof *e->paint.lamp);
    e->expose.before =
        malloc(((size_t)e->most_lamps + 1) * sizeof *e->expose.before);
    e->expose.part =
        malloc(((size_t)e->most_lamps + 1) * sizeof *e->expose.part);
    e->expose.by_drawing = !c->arena_bytes || c->arena_has_all;
    glint_strength_set_defaults(&e->expose.strength);
    glint_engine_set_light(e, &c->light);
    if (!e->paint.lamp || !e->expose.before || !e->expose.part)
        status = GLINT_E_MEMORY;
    if (status == GLINT_OK)
        status = init_drawing_frame(e, c);
    /* If the caller sets the exposure, only glint_engine_exposed() needs the
     * lens response. Without a model (exact rays) the response is measured when
     * a video needs it. */
    if (status == GLINT_OK && e->paint.frame.lens &&
        (!c->light.by_hand || c->cache))
        status = glint_response_measure_cached(&e->paint.frame, c->arena_bytes,
                                               c->cache, &e->expose.response);
    if (status == GLINT_OK)
        status = open_lamp_detector(e, c);
    glint_engine_select_parts(e, e->paint.parts, c->light.starburst,
                              c->light.gain > 0);
    if (status == GLINT_OK)
        status = reserve_drawing_memory(e, c);
    if (status != GLINT_OK)
        describe_creation_failure(e, c, status, error);
    return status;
}

enum glint_status glint_engine_create(struct glint_engine **engine,
                                      const struct glint_engine_config *cfg,
                                      struct glint_error *error)
{
    struct glint_engine_config whole;
    const char *wrong;
    struct glint_engine *e;
    enum glint_status status;

    *engine = NULL;
    if (cfg->size < FIRST_SIZE || cfg->size > sizeof whole ||
        !are_reserved_members_zero(cfg)) {
        snprintf(error->text, sizeof error->text,
                 "the configuration was not set by glint_engine_defaults(), or "
                 "the program was compiled for another version of glint");
        return GLINT_E_ARGUMENT;
    }
    glint_engine_defaults(&whole, cfg->width, cfg->height);
    memcpy(&whole, cfg, cfg->size);
    wrong = check_engine_config(&whole);
    if (wrong) {
        snprintf(error->text, sizeof error->text, "%s", wrong);
        return GLINT_E_ARGUMENT;
    }
    e = calloc(1, sizeof *e);
    if (!e) {
        snprintf(error->text, sizeof error->text, "not enough memory");
        return GLINT_E_MEMORY;
    }
    status = init_engine(e, &whole, error);
    if (status == GLINT_OK)
        *engine = e;
    else
        glint_engine_destroy(e);
    return status;
}

void glint_engine_destroy(struct glint_engine *engine)
{
    if (!engine)
        return;
    glint_lamp_detector_close(&engine->find.detector);
    glint_frame_finish(&engine->paint.frame);
    glint_dirt_free(engine->optics.dirt);
    if (engine->optics.own_front)
        engine->optics.camera.stops->free_front(engine->optics.own_front);
    free(engine->paint.lamp);
    free(engine->expose.before);
    free(engine->expose.part);
    free(engine);
}

enum glint_status glint_engine_continue(struct glint_engine *engine,
                                        struct glint_engine *from)
{
    const struct glint_view *const a = &engine->paint.frame.view;
    const struct glint_view *const b = &from->paint.frame.view;
    const struct glint_engine_finding find = engine->find;
    const struct glint_engine_exposing expose = engine->expose;

    if (a->width != b->width || a->height != b->height ||
        engine->most_lamps != from->most_lamps ||
        find.detector.max != from->find.detector.max)
        return GLINT_E_ARGUMENT;
    engine->find = from->find;
    engine->expose.strength = from->expose.strength;
    engine->expose.before = from->expose.before;
    engine->expose.part = from->expose.part;
    engine->expose.n_before = from->expose.n_before;
    engine->expose.is_done = false;
    from->find = find;
    from->expose.before = expose.before;
    from->expose.part = expose.part;
    from->expose.n_before = 0;
    glint_engine_set_light(engine, &expose.light);
    return GLINT_OK;
}

/* ----------------------------------------------------------------- settings */

const struct glint_view *glint_engine_view(const struct glint_engine *engine)
{
    return &engine->paint.frame.view;
}

void glint_engine_set_light(struct glint_engine *engine,
                            const struct glint_engine_light *light)
{
    struct glint_strength *const s = &engine->expose.strength;

    engine->expose.light = *light;
    s->asked = light->strength;
    s->is_physical = light->by_hand != 0;
    s->exposure_ev = light->exposure_ev;
    s->gain = light->gain;
}

void glint_engine_set_dials(struct glint_engine *engine,
                            struct glint_dials dials)
{
    struct glint_frame *f = &engine->paint.frame;

    f->dials = f->asked = dials;
    if (f->budget.ms > 0)
        f->dials = glint_budget_get_quality_parameters(&f->budget, &dials);
}

struct glint_dials glint_engine_dials(const struct glint_engine *engine)
{
    return engine->paint.frame.dials;
}

void glint_engine_set_only_ghost(struct glint_engine *engine, int ghost)
{
    engine->paint.frame.only_ghost = ghost;
}

void glint_engine_set_budget(struct glint_engine *engine, double budget_ms)
{
    if (engine->paint.frame.budget.ms > 0)
        engine->paint.frame.budget.ms = budget_ms;
}

void glint_engine_update_stop(struct glint_engine *engine)
{
    struct glint_frame *f = &engine->paint.frame;

    if (f->trace) /* This frees the cached rays of the former setup. */
        f->trace->finish(f);
    glint_setup_stop(engine->optics.setup, &f->cfg.stop);
    glint_frame_apply_config(f);
}

/* Exchanges the stop of ENGINE for another: swaps setup, camera and stop dirt
 * with OTHER, CAMERA and DIRT, and applies the new stop. A second call restores
 * the former stop. */
static void swap_engine_stop(struct glint_engine *engine,
                             struct glint_setup *other,
                             struct glint_engine_camera *camera,
                             struct glint_dirt **dirt)
{
    struct glint_engine_optics *const o = &engine->optics;
    const struct glint_setup own = o->own;
    const struct glint_engine_camera own_camera = o->camera;
    struct glint_dirt *const own_dirt = o->dirt;

    o->own = *other;
    o->camera = *camera;
    o->dirt = *dirt;
    *other = own;
    *camera = own_camera;
    *dirt = own_dirt;
    glint_engine_update_stop(engine);
}

enum glint_status
glint_engine_change_stop(struct glint_engine *engine,
                         const struct glint_engine_camera *camera, bool measure,
                         struct glint_error *error)
{
    struct glint_frame *const f = &engine->paint.frame;
    struct glint_response response = engine->expose.response;
    struct glint_engine_camera other = *camera;
    struct glint_setup setup;
    struct glint_dirt *dirt = NULL;
    enum glint_status status = GLINT_E_ARGUMENT;

    if (engine->optics.setup == &engine->optics.own)
        status = glint_engine_setup(&setup, f->lens, camera, &dirt, error);
    else
        snprintf(error->text, sizeof error->text,
                 "the engine cannot change the stop of camera.setup; leave "
                 "camera.setup NULL");
    if (status != GLINT_OK)
        return status;
    swap_engine_stop(engine, &setup, &other, &dirt);
    if (measure && engine->expose.light.by_hand)
        response.n = 0; /* The response is invalid now, as it was measured for
                           another stop. */
    else if (measure)
        status = glint_response_measure(
            f, f->limits.reserved ? f->memory.bytes : 0, HUGE_VAL, &response);
    if (status == GLINT_OK) {
        engine->expose.response = response;
    } else {
        swap_engine_stop(engine, &setup, &other, &dirt);
        snprintf(error->text, sizeof error->text, "%s",
                 glint_status_text(status));
    }
    glint_dirt_free(dirt);
    return status;
}

enum glint_status glint_engine_stop(struct glint_engine *engine,
                                    double f_number, struct glint_error *error)
{
    struct glint_engine_camera camera = engine->optics.camera;

    camera.f_number = f_number;
    return glint_engine_change_stop(engine, &camera, true, error);
}
