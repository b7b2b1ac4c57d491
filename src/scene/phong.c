/* SPDX-License-Identifier: MIT
 *
 * Reflects ambient light and the light of lamps and suns by the Phong model
 * [Phong75]. Light is _q15 and saturates at 2^30; products of light and
 * weights, _q15 up to 1, are below 2^45. */
#include "base/divide.h"
#include "scene/parts.h"
#include "scene/state.h"

static inline void add_light_times_weight(int32_t *to_q15, int64_t light_q15,
                                          int32_t weight_q15)
{
    int64_t sum_q15 = light_q15 < GLINT_SCENE_MOST_LIGHT
                          ? light_q15
                          : (int64_t)GLINT_SCENE_MOST_LIGHT;

    if (weight_q15 != GLINT_SCENE_ONE_Q15)
        sum_q15 = (sum_q15 * weight_q15 + (1 << 14)) >> 15;
    sum_q15 += *to_q15;
    *to_q15 = sum_q15 < GLINT_SCENE_MOST_LIGHT ? (int32_t)sum_q15
                                               : GLINT_SCENE_MOST_LIGHT;
}

/* ------------------------------------------------------------------- gloss */

/* The table has (1 - y)^k for the exponent k. It ends at y = 1 - 2^(-17 / k),
 * where the power falls below 2^-17. For larger y the power is 0. */
void glint_gloss_fill_power_table(struct glint_gloss *gloss, int32_t power_q8)
{
    int32_t end_q30 = 1 << 30;

    /* bisection for the smallest y with (1 - y)^k = 0 */
    for (int32_t step_q30 = 1 << 29; step_q30; step_q30 /= 2)
        if (end_q30 > step_q30 &&
            glint_compute_power_q15((1 << 30) - (end_q30 - step_q30),
                                    power_q8) == 0)
            end_q30 -= step_q30;
    gloss->end_q30 = end_q30;
    gloss->scale_q30 = q_divide(INT64_C(1) << 60, end_q30);
    for (int i = 0; i <= GLINT_GLOSS_STEPS; i++)
        gloss->at_q15[i] = (uint16_t)glint_compute_power_q15(
            (1 << 30) -
                (int32_t)((int64_t)end_q30 * i >> GLINT_GLOSS_STEPS_LOG2),
            power_q8);
}

/* Returns the specular factor of a light: a power of the cosine between the ray
 * and the mirrored direction L - 2 (L.N) N, where L is the light's direction
 * and N the normal. */
static inline int32_t
compute_specular_q15(const struct glint_gloss *gloss,
                     const struct glint_scene_ray *ray,
                     const struct glint_met_surface *surface,
                     const int32_t toward_q30[3], int32_t cosine_q30)
{
    const int64_t beside_q60 =
        v3_dot(toward_q30, ray->toward_q30) -
        2 * (int64_t)cosine_q30 *
            v3_cosine_q30(surface->normal_q30, ray->toward_q30);
    const int64_t y_q30 = (1 << 30) - (beside_q60 >> 30);
    int32_t at_q16, i;

    if (y_q30 >= gloss->end_q30)
        return 0;
    if (y_q30 <= 0)
        return GLINT_SCENE_ONE_Q15;
    at_q16 =
        (int32_t)(y_q30 * gloss->scale_q30 >> (44 - GLINT_GLOSS_STEPS_LOG2));
    i = at_q16 >> 16;
    return gloss->at_q15[i] -
           ((gloss->at_q15[i] - gloss->at_q15[i + 1]) * (at_q16 & 65535) >> 16);
}

/* ------------------------------------------------------------------ lights */

/* Adds the highlight of light LIT on a brushed metal. T: distance of LIT,
 * steps. SHARE_Q15: fraction of LIT's light that reaches the surface. */
