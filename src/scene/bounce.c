/* SPDX-License-Identifier: MIT
 *
 * Reflection and transmission: one reflection, and up to eight surfaces of
 * transmission.
 *
 * A ray that enters a sphere leaves it at the other end of its chord, at the
 * angle of entry, so total reflection inside does not occur. With index 1 rays
 * pass straight on, and the background behind the last object is the picture
 * itself; otherwise, as for reflections, it is the background's colour, the
 * environment, or the camera's picture extended to all directions.
 *
 * In the last case directions that the camera sees have the light of the
 * picture; all others get the picture mirrored at its edge. */
#include "scene/parts.h"
#include "scene/state.h"

/* A ray after reflection or refraction, and the surface that it starts from. */
struct passing {
    struct glint_scene_ray ray;
    uint32_t object, triangle;
    int32_t weight_q15; /* weight, in the pixel, of the light that it meets */
    int is_bent; /* 1: its direction differs from that of the primary ray */
    int64_t spread_q40; /* angular variance of a pixel's rays at this point */
};

/* Starts a ray at SURFACE, on the side from which the previous ray came; if
 * BEYOND is set, on the opposite side. */
static void start_ray(const struct glint_scene *s,
                      const struct glint_met_surface *surface, int beyond,
                      struct passing *p)
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

/* Sets RGB to the light of the camera's picture in the direction of P. In
 * units in which the picture's edge is at 1, direction (x, y, z) maps to (x,
 * y) / z. M = max(|x|, |y|) equals z at the edge; outside, z is mirrored
 * there: (x, y) / (2 M - z). The map is continuous, and the direction
 * opposite to the view maps to the middle again. */
static void look_up_picture(const struct glint_scene *s,
                            const struct passing *p, int32_t rgb_q15[3])
{
    const struct glint_scene_view *v = &s->view;
    /* Tangents of half the picture's width and height, at most 2^30. */
    const int64_t tan_x_q24 = q_shift(v->step_q56[0] * v->width, 25);
    const int64_t tan_y_q24 = q_shift(v->step_q56[1] * v->height, 25);
    const int64_t both_q24 = q_shift(tan_x_q24 * tan_y_q24, 24);
    int64_t x, y, z, most, over;
    int32_t seen_q30[3], half_q15[2];

    v3_turn(&v->turn, p->ray.toward_q30, seen_q30);
    /* All three times both tangents, _q30: within 2^36 and 2^43. */
    x = q_shift(seen_q30[0] * tan_y_q24, 24);
    y = q_shift(-seen_q30[1] * tan_x_q24, 24);
    z = q_shift(q_shift(seen_q30[2], 6) * both_q24, 18);
    most = (int64_t)q_magnitude(x);
    if ((int64_t)q_magnitude(y) > most)
        most = (int64_t)q_magnitude(y);
    over = z > most ? z : 2 * most - z;
    half_q15[0] = glint_ratio(q_magnitude(x) << 15, (uint64_t)over);
    half_q15[1] = glint_ratio(q_magnitude(y) << 15, (uint64_t)over);
    glint_around_at(&s->around,
                    (1 << 15) + (x < 0 ? -half_q15[0] : half_q15[0]),
                    (1 << 15) + (y < 0 ? -half_q15[1] : half_q15[1]), rgb_q15);
}

/* Adds the background in the direction of P: its colour, environment, or the
 * camera's picture. */
static void add_background(const struct glint_scene *s, const struct passing *p,
                           int32_t rgb_q15[3])
{
    int32_t light_q15[3];

    if (s->around.has_picture)
        look_up_picture(s, p, light_q15);
    else
        glint_scene_behind(s, p->ray.toward_q30, p->spread_q40, light_q15);
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

    return glint_scene_meet(s, &p->ray, p->object, p->triangle, &met) &&
           glint_scene_surface(s, &p->ray, &met, next);
}

/* Refracts P's direction at SURFACE. Returns 1 without changing it if total
 * reflection occurs. */
static int refract_ray(const struct glint_met_surface *surface,
                       uint32_t index_q16, struct passing *p)
{
    /* 2^44 / index: 2^28 times 1 / index, or the index itself */
    const uint32_t eta_q28 =
        surface->is_inside
            ? index_q16 << 12
            : (uint32_t)glint_ratio(UINT64_C(1) << 44, index_q16);
    int32_t to_q30[3];

    if (!glint_bend(p->ray.toward_q30, surface->normal_q30, eta_q28, to_q30)) {
        glint_mirror(p->ray.toward_q30, surface->normal_q30, p->ray.toward_q30);
        return 1;
    }
    for (int k = 0; k < 3; k++)
        p->ray.toward_q30[k] = to_q30[k];
    return 0;
}

