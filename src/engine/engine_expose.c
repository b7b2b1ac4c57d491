/* SPDX-License-Identifier: MIT
 *
 * Chooses the exposure of a picture's flare, which is the factor on its
 * brightness. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/engine_parts.h"

const struct glint_engine_exposure *
glint_engine_exposed(const struct glint_engine *engine)
{
    return &engine->expose.last;
}

int glint_engine_has_veil(const struct glint_engine *engine)
{
    return glint_frame_has_veil(&engine->paint.frame);
}

bool glint_engine_can_draw_on_image(const struct glint_engine *engine,
                                    const struct glint_image *image, int n)
{
    const struct glint_view *const view = &engine->paint.frame.view;

    return image->width == view->width && image->height == view->height &&
           n >= 0 && n <= engine->most_lamps;
}

/* Returns the factor on the ghosts of the lamp with number ID that the last
 * exposure chose. Returns 1 if the last exposure had no such lamp. I is the
 * index at which the lamp is searched first. The index differs if only some
 * lamps of the picture are drawn. */
static double find_ghost_exposure_factor(const struct glint_engine_exposing *x,
                                         uint32_t id, int i)
{
    if (i < x->n_before && x->before[i].id == id)
        return x->part[i];
    for (int k = 0; k < x->n_before; k++)
        if (x->before[k].id == id)
            return x->part[k];
    return 1;
}

const struct glint_lamp *
glint_engine_copy_ghost_lamps(struct glint_engine *engine,
                              const struct glint_engine_lamp *lamps, int n)
{
    const struct glint_engine_exposing *const x = &engine->expose;

    for (int i = 0; i < n; i++) {
        engine->paint.lamp[i] = lamps[i].lamp;
        engine->paint.lamp[i].power *=
            find_ghost_exposure_factor(x, lamps[i].id, i);
    }
    return engine->paint.lamp;
}

void glint_engine_select_parts(struct glint_engine *engine, unsigned parts,
                               double star, bool veil)
{
    const struct glint_engine_light *const light = &engine->expose.light;
    struct glint_frame *const f = &engine->paint.frame;

    veil = veil && parts & GLINT_ENGINE_VEIL;
    f->star.is_alone = !(parts & GLINT_ENGINE_GHOSTS);
    f->star.is_bare = (parts & GLINT_ENGINE_CORES) != 0;
    f->star.share = parts & GLINT_ENGINE_STAR ? star : 0;
    f->veil.glare = veil ? light->veil : 0;
    f->veil.haze = veil ? light->haze : 0;
    f->veil.front = veil ? engine->optics.front : NULL;
}

/* Corrects the exposure of a still picture by drawing its flare at reduced size
 * and measuring it. Too slow for videos. */
static enum glint_status
expose_by_drawing_flare(struct glint_engine *e, int n,
                        const struct glint_image *image, double white)
{
    struct glint_engine_exposing *const x = &e->expose;
    struct glint_ground *ground = NULL;
    enum glint_status status;

    if (x->strength.is_physical || !(x->strength.scale > 0))
        return GLINT_OK;
    if (image->format != GLINT_LINEAR_Q20) {
        ground = malloc(sizeof *ground);
        if (!ground)
            return GLINT_E_MEMORY;
        glint_ground_sample_picture(ground, image);
    }
    status = glint_strength_expose_still_picture(
        &x->strength, &e->paint.frame, e->paint.lamp, n, ground, white);
    free(ground);
    return status;
}

/* Returns the light of LAMP that clipping removed from the picture, in white
 * times pixels, as if no object occluded the lamp. In a video it is smoothed
 * over a third of a second, as the estimate for a clipped lamp may jump from
 * picture to picture. */
static double compute_smoothed_excess(const struct glint_engine_exposing *x,
                                      const struct glint_engine_lamp *lamp,
                                      double white, int32_t elapsed_us)
{
    const double excess = glint_lamp_compute_excess_light(
        &lamp->lamp, &lamp->track, lamp->level, lamp->share, white);
    const double k = 1 - exp(-3e-6 * elapsed_us);

    for (int j = 0; j < x->n_before && elapsed_us > 0; j++)
        if (x->before[j].id == lamp->id)
            return x->before[j].excess + k * (excess - x->before[j].excess);
    return excess;
}

