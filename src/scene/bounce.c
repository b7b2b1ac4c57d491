/* SPDX-License-Identifier: MIT
 *
 * Traces reflected and transmitted rays: one reflection per ray, and at most
 * eight transmitting surfaces in a row.
 *
 * A ray that has entered a sphere continues to the nearest surface: an object
 * inside the sphere, or the sphere's far side. Light and transmittance of a
 * sphere are those of the surface by which the ray enters. Snell's law takes
 * the refractive index on each side of a surface from the objects that the ray
 * has entered and not left. Behind the last object, rays that were never bent
 * let the picture show through unchanged. Bent and reflected rays see the
 * background's colour, the environment, or the camera's picture. The picture is
 * extended to all directions: directions outside the field of view read it
 * mirrored at its edge. */
#include "scene/parts.h"
#include "scene/state.h"

enum {
    AIR_Q16 = 1 << 16, /* refractive index outside all objects */
    /* Min half length, in the unit of chords, of a chord whose ends lie clearly
     * on both sides of its middle. */
    LEAST_HALF = 8
};

/* The objects that a ray has entered and not left, in the order of entry. The
 * ray runs in the medium of the last one. */
struct media {
    int n;
    uint32_t object[GLINT_SCENE_PASSES];
    int32_t index_q16[GLINT_SCENE_PASSES]; /* refractive indices */
};

/* A ray after reflection or refraction, and the surface that it starts from. */
struct passing {
    struct glint_scene_ray ray;
    uint32_t object, triangle;
    int is_in_sphere; /* 1: the ray starts on the sphere OBJECT and runs through
                         the sphere's inside */
    struct media media;
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
    const uint32_t kind = s->placed[surface->object].object->kind;
    const int lift = kind != GLINT_OBJECT_MESH ? 0
                     : beyond                  ? -GLINT_SCENE_LIFT
                                               : GLINT_SCENE_LIFT;

    for (int k = 0; k < 3; k++)
        p->ray.at[k] =
            surface->place[k] + q_mul(surface->face_q30[k], lift, 30);
    p->object = surface->object;
    p->triangle = surface->triangle;
    p->is_in_sphere =
        kind == GLINT_OBJECT_SPHERE && surface->is_inside != beyond;
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
    int32_t seen_q30[3] = {0}, half_q15[2];

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

/* ------------------------------------------------------------------- media */

static int32_t get_refractive_index_q16(const struct media *media)
{
    return media->n ? media->index_q16[media->n - 1] : AIR_Q16;
}

/* Returns the position of OBJECT in MEDIA, or -1 if it is not there. */
static int find_entered_object(const struct media *media, uint32_t object)
{
    int i = media->n - 1;

    while (i >= 0 && media->object[i] != object)
        i--;
    return i;
}

/* MEDIA must have room: a ray enters at most GLINT_SCENE_PASSES objects. */
static void enter_object(struct media *media, uint32_t object,
                         int32_t index_q16)
{
    media->object[media->n] = object;
    media->index_q16[media->n++] = index_q16;
}

/* Removes the object at position AT; does nothing if AT is -1. */
static void leave_object(struct media *media, int at)
{
    if (at < 0)
        return;
    for (media->n--; at < media->n; at++) {
        media->object[at] = media->object[at + 1];
        media->index_q16[at] = media->index_q16[at + 1];
    }
}

/* Returns whether SURFACE is the inner side of a sphere that P has entered. P
 * leaves it without loss, and gets no light there. */
static int does_ray_leave_sphere(const struct glint_scene *s,
                                 const struct passing *p,
                                 const struct glint_met_surface *surface)
{
    return surface->is_inside &&
           s->placed[surface->object].object->kind == GLINT_OBJECT_SPHERE &&
           find_entered_object(&p->media, surface->object) >= 0;
}

/* --------------------------------------------------------- transmitted rays */

/* Finds the far side of the sphere through which P runs. If P only grazes the
 * sphere, returns 0, and P leaves the sphere unbent. */
static int find_far_side_of_sphere(const struct glint_scene *s,
                                   struct passing *p, struct glint_met *met)
{
    const struct glint_placed *ball = &s->placed[p->object];

