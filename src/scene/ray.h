/* SPDX-License-Identifier: MIT
 *
 * Intersects rays with spheres, planes and triangles, in integer arithmetic.
 *
 * Distances along rays are integer steps. A ray misses a plane or triangle that
 * is parallel to it or has no area, so no division by 0 occurs. */
#ifndef GLINT_SCENE_RAY_H
#define GLINT_SCENE_RAY_H

#include "scene/vector.h"

struct glint_scene_ray {
    int32_t at[3];         /* origin, steps */
    int32_t toward_q30[3]; /* direction, a unit vector */
};

/* Sets TO to the point at distance T, steps, along RAY. T must be within
 * +-GLINT_FAR. Returns 1, or 0 if the point is not within +-2^29 of the
 * origin. */
int glint_ray_point_at_distance(const struct glint_scene_ray *ray, int32_t t,
                                int32_t to[3]);

/* ------------------------------------------------------------------ sphere */

/* The chord that a sphere cuts from a ray: its middle relative to the sphere's
 * centre, and half its length. Both have UP fraction bits, chosen so that the
 * radius is 2^29 to 2^30. */
struct glint_chord {
    int up;
    int32_t middle[3], half;
    /* Distances along the ray at which the chord starts and ends, steps;
     * negative behind the ray's start. */
    int32_t t[2];
};

/* Finds the chord of RAY in the sphere around CENTRE; returns 1, or 0 if the
 * ray misses the sphere. RADIUS must be 1 .. 2^27. The ray's distance from the
 * centre is |L x D|, where L is the vector from the ray's start to the centre
 * and D the ray's direction. Products are exact, so precision is the same at
 * any distance. */
int glint_ray_intersect_sphere(const struct glint_scene_ray *ray,
                               const int32_t centre[3], int32_t radius,
                               struct glint_chord *chord);

/* Sets PLACE to the position, and NORMAL_Q30 to the sphere's outward normal, at
 * end K of CHORD: 0 where the ray enters the sphere, 1 where it leaves. */
void glint_chord_set_end_point_and_normal(const struct glint_chord *chord,
                                          const struct glint_scene_ray *ray,
                                          const int32_t centre[3], int k,
                                          int32_t place[3],
                                          int32_t normal_q30[3]);

/* ------------------------------------------------------------------- plane */

/* Max distance, steps, of an intersection with a plane. Farther intersections
 * are moved to this distance, so that they stay in range. */
#define GLINT_PLANE_END (INT32_C(1) << 28)

/* Returns the distance along RAY to the plane through point AT, 1 ..
 * GLINT_PLANE_END, or 0 if RAY does not meet the plane. */
int32_t glint_ray_intersect_plane(const struct glint_scene_ray *ray,
                                  const int32_t at[3],
                                  const int32_t normal_q30[3]);

/* ---------------------------------------------------------------- triangle */

/* A ray prepared for triangle tests: sheared so that it runs along its longest
 * axis [Woop13]. */
struct glint_sheared {
    int32_t at[3];
    int axis[3];          /* indices of the axes x, y, z, the ray's longest axis
                             last */
    int32_t x_q29, y_q29; /* direction divided by its longest component */
    int32_t along_q30;    /* 1 / longest component of the direction; magnitude
                             2^30 .. 2^30.8 */
    int32_t least;        /* min distance of intersections, exclusive, steps */
};

struct glint_spot_on {
    int32_t t;           /* distance along the ray, steps */
    int32_t part_q30[3]; /* barycentric weights of the vertices; their sum is
                            1 */
};

/* Prepares RAY for triangle tests; intersections must be at distances above
 * 0. */
void glint_ray_shear_to_axis(const struct glint_scene_ray *ray,
                             struct glint_sheared *to);

/* Finds the intersection of RAY with the triangle, edges included. Returns 1,
 * or 0 if RAY misses the triangle. A vertex is sheared and rounded in the same
 * way in every triangle that has it, and all other steps are exact. So no ray
 * passes between two triangles that share an edge. */
int glint_ray_intersect_triangle(const struct glint_sheared *ray,
                                 const int32_t *const vertex[3],
                                 struct glint_spot_on *spot);

/* Like glint_ray_intersect_triangle(), but if RAY passes beside the triangle,
 * SPOT is a point on the edge that it passes. Used for rays that pass at most
 * slightly beside it. Returns 0 if the triangle has no area. */
int glint_ray_clamp_to_triangle(const struct glint_sheared *ray,
                                const int32_t *const vertex[3],
                                struct glint_spot_on *spot);

/* Sets the barycentric weights PART of three vertices from the edge functions
 * EDGE, whose sum is SUM. Each function must be 0 or have the sign of SUM, and
 * SUM must not be 0. */
void glint_compute_vertex_weights(const int64_t edge[3], int64_t sum,
                                  int32_t part_q30[3]);

/* Sets NORMAL_Q30 to the triangle's unit normal, on the side from which the
 * vertices appear clockwise. Returns 0 if the triangle has no area. */
int glint_set_triangle_normal(const int32_t *const vertex[3],
                              int32_t normal_q30[3]);

/* ----------------------------------------------------------------- surfaces */

/* Sets TO to direction D_Q30 reflected at a surface of normal N_Q30: D - 2
 * (D.N) N. */
void glint_reflect_direction(const int32_t d_q30[3], const int32_t n_q30[3],
                             int32_t to_q30[3]);

/* A little below 16, so that products with directions whose length exceeds 1 by
 * up to 2^-25 are below 2^62. */
#define GLINT_MOST_ETA_Q28 (UINT32_MAX - 255)

/* Refracts direction D_Q30 by Snell's law at a surface of normal N_Q30; D.N
 * must be negative. ETA_Q28 is the refractive index in front of the surface
 * divided by that behind it, at most GLINT_MOST_ETA_Q28. Returns 1; at total
 * reflection returns 0 and sets nothing. */
int glint_bend(const int32_t d_q30[3], const int32_t n_q30[3], uint32_t eta_q28,
               int32_t to_q30[3]);

#endif
