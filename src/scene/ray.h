/* SPDX-License-Identifier: MIT
 *
 * Intersects rays with spheres, planes and triangles, in integers.
 *
 * Distances along rays are integer steps. Surfaces that are parallel to the
 * ray, contain it or have no area are missed, so nothing is divided by 0. */
#ifndef GLINT_SCENE_RAY_H
#define GLINT_SCENE_RAY_H

#include "scene/vector.h"

struct glint_scene_ray {
    int32_t at[3];         /* origin */
    int32_t toward_q30[3]; /* direction */
};

/* Sets TO to the point T steps along RAY. T must be within +-GLINT_FAR. Returns
 * 0 if the point is not within +-2^29 of the origin. */
int glint_ray_go(const struct glint_scene_ray *ray, int32_t t, int32_t to[3]);

/* ------------------------------------------------------------------ sphere */

/* The chord of a ray in a sphere: its middle relative to the sphere's centre,
 * and half its length, both with UP fraction bits, chosen so that the radius is
 * 2^29 to 2^30. */
struct glint_chord {
    int up;
    int32_t middle[3], half;
    int32_t t[2]; /* its start and end along the ray; negative behind the ray's
                     start */
};

/* Finds the chord of RAY in the sphere around CENTRE; returns 0 if the ray
 * misses it. RADIUS must be 1 .. 2^27. The ray's distance from the centre is
 * |L x D| with L from the ray's start to the centre; the products are exact,
 * so that no precision is lost at any distance. */
int glint_ray_sphere(const struct glint_scene_ray *ray, const int32_t centre[3],
                     int32_t radius, struct glint_chord *chord);

/* Sets PLACE and the outward NORMAL_Q30 at end K of CHORD, 0 or 1. */
void glint_chord_end(const struct glint_chord *chord,
                     const struct glint_scene_ray *ray, const int32_t centre[3],
                     int k, int32_t place[3], int32_t normal_q30[3]);

/* ------------------------------------------------------------------- plane */

/* Max distance of an intersection with a plane; farther intersections are
 * moved to this distance, so that they stay in range. */
#define GLINT_PLANE_END (INT32_C(1) << 28)

/* Returns the distance along RAY to the plane through AT, 1 .. GLINT_PLANE_END,
 * or 0 if RAY does not meet it. */
int32_t glint_ray_plane(const struct glint_scene_ray *ray, const int32_t at[3],
                        const int32_t normal_q30[3]);

/* ---------------------------------------------------------------- triangle */

/* A ray prepared for triangle tests: sheared so that it runs along its longest
 * axis [Woop13]. */
struct glint_sheared {
    int32_t at[3];
    int axis[3];          /* axes; the longest is last */
    int32_t x_q29, y_q29; /* direction divided by its longest element */
    int32_t along_q30;    /* 1 / the longest element; magnitude 2^30 ..
                             2^30.8 */
    int32_t least;        /* intersections are above this distance */
};

struct glint_spot_on {
    int32_t t;           /* distance along the ray */
    int32_t part_q30[3]; /* weights of the vertices, which sum to 1 */
};

/* Prepares RAY, with intersections above 0. */
void glint_shear(const struct glint_scene_ray *ray, struct glint_sheared *to);

/* Finds the intersection of RAY and the triangle, edges included; returns 0
 * if RAY misses it. A vertex is sheared and rounded in the same way in every
 * triangle that has it, and all other steps are exact: no ray passes between
 * two triangles that share an edge. */
int glint_ray_triangle(const struct glint_sheared *ray,
                       const int32_t *const vertex[3],
                       struct glint_spot_on *spot);

/* Like glint_ray_triangle(), for a ray that is known to meet the triangle or
 * to miss it slightly: SPOT is clamped to the triangle. Returns 0 if the
 * triangle has no area. */
int glint_ray_hold(const struct glint_sheared *ray,
                   const int32_t *const vertex[3], struct glint_spot_on *spot);

/* Sets the weights of three vertices from their EDGE functions, whose sum is
 * SUM. Each must be 0 or have the sign of SUM, and SUM must not be 0. */
void glint_weigh(const int64_t edge[3], int64_t sum, int32_t part_q30[3]);

/* Sets NORMAL_Q30 of a triangle; it points to the side from which the vertices
 * appear clockwise. Returns 0 if the triangle has no area. */
int glint_triangle_normal(const int32_t *const vertex[3],
                          int32_t normal_q30[3]);

/* ----------------------------------------------------------------- surfaces */

/* Reflects direction D_Q30 at a surface of normal N_Q30: D - 2 (D.N) N. */
void glint_mirror(const int32_t d_q30[3], const int32_t n_q30[3],
                  int32_t to_q30[3]);

/* Refracts direction D_Q30 by Snell's law at a surface of normal N_Q30; D.N
 * must be negative. ETA_Q28 is the index before the surface / the index behind
 * it, at most 16. Returns 0, and sets nothing, at total reflection. */
int glint_bend(const int32_t d_q30[3], const int32_t n_q30[3], uint32_t eta_q28,
               int32_t to_q30[3]);

#endif
