/* SPDX-License-Identifier: MIT */
#include "reference/scenes/twin.h"

#include <stdlib.h>
#include <string.h>

#include "glint/view.h"
#include "reference/scenes/twin_around.h"
#include "reference/scenes/twin_stone.h"

/* ----------------------------------------------------------------- opening */

static float decode_srgb(uint8_t code)
{
    const double x = code / 255.0;

    return (float)(x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4));
}

static enum glint_status decode_picture_texels(struct twin_texels *texels,
                                               const struct glint_image *image)
{
    const size_t n = 3 * (size_t)image->width * (size_t)image->height;

    texels->width = image->width;
    texels->height = image->height;
    texels->rgb = malloc(n * sizeof *texels->rgb);
    if (!texels->rgb)
        return GLINT_E_MEMORY;
    for (size_t i = 0; i < n; i++)
        texels->rgb[i] = decode_srgb(image->plane[0][i]);
    return GLINT_OK;
}

enum glint_status reference_open(struct twin *twin,
                                 const struct glint_description *scene)
{
    const struct glint_described_environment *from = scene->environment;
    enum glint_status status = GLINT_OK;

    *twin =
        (struct twin){.scene = scene, .shadow_points = 1, .ward_samples = 8};
    if (scene->n_environments)
        status = glint_environment_open(&twin->around, from->data, from->bytes,
                                        &(const char *){NULL});
    for (int i = 0; status == GLINT_OK && i < scene->n_textures; i++)
        status =
            decode_picture_texels(&twin->texels[i], &scene->texture[i].image);
    if (status == GLINT_OK)
        status = reference_bound_triangles(twin);
    if (status == GLINT_OK)
        status = reference_allocate_media_maps(twin);
    if (status != GLINT_OK)
        reference_close(twin);
    return status;
}

void reference_close(struct twin *twin)
{
    for (int i = 0; i < GLINT_DESCRIPTION_MAX_TEXTURES; i++)
        free(twin->texels[i].rgb);
    reference_free_media_maps(twin);
    free(twin->bound);
    *twin = (struct twin){.scene = NULL};
}

/* ------------------------------------------------------------------ lights */

/* Computes the light of LIGHT at PLACE. Sets TOWARD to the direction towards
 * LIGHT, and RGB to the light that a white surface facing LIGHT reflects.
 * Returns the distance to LIGHT. */
static double compute_light_at_place(const struct glint_described_light *light,
                                     const double place[3], double toward[3],
                                     double rgb[3])
{
    double distance = HUGE_VAL, scale;

    if (light->kind == GLINT_DESCRIBED_SUN) {
        const double sine = sin(light->radius_deg * GLINT_PI / 180);

        vec_add_scaled(light->at, 0, light->at, toward);
        scale = sine * sine;
    } else {
        vec_add_scaled(light->at, -1, place, toward);
        distance = vec_normalise(toward);
        scale = distance > 0 ? 1 / (distance * distance) : 0;
    }
    for (int i = 0; i < 3; i++)
        rgb[i] = scale * light->colour[i];
    return distance;
}

/* Returns the sine of the angular radius of LIGHT seen from PLACE. */
static double
compute_light_sine_radius(const struct glint_described_light *light,
                          const double place[3])
{
    double off[3];

    vec_add_scaled(light->at, -1, place, off);
    return light->kind == GLINT_DESCRIBED_SUN
               ? sin(light->radius_deg * GLINT_PI / 180)
               : fmin(light->radius / vec_normalise(off), .5);
}

/* points on the unit disc, at which shadow rays to a light aim; the run time
 * uses the same */
static const double four[4][2] = {
    {.66446, .24185}, {-.24185, .66446}, {-.66446, -.24185}, {.24185, -.66446}};
static const double sixteen[16][2] = {
    {.17679, 0},        {-.22577, .20682},  {.03455, -.39377},
    {.28458, .37119},   {-.52222, -.09238}, {.49469, -.31470},
    {-.16547, .61554},  {-.31555, -.60760}, {.68463, .25003},
    {-.71225, .29401},  {.34335, -.73373},  {.25372, .80893},
    {-.76474, -.44318}, {.89713, -.19724},  {-.54752, .77878},
    {-.12650, -.97610}};

/* Changes TOWARD from the direction of a light's centre to that of point I of N
 * points on the light's disc, at DISTANCE. As in the run time, the axes of the
 * disc have z into the picture. */
