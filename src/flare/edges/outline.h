/* SPDX-License-Identifier: MIT
 *
 * Clips a primitive by the stop and two barrel apertures; the visible part is a
 * convex polygon.
 *
 *   in   a triangle of a primitive's corners, the stop, two barrels
 *   out  the polygon that the stop's sides and the barrels leave, all of them
 *        linear between the corners: its corners in pixels, its fraction of
 *        the triangle, its mean energy
 *
 * Method: the triangle is clipped by one half plane after the other, in
 * barycentric coordinates u, v of its second and third corner, so that
 * triangles without area on the screen are also clipped correctly. A round stop
 * is approximated by a half plane: the function (1 - r^2) / 2 at the corners,
 * plus the mean height of that function above the plane through the corners,
 * which makes the clipped area correct.
 *
 * Formats: u, v _q28; functions _q16, below 2^33, times u or v below 2^61;
 * pixels _q16 in 64 bits. */
#ifndef GLINT_FLARE_OUTLINE_H
#define GLINT_FLARE_OUTLINE_H

#include <stdint.h>

#include "base/q.h"
#include "flare/edges/primitive.h"
#include "glint/light.h"

/* Returns the function of a round stop at V: (1 - r^2) / 2, where r is the
 * distance from the stop's centre in stop radii. It is positive inside the stop
 * and clamped far outside. */
int64_t glint_disc_evaluate_function_q16(const struct glint_vertex *v);

/* Returns the distance, in stop radii, of a point from the arc between two
 * corners of the stop: positive inside, negative outside. STRAIGHT is the
 * distance of the point from the straight line between the corners. DISC is (1
 * - r^2) / 2, where r is the distance of the point from the stop's centre. Let
 * 1 / k be the radius of the arc's circle, d the distance of the circle's
 * centre behind the stop's centre, n the normal of the side and v the point. As
 * both corners have r = 1, k^-2 - |v + d n|^2 is 2 d STRAIGHT + 1 - r^2. The
 * result is that times k / 2, which equals the distance where it is small. */
int64_t glint_arc_compute_signed_distance_q16(const struct glint_stop *stop,
                                              int64_t straight_q16,
                                              int64_t disc_q16);

/* Returns the distance of V, in stop radii, from the straight line between the
 * corners of side SIDE. It is positive inside and negative outside. */
static inline int64_t
glint_side_compute_straight_distance_q16(const struct glint_stop *stop,
                                         int side, const struct glint_vertex *v)
{
    const int64_t nx = stop->normal_q30[side][0];
    const int64_t ny = stop->normal_q30[side][1];

    return stop->apothem_q16 -
           q_shift(nx * v->stop_x_q16 + ny * v->stop_y_q16, 30);
}

/* Return the distance of V from side SIDE of the stop, in stop radii, and the
 * value 1 - (1 + r^2) / 2 of V for a barrel aperture, with r in barrel radii.
 * Both are positive inside and negative outside. */
static inline int64_t
glint_side_compute_signed_distance_q16(const struct glint_stop *stop, int side,
                                       const struct glint_vertex *v)
{
    const int64_t straight_q16 =
        glint_side_compute_straight_distance_q16(stop, side, v);

    return stop->round_q30
               ? glint_arc_compute_signed_distance_q16(
                     stop, straight_q16, glint_disc_evaluate_function_q16(v))
               : straight_q16;
}

static inline int64_t
glint_barrel_evaluate_function_q16(int barrel, const struct glint_vertex *v)
{
    return (INT64_C(1) << 16) - v->barrel_q16[barrel];
}

/* Max number of corners of an outline: three of the triangle, one more per cut,
 * and a copy of the first corner at the end. */
enum { GLINT_OUTLINE_CORNERS = GLINT_MAX_BLADES + 8 };

/* A clipped polygon, and scratch memory for clipping; 2.3 KB. */
struct glint_outline {
    int n; /* number of corners; 0: nothing is visible */
    int64_t x_q16[GLINT_OUTLINE_CORNERS], y_q16[GLINT_OUTLINE_CORNERS];
    int32_t share_q28;  /* area of the polygon / area of the triangle, 0 .. 1 */
    int32_t energy_q16; /* mean energy of the polygon's corners */
    struct glint_uv {
        int32_t u_q28, v_q28;
    } uv[GLINT_OUTLINE_CORNERS], kept[GLINT_OUTLINE_CORNERS];
};

/* Returns the GLINT_CUT_ flags of the cuts that may cross the primitive, 0 if
 * it is completely visible, or -1 if it is completely outside. Masks of the
 * stop are ignored. */
int glint_outline_classify_primitive(const struct glint_corners *corners,
                                     const struct glint_stop *stop);

/* Sets OUTLINE to the unclipped primitive. */
void glint_outline_set_unclipped(struct glint_outline *outline,
                                 const struct glint_corners *corners);

/* Sets OUTLINE to the triangle of the corners 0, K + 1 and K + 2, clipped by
 * the stop and the barrel apertures. CUT has the GLINT_CUT_ flags of the cuts
 * to apply. */
void glint_outline_clip_triangle(struct glint_outline *outline,
                                 const struct glint_corners *corners, int k,
                                 const struct glint_stop *stop, int cut);

/* Replaces OUTLINE, which is thinner than a sixteenth of a pixel, by a strip of
 * that width along its longer side. The strip is at least as long as wide.
 * Returns twice the area of the strip, pixels^2. */
int64_t glint_outline_replace_by_strip_q32(struct glint_outline *outline);

#endif
