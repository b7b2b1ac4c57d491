/* SPDX-License-Identifier: MIT
 *
 * Intersects rays with objects. A ray is tested with each object, as scenes
 * have few objects; the triangles of a mesh are sorted into a grid. */
#include "scene/parts.h"
#include "scene/state.h"

static int intersect_sphere(const struct glint_placed *p,
                            const struct glint_scene_ray *ray,
                            struct glint_met *met)
{
    if (!glint_ray_intersect_sphere(ray, p->at, p->radius, &met->chord))
        return 0;
    met->end = met->chord.t[0] <= 0;
    met->t = met->chord.t[met->end];
    return met->t > 0;
}

static int intersect_plane(const struct glint_placed *p,
                           const struct glint_scene_ray *ray,
                           struct glint_met *met)
{
    met->t = glint_ray_intersect_plane(ray, p->at, p->centre);
    return met->t > 0;
}

/* Intersects RAY with object I. On entry MET->t is the max distance, steps.
 * Returns 1 if RAY hits nearer. If ANY is set, stops at the first intersection
 * found. */
static int intersect_object(const struct glint_scene *s, uint32_t i,
                            const struct glint_scene_ray *ray,
                            uint32_t but_triangle, int any,
                            struct glint_met *met)
{
    const struct glint_placed *p = &s->placed[i];
    const int32_t limit = met->t;
    int does;

    met->object = i;
    met->triangle = 0;
    if (p->object->kind == GLINT_OBJECT_MESH)
        return s->cfg.parts.meshes->meet(s, i, but_triangle, ray, any, met);
    does = p->object->kind == GLINT_OBJECT_SPHERE
               ? intersect_sphere(p, ray, met)
               : intersect_plane(p, ray, met);
    return does && met->t < limit;
}

/* Returns whether rays that start on OBJECT can hit object I: I is shown, is
 * not a shadow catcher, and is not OBJECT itself, unless OBJECT is a mesh
 * (spheres and planes are convex). */
static int can_ray_hit_object(const struct glint_scene *s, uint32_t i,
                              uint32_t object)
{
    const struct glint_scene_object *o = s->placed[i].object;

    return s->placed[i].is_shown && o->catcher_q15 == 0 &&
           (i != object || o->kind == GLINT_OBJECT_MESH);
}

int glint_scene_find_nearest_hit(const struct glint_scene *scene,
                                 const struct glint_scene_ray *ray,
                                 uint32_t object, uint32_t triangle,
                                 struct glint_met *met)
{
    int any = 0;

    glint_scene_count_ray_tests(scene, scene->model.header->n_objects);
    met->t = GLINT_FAR;
    for (uint32_t i = 0; i < scene->model.header->n_objects; i++) {
        struct glint_met next = {.t = met->t};

        if (can_ray_hit_object(scene, i, object) &&
            intersect_object(scene, i, ray,
                             i == object ? triangle : GLINT_NOTHING, 0,
                             &next)) {
            *met = next;
            any = 1;
        }
    }
    return any;
}

int glint_scene_is_ray_blocked(const struct glint_scene *scene,
                               const struct glint_scene_ray *ray,
                               uint32_t object, uint32_t triangle,
                               int32_t limit)
{
    const uint32_t n = scene->model.header->n_objects;

    for (uint32_t i = 0; i < n; i++) {
        struct glint_met met = {.t = limit};

        if (can_ray_hit_object(scene, i, object) &&
            intersect_object(scene, i, ray,
                             i == object ? triangle : GLINT_NOTHING, 1, &met)) {
            glint_scene_count_ray_tests(scene, i + 1);
            return 1;
        }
    }
    glint_scene_count_ray_tests(scene, n);
    return 0;
}

/* Returns whether object I casts a shadow on points of OBJECT. */
static int can_object_shadow(const struct glint_scene *s, uint32_t i,
                             uint32_t object)
{
    return can_ray_hit_object(s, i, object) &&
           s->placed[i].object->unblocked_q15 < GLINT_SCENE_ONE_Q15;
}

int32_t glint_scene_compute_unblocked_light(const struct glint_scene *scene,
                                            const struct glint_scene_ray *ray,
                                            uint32_t object, uint32_t triangle,
                                            int32_t limit)
{
    const uint32_t n = scene->model.header->n_objects;
    int32_t share_q15 = GLINT_SCENE_ONE_Q15;

    for (uint32_t i = 0; i < n; i++) {
        struct glint_met met = {.t = limit};

        if (!can_object_shadow(scene, i, object) ||
            !intersect_object(scene, i, ray,
                              i == object ? triangle : GLINT_NOTHING, 1, &met))
            continue;
        share_q15 =
            q_mul(share_q15, scene->placed[i].object->unblocked_q15, 15);
        if (share_q15 == 0) {
            glint_scene_count_ray_tests(scene, i + 1);
            return 0;
        }
    }
    glint_scene_count_ray_tests(scene, n);
    return share_q15;
}

/* Returns whether object P may touch the cone of rays (state.h). P's bounding
 * sphere decides; its distance from the cone's axis is |L x D|, where L is the
 * vector from the cone's tip to the sphere's centre, and D the axis. */
