/* SPDX-License-Identifier: MIT */
#include "scene/quick.h"

#include "base/divide.h"
#include "scene/parts.h"

enum { ONE_Q30 = 1 << 30, LEAST_UP = 17 };

/* -------------------------------------------------------------------- rays */

/* The direction is scaled such that the picture's plane is at distance 2^28.
 * For wide fields of view it is scaled down, such that the vector to the
 * picture's farthest corner has length 2^29 to 2^30. */
void glint_quick_compute_ray(const struct glint_scene_view *view, int32_t x_q8,
                             int32_t y_q8, struct glint_scene_ray *ray,
                             int32_t seen_q30[3])
{
    const int down = 28 + view->wide;
    const int32_t toward[3] = {(int32_t)((x_q8 * view->step_q56[0]) >> down),
                               -(int32_t)((y_q8 * view->step_q56[1]) >> down),
                               (1 << 28) >> view->wide};

    glint_quick_normalise(toward, seen_q30);
    v3_rotate_back(&view->turn, seen_q30, ray->toward_q30);
    for (int k = 0; k < 3; k++)
        ray->at[k] = view->at[k];
}

/* ------------------------------------------------------------------- balls */

/* Prepares ball P for the fast path, which computes in units of the ball's
 * radius. Balls do not use it if the camera is inside, within 1/16 radius of
 * the surface, or 2^12 radii or more away. */
static void prepare_ball_for_fast_path(const struct glint_scene *s,
                                       struct glint_placed *p)
{
    int32_t to[3];
    uint64_t away;
    int up;

    p->over_up = 0;
    if (!p->is_seen || p->object->kind != GLINT_OBJECT_SPHERE)
        return;
    v3_subtract(p->at, s->view.at, to);
    away = glint_compute_square_root((uint64_t)v3_dot(to, to));
    if (away < (uint64_t)p->radius + (uint64_t)p->radius / 16 + 16)
        return;
    up = 29 - bit_length((uint64_t)q_divide((int64_t)away, p->radius));
    if (up < LEAST_UP)
        return;
    for (int k = 0; k < 3; k++)
        p->over[k] =
            (int32_t)q_divide((int64_t)to[k] * (INT64_C(1) << up), p->radius);
    p->over_up = up;
}

/* Prepares the computation of the pixels that ball P spans in each row. Let M
 * be the direction to the ball's middle and C the squared cosine of the angle
 * between M and the ball's rim. Let (X, Y) be a position in the picture, in
 * tangents. It is on the ball if (M.x X + M.y Y + M.z)^2 >= C (1 + X^2 +
 * Y^2). */
static void prepare_row_spans_of_ball(const struct glint_scene *s,
                                      struct glint_placed *p)
{
    int32_t seen[3], away;
    int64_t to[3], sine_q30;

    p->span.is_there = 0;
    if (p->over_up == 0 || s->view.wide > 1)
        return;
    glint_view_convert_to_camera(&s->view, p->at, seen);
    for (int k = 0; k < 3; k++)
        to[k] = seen[k];
    away = (int32_t)glint_compute_square_root((uint64_t)v3_dot(seen, seen));
    /* The ball is enlarged by a margin, as the samples of a row lie above and
     * below the middles of its pixels. */
    sine_q30 = glint_divide_rounded(
        ((uint64_t)p->radius + 2 * (uint64_t)p->margin) << 30, (uint64_t)away);
    if (!glint_normalise_vector(to, p->span.m_q30) || sine_q30 < 1 << 22 ||
        sine_q30 > 1 << 29)
        return;
    p->span.c_q30 = (int32_t)((1 << 30) - (sine_q30 * sine_q30 >> 30));
    p->span.a_q30 =
        (int32_t)(((int64_t)p->span.m_q30[0] * p->span.m_q30[0] >> 30) -
                  p->span.c_q30);
    /* The outline of the ball must be an ellipse that is not too flat. */
    if (p->span.a_q30 > -(1 << 26))
        return;
    p->span.up = q_count_normalising_shift((uint64_t)-p->span.a_q30);
    p->span.over = q_reciprocal((uint32_t)-p->span.a_q30 << p->span.up) >> 2;
    p->span.is_there = 1;
}

/* Solves for X the quadratic inequality (C - M.x^2) X^2 - 2 M.x h X + C (1 +
 * Y^2) - h^2 <= 0. h is M.y Y + M.z. prepare_row_spans_of_ball() defines C, M,
 * X and Y. */
int glint_scene_find_ball_span(const struct glint_scene *s,
                               const struct glint_placed *p, int y, int32_t *x0,
                               int32_t *x1)
{
    const int32_t y_q8 = 256 * y - 128 * (s->view.height - 1);
    const int64_t y_q28 = -(y_q8 * s->view.step_q56[1] >> 28);
    int64_t h_q28, rest_q56, half_q28, middle_q28, end_q28[2];
    int64_t square_q28;

    if (!p->span.is_there)
        return 1;
    square_q28 = (1 << 28) + (y_q28 * y_q28 >> 28); /* y is below 2^30 */
    h_q28 = (p->span.m_q30[1] * y_q28 >> 30) + (p->span.m_q30[2] >> 2);
    rest_q56 = h_q28 * h_q28 + (square_q28 * p->span.a_q30 >> 2);
    if (rest_q56 < -(INT64_C(1) << 36))
        return 0;
    rest_q56 = rest_q56 < 0 ? 0 : rest_q56;
    half_q28 = glint_compute_square_root((uint64_t)rest_q56) + (1 << 16);
    middle_q28 = p->span.m_q30[0] * h_q28 >> 30;
    for (int k = 0; k < 2; k++) {
        end_q28[k] =
            (middle_q28 + (k ? half_q28 : -half_q28)) * (int64_t)p->span.over >>
            (31 - p->span.up);
        end_q28[k] =
            (end_q28[k] * s->view.per_tan_q8 >> 36) + s->view.width / 2;
    }
    *x0 = q_clamp_sat(end_q28[0] - 2, *x0, *x1);
    *x1 = q_clamp_sat(end_q28[1] + 3, *x0, *x1);
    return *x0 < *x1;
}

