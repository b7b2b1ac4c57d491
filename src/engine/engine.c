/* SPDX-License-Identifier: MIT */
#include "engine/engine_parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/kernels.h"

void glint_engine_defaults(struct glint_engine_config *cfg, int width,
                           int height)
{
    *cfg = (struct glint_engine_config){.width = width,
                                        .height = height,
                                        .sets = glint_sets_here(),
                                        .n_blades = 8,
                                        .threshold_ev = {-0.1, -0.15},
                                        .headroom_ev = -1,
                                        .max_found = 16,
                                        .strength = 0.5,
                                        .gain = 1,
                                        .starburst = 1,
                                        .dials = glint_dials_at(1 << 14)};
}

/* Returns a text that says what is out of range in C, or NULL. */
static const char *check(const struct glint_engine_config *c)
{
    if (c->width < 1 || c->width > GLINT_MAX_SIDE || c->height < 1 ||
        c->height > GLINT_MAX_SIDE)
        return "pictures have 1 to 32768 pixels a side";
    if (!c->model)
        return "there is no model";
    if (c->max_found < 1 || c->max_found > GLINT_ENGINE_MAX_LAMPS / 2)
        return "1 to 512 lamps can be looked for";
    if (!(c->strength >= 0 && c->strength <= 100) || !(c->gain >= 0) ||
        !(fabs(c->exposure_ev) <= 100))
        return "the exposure is out of range";
    if (!(c->starburst >= 0 && c->starburst <= 1000))
        return "the starburst is out of range";
    if (!(c->veil >= 0 && c->haze >= 0 && c->veil + c->haze <= GLINT_MOST_VEIL))
        return "the veil is out of range";
    if (!(c->threshold_ev[0] <= 0 && c->threshold_ev[0] >= -20 &&
          c->threshold_ev[1] >= -20 &&
          c->threshold_ev[1] <= c->threshold_ev[0]))
        return "the thresholds are out of range";
    return NULL;
}

/* ------------------------------------------------------------------- making */

/* Makes a setup of MODEL for SHAPE. *DIRT receives what it refers to, or NULL.
 */
static enum glint_status set_up(struct glint_setup *setup,
                                const struct glint_lens *model,
                                const struct glint_engine_shape *shape,
                                struct glint_dirt **dirt,
                                struct glint_error *error)
{
    static const double wavelength_nm[] = {650, 532, 450};
    enum glint_status status =
        glint_setup_from_model(setup, model, shape->n_blades,
                               shape->rotation_deg, wavelength_nm, 3, error);

    *dirt = NULL;
    if (status == GLINT_OK && shape->f_number != 0)
        status = glint_setup_stop_down(setup, model, shape->f_number, error);
    if (status == GLINT_OK && shape->set_iris)
        status = shape->set_iris(setup, &shape->iris, dirt, error);
    /* The sparse basis has its own three wavelengths and no others. */
    if (status == GLINT_OK && model->header->basis != GLINT_BASIS_SPARSE)
        glint_setup_spread(setup, model);
    return status;
}

static struct glint_view view_of(const struct glint_engine_config *c)
{
    const struct glint_model_header *h = c->model->header;
    const double width_mm = c->sensor_width_mm > 0
                                ? c->sensor_width_mm
                                : glint_real_value(h->film_width_mm);
    const double height_mm = c->sensor_height_mm > 0
                                 ? c->sensor_height_mm
                                 : glint_real_value(h->film_height_mm);

    return glint_view_fit(c->width, c->height, width_mm, height_mm);
}

static enum glint_status open_frame(struct glint_engine *e,
                                    const struct glint_engine_config *c)
{
    struct glint_frame *f = &e->frame;

    glint_frame_init(f, &e->setup, view_of(c), c->workers);
    f->lens = c->model;
    f->clock = c->clock;
    f->cfg.sets = c->sets;
    f->cfg.reuse = &glint_reuse;
    f->dials = f->asked = c->dials;
    if (c->budget_ms <= 0 || !c->clock)
        return GLINT_OK;
    glint_budget_init(&f->budget, c->budget_ms);
    f->dials = glint_budget_dials(&f->budget, &f->dials);
    return glint_frame_calibrate(f);
}

static enum glint_status open_detector(struct glint_engine *e,
                                       const struct glint_engine_config *c)
{
    e->detector.headroom_ev = c->headroom_ev;
    e->detector.max = c->max_found;
    return glint_lamp_detector_open_at(&e->detector, c->width, c->height,
                                       c->threshold_ev);
}

static enum glint_status make(struct glint_engine *e,
                              const struct glint_engine_config *c,
                              struct glint_error *error)
{
    enum glint_status status;