static void add_metal_highlight(
    const struct glint_scene *s, const struct glint_scene_ray *ray,
    const struct glint_met_surface *surface, struct glint_brushed *brushed,
    const struct glint_lit *lit, int32_t t, const int32_t toward_q30[3],
    const int32_t level_q15[3], int32_t share_q15, int32_t rgb_q15[3])
{
    const int32_t radius = lit->light->radius;
    const int32_t radius_q30 =
        t == GLINT_FAR ? radius
                       : q_smaller(glint_divide_rounded((uint64_t)radius << 30,
                                                        (uint64_t)t),
                                   1 << 29);
    int32_t shine_q15[3];

    if (brushed->spread_q30 < 0)
        brushed->spread_q30 = s->cfg.parts.wards->spread(s, ray, surface);
    if (!s->cfg.parts.wards->shine(s, ray, surface, brushed, toward_q30,
                                   level_q15, radius_q30, shine_q15))
        return;
    for (int c = 0; c < 3; c++)
        add_light_times_weight(&rgb_q15[c], shine_q15[c], share_q15);
}

/* Adds the reflection of one light source. BRUSHED must be NULL if SURFACE is
 * not a metal. */
static WHOLLY_INLINE void add_light_reflection(
    const struct glint_scene *s, const struct glint_scene_ray *ray,
    const struct glint_met_surface *surface, struct glint_brushed *brushed,
    const struct glint_lit *lit, const int32_t colour_q15[3],
    int32_t weight_q15, int32_t rgb_q15[3])
{
    const struct glint_scene_material *m = surface->material;
    const int is_sun = lit->light->kind == GLINT_LIGHT_SUN;
    int32_t lamp_q30[3], lamp_q15[3], cosine_q30, gloss = 0, share_q15;
    int32_t t = GLINT_FAR;
    const int32_t *toward_q30 = is_sun ? lit->toward_q30 : lamp_q30;
    const int32_t *level_q15 = is_sun ? lit->rgb_q15 : lamp_q15;

    if (!is_sun)
        t = glint_scene_compute_light_at(s, lit, surface->place, lamp_q30,
                                         lamp_q15);
    if (t == 0)
        return;
    cosine_q30 = v3_cosine_q30(toward_q30, surface->normal_q30);
    if (cosine_q30 <= 0)
        return;
    share_q15 = glint_scene_lit_fraction(s, surface, lit);
    if (share_q15 == 0)
        return;
    if (m->specular_q15)
        gloss = compute_specular_q15(&s->gloss[m - s->model.material], ray,
                                     surface, toward_q30, cosine_q30);
    share_q15 = q_mul(share_q15, weight_q15, 15);
    if (brushed)
        add_metal_highlight(s, ray, surface, brushed, lit, t, toward_q30,
                            level_q15, share_q15, rgb_q15);
    if (brushed && !(colour_q15[0] | colour_q15[1] | colour_q15[2]))
        return;
    /* both factors are _q15, at most 1; the product is _q30 */
    gloss *= m->specular_q15;
    cosine_q30 = q_mul(m->diffuse_q15, cosine_q30, 15);
    for (int c = 0; c < 3; c++) {
        const int64_t white_q30 =
            ((int64_t)cosine_q30 * colour_q15[c] >> 15) + gloss;

        add_light_times_weight(&rgb_q15[c],
                               (level_q15[c] * white_q30 + (1 << 29)) >> 30,
                               share_q15);
    }
}

/* Inlined, so that compilers specialise it for weight 1, which most pixels
 * have. */