void glint_quick_prepare_ball(const struct glint_scene *scene,
                              struct glint_placed *p)
{
    prepare_ball_for_fast_path(scene, p);
    prepare_row_spans_of_ball(scene, p);
}

void glint_quick_prepare_balls(struct glint_scene *scene)
{
    for (uint32_t i = 0; i < scene->model.header->n_objects; i++)
        glint_quick_prepare_ball(scene, &scene->placed[i]);
}

/* L is the vector from the ray's start to the ball's middle, D the ray's
 * direction. The ray passes the middle at distance |A|, A = L x D, in radii.
 * The unit normal is A x D - sqrt(1 - A.A) D, which is not accurate near the
 * rim. */
int glint_quick_intersect_ball(const struct glint_placed *p,
                               const struct glint_scene_ray *ray,
                               int32_t across_q30[3], int32_t *cosine_q30)
{
    int64_t cross[3];
    uint64_t square_q60;
    uint32_t s_q32;
    int up;

    v3_cross(p->over, ray->toward_q30, cross);
    for (int k = 0; k < 3; k++) {
        const int64_t a_q30 = cross[k] >> p->over_up;

        if (a_q30 > ONE_Q30 || a_q30 < -ONE_Q30)
            return 0;
        across_q30[k] = (int32_t)a_q30;
    }
    square_q60 = (UINT64_C(1) << 60) - (uint64_t)v3_dot(across_q30, across_q30);
    if ((int64_t)square_q60 < INT64_C(1) << 44)
        return 0;
    up = glint_quick_compute_even_shift(square_q60);
    s_q32 = (uint32_t)(square_q60 << up >> 32);
    *cosine_q30 =
        (int32_t)((uint64_t)s_q32 * glint_quick_inverse_root_q31(s_q32) >>
                  (31 + up / 2));
    return 1;
}

/* The distance to the intersection is L.D - cosine, in radii (L, D: see
 * glint_quick_intersect_ball()). */
int32_t glint_quick_get_ball_distance(const struct glint_placed *p,
                                      const struct glint_scene_ray *ray,
                                      int32_t cosine_q30)
{
    return q_clamp_sat((((v3_dot(p->over, ray->toward_q30) >> 30) -
                         (cosine_q30 >> (30 - p->over_up))) *
                        p->radius) >>
                           p->over_up,
                       1, GLINT_FAR - 1);
}

static int find_ball_surface(const struct glint_placed *p,
                             const struct glint_scene_ray *ray,
                             struct glint_met_surface *surface)
{
    const int32_t *d_q30 = ray->toward_q30;
    int64_t cross[3];
    int32_t across_q30[3], half_q30;

    if (!glint_quick_intersect_ball(p, ray, across_q30, &half_q30))
        return 0;
    v3_cross(across_q30, d_q30, cross);
    for (int k = 0; k < 3; k++) {
        const int32_t n_q30 =
            (int32_t)((cross[k] - (int64_t)half_q30 * d_q30[k]) >> 30);

        surface->normal_q30[k] = surface->face_q30[k] = n_q30;
        surface->place[k] =
            p->at[k] + (int32_t)q_shift((int64_t)n_q30 * p->radius, 30);
    }
    surface->t = glint_quick_get_ball_distance(p, ray, half_q30);
    return 1;
}

/* ------------------------------------------------------------------ planes */

/* Finds the point where RAY hits plane P. An error of 2^-24 in the ray's
 * direction moves the point by 2^-24 in the picture, for any orientation of the
 * plane. */
static int find_plane_surface(const struct glint_placed *p,
                              const struct glint_scene_ray *ray,
                              struct glint_met_surface *surface)
{
    int32_t sign;

    surface->t = glint_ray_intersect_plane(ray, p->at, p->centre);
    surface->is_inside = v3_dot(ray->toward_q30, p->centre) > 0;
    sign = surface->is_inside ? -1 : 1;
    for (int k = 0; k < 3; k++)
        surface->normal_q30[k] = surface->face_q30[k] = sign * p->centre[k];
    return surface->t > 0 &&
           glint_ray_point_at_distance(ray, surface->t, surface->place);
}

/* ------------------------------------------------------------------- either */

int glint_quick_find_surface(struct glint_scene_worker *w, uint32_t id,
                             int32_t x_q8, int32_t y_q8,
                             struct glint_scene_ray *ray,
                             struct glint_met_surface *surface)
{
    const struct glint_scene *s = w->scene;
    const struct glint_placed *p = &s->placed[id >> 20];
    int32_t seen_q30[3];

    surface->object = id >> 20;
    surface->triangle = id & 0xfffff;
    if (p->object->kind == GLINT_OBJECT_MESH) {
        if (!s->cfg.parts.meshes->find(w, id, x_q8, y_q8, surface))
            return 0;
        glint_quick_compute_ray(&s->view, x_q8, y_q8, ray, seen_q30);
        return 1;
    }
    if (p->object->kind == GLINT_OBJECT_SPHERE && !p->over_up)
        return 0;
    glint_quick_compute_ray(&s->view, x_q8, y_q8, ray, seen_q30);
    surface->material = &s->model.material[p->material];
    if (p->object->kind == GLINT_OBJECT_PLANE)
        return find_plane_surface(p, ray, surface);
    surface->is_inside = 0;
    return find_ball_surface(p, ray, surface);
}
