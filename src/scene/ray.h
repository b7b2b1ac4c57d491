/* SPDX-License-Identifier: MIT
 *
 * Where a ray meets a sphere, a plane or a triangle, in integers.
 *
 * Distances along rays are whole steps. What is parallel, has no area or lies
 * in the ray is missed; nothing is ever divided by 0. */
#ifndef GLINT_SCENE_RAY_H
#define GLINT_SCENE_RAY_H

#include "scene/vector.h"

struct glint_scene_ray {
    int32_t at[3];         /* place */
    int32_t toward_q30[3]; /* direction */
};

/* Sets TO to the place T steps along RAY. T is within +-GLINT_FAR. Returns 0 if
 * that is not within +-2^29 of the origin. */
int glint_ray_go(const struct glint_scene_ray *ray, int32_t t, int32_t to[3]);

/* ------------------------------------------------------------------ sphere */

/* The chord of a ray in a sphere: its middle, counted from the sphere's centre,
 * and its half, both with UP fraction bits, which make the radius 2^29 to
 * 2^30. */
struct glint_chord {
    int up;
    int32_t middle[3], half;
    int32_t t[2]; /* where it begins and ends; behind the ray's start below 0 */
};

/* Finds the chord of RAY in the sphere about CENTRE, RADIUS 1 .. 2^27; returns
 * 0 if there is none. The ray's distance from the centre is the length of L x
 * D, L from its start to the centre: products that are exact, so that nothing
 * cancels however far away the sphere is. */
int glint_ray_sphere(const struct glint_scene_ray *ray, const int32_t centre[3],
                     int32_t radius, struct glint_chord *chord);

/* Sets PLACE and the outward NORMAL_Q30 at end K of CHORD, 0 or 1. */
void glint_chord_end(const struct glint_chord *chord,
                     const struct glint_scene_ray *ray, const int32_t centre[3],
                     int k, int32_t place[3], int32_t normal_q30[3]);

/* ------------------------------------------------------------------- plane */

/* What is farther away on a plane counts as here: a plane moves to its
 * horizon, and places on it stay in range. */
#define GLINT_PLANE_END (INT32_C(1) << 28)

/* Returns the distance along RAY to the plane through AT, 1 ..
 * GLINT_PLANE_END; 0 if RAY does not meet it. */
int32_t glint_ray_plane(const struct glint_scene_ray *ray, const int32_t at[3],
                        const int32_t normal_q30[3]);

/* ---------------------------------------------------------------- triangle */

/* A ray as triangles take it: sheared so that it runs along its longest axis
 * [Woop13]. */
struct glint_sheared {
    int32_t at[3];
    int axis[3];          /* the longest last */
    int32_t x_q29, y_q29; /* direction over its longest element */
    int32_t along_q30;    /* 1 / the longest element, +-2^30 .. 2^30.8 */
};

struct glint_spot_on {
    int32_t t;           /* above 0 */
    int32_t part_q30[3]; /* weights of the vertices, which sum to 1 */
};

void glint_shear(const struct glint_scene_ray *ray, struct glint_sheared *to);

/* Finds where RAY meets the triangle; returns 0 if it does not. The edges are
 * part of it. Vertices are moved by the shear, and rounded, alike in every
 * triangle that has them, and the rest is exact: no ray passes between two
 * triangles that share an edge. */
int glint_ray_triangle(const struct glint_sheared *ray,
                       const int32_t *const vertex[3],
                       struct glint_spot_on *spot);

/* The same for a ray that is known to meet the triangle, or to miss it by a
 * little: SPOT is held inside. Returns 0 if the triangle has no area. */
int glint_ray_hold(const struct glint_sheared *ray,
                   const int32_t *const vertex[3], struct glint_spot_on *spot);

/* Sets the weights of three vertices from EDGE functions that all have the sign
 * of SUM, which they sum to, or are 0. SUM is not 0. */
void glint_weigh(const int64_t edge[3], int64_t sum, int32_t part_q30[3]);

/* Sets NORMAL_Q30 of a triangle, towards whom sees its vertices clockwise;
 * returns 0 if it has no area. */
int glint_triangle_normal(const int32_t *const vertex[3],
                          int32_t normal_q30[3]);

/* ----------------------------------------------------------------- surfaces */

/* Turns direction D_Q30 at a surface of normal N_Q30: D - 2 (D.N) N. */
void glint_mirror(const int32_t d_q30[3], const int32_t n_q30[3],
                  int32_t to_q30[3]);

/* Bends direction D_Q30 at a surface whose normal N_Q30 points back, D.N < 0,
 * by Snell's law: ETA_Q28 is the index before over that behind, at most 16.
 * Returns 0, and sets nothing, where all light is reflected. */
int glint_bend(const int32_t d_q30[3], const int32_t n_q30[3], uint32_t eta_q28,
               int32_t to_q30[3]);

#endif
