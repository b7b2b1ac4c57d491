/* SPDX-License-Identifier: MIT */
#include "scene/ray.h"

#include "base/divide.h"

enum { ONE_Q30 = 1 << 30, REACH = 1 << 29 };

int glint_ray_point_at_distance(const struct glint_scene_ray *ray, int32_t t,
                                int32_t to[3])
{
    int64_t place[3];
    int fits = 1;

    for (int k = 0; k < 3; k++) {
        place[k] = ray->at[k] + q_shift((int64_t)ray->toward_q30[k] * t, 30);
        fits &= place[k] > -REACH && place[k] < REACH;
    }
    for (int k = 0; k < 3 && fits; k++)
        to[k] = (int32_t)place[k];
    return fits;
}

/* ------------------------------------------------------------------ sphere */

/* L is the vector from the ray's start to the sphere's centre, D the ray's
 * direction. Components of L are within 2^29 and |D| is 1. So |L.D| and each
 * component of L x D are below 2^60 in _q30. If the ray hits, the components of
 * L x D are at most the radius. They are then stored with UP fraction bits,
 * below 2^30, so that their squares sum to less than 3 * 2^60. */
int glint_ray_intersect_sphere(const struct glint_scene_ray *ray,
                               const int32_t centre[3], int32_t radius,
                               struct glint_chord *chord)
{
    const int up = 30 - bit_length((uint32_t)radius);
    const int64_t radius_up = (int64_t)radius << up;
    int64_t across_q30[3], rest = radius_up * radius_up, middle_q30;
    int32_t to[3], across[3];

    v3_subtract(centre, ray->at, to);
    v3_cross(to, ray->toward_q30, across_q30);
    for (int k = 0; k < 3; k++) {
        const int64_t x = q_shift(across_q30[k], 30 - up);

        if (x > radius_up || x < -radius_up)
            return 0;
        across[k] = (int32_t)x;
        rest -= x * x;
    }
    if (rest < 0)
        return 0;
    middle_q30 = v3_dot(to, ray->toward_q30);
    chord->up = up;
    chord->half = (int32_t)glint_compute_square_root((uint64_t)rest);
    v3_cross(across, ray->toward_q30, across_q30);
    for (int k = 0; k < 3; k++)
        chord->middle[k] = (int32_t)q_shift(across_q30[k], 30);
    for (int k = 0; k < 2; k++) {
        const int64_t half_q30 = (int64_t)chord->half << (30 - up);

        chord->t[k] =
            q_narrow(q_shift(middle_q30 + (k ? half_q30 : -half_q30), 30));
    }
    return 1;
}

void glint_chord_set_end_point_and_normal(const struct glint_chord *chord,
                                          const struct glint_scene_ray *ray,
                                          const int32_t centre[3], int k,
                                          int32_t place[3],
                                          int32_t normal_q30[3])
{
    int64_t from[3];

    for (int i = 0; i < 3; i++) {
        const int64_t along =
            q_shift((int64_t)ray->toward_q30[i] * chord->half, 30);

        from[i] = chord->middle[i] + (k ? along : -along);
        place[i] = q_narrow(centre[i] + q_shift(from[i], chord->up));
    }
    /* The vector from the centre to the point is as long as the radius, so it
     * is not 0. */
    glint_normalise_vector(from, normal_q30);
}

/* ------------------------------------------------------------------- plane */

int32_t glint_ray_intersect_plane(const struct glint_scene_ray *ray,
                                  const int32_t at[3],
                                  const int32_t normal_q30[3])
{
    int64_t away_q30, along_q60;
    int32_t to[3], t;

    v3_subtract(at, ray->at, to);
    away_q30 = v3_dot(to, normal_q30);
    along_q60 = v3_dot(ray->toward_q30, normal_q30);
    if (away_q30 == 0 || along_q60 == 0 || (away_q30 < 0) != (along_q60 < 0))
        return 0;
    /* The distance to the plane is below 2^60 and is scaled up, as the divisor
     * is at most 1. */
    t = glint_divide_rounded(q_magnitude(away_q30),
                             (q_magnitude(along_q60) + (1 << 29)) >> 30);
    return q_smaller(t, GLINT_PLANE_END);
}