static int can_object_touch_cone(const struct glint_placed *p,
                                 const struct glint_scene_ray *axis, int32_t t,
                                 int32_t slope_q30)
{
    enum { SLACK = 16 }; /* tolerance for rounding errors, steps */
    const int64_t reach = p->reach + SLACK;
    int64_t across_q30[3], along, limit, square = 0;
    int32_t to[3];

    if (p->object->kind == GLINT_OBJECT_PLANE)
        return 1;
    v3_subtract(p->centre, axis->at, to);
    along = q_shift(v3_dot(to, axis->toward_q30), 30);
    if (along + reach < 0 || along - reach > t)
        return 0;
    limit = reach + q_shift((along + reach) * slope_q30, 30);
    v3_cross(to, axis->toward_q30, across_q30);
    for (int k = 0; k < 3; k++) {
        const int64_t x = q_shift(across_q30[k], 30);

        square += x * x; /* below 3 * 2^60 */
    }
    return square <= limit * limit; /* LIMIT is below 2^31 */
}

int glint_scene_can_cone_be_blocked(const struct glint_scene *scene,
                                    const struct glint_scene_ray *axis,
                                    uint32_t object, int32_t t,
                                    int32_t slope_q30)
{
    const uint32_t n = scene->model.header->n_objects;

    glint_scene_count_ray_tests(scene, n);
    for (uint32_t i = 0; i < n; i++)
        if (can_object_shadow(scene, i, object) &&
            can_object_touch_cone(&scene->placed[i], axis, t, slope_q30))
            return 1;
    return 0;
}

int glint_scene_is_ray_blocked_by_plane(const struct glint_scene *scene,
                                        const struct glint_scene_ray *ray,
                                        uint32_t object)
{
    for (uint32_t i = 0; scene->n_planes && i <= scene->plane; i++) {
        struct glint_met met;

        if (scene->placed[i].object->kind == GLINT_OBJECT_PLANE &&
            can_ray_hit_object(scene, i, object) &&
            intersect_plane(&scene->placed[i], ray, &met))
            return 1;
    }
    return 0;
}

void glint_scene_look_up_background(const struct glint_scene *scene,
                                    const int32_t toward_q30[3],
                                    int64_t spread_q40, int32_t rgb_q15[3])
{
    const struct glint_scene_header *h = scene->model.header;

    if (h->background == GLINT_BACKGROUND_ENVIRONMENT)
        scene->cfg.parts.wards->look(scene, toward_q30, spread_q40, rgb_q15);
    else
        for (int c = 0; c < 3; c++)
            rgb_q15[c] = h->background_q15[c];
}

int glint_scene_ray_hits_id(const struct glint_scene *scene,
                            const struct glint_scene_ray *ray,
                            const int32_t seen_q30[3], uint32_t id,
                            struct glint_met *met)
{
    const uint32_t object = id >> 20, triangle = id & 0xfffff;
    const struct glint_placed *p = &scene->placed[object];

    met->object = object;
    met->triangle = triangle;
    if (p->object->kind == GLINT_OBJECT_MESH)
        return scene->cfg.parts.meshes->hold(scene, object, triangle, seen_q30,
                                             met);
    return p->object->kind == GLINT_OBJECT_SPHERE
               ? intersect_sphere(p, ray, met)
               : intersect_plane(p, ray, met);
}

static void negate_vector(int32_t v[3])
{
    for (int k = 0; k < 3; k++)
        v[k] = -v[k];
}

static int set_plane_surface(const struct glint_scene_ray *ray,
                             const struct glint_placed *p,
                             const struct glint_met *met,
                             struct glint_met_surface *surface)
{
    for (int k = 0; k < 3; k++)
        surface->normal_q30[k] = surface->face_q30[k] = p->centre[k];
    return glint_ray_point_at_distance(ray, met->t, surface->place);
}

static int set_sphere_surface(const struct glint_scene_ray *ray,
                              const struct glint_placed *p,
                              const struct glint_met *met,
                              struct glint_met_surface *surface)
{
    glint_chord_set_end_point_and_normal(&met->chord, ray, p->at, met->end,
                                         surface->place, surface->normal_q30);
    for (int k = 0; k < 3; k++)
        surface->face_q30[k] = surface->normal_q30[k];
    return 1;
}

int glint_scene_find_surface_at_hit(const struct glint_scene *scene,
                                    const struct glint_scene_ray *ray,
                                    const struct glint_met *met,
                                    struct glint_met_surface *surface)
{
    const struct glint_placed *p = &scene->placed[met->object];
    int is;

    surface->object = met->object;
    surface->triangle = met->triangle;
    surface->t = met->t;
    surface->material = &scene->model.material[p->material];
    surface->uv_q16[0] = surface->uv_q16[1] = 0;
    surface->uv_log2_q16 = 0;
    if (p->object->kind == GLINT_OBJECT_MESH)
        is = scene->cfg.parts.meshes->surface(scene, met, surface);
    else if (p->object->kind == GLINT_OBJECT_SPHERE)
        is = set_sphere_surface(ray, p, met, surface);
    else
        is = set_plane_surface(ray, p, met, surface);
    surface->is_inside = v3_dot(ray->toward_q30, surface->face_q30) > 0;
    if (surface->is_inside) {
        negate_vector(surface->normal_q30);
        negate_vector(surface->face_q30);
    }
    return is;
}
