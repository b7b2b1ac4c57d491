/* SPDX-License-Identifier: MIT
 *
 * Traces reflected and transmitted rays: one reflection per ray, and at most
 * eight transmitting surfaces in a row.
 *
 * A ray that enters a sphere leaves it at the other end of its chord, at the
 * angle of entry, so total reflection inside does not occur. If the refractive
 * index is 1, rays are not bent. Behind the last object such rays let the
 * picture show through unchanged. Bent and reflected rays see the background's
 * colour, the environment, or the camera's picture. The picture is extended to
 * all directions: directions outside the field of view read it mirrored at its
 * edge. */
#include "scene/parts.h"
#include "scene/state.h"

/* A ray after reflection or refraction, and the surface that it starts from. */
struct passing {
    struct glint_scene_ray ray;
    uint32_t object, triangle;
    int32_t weight_q15; /* fraction of this ray's light that reaches the
                           pixel */
    int is_bent; /* 1: its direction differs from that of the primary ray */
    int64_t spread_q40; /* angular variance of the rays of a pixel, radians^2 */
};

/* Starts a secondary ray at SURFACE. On a mesh, it starts on the side from
 * which the previous ray came, or on the opposite side if BEYOND is set. */
static void start_secondary_ray(const struct glint_scene *s,
                                const struct glint_met_surface *surface,
                                int beyond, struct passing *p)
{
    const int is_mesh =
        s->placed[surface->object].object->kind == GLINT_OBJECT_MESH;
    const int lift =
        is_mesh ? beyond ? -GLINT_SCENE_LIFT : GLINT_SCENE_LIFT : 0;

    for (int k = 0; k < 3; k++)
        p->ray.at[k] =
            surface->place[k] + q_mul(surface->face_q30[k], lift, 30);
    p->object = surface->object;
    p->triangle = surface->triangle;
}

/* Sets RGB to the light of the camera's picture in the direction of P. Let (x,
 * y, z) be that direction, with x and y scaled such that the picture's edges
 * are at |x| = z and |y| = z. Inside the picture the direction reads the
 * position (x, y) / z. Outside, where M = max(|x|, |y|) is above z, it reads
 * (x, y) / (2 M - z). This is continuous at the edge, and the direction
 * opposite to the view reads the middle again. */
static void sample_camera_picture(const struct glint_scene *s,
                                  const struct passing *p, int32_t rgb_q15[3])
{
    const struct glint_scene_view *v = &s->view;
    /* Tangents of half the picture's width and height, at most 2^30. */
    const int64_t tan_x_q24 = q_shift(v->step_q56[0] * v->width, 25);
    const int64_t tan_y_q24 = q_shift(v->step_q56[1] * v->height, 25);
    const int64_t both_q24 = q_shift(tan_x_q24 * tan_y_q24, 24);
    int64_t x, y, z, most, over;
    int32_t seen_q30[3], half_q15[2];

    v3_rotate(&v->turn, p->ray.toward_q30, seen_q30);
    /* x, y and z are multiplied by both tangents, which scales x and y without
     * a division. They are _q30, within 2^36 and 2^43. */
    x = q_shift(seen_q30[0] * tan_y_q24, 24);
    y = q_shift(-seen_q30[1] * tan_x_q24, 24);
    z = q_shift(q_shift(seen_q30[2], 6) * both_q24, 18);
    most = (int64_t)q_magnitude(x);
    if ((int64_t)q_magnitude(y) > most)
        most = (int64_t)q_magnitude(y);
    over = z > most ? z : 2 * most - z;
    half_q15[0] = glint_divide_rounded(q_magnitude(x) << 15, (uint64_t)over);
    half_q15[1] = glint_divide_rounded(q_magnitude(y) << 15, (uint64_t)over);
    glint_background_sample(
        &s->around, (1 << 15) + (x < 0 ? -half_q15[0] : half_q15[0]),
        (1 << 15) + (y < 0 ? -half_q15[1] : half_q15[1]), rgb_q15);
}

/* Adds to RGB the background in the direction of P, times P's weight: a colour,
 * the environment, or the camera's picture. */
static void add_background_light(const struct glint_scene *s,
                                 const struct passing *p, int32_t rgb_q15[3])
{
    int32_t light_q15[3];

    if (s->around.has_picture)
        sample_camera_picture(s, p, light_q15);
    else
        glint_scene_look_up_background(s, p->ray.toward_q30, p->spread_q40,
                                       light_q15);
    for (int c = 0; c < 3; c++)
        rgb_q15[c] = q_clamp_sat(
            rgb_q15[c] + q_shift(light_q15[c] * (int64_t)p->weight_q15, 15), 0,
            GLINT_SCENE_MOST_LIGHT);
}

static int find_next_surface(const struct glint_scene *s,
                             const struct passing *p,
                             struct glint_met_surface *next)
{
    struct glint_met met;

    return glint_scene_find_nearest_hit(s, &p->ray, p->object, p->triangle,
                                        &met) &&
           glint_scene_find_surface_at_hit(s, &p->ray, &met, next);
}

/* Refracts the ray P at SURFACE and returns 0; or, at total reflection,
 * reflects P and returns 1. */
static int refract_ray(const struct glint_met_surface *surface,
                       uint32_t index_q16, struct passing *p)
{
    /* refractive index in front of the surface / index behind it: 1 / INDEX if
     * the ray enters the object, INDEX if it leaves */
    const uint32_t eta_q28 =
        surface->is_inside
            ? index_q16 << 12
            : (uint32_t)glint_divide_rounded(UINT64_C(1) << 44, index_q16);
    int32_t to_q30[3];

    if (!glint_bend(p->ray.toward_q30, surface->normal_q30, eta_q28, to_q30)) {
        glint_reflect_direction(p->ray.toward_q30, surface->normal_q30,
                                p->ray.toward_q30);
        return 1;
    }
    for (int k = 0; k < 3; k++)
        p->ray.toward_q30[k] = to_q30[k];
    return 0;
}

