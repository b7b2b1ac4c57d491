/* SPDX-License-Identifier: MIT
 *
 * Fast path for shading. Finds the surface at the middle of a pixel with 26
 * bits of precision, which suffice for shading. Values that all pixels of an
 * object share are precomputed. Which object is visible has been determined
 * exactly by visible.c. */
#ifndef GLINT_SCENE_QUICK_H
#define GLINT_SCENE_QUICK_H

#include "scene/visible.h"

/* ------------------------------------------------------------------- roots */

/* Returns 2^31 / sqrt(S) for S = S_Q32 / 2^32, 1/4 <= S < 1. The relative error
 * is at most 2^-25.8, and the result is never above the true value: Newton's
 * method from a table of error 2^-6.9. */
static inline uint32_t glint_quick_inverse_root_q31(uint32_t s_q32)
{
    uint32_t r_q31 = glint_look_up_inverse_root(s_q32 >> 25) << 24;

    for (int i = 0; i < 2; i++) {
        const uint32_t square_q30 = (uint32_t)((uint64_t)r_q31 * r_q31 >> 32);
        const uint32_t one_q30 = (uint32_t)((uint64_t)square_q30 * s_q32 >> 32);
        const uint32_t rest_q30 = (UINT32_C(3) << 30) - one_q30;

        r_q31 = (uint32_t)((uint64_t)r_q31 * rest_q30 >> 31);
    }
    return r_q31;
}

/* Returns the even number of bits by which X must be shifted up to have 63 or
 * 64 bits. X must not be 0. */
static inline int glint_quick_compute_even_shift(uint64_t x)
{
    return (64 - bit_length(x | 1)) & ~1;
}

/* Sets UNIT_Q30 to V / |V|. Components of V must be within +-2^30, and at least
 * one of magnitude 2^20 or more. */
static inline void glint_quick_normalise(const int32_t v[3],
                                         int32_t unit_q30[3])
{
    const uint64_t square = (uint64_t)v3_dot(v, v); /* below 3 * 2^60 */
    const int up = glint_quick_compute_even_shift(square);
    const int64_t r_q31 =
        glint_quick_inverse_root_q31((uint32_t)(square << up >> 32));
    const int down = 33 - up / 2;

    for (int k = 0; k < 3; k++)
        unit_q30[k] = (int32_t)((v[k] * r_q31) >> down);
}

/* -------------------------------------------------------------------- find */

/* Prepares all balls of a frame for the fast path. */
void glint_quick_prepare_balls(struct glint_scene *scene);

/* Sets RAY to the ray through position (X, Y), with an error of 2^-24 per
 * component. Sets SURFACE to the ray's intersection with object or triangle ID.
 * A ray that just misses a triangle is moved to the triangle's edge. Returns 0
 * if the fast path does not apply: near the rim of a ball, for balls too near
 * or far, and for triangles that are near the camera, textured or
 * translucent. */
int glint_quick_find_surface(struct glint_scene_worker *w, uint32_t id,
                             int32_t x_q8, int32_t y_q8,
                             struct glint_scene_ray *ray,
                             struct glint_met_surface *surface);

#endif