    *met = (struct glint_met){.object = p->object, .end = 1};
    if (glint_ray_intersect_sphere(&p->ray, ball->at, ball->radius,
                                   &met->chord) &&
        met->chord.half >= LEAST_HALF) {
        met->t = met->chord.t[1];
        return 1;
    }
    leave_object(&p->media, find_entered_object(&p->media, p->object));
    return 0;
}

static int find_next_surface(const struct glint_scene *s, struct passing *p,
                             struct glint_met_surface *next)
{
    struct glint_met met, end;
    int any =
        glint_scene_find_nearest_hit(s, &p->ray, p->object, p->triangle, &met);

    if (p->is_in_sphere && find_far_side_of_sphere(s, p, &end) &&
        (!any || end.t <= met.t)) {
        met = end;
        any = 1;
    }
    return any && glint_scene_find_surface_at_hit(s, &p->ray, &met, next);
}

/* Refracts P at SURFACE, between media of the given refractive indices, and
 * returns 1; at total reflection reflects P and returns 0. */
static int refract_ray(const struct glint_met_surface *surface,
                       int32_t before_q16, int32_t behind_q16,
                       struct passing *p)
{
    /* Both indices are 1/4 to 4, so their quotient is at most 16. */
    const int64_t eta_q28 = q_shift(
        (int64_t)glint_divide_rounded(UINT64_C(1) << 44, (uint64_t)behind_q16) *
            before_q16,
        16);
    int32_t to_q30[3];

    p->is_bent = 1;
    if (!glint_bend(p->ray.toward_q30, surface->normal_q30,
                    eta_q28 < GLINT_MOST_ETA_Q28 ? (uint32_t)eta_q28
                                                 : GLINT_MOST_ETA_Q28,
                    to_q30)) {
        glint_reflect_direction(p->ray.toward_q30, surface->normal_q30,
                                p->ray.toward_q30);
        return 0;
    }
    for (int k = 0; k < 3; k++)
        p->ray.toward_q30[k] = to_q30[k];
    return 1;
}

/* Moves P to the medium behind SURFACE and returns 1; at total reflection
 * returns 0. If P leaves an object other than the one that it entered last, the
 * medium stays the same. */
static int cross_surface(const struct glint_met_surface *surface,
                         struct passing *p)
{
    const int at = find_entered_object(&p->media, surface->object);
    const int32_t index_q16 = surface->material->index_q16;
    struct media behind = p->media;
    int32_t before_q16 = get_refractive_index_q16(&behind), behind_q16;

    if (!surface->is_inside) {
        enter_object(&behind, surface->object, index_q16);
    } else {
        leave_object(&behind, at);
        if (at < 0)
            before_q16 = index_q16;
    }
    behind_q16 = get_refractive_index_q16(&behind);
    if (before_q16 != behind_q16 &&
        !refract_ray(surface, before_q16, behind_q16, p)) {
        if (surface->is_inside && at < 0)
            enter_object(&p->media, surface->object, index_q16);
        return 0;
    }
    p->media = behind;
    return 1;
}

/* Continues the ray P behind SURFACE, and multiplies its weight by the
 * transmitted fraction; or in front of it after total reflection, which loses
 * no light. Returns 1 if P leaves a sphere, which does not count as a
 * transmitting surface. */
static int continue_ray_at_surface(const struct glint_scene *s,
                                   const struct glint_met_surface *surface,
                                   struct passing *p)
{
    const int is_end = does_ray_leave_sphere(s, p, surface);
    const int is_beyond = cross_surface(surface, p);

    if (is_beyond && !is_end)
        p->weight_q15 = q_mul(p->weight_q15, surface->material->pass_q15, 15);
    start_secondary_ray(s, surface, is_beyond, p);
    return is_end && is_beyond;
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
    for (int i = 0, is_end = 0;
         i < GLINT_SCENE_PASSES + is_end && at.material->pass_q15;) {
        i += !continue_ray_at_surface(s, &at, &p);
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
        is_end = does_ray_leave_sphere(s, &p, &at);
        if (!is_end)
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
