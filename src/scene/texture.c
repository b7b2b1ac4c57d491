/* SPDX-License-Identifier: MIT
 *
 * Samples textures: bilinearly within a mip level, in linear light, and blended
 * between the two levels whose texels are closest in size to the longer side of
 * a pixel on the surface. */
#include "base/log2.h"
#include "base/real.h"
#include "scene/parts.h"
#include "scene/state.h"

enum { LEAST_COSINE_Q30 = 1 << 22 };

/* ------------------------------------------------------------------ u and v */

static void set_texture_coordinates_of_ball(const struct glint_placed *p,
                                            struct glint_met_surface *s)
{
    glint_compute_ball_uv(p, s, s->uv_q16);
    /* log2 of the area in uv space, 1, divided by the area of the ball, 4 pi
     * radius^2 steps^2 */
    s->uv_log2_q16 =
        -Q_CONST(3.6514961, 16) - 2 * q_log2_q16((uint64_t)p->radius);
}

static void set_texture_coordinates_of_plane(const struct glint_scene *scene,
                                             const struct glint_placed *p,
                                             struct glint_met_surface *s)
{
    const int unit_log2 = scene->model.header->unit_log2;
    int32_t off[3], at[3];

    v3_subtract(s->place, p->at, off);
    v3_rotate_back(&p->turn, off, at);
    for (int k = 0; k < 2; k++) {
        const struct glint_real uv = real_of(k ? -at[2] : at[0], -unit_log2);

        /* Textures repeat, so the integer part of the coordinate is dropped. */
        s->uv_q16[k] =
            (int32_t)(real_integer(uv, 16, INT64_C(1) << 62) & ((1 << 24) - 1));
    }
    s->uv_log2_q16 = -2 * unit_log2 * 65536;
}

/* ------------------------------------------------------------------- texels */

/* Returns the mip level, _q16: log2 of the longer side of a pixel on the
 * surface, measured in texels. */
static int32_t compute_mip_level(const struct glint_scene *scene,
                                 const struct glint_scene_ray *ray,
                                 const struct glint_met_surface *s,
                                 const struct glint_scene_texture *t)
{
    const int32_t cosine_q30 = q_larger(
        -v3_cosine_q30(ray->toward_q30, s->face_q30), LEAST_COSINE_Q30);
    const int64_t area_q16 =
        s->uv_log2_q16 + (int32_t)((t->width_log2 + t->height_log2) << 16);
    const int64_t side_q16 = q_log2_q16((uint64_t)s->t) +
                             q_log2_q16((uint64_t)scene->view.step_q56[0]) -
                             q_log2_q16((uint64_t)cosine_q30) -
                             ((56 - 8 - 30) << 16);
    const int most = q_larger((int32_t)t->width_log2, (int32_t)t->height_log2);

    return q_clamp_sat(side_q16 + area_q16 / 2, 0, most << 16);
}

/* Sets I to the indices of the two texels on both sides of coordinate UV;
 * returns the weight of the second texel. */
static uint32_t find_texel_pair(int32_t uv_q16, uint32_t log2, uint32_t i[2])
{
    const int64_t at_q16 = (int64_t)uv_q16 * (1 << log2) - (1 << 15);
    const uint32_t mask = (1U << log2) - 1;

    i[0] = (uint32_t)(at_q16 >> 16) & mask;
    i[1] = (i[0] + 1) & mask;
    return (uint32_t)at_q16 & 0xffff;
}

/* Sets RGB_Q20 to the bilinear light of texture T at (U, V) in mip level
 * LEVEL. */
static void sample_mip_level(const struct glint_scene *scene,
                             const struct glint_scene_texture *t,
                             const int32_t uv_q16[2], int level,
                             int32_t rgb_q20[3])
{
    const uint8_t *texel = (const uint8_t *)scene->model.header + t->texel_at;
    const int32_t *light_q20 = scene->curve->decode_q20;
    uint32_t w = t->width_log2, h = t->height_log2, x[2], y[2], fx, fy;

    for (int i = 0; i < level; i++) {
        texel += (size_t)3 << (w + h);
        w -= w > 0;
        h -= h > 0;
    }
    fx = find_texel_pair(uv_q16[0], w, x);
    fy = find_texel_pair(uv_q16[1], h, y);
    for (size_t c = 0; c < 3; c++) {
        int64_t row_q20[2];

        for (int k = 0; k < 2; k++) {
            const int32_t a = light_q20[texel[3 * ((y[k] << w) + x[0]) + c]];
            const int32_t b = light_q20[texel[3 * ((y[k] << w) + x[1]) + c]];

            row_q20[k] = a + q_shift((int64_t)(b - a) * fx, 16);
        }
        rgb_q20[c] =
            (int32_t)(row_q20[0] + q_shift((row_q20[1] - row_q20[0]) * fy, 16));
    }
}

static void multiply_light_by_texture(const struct glint_scene *scene,
                                      const struct glint_scene_ray *ray,
                                      const struct glint_met_surface *surface,
                                      int32_t rgb_q15[3])
{
    const struct glint_scene_texture *t =
        &scene->model.texture[surface->material->texture];
    const struct glint_placed *p = &scene->placed[surface->object];
    struct glint_met_surface s = *surface;
    int32_t level_q16, fine_q20[3], coarse_q20[3];

    if (p->object->kind == GLINT_OBJECT_SPHERE)
        set_texture_coordinates_of_ball(p, &s);
    else if (p->object->kind == GLINT_OBJECT_PLANE)
        set_texture_coordinates_of_plane(scene, p, &s);
    level_q16 = compute_mip_level(scene, ray, &s, t);
    sample_mip_level(scene, t, s.uv_q16, level_q16 >> 16, fine_q20);
    if (level_q16 & 0xffff)
        sample_mip_level(scene, t, s.uv_q16, (level_q16 >> 16) + 1, coarse_q20);
    for (int c = 0; c < 3; c++) {
        if (level_q16 & 0xffff)
            fine_q20[c] +=
                q_mul(coarse_q20[c] - fine_q20[c], level_q16 & 0xffff, 16);
        rgb_q15[c] = q_mul(rgb_q15[c], fine_q20[c], 20);
    }
}

static void prepare_decoding_curve(struct glint_curve *curve)
{
    glint_curve_init(curve, GLINT_TONE_SRGB);
}

const struct glint_scene_textures glint_scene_textures = {
    multiply_light_by_texture, prepare_decoding_curve};
