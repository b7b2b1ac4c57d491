/* SPDX-License-Identifier: MIT
 *
 * Ray intersections of the reference renderer (twin.h).
 */
#include "reference/scenes/twin.h"

#include <stdlib.h>

#include "glint/view.h"
#include "reference/scenes/vec.h"

/* A ray that starts on a mesh first moves ahead by this fraction of 1 + the
 * distance between its start and the mesh's origin, so that it does not hit a
 * neighbouring triangle at a shared corner. */
#define ACNE 1e-9

/* number of consecutive triangles of the description with a common bounding
 * sphere */
enum { RUN = 16 };

/* ------------------------------------------------------ spheres and planes */

/* With L the vector from the ray's origin to the centre, d the ray's direction
 * and s = L.d, the ray hits if |L - s d|^2 <= r^2. INSIDE: the ray starts on
 * the ball's surface and runs into it. */
static bool intersect_sphere(const struct glint_described_object *o,
                             const struct twin_ray *ray, bool inside,
                             double most, struct twin_hit *hit)
{
    double l[3], q[3], s, half;

    vec_add_scaled(o->at, -1, ray->from, l);
    s = vec_dot(l, ray->toward);
    vec_add_scaled(l, -s, ray->toward, q);
    half = o->radius * o->radius - vec_dot(q, q);
    if (half < 0)
        return false;
    half = sqrt(half);
    hit->inside = inside || vec_dot(l, l) < o->radius * o->radius;
    hit->t = hit->inside ? s + half : s - half;
    if (hit->t <= 0 || hit->t >= most)
        return false;
    vec_add_scaled(ray->from, hit->t, ray->toward, hit->place);
    vec_add_scaled(hit->place, -1, o->at, hit->normal);
    vec_normalise(hit->normal);
    return true;
}

/* Sets the texture coordinates on a ball. u is the longitude about the y axis;
 * it is 1/2 at the point that faces an unrotated camera. v is the latitude,
 * upwards from the lowest point. */
static void set_ball_uv(const struct glint_description *scene,
                        const struct glint_described_object *o,
                        struct twin_hit *hit)
{
    double n[3];

    vec_rotate(o->turn, -1, hit->normal, n);
    hit->uv[0] =
        .5 + atan2(n[0], scene->left_handed ? -n[2] : n[2]) / (2 * GLINT_PI);
    hit->uv[1] = 1 - acos(fmax(-1, fmin(1, n[1]))) / GLINT_PI;
}

/* Sets the texture coordinates on a plane. u and v are lengths in units of the
 * scene: on a horizontal plane, u along x and v away from the viewer. */
static void set_plane_uv(const struct glint_description *scene,
                         const struct glint_described_object *o,
                         struct twin_hit *hit)
{
    double upright[4], away[3], flat[3];

    glint_described_upright(o->normal, upright);
    vec_add_scaled(hit->place, -1, o->at, away);
    vec_rotate(o->turn, -1, away, flat);
    vec_rotate(upright, -1, flat, away);
    hit->uv[0] = away[0];
    hit->uv[1] = scene->left_handed ? away[2] : -away[2];
}

static bool intersect_plane(const struct glint_described_object *o,
                            const struct twin_ray *ray, double most,
                            struct twin_hit *hit)
{
    double away[3], slope;

    vec_rotate(o->turn, 1, o->normal, hit->normal);
    slope = vec_dot(hit->normal, ray->toward);
    vec_add_scaled(o->at, -1, ray->from, away);
    if (slope == 0)
        return false;
    hit->t = vec_dot(hit->normal, away) / slope;
    if (!(hit->t > 0) || hit->t >= most)
        return false;
    vec_add_scaled(ray->from, hit->t, ray->toward, hit->place);
    hit->inside = slope > 0;
    return true;
}

/* ------------------------------------------------------------------ meshes */

void reference_complete_triangle_hit(const struct twin *twin,
                                     const struct glint_described_object *o,
                                     struct twin_hit *hit)
{
    const struct glint_described_triangle *t =
        &twin->scene->triangle[hit->triangle];
    const double share[3] = {1 - hit->uv[0] - hit->uv[1], hit->uv[0],
                             hit->uv[1]};
    double a[3], b[3], n[3], smooth[3] = {0, 0, 0};