static void aim_at_light_disc(const struct glint_description *scene,
                              const struct glint_described_light *light,
                              double toward[3], double distance, int i, int n)
{
    const double *at = n == 4 ? four[i] : sixteen[i];
    const bool is_sun = light->kind == GLINT_DESCRIBED_SUN;
    const double size = is_sun ? sin(light->radius_deg * GLINT_PI / 180)
                               : light->radius / distance;
    const double hand = scene->left_handed ? 1 : -1;
    double d[3] = {toward[0], toward[1], hand * toward[2]};
    double axis[3] = {0, 0, 0}, u[3], v[3];

    if (n == 1 || !(size > 0))
        return;
    axis[fabs(d[0]) > .5] = 1;
    vec_cross(d, axis, u);
    vec_normalise(u);
    vec_cross(d, u, v);
    vec_normalise(v);
    for (int k = 0; k < 3; k++)
        toward[k] =
            (d[k] + size * (u[k] * at[0] + v[k] * at[1])) * (k == 2 ? hand : 1);
    vec_normalise(toward);
}

/* Returns the fraction of a light at DISTANCE that reaches HIT. Objects farther
 * away than the light do not occlude it. */
static double
compute_light_visibility(const struct twin *twin, const struct twin_hit *hit,
                         const struct glint_described_light *light,
                         const double toward[3], double distance)
{
    const bool has_extent =
        light->kind == GLINT_DESCRIBED_SUN || light->radius > 0;
    const int n = has_extent ? twin->shadow_points : 1;
    double reached = 0;

    if (!twin->scene->has_shadows)
        return 1;
    for (int i = 0; i < n; i++) {
        struct twin_ray ray = {.skip_object = hit->object,
                               .skip_triangle = hit->triangle};

        memcpy(ray.from, hit->place, sizeof ray.from);
        memcpy(ray.toward, toward, sizeof ray.toward);
        aim_at_light_disc(twin->scene, light, ray.toward, distance, i, n);
        if (vec_dot(hit->normal, ray.toward) > 0)
            reached += reference_compute_unblocked_light(twin, &ray, distance);
    }
    return reached / n;
}

double reference_compute_light_at_hit(const struct twin *twin,
                                      const struct twin_hit *hit,
                                      const struct glint_described_light *light,
                                      double toward[3], double rgb[3],
                                      double *share)
{
    const double distance =
        compute_light_at_place(light, hit->place, toward, rgb);
    const double facing = vec_dot(hit->shading, toward);

    *share = facing > 0
                 ? compute_light_visibility(twin, hit, light, toward, distance)
                 : 0;
    return facing;
}

/* ---------------------------------------------------------------- surfaces */

static void interpolate_texels(const struct twin_texels *t, const double uv[2],
                               double rgb[3])
{
    const double x = uv[0] * t->width - 0.5;
    const double y = (1 - uv[1]) * t->height - 0.5;
    const double left = floor(x), top = floor(y);

    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int k = 0; k < 4; k++) {
        const double share =
            (k & 1 ? x - left : 1 - x + left) * (k & 2 ? y - top : 1 - y + top);
        /* texture sizes are powers of two; the texture repeats outside 0 ..
         * 1 */
        const int i = (int)fmod(left + (k & 1), t->width);
        const int j = (int)fmod(top + (k >> 1), t->height);
        const float *texel =
            t->rgb + 3 * ((ptrdiff_t)((j + t->height) % t->height) * t->width +
                          (i + t->width) % t->width);

        for (int c = 0; c < 3; c++)
            rgb[c] += share * (double)texel[c];
    }
}

