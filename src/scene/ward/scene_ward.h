/* SPDX-License-Identifier: MIT
 *
 * The part of a scene for light from all around and brushed metal. */
#ifndef GLINT_SCENE_WARD_SCENE_WARD_H
#define GLINT_SCENE_WARD_SCENE_WARD_H

#include "glint/scene/ward.h"
#include "scene/state.h"

struct glint_ward_state {
    struct glint_environment *opened; /* [n_environments] */
    struct glint_scene_light *sun;    /* [n_environment_lights] */
    int has_environment;
    struct glint_environment environment; /* that is shown */
    int32_t turn_q30[2];                  /* cosine and sine, to the right */
    struct glint_real scale;              /* of all its light */
    struct glint_real unit;               /* of its texels, with that scale */
    struct glint_ward_material *material; /* [n_wards], ratios held */
    struct glint_ward_lobe *lobe;         /* [n_wards] */
};

/* Sets TO to direction V, _q30, in the directions of the environment. */
static inline void glint_ward_turn(const struct glint_ward_state *w,
                                   const int32_t v[3], int32_t to[3])
{
    const int64_t c = w->turn_q30[0], s = w->turn_q30[1];

    to[0] = (int32_t)q_shift(c * v[0] - s * v[2], 30);
    to[1] = v[1];
    to[2] = (int32_t)q_shift(c * v[2] + s * v[0], 30);
}

/* shine.c, behind.c: members of the part (scene/state.h). */
int glint_ward_shine(const struct glint_scene *scene,
                     const struct glint_scene_ray *ray,
                     const struct glint_met_surface *surface,
                     const struct glint_brushed *brushed,
                     const int32_t toward_q30[3], const int32_t level_q15[3],
                     int32_t radius_q30, int32_t rgb_q15[3]);
void glint_ward_behind(const struct glint_scene *scene,
                       const int32_t toward_q30[3], int64_t spread_q40,
                       int32_t rgb_q15[3]);

#endif