/* Moves P through the sphere that it has entered to the point where it leaves
 * the sphere. */
static void move_ray_through_sphere(const struct glint_scene *s,
                                    const struct glint_met_surface *surface,
                                    int is_straight, struct passing *p)
{
    const struct glint_placed *ball = &s->placed[surface->object];
    struct glint_met_surface end = *surface;
    struct glint_chord chord;

    if (!glint_ray_intersect_sphere(&p->ray, ball->at, ball->radius, &chord))
        return; /* a grazing ray leaves the sphere at the point where it
                   enters */
    glint_chord_set_end_point_and_normal(&chord, &p->ray, ball->at, 1,
                                         end.place, end.normal_q30);
    for (int k = 0; k < 3; k++)
        end.normal_q30[k] = -end.normal_q30[k];
    end.is_inside = 1;
    if (!is_straight)
        refract_ray(&end, (uint32_t)surface->material->index_q16, p);
    start_secondary_ray(s, &end, 1, p);
}

/* Continues the ray P behind SURFACE, or in front of it after total reflection,
 * and multiplies its weight by the transmitted fraction. */
static void continue_ray_behind_surface(const struct glint_scene *s,
                                        const struct glint_met_surface *surface,
                                        struct passing *p)
{
    const struct glint_scene_material *m = surface->material;
    const int is_straight = m->index_q16 == 1 << 16;
    const int is_sphere =
        s->placed[surface->object].object->kind == GLINT_OBJECT_SPHERE;
    int is_mirrored = 0;

    p->weight_q15 = q_mul(p->weight_q15, m->pass_q15, 15);
    p->is_bent |= !is_straight;
    if (!is_straight)
        is_mirrored = refract_ray(surface, (uint32_t)m->index_q16, p);
    start_secondary_ray(s, surface, !is_mirrored, p);
    if (is_sphere && surface->is_inside && is_mirrored)
        /* light that is totally reflected never leaves a ball */
        p->weight_q15 = 0;
    else if (is_sphere && !surface->is_inside && !is_mirrored)
        move_ray_through_sphere(s, surface, is_straight, p);
}

/* Returns the angular variance of a pixel's rays, radians^2, after reflection
 * at SURFACE. Curved surfaces increase it. 0 if the background is not an
 * environment, as only this is blurred. */
static int64_t
compute_mirror_spread_q40(const struct glint_scene *s,
                          const struct glint_scene_ray *ray,
                          const struct glint_met_surface *surface)
{
    if (s->model.header->background != GLINT_BACKGROUND_ENVIRONMENT)
        return 0;
    return glint_scene_pixel_variance_q40(s) +
           (int64_t)s->cfg.parts.wards->spread(s, ray, surface) * 2048;
}

static void trace_reflected_ray(const struct glint_scene *s,
                                const struct passing *from,
                                const struct glint_met_surface *surface,
                                int32_t rgb_q15[3])
{
    struct passing p = *from;
    struct glint_met_surface next;

    p.weight_q15 = q_mul(p.weight_q15, surface->material->reflect_q15, 15);
    glint_reflect_direction(from->ray.toward_q30, surface->normal_q30,
                            p.ray.toward_q30);
    start_secondary_ray(s, surface, 0, &p);
    p.spread_q40 = compute_mirror_spread_q40(s, &from->ray, surface);
    if (find_next_surface(s, &p, &next))
        glint_scene_add_phong_light(s, &p.ray, &next, p.weight_q15, rgb_q15);
    else
        add_background_light(s, &p, rgb_q15);
}

static void add_secondary_light(const struct glint_scene *s,
                                const struct glint_scene_ray *ray,
                                const struct glint_met_surface *surface,
                                struct glint_met_shade *shade)
{
    struct passing p = {.ray = *ray,
                        .weight_q15 = GLINT_SCENE_ONE_Q15,
                        .spread_q40 = glint_scene_pixel_variance_q40(s)};
    struct glint_met_surface at = *surface;

    if (at.material->reflect_q15)
        trace_reflected_ray(s, &p, &at, shade->rgb_q15);
    for (int i = 0; i < GLINT_SCENE_PASSES && at.material->pass_q15; i++) {
        continue_ray_behind_surface(s, &at, &p);
        if (p.weight_q15 == 0)
            return;
        if (!find_next_surface(s, &p, &at)) {
            const int is_picture =
                s->model.header->background == GLINT_BACKGROUND_CAMERA;

            if (is_picture && !p.is_bent)
                shade->cover_q8 -= q_mul(p.weight_q15, GLINT_COVER_ALL, 15);
            else
                add_background_light(s, &p, shade->rgb_q15);
            return;
        }
        glint_scene_add_phong_light(s, &p.ray, &at, p.weight_q15,
                                    shade->rgb_q15);
    }
}

static void allocate_background_picture(struct glint_scene *scene,
                                        struct glint_arena *arena)
{
    glint_background_allocate(&scene->around, arena, scene->cfg.width,
                              scene->cfg.height);
}

static void store_background_picture(struct glint_scene *scene,
                                     const struct glint_image *image)
{
    glint_background_store(&scene->around, image, scene->cfg.workers);
}

const struct glint_scene_bounces glint_scene_bounces = {
    add_secondary_light, allocate_background_picture, store_background_picture};
