/* SPDX-License-Identifier: MIT
 *
 * An environment as it is seen itself, behind things and in mirrors: its levels
 * and the discs of its bright lights, blurred as far as a pixel sees. */
#include "scene/ward/scene_ward.h"

#include "base/log2.h"
#include "base/real.h"

enum {
    LOG2_PI_Q16 = 108232,
    LEAST_SPREAD_Q40 = 1 << 14 /* the lights that are points have a disc */
};

/* Level l has a variance of 4^l pi / side^2. */
static int32_t level_q8(const struct glint_environment *e, int64_t spread_q40)
{
    const int32_t octaves_q16 = q_log2_q16((uint64_t)spread_q40) - (40 << 16) +
                                (int32_t)(e->header->side_log2 << 17) -
                                LOG2_PI_Q16;

    return (int32_t)q_shift(octaves_q16, 9);
}

/* Adds a disc of R, at least as large as the spot that is seen: within half of
 * that of its rim it fades. */
static void add_disc(const struct glint_ward_state *w,
                     const struct glint_environment_light *light,
                     const int32_t toward_q30[3], int64_t spread_q40,
                     int32_t rgb_q15[3])
{
    const int32_t width_q30 = (int32_t)glint_root((uint64_t)spread_q40 << 22);
    const int32_t r_q30 = q_larger(light->radius_q30, width_q30);
    const struct glint_real r = real_of(r_q30, -30);
    int32_t off_q29[3], away_q30, share_q15;
    struct glint_real per_disc;

    for (int k = 0; k < 3; k++)
        off_q29[k] = toward_q30[k] / 2 - light->toward_q30[k] / 2;
    away_q30 = 2 * (int32_t)q_smaller(
                       (int32_t)glint_root((uint64_t)v3_dot(off_q29, off_q29)),
                       (1 << 30) - 1);
    if (away_q30 >= r_q30 + width_q30 / 2)
        return;
    share_q15 = away_q30 <= r_q30 - width_q30 / 2
                    ? GLINT_SCENE_ONE_Q15
                    : q_part_q30((uint64_t)(r_q30 + width_q30 / 2 - away_q30),
                                 (uint64_t)width_q30) >>
                          15;
    per_disc = real_over(real_times(w->scale, real_of(share_q15, -15)),
                         real_times(r, r));
    for (int c = 0; c < 3; c++)
        rgb_q15[c] = q_clamp_sat(
            rgb_q15[c] + real_integer(real_times(light->rgb[c], per_disc), 15,
                                      GLINT_SCENE_MOST_LIGHT),
            0, GLINT_SCENE_MOST_LIGHT);
}

void glint_ward_behind(const struct glint_scene *scene,
                       const int32_t toward_q30[3], int64_t spread_q40,
                       int32_t rgb_q15[3])
{
    const struct glint_ward_state *w = scene->wards;
    const struct glint_environment *e = &w->environment;
    const int64_t seen_q40 =
        q_clamp_sat(spread_q40 >> 10, LEAST_SPREAD_Q40 >> 10, 1 << 28) *
        INT64_C(1024);
    int32_t to_q30[3], to_q16[3], light[3];

    glint_ward_turn(w, toward_q30, to_q30);
    for (int k = 0; k < 3; k++)
        to_q16[k] = (int32_t)q_shift(to_q30[k], 14);
    glint_environment_look(e, to_q16, level_q8(e, seen_q40), light);
    for (int c = 0; c < 3; c++)
        rgb_q15[c] =
            (int32_t)real_integer(real_times(real_of(light[c], 0), w->unit), 15,
                                  GLINT_SCENE_MOST_LIGHT);
    for (uint32_t i = 0; i < e->header->n_lights; i++)
        add_disc(w, &e->light[i], to_q30, seen_q40, rgb_q15);
}