/* Sets RGB to the light at HIT by Phong's model, seen from direction TOWARD. */
static void compute_phong_terms(const struct twin *twin,
                                const struct twin_hit *hit,
                                const double toward[3], double rgb[3])
{
    const struct glint_description *s = twin->scene;
    const struct glint_described_material *m = &s->material[hit->material];
    double colour[3] = {1, 1, 1};

    if (m->texture >= 0)
        interpolate_texels(&twin->texels[m->texture], hit->uv, colour);
    for (int c = 0; c < 3; c++) {
        colour[c] *= m->colour[c];
        rgb[c] = m->ambient * colour[c];
    }
    reference_add_environment(twin, hit, toward, colour, rgb);
    for (int i = 0; i < s->n_lights; i++) {
        double l[3], light[3], glint, share, shine = 0;
        const double facing = reference_compute_light_at_hit(
            twin, hit, &s->light[i], l, light, &share);

        if (facing <= 0)
            continue;
        /* glint: the cosine between the viewer and the mirrored light R = 2
         * (N.L) N - L */
        glint = vec_dot(l, toward) - 2 * facing * vec_dot(hit->shading, toward);
        glint = glint > 0 ? pow(glint, m->power) : 0;
        if (m->is_metal)
            shine = reference_compute_metal_reflection(
                twin, hit, toward, l,
                compute_light_sine_radius(&s->light[i], hit->place));
        for (int c = 0; c < 3; c++)
            rgb[c] += share * light[c] *
                      (m->diffuse * facing * colour[c] + m->specular * glint +
                       m->metal[c] * shine);
    }
    if (m->is_stone)
        reference_add_medium_light(twin, hit, toward, rgb);
}

/* -------------------------------------------- transmitted and mirrored rays */

/* Refracts direction D at a surface by Snell's law. The normal N points to the
 * ray's origin; ETA is the refractive index before the surface divided by that
 * behind it. Returns false at total reflection. */
static bool refract_direction(const double d[3], const double n[3], double eta,
                              double to[3])
{
    const double cosine = -vec_dot(d, n);
    const double rest = 1 - eta * eta * (1 - cosine * cosine);

    if (rest < 0)
        return false;
    for (int i = 0; i < 3; i++)
        to[i] = eta * d[i] + (eta * cosine - sqrt(rest)) * n[i];
    vec_normalise(to);
    return true;
}

/* Mirrors direction D at a surface with normal N: D - 2 (D.N) N. */
static void reflect_direction(const double d[3], const double n[3],
                              double to[3])
{
    vec_add_scaled(d, -2 * vec_dot(d, n), n, to);
}

/* Transparent objects in which a ray may be at once; it enters at most eight.
 */
#define MAX_ENTERED 8

/* A ray on its way through transparent objects. */
struct passing {
    struct twin_ray ray;
    /* fraction of the next object's light that reaches the viewer */
    double weight;
    bool is_bent; /* true: refraction has changed the ray's direction */
    /* Objects that the ray is in, and their refractive indices. The medium is
     * that of the last one. */
    int n_entered, entered[MAX_ENTERED];
    double index[MAX_ENTERED];
};

static double get_medium_index(const struct passing *p)
{
    return p->n_entered > 0 ? p->index[p->n_entered - 1] : 1;
}

static bool is_inside_object(const struct passing *p, int object)
{
    for (int i = 0; i < p->n_entered; i++)
        if (p->entered[i] == object)
            return true;
    return false;
}

static void enter_object(struct passing *p, int object, double index)
{
    p->entered[p->n_entered] = object;
    p->index[p->n_entered++] = index;
}

/* Removes the last entry of OBJECT. */
static void leave_object(struct passing *p, int object)
{
    int at = p->n_entered - 1;

    while (at > 0 && p->entered[at] != object)
        at--;
    p->n_entered--;
    for (; at < p->n_entered; at++) {
        p->entered[at] = p->entered[at + 1];
        p->index[at] = p->index[at + 1];
    }
}

/* Returns whether HIT is the inner side of a ball that P has entered: P leaves
 * it without loss. */
static bool is_ball_exit(const struct twin *twin, const struct passing *p,
                         const struct twin_hit *hit)
{
    return hit->inside &&
           twin->scene->object[hit->object].kind == GLINT_DESCRIBED_SPHERE &&
           is_inside_object(p, hit->object);
}

/* Moves P through the surface at HIT, or mirrors it there. Returns whether P
 * has left a ball. */
