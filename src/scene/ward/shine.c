/* SPDX-License-Identifier: MIT
 *
 * What brushed metal shows of one light: Ward's lobe, as wide as the metal is
 * rough, the light's disc large and the surface bent within a pixel. Without
 * the last the highlight of a small ball would come and go between its pixels.
 *
 * Variances of slopes add up: alpha^2 / 2 of the metal, r^2 / 16 of the half
 * vector to a disc of angular radius r, and that of the normal within a pixel.
 * With h the half vector and o to the eye the light is
 *
 *     level weight exp(-slope) / (4 ax ay (h.o) (h.n)^3)
 *
 * with the weight of ward.c, held to 8. */
#include "scene/ward/scene_ward.h"

#include "base/log2.h"
#include "base/real.h"

enum { MOST_SLOPE = 16, LOG2_E_Q16 = 94548 };

/* The half vector and what it is to the surface; all q30 but slopes. */
struct half {
    int32_t ho_q30, hn_q30, ni_q30, no_q30;
    uint64_t slope_q52[2]; /* squares of slopes along the two axes, to 2^60 */
};

/* Returns whether ALONG_Q30 over HN_Q30 is surely so much that the lobe of the
 * square of alpha ALPHA_Q40, below 2^42, is nothing there: before there is a
 * root or a ratio. The left side is rounded down, to 2^56, the right one up, to
 * 2^63, and has 1/512 more, which is more than what ratios are off. */
static int is_beyond(uint32_t along_q30, int32_t hn_q30, int64_t alpha_q40)
{
    const uint64_t along_q28 = along_q30 >> 2;
    const uint64_t hn_q28 = ((uint64_t)hn_q30 >> 2) + 1;
    const uint64_t most_q56 = ((hn_q28 * hn_q28 >> 24) + 1) *
                              (((uint64_t)alpha_q40 * MOST_SLOPE >> 16) + 1);

    return along_q28 * along_q28 > most_q56 + (most_q56 >> 9);
}

/* Returns 0 if the light or the eye is behind the surface, or the lobe of
 * ALPHA_Q40, squares, is nothing there. */
static int find_half(const struct glint_scene_ray *ray,
                     const struct glint_brushed *brushed,
                     const int32_t toward_q30[3], const int64_t alpha_q40[2],
                     struct half *h)
{
    const int32_t *n_q30 = brushed->frame_q30[2];
    int32_t half_q30[3], hn_q30;
    uint32_t along_q30[2];

    for (int k = 0; k < 3; k++)
        half_q30[k] = (int32_t)(((int64_t)toward_q30[k] - ray->toward_q30[k]) /
                                2); /* (i + o) / 2 = (h.o) h */
    hn_q30 = v3_cosine_q30(half_q30, n_q30);
    if (hn_q30 <= 0)
        return 0;
    for (int k = 0; k < 2; k++) {
        along_q30[k] = (uint32_t)q_magnitude(
            v3_cosine_q30(half_q30, brushed->frame_q30[k]));
        if (is_beyond(along_q30[k], hn_q30, alpha_q40[k]))
            return 0;
    }
    h->ni_q30 = v3_cosine_q30(toward_q30, n_q30);
    h->no_q30 = -v3_cosine_q30(ray->toward_q30, n_q30);
    if (h->ni_q30 <= 0 || h->no_q30 <= 0)
        return 0;
    h->ho_q30 = (int32_t)glint_root((uint64_t)v3_dot(half_q30, half_q30));
    if (h->ho_q30 < hn_q30)
        h->ho_q30 = hn_q30;
    h->hn_q30 = q_part_q30((uint64_t)hn_q30, (uint64_t)h->ho_q30);
    for (int k = 0; k < 2; k++) {
        const uint64_t slope_q26 = (uint64_t)glint_ratio(
            (uint64_t)along_q30[k] << 26, (uint64_t)hn_q30);

        h->slope_q52[k] = slope_q26 * slope_q26;
    }
    return 1;
}

/* Returns what the lobe counts by the norm, 0 .. 8, before its density. */
static struct glint_real weight_of(enum glint_ward_norm norm,
                                   const struct half *h)
{
    const struct glint_real most = real_of(8, 0);
    const struct glint_real ho = real_of(h->ho_q30, -30);
    const struct glint_real hn = real_of(h->hn_q30, -30);
    struct glint_real weight;

    if (norm == GLINT_WARD_BOUNDED)
        weight = real_over(real_of(h->ni_q30, -30), real_times(ho, hn));
    else
        weight = real_over(
            real_times(real_times(real_times(ho, hn), real_times(hn, hn)),
                       real_of(glint_root((uint64_t)h->ni_q30 << 30), -30)),
            real_of(glint_root((uint64_t)h->no_q30 << 30), -30));
    return real_less(weight, most) ? weight : most;
}

int glint_ward_shine(const struct glint_scene *scene,
                     const struct glint_scene_ray *ray,
                     const struct glint_met_surface *surface,
                     const struct glint_brushed *brushed,
                     const int32_t toward_q30[3], const int32_t level_q15[3],
                     int32_t radius_q30, int32_t rgb_q15[3])
{
    const struct glint_ward_material *m =
        &scene->wards->material[surface->material->ward];
    const int64_t wider_q40 =
        ((int64_t)radius_q30 * radius_q30 >> 23) +
        (int64_t)brushed->spread_q30 * 1024; /* r^2 / 8, and the normal's */
    struct glint_real area = real_of(4, 0), gain;
    int64_t alpha_q40[2];
    int32_t slope_q16 = 0;
    struct half h;

    for (int k = 0; k < 2; k++)
        alpha_q40[k] =
            ((int64_t)m->alpha_q24[k] * m->alpha_q24[k] >> 8) + wider_q40;
    if (!find_half(ray, brushed, toward_q30, alpha_q40, &h))
        return 0;
    for (int k = 0; k < 2; k++) {
        if ((h.slope_q52[k] >> 12) >= (uint64_t)alpha_q40[k] * MOST_SLOPE)
            return 0;
        slope_q16 += glint_ratio(h.slope_q52[k] << 4, (uint64_t)alpha_q40[k]);
        area = real_times(
            area, real_of(glint_root((uint64_t)alpha_q40[k] << 20), -30));
    }
    if (slope_q16 >= MOST_SLOPE << 16)
        return 0;
    area = real_times(
        area, real_times(real_of(h.ho_q30, -30), real_of(h.hn_q30, -30)));
    area = real_times(
        area, real_times(real_of(h.hn_q30, -30), real_of(h.hn_q30, -30)));
    gain = real_of(q_exp2_q16((14 << 16) -
                              (int32_t)((int64_t)slope_q16 * LOG2_E_Q16 >> 16)),
                   -30);
    gain = real_over(real_times(gain, weight_of(m->norm, &h)), area);
    for (int c = 0; c < 3; c++)
        rgb_q15[c] = (int32_t)real_integer(
            real_times(real_of((int64_t)level_q15[c] * m->specular_q15[c], -30),
                       gain),
            15, GLINT_SCENE_MOST_LIGHT);
    return 1;
}