/* ---------------------------------------------------------------- triangle */

void glint_ray_shear_to_axis(const struct glint_scene_ray *ray,
                             struct glint_sheared *to)
{
    const int32_t *d_q30 = ray->toward_q30;
    /* starts at 1, which rules out a division by 0 */
    uint64_t most = 1;
    int longest = 0, is_back;
    uint32_t one_over_q30;

    for (int k = 0; k < 3; k++) {
        to->at[k] = ray->at[k];
        if (q_magnitude(d_q30[k]) > most) {
            most = q_magnitude(d_q30[k]);
            longest = k;
        }
    }
    is_back = d_q30[longest] < 0;
    for (int k = 0; k < 3; k++)
        to->axis[k] = (longest + 1 + k) % 3;
    /* q_reciprocal() returns 2^63 / (4 * most), _q31. 4 * most is above 2^31
     * and may slightly exceed 2^32. */
    one_over_q30 =
        (q_reciprocal(most < ONE_Q30 ? (uint32_t)(4 * most) : UINT32_MAX) + 1) /
        2;
    to->along_q30 = is_back ? -(int32_t)one_over_q30 : (int32_t)one_over_q30;
    to->x_q29 = q_mul(d_q30[to->axis[0]], to->along_q30, 31);
    to->y_q29 = q_mul(d_q30[to->axis[1]], to->along_q30, 31);
    to->least = 0;
}

/* A triangle in the sheared space of a ray: edge functions and depths. */
struct seen {
    int64_t edge[3], sum;
    int32_t x[3], y[3], z[3];
};

/* Applies the shear to the vertices. Differences of points are within 2^29 and
 * the shear is at most 1, so x and y are below 2^30. */
static void shear_triangle_vertices(const struct glint_sheared *ray,
                                    const int32_t *const vertex[3],
                                    struct seen *to)
{
    for (int i = 0; i < 3; i++) {
        int32_t off[3];

        for (int k = 0; k < 3; k++)
            off[k] = q_narrow((int64_t)vertex[i][ray->axis[k]] -
                              ray->at[ray->axis[k]]);
        to->z[i] = off[2];
        to->x[i] = q_narrow(off[0] - q_shift((int64_t)off[2] * ray->x_q29, 29));
        to->y[i] = q_narrow(off[1] - q_shift((int64_t)off[2] * ray->y_q29, 29));
    }
}

/* Returns whether three numbers are all positive or all negative. */
static int have_same_sign(const int32_t x[3])
{
    return (x[0] & x[1] & x[2]) < 0 || (-x[0] & -x[1] & -x[2]) < 0;
}

/* Sets the three edge functions, each below 2^61, and their sum, below 3 *
 * 2^61. */
static void set_edge_functions(struct seen *s)
{
    s->sum = 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        s->edge[i] = (int64_t)s->x[k] * s->y[j] - (int64_t)s->y[k] * s->x[j];
        s->sum += s->edge[i];
    }
}

void glint_compute_vertex_weights(const int64_t edge[3], int64_t sum,
                                  int32_t part_q30[3])
{
    const uint64_t all = q_magnitude(sum);
    const int up = q_count_normalising_shift(all);
    const uint64_t one_over = q_reciprocal(q_shift_to_32_bits(all, up));

    for (int k = 0; k < 2; k++)
        part_q30[k] =
            (int32_t)((uint64_t)q_shift_to_32_bits(q_magnitude(edge[k]), up) *
                          one_over >>
                      33);
    part_q30[2] = q_larger(0, ONE_Q30 - part_q30[0] - part_q30[1]);
    part_q30[1] = ONE_Q30 - part_q30[0] - part_q30[2];
}

static void set_spot_distance(const struct glint_sheared *ray,
                              const struct seen *s, struct glint_spot_on *spot)
{
    spot->t = q_narrow(q_shift(
        q_shift(v3_dot(spot->part_q30, s->z), 30) * ray->along_q30, 30));
}

int glint_ray_intersect_triangle(const struct glint_sheared *ray,
                                 const int32_t *const vertex[3],
                                 struct glint_spot_on *spot)
{
    struct seen s;