static bool pass_through_surface(const struct twin *twin,
                                 const struct twin_hit *hit, struct passing *p)
{
    const struct glint_described_material *m =
        &twin->scene->material[hit->material];
    const bool is_ball =
        twin->scene->object[hit->object].kind == GLINT_DESCRIBED_SPHERE;
    const bool is_exit = is_ball_exit(twin, p, hit);
    const bool was_inside = is_inside_object(p, hit->object);
    const double d[3] = {p->ray.toward[0], p->ray.toward[1], p->ray.toward[2]};
    const struct passing before = *p;
    double index = get_medium_index(p);
    bool is_mirrored = false;

    if (!hit->inside) {
        enter_object(p, hit->object, m->index);
    } else if (!was_inside) {
        index = m->index;
    } else {
        const bool is_last = p->entered[p->n_entered - 1] == hit->object;

        leave_object(p, hit->object);
        index = is_last ? m->index : get_medium_index(p);
    }
    if (index != get_medium_index(p)) {
        p->is_bent = true;
        is_mirrored = !refract_direction(
            d, hit->shading, index / get_medium_index(p), p->ray.toward);
    }
    if (is_mirrored) {
        reflect_direction(d, hit->shading, p->ray.toward);
        p->n_entered = before.n_entered;
        memcpy(p->entered, before.entered, sizeof p->entered);
        memcpy(p->index, before.index, sizeof p->index);
        if (hit->inside && !was_inside)
            enter_object(p, hit->object, m->index);
    } else if (!is_exit) {
        p->weight *= m->pass;
    }
    memcpy(p->ray.from, hit->place, sizeof p->ray.from);
    p->ray.skip_object = hit->object;
    p->ray.skip_triangle = hit->triangle;
    p->ray.is_in_ball = is_ball && hit->inside == is_mirrored;
    return is_exit && !is_mirrored;
}

static void add_light_source(struct twin_pixel *pixel, double share,
                             const double rgb[3])
{
    for (int c = 0; c < 3; c++)
        pixel->rgb[c] += (float)(share * rgb[c]);
}

/* Adds the light that the mirror at HIT reflects. Mirrors do not show the
 * background picture, as it does not contain the mirrored direction. */
static void add_mirrored_light(const struct twin *twin,
                               const struct twin_ray *ray,
                               const struct twin_hit *hit,
                               struct twin_pixel *pixel)
{
    struct twin_ray next = {
        .skip_object = hit->object,
        .skip_triangle = hit->triangle,
        .is_in_ball = hit->inside && twin->scene->object[hit->object].kind ==
                                         GLINT_DESCRIBED_SPHERE};
    struct twin_hit met;
    double rgb[3];

    memcpy(next.from, hit->place, sizeof next.from);
    reflect_direction(ray->toward, hit->shading, next.toward);
    if (reference_intersect_scene(twin, &next, HUGE_VAL, &met))
        compute_phong_terms(twin, &met, next.toward, rgb);
    else
        reference_compute_background_light(
            twin, next.toward,
            twin->pixel_tan * twin->pixel_tan / 4 +
                2 * reference_compute_alpha_widening(twin, hit, ray->toward),
            rgb);
    add_light_source(pixel, twin->scene->material[hit->material].reflect, rgb);
}

/* Adds the light that the transparent surface at HIT transmits, through at most
 * eight surfaces. */
static void add_transmitted_light(const struct twin *twin,
                                  const struct twin_ray *ray,
                                  const struct twin_hit *hit,
                                  struct twin_pixel *pixel)
{
    const struct glint_description *s = twin->scene;
    struct passing p = {.ray = *ray, .weight = 1};
    struct twin_hit at = *hit;
    bool is_exit = false;

    for (int i = 0;
         (i < 8 || (i == 8 && is_exit)) && s->material[at.material].pass > 0;) {
        double rgb[3];

        i += !pass_through_surface(twin, &at, &p);
        if (!reference_intersect_scene(twin, &p.ray, HUGE_VAL, &at)) {
            if (s->background == GLINT_BEHIND_CAMERA && !p.is_bent)
                pixel->cover -= (float)p.weight;
            reference_compute_background_light(
                twin, p.ray.toward, twin->pixel_tan * twin->pixel_tan / 4, rgb);
            add_light_source(pixel, p.weight, rgb);
            return;
        }
        is_exit = is_ball_exit(twin, &p, &at);
        if (is_exit)
            continue;
        compute_phong_terms(twin, &at, p.ray.toward, rgb);
        add_light_source(pixel, p.weight, rgb);
    }
}

/* ---------------------------------------------------------- primary rays */

/* Returns the fraction of the light at HIT, a point of a shadow catcher, that
 * objects occlude. */