    e->shape =
        (struct glint_engine_shape){.n_blades = c->n_blades,
                                    .rotation_deg = c->blade_rotation_deg,
                                    .f_number = c->f_number};
    status = set_up(&e->setup, c->model, &e->shape, &e->dirt, error);
    if (status != GLINT_OK)
        return status;
    glint_strength_defaults(&e->strength);
    e->strength.asked = c->strength;
    e->strength.is_physical = c->by_hand != 0;
    e->strength.exposure_ev = c->exposure_ev;
    e->strength.gain = c->gain;
    e->starburst = c->starburst;
    e->has_arena = c->arena_bytes > 0;
    status = open_frame(e, c);
    if (status == GLINT_OK && !c->by_hand)
        status =
            glint_response_measure(&e->frame, c->arena_bytes, &e->response);
    if (status == GLINT_OK)
        status = open_detector(e, c);
    if (status == GLINT_OK && c->arena_bytes)
        status = glint_frame_reserve(&e->frame, c->arena, c->arena_bytes,
                                     GLINT_ENGINE_MAX_LAMPS, 2 * c->max_found);
    e->frame.star.share = e->starburst;
    e->frame.veil.glare = c->gain > 0 ? c->veil : 0;
    e->frame.veil.haze = c->gain > 0 ? c->haze : 0;
    if (status == GLINT_OK)
        status = glint_frame_star_hold(&e->frame, 2 * c->max_found);
    if (status == GLINT_OK)
        status = glint_frame_veil_hold(&e->frame);
    if (status != GLINT_OK)
        snprintf(error->text, sizeof error->text, "%s",
                 glint_status_text(status));
    return status;
}

enum glint_status glint_engine_create(struct glint_engine **engine,
                                      const struct glint_engine_config *cfg,
                                      struct glint_error *error)
{
    const char *const wrong = check(cfg);
    struct glint_engine *e;
    enum glint_status status;

    *engine = NULL;
    if (wrong) {
        snprintf(error->text, sizeof error->text, "%s", wrong);
        return GLINT_E_ARGUMENT;
    }
    e = calloc(1, sizeof *e);
    if (!e) {
        snprintf(error->text, sizeof error->text, "no memory");
        return GLINT_E_MEMORY;
    }
    status = make(e, cfg, error);
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
    glint_lamp_detector_close(&engine->detector);
    glint_frame_finish(&engine->frame);
    glint_dirt_free(engine->dirt);
    if (engine->free_front)
        engine->free_front(engine->front);
    free(engine);
}

void glint_engine_turn(struct glint_engine *engine, struct glint_dials dials)
{
    struct glint_frame *f = &engine->frame;

    f->dials = f->asked = dials;
    if (f->budget.ms > 0)
        f->dials = glint_budget_dials(&f->budget, &dials);
}

enum glint_status glint_engine_reshape(struct glint_engine *engine,
                                       const struct glint_engine_shape *shape,
                                       bool measure, struct glint_error *error)
{
    struct glint_engine *e = engine;
    struct glint_frame *f = &e->frame;
    struct glint_setup setup;
    struct glint_dirt *dirt;
    enum glint_status status = set_up(&setup, f->lens, shape, &dirt, error);

    if (status != GLINT_OK) {
        glint_dirt_free(dirt);
        return status;
    }
    e->setup = setup;
    e->shape = *shape;
    glint_setup_stop(&e->setup, &f->cfg.stop);
    glint_frame_retune(f);
    glint_dirt_free(e->dirt);
    e->dirt = dirt;
    if (!measure || e->strength.is_physical)
        return GLINT_OK;
    status =
        glint_response_measure(f, f->reserved ? f->bytes : 0, &e->response);
    if (status != GLINT_OK)
        snprintf(error->text, sizeof error->text, "%s",
                 glint_status_text(status));
    return status;
}

enum glint_status glint_engine_stop(struct glint_engine *engine,
                                    double f_number, struct glint_error *error)
{
    struct glint_engine_shape shape = engine->shape;

    shape.f_number = f_number;
    return glint_engine_reshape(engine, &shape, true, error);
}

/* ----------------------------------------------------------------- pictures */

void glint_engine_elapsed(struct glint_engine *engine, int32_t elapsed_us)
{
    engine->elapsed_us = elapsed_us;
    engine->is_timed = true;
}

int glint_engine_find(struct glint_engine *engine,
                      const struct glint_image *image, int32_t elapsed_us,
                      struct glint_lamp *lamps, int max)
{
    struct glint_engine *e = engine;
    const int n = glint_lamp_detector_frame(&e->detector, image, elapsed_us,
                                            &e->frame.view,
                                            e->setup.optics.focal_mm, e->lamp);