static WHOLLY_INLINE void
add_phong_lights(const struct glint_scene *scene,
                 const struct glint_scene_ray *ray,
                 const struct glint_met_surface *surface, int32_t weight_q15,
                 int32_t rgb_q15[3])
{
    const struct glint_scene_material *m = surface->material;
    const struct glint_scene_wards *wards = scene->cfg.parts.wards;
    const int is_metal = m->ward != GLINT_SCENE_NONE;
    struct glint_brushed brushed;
    int32_t colour_q15[3];

    if (scene->placed[surface->object].skin >= 0) {
        const int32_t coat_q15 = scene->cfg.parts.stones->add(
            scene, ray, surface, weight_q15, rgb_q15);

        if (coat_q15 && !is_metal)
            return;
        if (coat_q15)
            weight_q15 = q_mul(weight_q15, coat_q15, 15);
    }
    for (int c = 0; c < 3; c++)
        colour_q15[c] = m->rgb_q15[c];
    if (m->texture != GLINT_SCENE_NONE)
        scene->cfg.parts.textures->colour(scene, ray, surface, colour_q15);
    for (int c = 0; c < 3; c++)
        add_light_times_weight(
            &rgb_q15[c], q_mul(m->ambient_q15, colour_q15[c], 15), weight_q15);
    if (is_metal)
        wards->lie(scene, surface, &brushed);
    if (scene->wards)
        wards->reflect(scene, ray, surface, is_metal ? &brushed : NULL,
                       colour_q15, weight_q15, rgb_q15);
    for (uint32_t i = 0; i < scene->n_lit; i++)
        add_light_reflection(scene, ray, surface, is_metal ? &brushed : NULL,
                             &scene->lit[i], colour_q15, weight_q15, rgb_q15);
}

void glint_scene_add_phong_light(const struct glint_scene *scene,
                                 const struct glint_scene_ray *ray,
                                 const struct glint_met_surface *surface,
                                 int32_t weight_q15, int32_t rgb_q15[3])
{
    add_phong_lights(scene, ray, surface, weight_q15, rgb_q15);
}

/* Returns the fraction of the light of all sources that is shadowed at SURFACE,
 * times the strength CATCHER_Q15, q8. SURFACE is on a shadow catcher, a plane
 * that only receives shadows. */
static int compute_catcher_shadow_q8(const struct glint_scene *s,
                                     const struct glint_met_surface *surface,
                                     int32_t catcher_q15)
{
    int64_t all = 0, gone = 0;

    for (uint32_t i = 0; i < s->n_lit; i++) {
        int32_t toward_q30[3], level_q15[3];
        int64_t light;

        if (!glint_scene_compute_light_at(s, &s->lit[i], surface->place,
                                          toward_q30, level_q15))
            continue;
        light = q_larger(0, v3_cosine_q30(toward_q30, surface->normal_q30));
        light = light * ((int64_t)level_q15[0] + 2 * (int64_t)level_q15[1] +
                         level_q15[2]) >>
                6; /* LIGHT is below 2^56, so 32 lights sum to less than 2^61 */
        all += light;
        if (light > 0)
            gone += (light >> 15) *
                    (GLINT_SCENE_ONE_Q15 -
                     glint_scene_lit_fraction(s, surface, &s->lit[i]));
    }
    if (gone <= 0 || all <= 0)
        return 0;
    return (int)q_shift((int64_t)glint_divide_rounded(
                            (uint64_t)gone << (all < INT64_C(1) << 48 ? 8 : 0),
                            (uint64_t)all >> (all < INT64_C(1) << 48 ? 0 : 8)) *
                            catcher_q15,
                        15);
}

void glint_scene_shade_surface(const struct glint_scene *scene,
                               const struct glint_scene_ray *ray,
                               const struct glint_met_surface *surface,
                               struct glint_met_shade *shade)
{
    const struct glint_scene_material *m = surface->material;
    const struct glint_placed *p = &scene->placed[surface->object];

    *shade = (struct glint_met_shade){{0, 0, 0}, GLINT_COVER_ALL};
    if (scene->has_catchers && p->is_catcher) {
        shade->cover_q8 = q_smaller(
            compute_catcher_shadow_q8(scene, surface, p->object->catcher_q15),
            GLINT_COVER_ALL);
        return;
    }
    add_phong_lights(scene, ray, surface, GLINT_SCENE_ONE_Q15, shade->rgb_q15);
    if (m->reflect_q15 || m->pass_q15)
        scene->cfg.parts.bounces->follow(scene, ray, surface, shade);
}