    vec_add_scaled(t->place[1], -1, t->place[0], a);
    vec_add_scaled(t->place[2], -1, t->place[0], b);
    vec_cross(a, b, n);
    vec_normalise(n);
    hit->uv[0] = hit->uv[1] = 0;
    for (int k = 0; k < 3; k++) {
        if (t->has_normals)
            vec_add_scaled(smooth, share[k], t->normal[k], smooth);
        for (int i = 0; t->has_uv && i < 2; i++)
            hit->uv[i] += share[k] * t->uv[k][i];
    }
    /* the normals in the file determine which side is outside, not the order of
     * the corners */
    if (!t->has_normals || !(vec_normalise(smooth) > 0))
        for (int i = 0; i < 3; i++)
            smooth[i] = n[i];
    vec_rotate(o->turn, 1, n, hit->normal);
    vec_rotate(o->turn, 1, smooth, hit->shading);
    hit->material = t->material;
}

/* Finds the intersection of RAY with triangle I nearer than hit->t, by
 * [Moller97]. The point is V0 + u (V1 - V0) + v (V2 - V0), where V0, V1 and V2
 * are the corners. */
static bool intersect_triangle(const struct twin *twin, int i,
                               const struct twin_ray *ray, struct twin_hit *hit)
{
    const struct glint_described_triangle *tri = &twin->scene->triangle[i];
    double a[3], b[3], p[3], q[3], s[3], det, u, v, t;

    vec_add_scaled(tri->place[1], -1, tri->place[0], a);
    vec_add_scaled(tri->place[2], -1, tri->place[0], b);
    vec_cross(ray->toward, b, p);
    det = vec_dot(a, p);
    vec_add_scaled(ray->from, -1, tri->place[0], s);
    vec_cross(s, a, q);
    u = vec_dot(s, p);
    v = vec_dot(ray->toward, q);
    t = vec_dot(b, q);
    if (det < 0) {
        u = -u;
        v = -v;
        t = -t;
    }
    /* if the ray lies in the triangle's plane, or the triangle has no area,
     * det, u, v and t are 0 */
    if (!(fabs(det) > 0) || u < 0 || v < 0 || u + v > fabs(det) || t <= 0 ||
        t >= hit->t * fabs(det))
        return false;
    hit->t = t / fabs(det);
    hit->triangle = i;
    hit->inside = det < 0;
    hit->uv[0] = u / fabs(det);
    hit->uv[1] = v / fabs(det);
    return true;
}

enum glint_status reference_bound_triangles(struct twin *twin)
{
    const struct glint_description *s = twin->scene;
    const int n_runs = (s->n_triangles + RUN - 1) / RUN;

    twin->bound = calloc((size_t)n_runs + 1, sizeof *twin->bound);
    if (!twin->bound)
        return GLINT_E_MEMORY;
    for (int i = 0; i < n_runs; i++) {
        struct twin_bound *const b = &twin->bound[i];
        const int n = s->n_triangles - RUN * i < RUN ? s->n_triangles - RUN * i
                                                     : (int)RUN;
        double square = 0;

        for (int k = 0; k < 3 * n; k++)
            vec_add_scaled(b->centre, 1. / (3 * n),
                           s->triangle[RUN * i + k / 3].place[k % 3],
                           b->centre);
        for (int k = 0; k < 3 * n; k++) {
            double to[3];

            vec_add_scaled(s->triangle[RUN * i + k / 3].place[k % 3], -1,
                           b->centre, to);
            square = fmax(square, vec_dot(to, to));
        }
        b->radius = sqrt(square);
    }
    return GLINT_OK;
}

/* Returns whether RAY passes through sphere B nearer than the distance MOST. */
static bool ray_passes_bound(const struct twin_bound *b,
                             const struct twin_ray *ray, double most)
{
    double l[3], q[3], reach, s;

    vec_add_scaled(b->centre, -1, ray->from, l);
    s = vec_dot(l, ray->toward);
    vec_add_scaled(l, -s, ray->toward, q);
    reach = b->radius + ACNE * (b->radius + sqrt(vec_dot(l, l)));
    return s > -reach && s - reach < most && vec_dot(q, q) <= reach * reach;
}

static bool intersect_mesh_object(const struct twin *twin, int object,
                                  const struct twin_ray *ray, double most,
                                  struct twin_hit *hit)
{
    const struct glint_described_object *o = &twin->scene->object[object];
    const int end = o->first_triangle + o->n_triangles;
    struct twin_ray local = *ray;
    double away[3];
    bool found = false;