    shear_triangle_vertices(ray, vertex, &s);
    if (have_same_sign(s.x) || have_same_sign(s.y))
        return 0;
    set_edge_functions(&s);
    if (((s.edge[0] | s.edge[1] | s.edge[2]) < 0 &&
         (s.edge[0] > 0 || s.edge[1] > 0 || s.edge[2] > 0)) ||
        s.sum == 0)
        return 0;
    glint_compute_vertex_weights(s.edge, s.sum, spot->part_q30);
    set_spot_distance(ray, &s, spot);
    return spot->t > ray->least;
}

int glint_ray_clamp_to_triangle(const struct glint_sheared *ray,
                                const int32_t *const vertex[3],
                                struct glint_spot_on *spot)
{
    struct seen s;
    int64_t sum = 0;

    shear_triangle_vertices(ray, vertex, &s);
    set_edge_functions(&s);
    if (s.sum == 0)
        return 0;
    for (int k = 0; k < 3; k++) {
        if ((s.edge[k] < 0) != (s.sum < 0))
            s.edge[k] = 0;
        sum += s.edge[k];
    }
    if (sum == 0)
        return 0;
    s.sum = sum;
    glint_compute_vertex_weights(s.edge, s.sum, spot->part_q30);
    set_spot_distance(ray, &s, spot);
    return 1;
}

int glint_set_triangle_normal(const int32_t *const vertex[3],
                              int32_t normal_q30[3])
{
    int32_t first[3], second[3];
    int64_t normal[3];

    v3_subtract(vertex[1], vertex[0], first);
    v3_subtract(vertex[2], vertex[0], second);
    v3_cross(first, second, normal);
    return glint_normalise_vector(normal, normal_q30);
}

/* ----------------------------------------------------------------- surfaces */

/* N has length 1 up to rounding errors. The product is divided by N.N, to first
 * order, so that the length of D does not change. */
void glint_reflect_direction(const int32_t d_q30[3], const int32_t n_q30[3],
                             int32_t to_q30[3])
{
    const int64_t over_q45 = (v3_dot(n_q30, n_q30) - (INT64_C(1) << 60)) >> 15;
    int64_t along_q30 = v3_cosine_q30(d_q30, n_q30);

    along_q30 -= q_shift(along_q30 * over_q45, 45);
    for (int k = 0; k < 3; k++)
        to_q30[k] = (int32_t)(d_q30[k] - q_shift(along_q30 * n_q30[k], 29));
}

/* By Snell's law, the sine of the angle between ray and normal is multiplied by
 * ETA. The direction sought is eta d + (eta * before - behind) n, with the
 * cosines before and behind the surface. The factor of n is at most sqrt(eta^2
 * - 1): below 3.9 if eta is at most 4, and below 16 otherwise. There, two bits
 * of it are dropped, so that its product with n is below 2^62. */
int glint_bend(const int32_t d_q30[3], const int32_t n_q30[3], uint32_t eta_q28,
               int32_t to_q30[3])
{
    const int64_t along_q30 = v3_cosine_q30(d_q30, n_q30);
    const int64_t square_q60 = (INT64_C(1) << 60) - along_q30 * along_q30;
    const int64_t sine_q30 =
        square_q60 > 0 ? glint_compute_square_root((uint64_t)square_q60) : 0;
    const int64_t behind_q30 = q_shift(sine_q30 * eta_q28, 28);
    const int drop = eta_q28 > UINT32_C(4) << 28 ? 2 : 0;
    int64_t to[3], cosine_q30, factor;

    if (behind_q30 > ONE_Q30)
        return 0;
    cosine_q30 = glint_compute_square_root(
        (uint64_t)((INT64_C(1) << 60) - behind_q30 * behind_q30));
    factor = q_shift(q_shift(along_q30 * eta_q28, 28) + cosine_q30, drop);
    for (int k = 0; k < 3; k++)
        to[k] = q_shift(d_q30[k] * (int64_t)eta_q28, 28) -
                q_shift(factor * n_q30[k], 30 - drop);
    return glint_normalise_vector(to, to_q30);
}
