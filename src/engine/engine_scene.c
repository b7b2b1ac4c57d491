/* SPDX-License-Identifier: MIT
 *
 * Adapts the lamps of a picture to a 3-D scene that is composited onto it.
 * Objects of the scene occlude lamps, and its lights become lamps. */
#include <math.h>

#include "engine/engine_parts.h"
#include "glint/area.h"
#include "glint/scene/scene.h"

/* first id of lamps that are lights of a scene */
#define SCENE_IDS UINT32_C(0xffffff00)

/* Multiplies the power of LAMP by SEEN, its visible fraction. Increments HIDDEN
 * if SEEN is 0. */
static void attenuate_occluded_lamp(struct glint_engine_lamp *lamp, double seen,
                                    int *hidden)
{
    lamp->share = fmax(seen, GLINT_ENGINE_HIDDEN);
    lamp->lamp.power *= lamp->share;
    *hidden += seen <= 0;
}

static int occlude_lamps(const struct glint_engine *e,
                         const struct glint_scene *scene,
                         struct glint_engine_lamp *lamps, int n)
{
    const struct glint_view *const view = &e->paint.frame.view;
    const double focal_mm = e->optics.setup->optics.focal_mm;
    const double pixels = 1 / glint_view_pixel_tangent(view, focal_mm);
    int hidden = 0;

    for (int i = 0; i < n; i++) {
        /* the radius of a uniform disc is twice its RMS semi-axis */
        const double radius = 2 * pixels * lamps[i].lamp.axis[0];
        double x, y;
        int cover;

        glint_view_to_pixel(view, focal_mm, &lamps[i].lamp, &x, &y);
        if (!(x >= 0 && y >= 0 && x < view->width && y < view->height))
            continue;
        cover = glint_scene_cover(scene, (int32_t)(256 * x), (int32_t)(256 * y),
                                  (int32_t)(256 * fmin(radius, 1 << 14)));
        attenuate_occluded_lamp(&lamps[i], 1 - cover / 256.0, &hidden);
    }
    return hidden;
}

/* Converts FROM, a light of a scene, to LAMP. Returns false if FROM emits no
 * light. */
static bool convert_scene_lamp(const struct glint_engine *e,
                               const struct glint_scene_lamp *from,
                               struct glint_lamp *lamp)
{
    static const double weight[3] = {0.2126, 0.7152, 0.0722};
    const struct glint_view *const view = &e->paint.frame.view;
    const double focal_mm = e->optics.setup->optics.focal_mm;
    double rgb[3], luminance = 0;

    for (int c = 0; c < 3; c++) {
        rgb[c] = glint_real_value(from->rgb[c]);
        luminance += weight[c] * rgb[c];
    }
    if (!(luminance > 0))
        return false;
    *lamp = (struct glint_lamp){.power = fmin(luminance, 1e30)};
    glint_view_to_angles(view, focal_mm, from->x_q8 / 256.0, from->y_q8 / 256.0,
                         lamp);
    glint_area_set_round(lamp, from->radius_q8 / 256.0 / sqrt(2) *
                                   glint_view_pixel_tangent(view, focal_mm));
    for (int c = 0; c < 3; c++)
        lamp->rgb[c] = rgb[c] / luminance;
    return true;
}

int glint_engine_add_scene(const struct glint_engine *engine,
                           const struct glint_scene *scene,
                           struct glint_engine_lamp *lamps, int n, int *hidden)
{
    struct glint_scene_lamp light[GLINT_SCENE_MAX_LIGHTS];
    const int n_lights = glint_scene_lights(scene, light);
    const int before = n;

    *hidden = occlude_lamps(engine, scene, lamps, n);
    for (int i = 0; i < n_lights; i++) {
        struct glint_lamp lamp;

        if (!convert_scene_lamp(engine, &light[i], &lamp))
            continue;
        lamps[n] =
            glint_engine_lamp_of(&lamp, SCENE_IDS + (uint32_t)(n - before));
        lamps[n].seen_px = -1;
        attenuate_occluded_lamp(&lamps[n++], light[i].share / 16.0, hidden);
    }
    return n;
}

void glint_engine_apply_shares(struct glint_engine_lamp *lamps, int n,
                               int is_still)
{
    for (int i = 0; i < n; i++)
        if (lamps[i].share > GLINT_ENGINE_HIDDEN || !is_still)
            lamps[i].level *= lamps[i].share;
        else /* A hidden lamp is removed. Otherwise the exposure of a still
                picture would raise the lamp's remaining light until that is
                visible. */
            lamps[i].lamp.power = 0;
}

double glint_engine_focal_px(const struct glint_engine *engine)
{
    return 1 / glint_view_pixel_tangent(&engine->paint.frame.view,
                                        engine->optics.setup->optics.focal_mm);
}