static double compute_catcher_shadow(const struct twin *twin,
                                     const struct twin_hit *hit)
{
    const struct glint_description *s = twin->scene;
    double all = 0, hidden = 0;

    for (int i = 0; i < s->n_lights; i++) {
        double l[3], rgb[3], light;
        const double distance =
            compute_light_at_place(&s->light[i], hit->place, l, rgb);

        light =
            fmax(0, vec_dot(hit->normal, l)) * (rgb[0] + 2 * rgb[1] + rgb[2]);
        all += light;
        if (light > 0)
            hidden += light * (1 - compute_light_visibility(
                                       twin, hit, &s->light[i], l, distance));
    }
    return all > 0 ? hidden / all : 0;
}

/* Finds the first object that RAY hits, including shadow catchers. */
static bool find_first_object(const struct twin *twin,
                              const struct twin_ray *ray, struct twin_hit *hit)
{
    bool is_met = reference_intersect_scene(twin, ray, HUGE_VAL, hit);
    struct twin_hit on;

    for (int i = 0; i < twin->scene->n_objects; i++)
        if (twin->scene->object[i].catcher > 0 &&
            reference_intersect_object(twin, i, ray, is_met ? hit->t : HUGE_VAL,
                                       &on)) {
            *hit = on;
            is_met = true;
        }
    return is_met;
}

struct twin_pixel reference_trace_ray(const struct twin *twin,
                                      const struct twin_ray *ray)
{
    const struct glint_description *s = twin->scene;
    struct twin_pixel pixel = {{0, 0, 0}, 1};
    struct twin_hit hit;
    double rgb[3];

    if (!find_first_object(twin, ray, &hit)) {
        pixel.cover = s->background != GLINT_BEHIND_CAMERA;
        reference_compute_background_light(
            twin, ray->toward, twin->pixel_tan * twin->pixel_tan / 4, rgb);
        add_light_source(&pixel, 1, rgb);
        return pixel;
    }
    if (s->object[hit.object].catcher > 0) {
        pixel.cover = (float)(s->object[hit.object].catcher *
                              compute_catcher_shadow(twin, &hit));
        return pixel;
    }
    compute_phong_terms(twin, &hit, ray->toward, rgb);
    add_light_source(&pixel, 1, rgb);
    if (s->material[hit.material].reflect > 0)
        add_mirrored_light(twin, ray, &hit, &pixel);
    if (s->material[hit.material].pass > 0)
        add_transmitted_light(twin, ray, &hit, &pixel);
    return pixel;
}

/* ---------------------------------------------------------------- pictures */

struct drawing {
    const struct twin *twin;
    const struct twin_view *view;
    struct twin_pixel *pixels;
};

static void render_row(void *ctx, int y, int worker)
{
    const struct drawing *d = ctx;
    const int n = d->view->samples;
    /* with `camera corners`, rays pass through pixel corners */
    const double first =
        d->twin->scene->camera.field == GLINT_DESCRIBED_CORNERS ? -0.5 : 0;

    (void)worker;
    for (int x = 0; x < d->view->width; x++) {
        struct twin_pixel sum = {{0, 0, 0}, 0};

        for (int k = 0; k < n * n; k++) {
            struct twin_pixel one;
            struct twin_ray ray;
            const int row = k / n;

            reference_make_camera_ray(d->twin, d->view,
                                      x + first + (k % n + 0.5) / n,
                                      y + first + (row + 0.5) / n, &ray);
            one = reference_trace_ray(d->twin, &ray);
            for (int c = 0; c < 3; c++)
                sum.rgb[c] += one.rgb[c] / (float)(n * n);
            sum.cover += one.cover / (float)(n * n);
        }
        d->pixels[(ptrdiff_t)y * d->view->width + x] = sum;
    }
}

void reference_set_pixel_size(struct twin *twin, const struct twin_view *view)
{
    struct twin_ray middle, beside;
    double off[3];

    reference_make_camera_ray(twin, view, view->width / 2., view->height / 2.,
                              &middle);
    reference_make_camera_ray(twin, view, view->width / 2. + 1,
                              view->height / 2., &beside);
    vec_add_scaled(beside.toward, -1, middle.toward, off);
    twin->pixel_tan = vec_normalise(off);
    reference_compute_media_maps(twin);
}

void reference_render_image(const struct twin *twin,
                            const struct twin_view *view,
                            struct glint_workers *workers,
                            struct twin_pixel *pixels)
{
    struct twin seen = *twin;
    struct drawing drawing = {&seen, view, pixels};

    reference_set_pixel_size(&seen, view);
    glint_workers_run(workers, view->height, render_row, &drawing);
}