static void set_lamp_excess(struct glint_engine_exposing *x,
                            struct glint_engine_lamp *lamps, int n,
                            double white, int32_t elapsed_us)
{
    for (int i = 0; i < n; i++)
        lamps[i].excess =
            lamps[i].is_found
                ? compute_smoothed_excess(x, &lamps[i], white, elapsed_us)
                : lamps[i].lamp.power /
                      fmax(lamps[i].share, GLINT_ENGINE_HIDDEN);
    for (int i = 0; i < n; i++) {
        x->before[i] =
            (struct glint_engine_before){lamps[i].id, lamps[i].excess};
        lamps[i].excess *= lamps[i].share;
    }
    x->n_before = n;
}

/* Measures the response of X with FRAME unless it is measured: by exact rays
 * again if one of the N LAMPS is larger than all lamps before. */
static enum glint_status
measure_missing_response(struct glint_engine_exposing *x,
                         const struct glint_frame *frame,
                         const struct glint_engine_lamp *lamps, int n)
{
    struct glint_response measured;
    enum glint_status status;
    double extent = frame->lens ? HUGE_VAL : 0;

    for (int i = 0; i < n; i++)
        extent =
            fmax(extent, hypot(lamps[i].lamp.axis[0], lamps[i].lamp.axis[1]));
    if (x->response.n > 0 && glint_response_has_extent(&x->response, extent))
        return GLINT_OK;
    measured = x->response;
    status = glint_response_measure(frame, 0, extent, &measured);
    if (status == GLINT_OK)
        x->response = measured;
    return status;
}

enum glint_status glint_engine_expose(struct glint_engine *engine,
                                      struct glint_engine_lamp *lamps, int n,
                                      const struct glint_image *image,
                                      double white)
{
    struct glint_engine_finding *const find = &engine->find;
    struct glint_engine_exposing *const x = &engine->expose;
    struct glint_frame *const f = &engine->paint.frame;
    const struct glint_strength_lamps all = {
        lamps, x->part, n, (double)f->view.width * f->view.height * white};
    const int32_t elapsed_us = find->elapsed_us;
    const bool is_new =
        find->is_cut || (find->is_searched && elapsed_us > 0 &&
                         glint_lamp_tracker_was_cut(find->detector.tracks));
    const bool is_drawn = elapsed_us == 0 && f->budget.ms <= 0 && x->by_drawing;
    /* No measured response is needed: the exposure that is computed from this
     * placeholder is replaced when the flare has been drawn. */
    const struct glint_response any = {.n = 1};
    enum glint_status status = GLINT_OK;

    if (!glint_engine_can_draw_on_image(engine, image, n))
        return GLINT_E_ARGUMENT;
    if (!x->light.by_hand && n > 0 && !is_drawn)
        status = measure_missing_response(x, f, lamps, n);
    if (status != GLINT_OK)
        return status;
    set_lamp_excess(x, lamps, n, white, is_new ? 0 : elapsed_us);
    glint_strength_expose_frame(&x->strength,
                                x->response.n ? &x->response : &any, &all,
                                is_new ? 0 : elapsed_us);
    glint_engine_copy_ghost_lamps(engine, lamps, n);
    if (is_drawn)
        status = expose_by_drawing_flare(engine, n, image, white);
    if (status != GLINT_OK)
        return status;
    glint_engine_select_parts(
        engine, engine->paint.parts,
        glint_strength_compute_star_factor(&x->strength, x->light.starburst),
        x->light.gain > 0);
    f->veil.alone_gain = 1;
    if (f->budget.ms <= 0)
        glint_frame_set_area_sampling(f, elapsed_us == 0,
                                      !engine->paint.keep_points,
                                      !engine->paint.keep_lights);
    x->last = (struct glint_engine_exposure){.scale = x->strength.scale,
                                             .light = x->strength.light,
                                             .is_drawn = x->strength.is_drawn,
                                             .is_new = is_new};
    x->is_done = true;
    find->elapsed_us = 0;
    find->is_searched = find->is_cut = false;
    return glint_frame_veil_read_picture(f, image, white);
}