    vec_add_scaled(ray->from, -1, o->at, away);
    vec_rotate(o->turn, -1, away, local.from);
    vec_rotate(o->turn, -1, ray->toward, local.toward);
    if (ray->skip_object == object) {
        const double step = ACNE * (1 + sqrt(vec_dot(away, away)));

        vec_add_scaled(local.from, step, local.toward, local.from);
    } else {
        local.skip_triangle = -1;
    }
    hit->t = most;
    for (int i = o->first_triangle, next; i < end; i = next) {
        next = i - i % RUN + RUN < end ? i - i % RUN + RUN : end;
        if (!ray_passes_bound(&twin->bound[i / RUN], &local, hit->t))
            continue;
        for (; i < next; i++)
            if (i != local.skip_triangle)
                found |= intersect_triangle(twin, i, &local, hit);
    }
    if (!found)
        return false;
    vec_add_scaled(ray->from, hit->t, ray->toward, hit->place);
    reference_complete_triangle_hit(twin, o, hit);
    return true;
}

/* -------------------------------------------------------------- any object */

bool reference_intersect_object(const struct twin *twin, int object,
                                const struct twin_ray *ray, double most,
                                struct twin_hit *hit)
{
    const struct glint_description *s = twin->scene;
    const struct glint_described_object *o = &s->object[object];
    const bool is_mesh = o->n_triangles > 0;

    *hit = (struct twin_hit){
        .object = object, .triangle = -1, .material = o->material};
    if (is_mesh) {
        if (!intersect_mesh_object(twin, object, ray, most, hit))
            return false;
    } else {
        const bool is_ball = o->kind == GLINT_DESCRIBED_SPHERE;
        const bool is_own = ray->skip_object == object;

        if ((is_own && !ray->is_in_ball) ||
            !(is_ball ? intersect_sphere(o, ray, is_own, most, hit)
                      : intersect_plane(o, ray, most, hit)))
            return false;
        if (o->material >= 0 && (s->material[o->material].texture >= 0 ||
                                 s->material[o->material].is_stone))
            (is_ball ? set_ball_uv : set_plane_uv)(s, o, hit);
        for (int i = 0; i < 3; i++)
            hit->shading[i] = hit->normal[i];
    }
    if (vec_dot(hit->shading, hit->normal) < 0)
        for (int i = 0; i < 3; i++)
            hit->shading[i] = -hit->shading[i];
    if (vec_dot(hit->normal, ray->toward) > 0)
        for (int i = 0; i < 3; i++) {
            hit->normal[i] = -hit->normal[i];
            hit->shading[i] = -hit->shading[i];
        }
    return true;
}

bool reference_intersect_scene(const struct twin *twin,
                               const struct twin_ray *ray, double most,
                               struct twin_hit *hit)
{
    bool found = false;

    for (int i = 0; i < twin->scene->n_objects; i++) {
        struct twin_hit next;

        if (twin->scene->object[i].catcher > 0 ||
            !reference_intersect_object(twin, i, ray, found ? hit->t : most,
                                        &next))
            continue;
        *hit = next;
        found = true;
    }
    return found;
}

double reference_compute_unblocked_light(const struct twin *twin,
                                         const struct twin_ray *ray,
                                         double most)
{
    double share = 1;

    for (int i = 0; share > 0 && i < twin->scene->n_objects; i++) {
        const struct glint_described_object *o = &twin->scene->object[i];
        struct twin_hit hit;

        if (!(o->catcher > 0) &&
            reference_intersect_object(twin, i, ray, most, &hit))
            share *= 1 - o->shadow;
    }
    return share;
}

void reference_make_camera_ray(const struct twin *twin,
                               const struct twin_view *view, double x, double y,
                               struct twin_ray *ray)
{
    const struct glint_described_camera *c = &twin->scene->camera;
    const double w = view->width, h = view->height;
    double right, up;

    if (c->field == GLINT_DESCRIBED_CORNERS) {
        right = w > 1 ? 1.6 * x / (w - 1) - 0.8 : 0;
        up = h > 1 ? 0.45 - 0.9 * y / (h - 1) : 0;
    } else {
        const double focal = c->field == GLINT_DESCRIBED_LENS
                                 ? view->focal_px
                                 : w / 2 / tan(c->fov_deg * GLINT_PI / 360);

        right = (x - w / 2) / focal;
        up = (h / 2 - y) / focal;
    }
    *ray = (struct twin_ray){.skip_object = -1, .skip_triangle = -1};
    for (int i = 0; i < 3; i++) {
        ray->from[i] = c->at[i];
        ray->toward[i] = c->forward[i] + right * c->right[i] + up * c->up[i];
    }
    vec_normalise(ray->toward);
}