    glint_engine_elapsed(e, elapsed_us);
    e->is_searched = true;
    e->n_found = n < max ? n : max;
    for (int i = 0; i < e->n_found; i++)
        e->level[i] = e->detector.track[i].level_q15 / 32768.0;
    memcpy(lamps, e->lamp, (size_t)e->n_found * sizeof *lamps);
    return e->n_found;
}

/* Returns whether LAMPS are at the places of the lamps found last; their powers
 * may differ. */
static bool are_found(const struct glint_engine *e,
                      const struct glint_lamp *lamps, int n)
{
    for (int i = 0; i < n && n == e->n_found; i++)
        if (lamps[i].theta_deg != e->lamp[i].theta_deg ||
            lamps[i].phi_deg != e->lamp[i].phi_deg)
            return false;
    return n == e->n_found;
}

/* Exposes a picture by itself, for which there is time, by drawing its flare
 * small. */
static void expose_as_drawn(struct glint_engine *e, int n,
                            const struct glint_image *image)
{
    struct glint_ground *ground = NULL;

    if (e->has_arena || e->strength.is_physical || !(e->strength.scale > 0))
        return;
    if (image->format != GLINT_LINEAR_Q20)
        ground = malloc(sizeof *ground);
    if (ground)
        glint_ground_take(ground, image);
    glint_strength_expose_still(&e->strength, &e->frame, e->lamp, n, ground, 1);
    free(ground);
}

/* Sets the factor on the powers of N lamps, and lowers those that are still too
 * bright for it. */
static void expose(struct glint_engine *e, int n, bool is_found,
                   const struct glint_image *image)
{
    const double pixels = (double)e->frame.view.width * e->frame.view.height;
    const struct glint_strength_lamps lamps = {
        e->lamp, is_found ? e->level : NULL, n, pixels};
    const bool is_new = (is_found || e->is_searched) &&
                        glint_lamp_tracker_was_cut(e->detector.tracks);

    glint_strength_expose(&e->strength, &e->response, &lamps,
                          is_new ? 0 : e->elapsed_us);
    if (e->elapsed_us == 0 && e->frame.budget.ms <= 0)
        expose_as_drawn(e, n, image);
}

static void set_report(const struct glint_engine *e,
                       const struct glint_frame_report *r,
                       struct glint_engine_report *report)
{
    *report = (struct glint_engine_report){
        .lamps = r->lights,
        .lamps_beyond = r->beyond_lights,
        .lights = r->drawn_lights,
        .ghosts = r->ghosts,
        .bundles = r->stats.bundles,
        .dropped_bundles = r->stats.dropped_bundles,
        .dropped_cells = r->stats.dropped_cells,
        .bytes = r->arena_bytes,
        .need_bytes = r->need_bytes,
        .scale = e->strength.scale,
        .plan_ms = r->plan_ms,
        .bin_ms = r->bin_ms,
        .draw_ms = r->draw_ms,
        .quality = r->quality};
}

enum glint_status glint_engine_draw(struct glint_engine *engine,
                                    const struct glint_lamp *lamps, int n,
                                    const struct glint_image *image,
                                    struct glint_engine_report *report)
{
    struct glint_engine *e = engine;
    struct glint_frame *f = &e->frame;
    struct glint_frame_report drawn;
    enum glint_status status;
    bool is_found;

    if (image->width != f->view.width || image->height != f->view.height ||
        n < 0 || n > GLINT_ENGINE_MAX_LAMPS)
        return GLINT_E_ARGUMENT;
    is_found = are_found(e, lamps, n);
    e->n_found = is_found ? n : 0;
    if (!is_found && !e->is_timed)
        e->elapsed_us = 0;
    memcpy(e->lamp, lamps, (size_t)n * sizeof *lamps);
    expose(e, n, is_found, image);
    f->star.share = glint_strength_star(&e->strength, e->starburst);
    for (int i = 0; i < n && is_found; i++)
        e->seen_px[i] = e->detector.track[i].size_q8 / 256.0;
    for (int i = 0; i < n && is_found; i++)
        e->excess[i] = glint_lamp_excess(&e->lamp[i], &e->detector.track[i],
                                         e->level[i], 1, 1);
    f->veil.excess = is_found ? e->excess : NULL;
    f->star.seen_px =
        is_found && e->detector.headroom_ev < 0 ? e->seen_px : NULL;
    f->star.level = is_found ? e->level : NULL;
    if (f->budget.ms <= 0)
        glint_frame_set_still(f, e->elapsed_us == 0, true, true);
    status = glint_frame_draw(f, e->lamp, e->strength.scale > 0 ? n : 0,
                              e->strength.scale, image, &drawn);
    e->is_timed = e->is_searched = false;
    drawn.lights = n;
    set_report(e, &drawn, report);
    return status;
}
