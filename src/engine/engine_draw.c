/* SPDX-License-Identifier: MIT
 *
 * Draws the flare of a picture, or parts of the flare as separate layers. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/engine_parts.h"

enum glint_status glint_engine_draw(struct glint_engine *engine,
                                    struct glint_engine_lamp *lamps, int n,
                                    const struct glint_image *image,
                                    struct glint_engine_report *report)
{
    struct glint_frame *const f = &engine->paint.frame;
    enum glint_status status = GLINT_OK;
    double scale;

    if (!glint_engine_can_draw_on_image(engine, image, n))
        return GLINT_E_ARGUMENT;
    if (!engine->expose.is_done)
        status = glint_engine_expose(engine, lamps, n, image, 1);
    if (status != GLINT_OK)
        return status;
    engine->expose.is_done = false;
    scale = engine->expose.last.scale;
    f->known = lamps;
    status =
        glint_frame_draw(f, glint_engine_copy_ghost_lamps(engine, lamps, n),
                         scale > 0 ? n : 0, scale, image, report);
    f->known = NULL;
    f->progress = NULL;
    report->lights = n;
    report->scale = scale;
    return status;
}

/* log2 of the factor by which the light of a picture of 16 bits is multiplied
 * for its plan. An eighth of an 8-bit code, the light that is omitted, is then
 * 0.2 steps of 16 bits of linear light. Light above 128 times white is
 * clamped. */
enum { LIFT_16_LOG2 = 4 };

/* Draws the selected parts of the flare (ghosts, starbursts, veil) into RGB,
 * linear light. Ghosts and quality are chosen as for a picture of 8-bit codes
 * whose light is 2^LIFT_LOG2 times that of RGB. */
static enum glint_status draw_linear_with_8bit_plan(
    struct glint_frame *f, const struct glint_lamp *lamps, int n, double scale,
    int lift_log2, float *rgb, struct glint_engine_report *report)
{
    const float unit = (float)ldexp(1, -20 - lift_log2);
    const size_t samples = 3 * (size_t)f->view.width * (size_t)f->view.height;
    struct glint_image layer =
        glint_image_over(rgb, GLINT_LINEAR_Q20, f->view.width, f->view.height);
    enum glint_status status;

    /* Until the conversion below, RGB contains integers, _q20. */
    f->picture.for_codes = true;
    status =
        glint_frame_draw(f, lamps, n, ldexp(scale, lift_log2), &layer, report);
    f->picture.for_codes = false;
    for (size_t i = 0; i < samples; i++) {
        int32_t light_q20;

        memcpy(&light_q20, &rgb[i], sizeof light_q20);
        rgb[i] = (float)light_q20 * unit;
    }
    return status;
}

/* Adds the veil that was computed for the last picture to RGB. */
static enum glint_status draw_prepared_veil(struct glint_frame *f, float *rgb)
{
    const size_t samples = 3 * (size_t)f->view.width * (size_t)f->view.height;
    int32_t *const linear_q20 = malloc(samples * sizeof *linear_q20);

    if (!linear_q20)
        return GLINT_E_MEMORY;
    glint_frame_veil_add_to_rgb(f, 1, linear_q20, rgb);
    free(linear_q20);
    return GLINT_OK;
}

enum glint_status glint_engine_draw_layer(struct glint_engine *engine,
                                          const struct glint_engine_lamp *lamps,
                                          int n, unsigned parts, float *rgb,
                                          struct glint_engine_report *report)
{
    struct glint_frame *const f = &engine->paint.frame;
    const double star = f->star.share, scale = engine->expose.last.scale;
    const unsigned drawn = parts & engine->paint.parts;
    const struct glint_lamp *plain;
    enum glint_status status = GLINT_OK;

    if (n < 0 || n > engine->most_lamps)
        return GLINT_E_ARGUMENT;
    plain = glint_engine_copy_ghost_lamps(engine, lamps, n);
    memset(rgb, 0,
           3 * (size_t)f->view.width * (size_t)f->view.height * sizeof *rgb);
    *report = (struct glint_engine_report){.lights = n, .scale = scale};
    if (parts == GLINT_ENGINE_VEIL && f->veil.is_set)
        return draw_prepared_veil(f, rgb);
    if ((drawn & GLINT_ENGINE_ALL) == 0)
        return GLINT_OK;
    glint_engine_select_parts(engine, drawn | (parts & GLINT_ENGINE_CORES),
                              star, engine->expose.light.gain > 0);
    f->known = lamps;
    if (parts & GLINT_ENGINE_CODES || n == 0)
        status = draw_linear_with_8bit_plan(f, plain, n, scale, 0, rgb, report);
    else if (parts & GLINT_ENGINE_CODES_16)
        status = draw_linear_with_8bit_plan(f, plain, n, scale, LIFT_16_LOG2,
                                            rgb, report);
    else if (drawn & (GLINT_ENGINE_GHOSTS | GLINT_ENGINE_VEIL) || star > 0)
        status = glint_frame_draw_flare_alone(f, plain, n, scale, rgb, report);
    f->known = NULL;
    f->progress = NULL;
    glint_engine_select_parts(engine, engine->paint.parts, star,
                              engine->expose.light.gain > 0);
    report->lights = n;
    report->scale = scale;
    return status;
}

enum glint_status glint_engine_draw_at(struct glint_engine *engine,
                                       const struct glint_lamp *lamps, int n,
                                       double scale,
                                       const struct glint_image *image,
                                       struct glint_engine_report *report)
{
    struct glint_frame *const f = &engine->paint.frame;
    enum glint_status status;

    if (!glint_engine_can_draw_on_image(engine, image, 0))
        return GLINT_E_ARGUMENT;
    glint_engine_select_parts(engine, engine->paint.parts,
                              engine->expose.light.starburst, true);
    status = glint_frame_draw(f, lamps, n, scale, image, report);
    f->progress = NULL;
    report->scale = scale;
    return status;
}

enum glint_status glint_engine_render(struct glint_engine *engine,
                                      const struct glint_lamp *lamps, int n,
                                      double gain, unsigned parts, float *rgb,
                                      struct glint_engine_report *report)
{
    struct glint_frame *const f = &engine->paint.frame;
    enum glint_status status;

    glint_engine_select_parts(
        engine, parts & (engine->paint.parts | GLINT_ENGINE_CORES),
        engine->expose.light.starburst, true);
    f->veil.alone_gain = 0;
    if (parts & GLINT_ENGINE_CODES) {
        memset(rgb, 0,
               3 * (size_t)f->view.width * (size_t)f->view.height *
                   sizeof *rgb);
        status = draw_linear_with_8bit_plan(f, lamps, n, gain, 0, rgb, report);
    } else
        status = glint_frame_draw_flare_alone(f, lamps, n, gain, rgb, report);
    f->progress = NULL;
    report->scale = gain;
    return status;
}

enum glint_status glint_engine_measure(struct glint_engine *engine,
                                       const struct glint_engine_lamp *lamps,
                                       int n,
                                       struct glint_response_light *light)
{
    struct glint_lamp *const plain = malloc(((size_t)n + 1) * sizeof *plain);
    enum glint_status status = GLINT_E_MEMORY;

    for (int i = 0; i < n && plain; i++)
        plain[i] = lamps[i].lamp;
    if (plain)
        status = glint_response_draw_and_measure(&engine->paint.frame, plain, n,
                                                 GLINT_RESPONSE_FINE, NULL,
                                                 light, NULL);
    free(plain);
    return status;
}