/* Moves P through the sphere that it has entered to the point where it
 * leaves. */
static void cross_sphere(const struct glint_scene *s,
                         const struct glint_met_surface *surface,
                         int is_straight, struct passing *p)
{
    const struct glint_placed *ball = &s->placed[surface->object];
    struct glint_met_surface end = *surface;
    struct glint_chord chord;

    if (!glint_ray_sphere(&p->ray, ball->at, ball->radius, &chord))
        return; /* grazing ray: it leaves where it entered */
    glint_chord_end(&chord, &p->ray, ball->at, 1, end.place, end.normal_q30);
    for (int k = 0; k < 3; k++)
        end.normal_q30[k] = -end.normal_q30[k];
    end.is_inside = 1;
    if (!is_straight)
        refract_ray(&end, (uint32_t)surface->material->index_q16, p);
    start_ray(s, &end, 1, p);
}

/* Continues P behind SURFACE. */
static void pass_through(const struct glint_scene *s,
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
    start_ray(s, surface, !is_mirrored, p);
    if (is_sphere && surface->is_inside && is_mirrored)
        /* light that is totally reflected never leaves a ball */
        p->weight_q15 = 0;
    else if (is_sphere && !surface->is_inside && !is_mirrored)
        cross_sphere(s, surface, is_straight, p);
}

/* Returns the angular variance of a pixel's rays after reflection; a curved
 * mirror increases it. */
static int64_t
compute_mirror_spread_q40(const struct glint_scene *s,
                          const struct glint_scene_ray *ray,
                          const struct glint_met_surface *surface)
{
    if (s->model.header->background != GLINT_BACKGROUND_ENVIRONMENT)
        return 0;
    return glint_scene_pixel_q40(s) +
           (int64_t)s->cfg.parts.wards->spread(s, ray, surface) * 2048;
}

static void trace_reflection(const struct glint_scene *s,
                             const struct passing *from,
                             const struct glint_met_surface *surface,
                             int32_t rgb_q15[3])
{
    struct passing p = *from;
    struct glint_met_surface next;

    p.weight_q15 = q_mul(p.weight_q15, surface->material->reflect_q15, 15);
    glint_mirror(from->ray.toward_q30, surface->normal_q30, p.ray.toward_q30);
    start_ray(s, surface, 0, &p);
    p.spread_q40 = compute_mirror_spread_q40(s, &from->ray, surface);
    if (find_next_surface(s, &p, &next))
        glint_scene_phong(s, &p.ray, &next, p.weight_q15, rgb_q15);
    else
        add_background(s, &p, rgb_q15);
}

static void add_bounces(const struct glint_scene *s,
                        const struct glint_scene_ray *ray,
                        const struct glint_met_surface *surface,
                        struct glint_met_shade *shade)
{
    struct passing p = {.ray = *ray,
                        .weight_q15 = GLINT_SCENE_ONE_Q15,
                        .spread_q40 = glint_scene_pixel_q40(s)};
    struct glint_met_surface at = *surface;

    if (at.material->reflect_q15)
        trace_reflection(s, &p, &at, shade->rgb_q15);
    for (int i = 0; i < GLINT_SCENE_PASSES && at.material->pass_q15; i++) {
        pass_through(s, &at, &p);
        if (p.weight_q15 == 0)
            return;
        if (!find_next_surface(s, &p, &at)) {
            const int is_picture =
                s->model.header->background == GLINT_BACKGROUND_CAMERA;

            if (is_picture && !p.is_bent)
                shade->cover_q8 -= q_mul(p.weight_q15, GLINT_COVER_ALL, 15);
            else
                add_background(s, &p, shade->rgb_q15);
            return;
        }
        glint_scene_phong(s, &p.ray, &at, p.weight_q15, shade->rgb_q15);
    }
}

static void carve_environment(struct glint_scene *scene,
                              struct glint_arena *arena)
{
    glint_around_carve(&scene->around, arena, scene->cfg.width,
                       scene->cfg.height);
}

static void store_background(struct glint_scene *scene,
                             const struct glint_image *image)
{
    glint_around_look(&scene->around, image, scene->cfg.workers);
}

const struct glint_scene_bounces glint_scene_bounces = {
    add_bounces, carve_environment, store_background};
