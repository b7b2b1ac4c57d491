/* SPDX-License-Identifier: MIT
 *
 * Environment light on the surfaces of a scene: diffuse reflection from the
 * irradiance map, and reflection by Ward's lobe on brushed metal. */
#include "base/log2.h"
#include "base/real.h"
#include "glint/scene/ward.h"
#include "scene/mesh.h"
#include "scene/parts.h"
#include "scene/state.h"
#include "scene/ward/send.h"

struct glint_ward_state {
    struct glint_environment *opened; /* [n_environments]: all environments of
                                         the scene */
    struct glint_scene_light *sun;    /* [n_environment_lights]: bright lights
                                         of the environment, as suns of the
                                         scene */
    int has_environment;
    struct glint_environment environment; /* the environment that is shown */
    int32_t turn_q30[2];                  /* cosine and sine of its rotation to
                                             the right */
    struct glint_real scale;              /* factor of all light from the
                                             environment */
    struct glint_real unit;               /* unit of the environment's texels
                                             times the factor SCALE */
    struct glint_ward_material *material; /* [n_wards]: parameters of the
                                             metals, with clamped ratios of
                                             alphas */
    struct glint_ward_lobe *lobe;         /* [n_wards]: reflection lobes */
};

/* Sets TO to direction V, _q30, rotated to the environment's coordinates. */
static inline void
rotate_direction_to_environment(const struct glint_ward_state *w,
                                const int32_t v[3], int32_t to[3])
{
    const int64_t c = w->turn_q30[0], s = w->turn_q30[1];

    to[0] = (int32_t)q_shift(c * v[0] - s * v[2], 30);
    to[1] = v[1];
    to[2] = (int32_t)q_shift(c * v[2] + s * v[0], 30);
}

/* --------------------------------------------------------------- background */

/* An environment as background, behind objects and in mirrors: its mip levels
 * and the discs of its bright lights, blurred to the size of a pixel. */
enum {
    LOG2_PI_Q16 = 108232,
    LEAST_SPREAD_Q40 = 1 << 14 /* min angular variance, radians^2, so that point
                                  lights appear as discs */
};

/* Returns the mip level, q8, whose texels have angular variance SPREAD. Level l
 * has the variance 4^l pi / side^2, where side is that of level 0 in texels. */
static int32_t compute_level_of_variance_q8(const struct glint_environment *e,
                                            int64_t spread_q40)
{
    const int32_t octaves_q16 = q_log2_q16((uint64_t)spread_q40) - (40 << 16) +
                                (int32_t)(e->header->side_log2 << 17) -
                                LOG2_PI_Q16;

    return (int32_t)q_shift(octaves_q16, 9);
}

/* Adds the disc of LIGHT to the background. The disc is at least as large as a
 * pixel, and its edge is blurred: light fades out from half a pixel inside the
 * rim to half a pixel outside. */
static void add_light_disc(const struct glint_ward_state *w,
                           const struct glint_environment_light *light,
                           const int32_t toward_q30[3], int64_t spread_q40,
                           int32_t rgb_q15[3])
{
    const int32_t width_q30 =
        (int32_t)glint_compute_square_root((uint64_t)spread_q40 << 22);
    const int32_t r_q30 = q_larger(light->radius_q30, width_q30);
    const struct glint_real r = real_of(r_q30, -30);
    int32_t off_q29[3], away_q30, share_q15;
    struct glint_real per_disc;

    for (int k = 0; k < 3; k++)
        off_q29[k] = toward_q30[k] / 2 - light->toward_q30[k] / 2;
    away_q30 = 2 * (int32_t)q_smaller((int32_t)glint_compute_square_root(
                                          (uint64_t)v3_dot(off_q29, off_q29)),
                                      (1 << 30) - 1);
    if (away_q30 >= r_q30 + width_q30 / 2)
        return;
    share_q15 = away_q30 <= r_q30 - width_q30 / 2
                    ? GLINT_SCENE_ONE_Q15
                    : q_divide_to_fraction_q30(
                          (uint64_t)(r_q30 + width_q30 / 2 - away_q30),
                          (uint64_t)width_q30) >>
                          15;
    per_disc = real_over(real_times(w->scale, real_of(share_q15, -15)),
                         real_times(r, r));
    for (int c = 0; c < 3; c++)
        rgb_q15[c] = q_clamp_sat(
            rgb_q15[c] + real_integer(real_times(light->rgb[c], per_disc), 15,
                                      GLINT_SCENE_MOST_LIGHT),
            0, GLINT_SCENE_MOST_LIGHT);
}

static void look_up_blurred_environment(const struct glint_scene *scene,
                                        const int32_t toward_q30[3],
                                        int64_t spread_q40, int32_t rgb_q15[3])
{
    const struct glint_ward_state *w = scene->wards;
    const struct glint_environment *e = &w->environment;
    const int64_t seen_q40 =
        q_clamp_sat(spread_q40 >> 10, LEAST_SPREAD_Q40 >> 10, 1 << 28) *
        INT64_C(1024);
    int32_t to_q30[3], to_q16[3], light[3];

    rotate_direction_to_environment(w, toward_q30, to_q30);
    for (int k = 0; k < 3; k++)
        to_q16[k] = (int32_t)q_shift(to_q30[k], 14);
    glint_environment_look(e, to_q16, compute_level_of_variance_q8(e, seen_q40),
                           light);
    for (int c = 0; c < 3; c++)
        rgb_q15[c] =
            (int32_t)real_integer(real_times(real_of(light[c], 0), w->unit), 15,
                                  GLINT_SCENE_MOST_LIGHT);
    for (uint32_t i = 0; i < e->header->n_lights; i++)
        add_light_disc(w, &e->light[i], to_q30, seen_q40, rgb_q15);
}

/* --------------------------------------------------------------- highlights */

/* Highlight of one light on brushed metal: Ward's lobe, whose width depends on
 * the metal's roughness, the size of the light's disc and the curvature of the
 * surface within a pixel. Without the curvature, the highlight on a small ball
 * would flicker as it moves between pixels.
 *
 * Variances of slopes add up: alpha^2 / 2 of the metal, r^2 / 16 of the half
 * vector to a disc of angular radius r, and the variance of the normal within a
 * pixel. With h the half vector, n the normal and o the direction to the eye,
 * the light is
 *
 *    level weight exp(-slope) / (4 ax ay (h.o) (h.n)^3)
 *
 * ax and ay are the alphas with these variances, level is the light's strength,
 * weight that of compute_lobe_weight(), and slope the sum of (slope of h /
 * alpha)^2 along the two tangents. */
enum { MOST_SLOPE = 16, LOG2_E_Q16 = 94548 };

/* The half vector in the surface's tangent frame; all q30 except slopes. */
struct half {
    int32_t ho_q30, hn_q30, ni_q30, no_q30;
    uint64_t slope_q52[2]; /* squares of the half vector's slopes along the two
                              tangents, up to 2^60 */
};

/* Returns whether the slope ALONG_Q30 / HN_Q30 is so large that the lobe with
 * squared alpha ALPHA_Q40, below 2^42, is certainly 0, without root or
 * division. The left side of the comparison is rounded down, at most 2^56; the
 * right side is rounded up, at most 2^63, and enlarged by 1/512, which exceeds
 * the error of the ratios. */
static int is_slope_outside_lobe(uint32_t along_q30, int32_t hn_q30,
                                 int64_t alpha_q40)
{
    const uint64_t along_q28 = along_q30 >> 2;
    const uint64_t hn_q28 = ((uint64_t)hn_q30 >> 2) + 1;
    const uint64_t max_q56 = ((hn_q28 * hn_q28 >> 24) + 1) *
                             (((uint64_t)alpha_q40 * MOST_SLOPE >> 16) + 1);

    return along_q28 * along_q28 > max_q56 + (max_q56 >> 9);
}

/* Computes the half vector between ray and light. Returns 0 if the light or the
 * eye is behind the surface. Also returns 0 if the lobe with squared alphas
 * ALPHA_Q40 is 0 at this half vector. */
static int compute_half_vector(const struct glint_scene_ray *ray,
                               const struct glint_brushed *brushed,
                               const int32_t toward_q30[3],
                               const int64_t alpha_q40[2], struct half *h)
{
    const int32_t *n_q30 = brushed->frame_q30[2];
    int32_t half_q30[3], hn_q30;
    uint32_t along_q30[2];

    /* The mean of the directions to light and eye is (h.o) h, where h is the
     * half vector. */
    for (int k = 0; k < 3; k++)
        half_q30[k] =
            (int32_t)(((int64_t)toward_q30[k] - ray->toward_q30[k]) / 2);
    hn_q30 = v3_cosine_q30(half_q30, n_q30);
    if (hn_q30 <= 0)
        return 0;
    for (int k = 0; k < 2; k++) {
        along_q30[k] = (uint32_t)q_magnitude(
            v3_cosine_q30(half_q30, brushed->frame_q30[k]));
        if (is_slope_outside_lobe(along_q30[k], hn_q30, alpha_q40[k]))
            return 0;
    }
    h->ni_q30 = v3_cosine_q30(toward_q30, n_q30);
    h->no_q30 = -v3_cosine_q30(ray->toward_q30, n_q30);
    if (h->ni_q30 <= 0 || h->no_q30 <= 0)
        return 0;
    h->ho_q30 = (int32_t)glint_compute_square_root(
        (uint64_t)v3_dot(half_q30, half_q30));
    if (h->ho_q30 < hn_q30)
        h->ho_q30 = hn_q30;
    h->hn_q30 = q_divide_to_fraction_q30((uint64_t)hn_q30, (uint64_t)h->ho_q30);
    for (int k = 0; k < 2; k++) {
        const uint64_t slope_q26 = (uint64_t)glint_divide_rounded(
            (uint64_t)along_q30[k] << 26, (uint64_t)hn_q30);

        h->slope_q52[k] = slope_q26 * slope_q26;
    }
    return 1;
}

/* Returns the weight of the lobe, 0 .. 8, normalised by NORM, without the
 * factor exp(-slope). */
static struct glint_real compute_lobe_weight(enum glint_ward_norm norm,
                                             const struct half *h)
{
    const struct glint_real most = real_of(8, 0);
    const struct glint_real ho = real_of(h->ho_q30, -30);
    const struct glint_real hn = real_of(h->hn_q30, -30);
    struct glint_real weight;

    if (norm == GLINT_WARD_BOUNDED)
        weight = real_over(real_of(h->ni_q30, -30), real_times(ho, hn));
    else
        weight = real_over(
            real_times(
                real_times(real_times(ho, hn), real_times(hn, hn)),
                real_of(glint_compute_square_root((uint64_t)h->ni_q30 << 30),
                        -30)),
            real_of(glint_compute_square_root((uint64_t)h->no_q30 << 30), -30));
    return real_less(weight, most) ? weight : most;
}

static int add_highlight_of_light(const struct glint_scene *scene,
                                  const struct glint_scene_ray *ray,
                                  const struct glint_met_surface *surface,
                                  const struct glint_brushed *brushed,
                                  const int32_t toward_q30[3],
                                  const int32_t level_q15[3],
                                  int32_t radius_q30, int32_t rgb_q15[3])
{
    const struct glint_ward_material *m =
        &scene->wards->material[surface->material->ward];
    /* Twice the additional variance: 2 r^2 / 16 for the light's disc of angular
     * radius r, plus the spread of the normal. */
    const int64_t wider_q40 = ((int64_t)radius_q30 * radius_q30 >> 23) +
                              (int64_t)brushed->spread_q30 * 1024;
    struct glint_real area = real_of(4, 0), gain;
    int64_t alpha_q40[2];
    int32_t slope_q16 = 0;
    struct half h;

    for (int k = 0; k < 2; k++)
        alpha_q40[k] =
            ((int64_t)m->alpha_q24[k] * m->alpha_q24[k] >> 8) + wider_q40;
    if (!compute_half_vector(ray, brushed, toward_q30, alpha_q40, &h))
        return 0;
    for (int k = 0; k < 2; k++) {
        if ((h.slope_q52[k] >> 12) >= (uint64_t)alpha_q40[k] * MOST_SLOPE)
            return 0;
        slope_q16 +=
            glint_divide_rounded(h.slope_q52[k] << 4, (uint64_t)alpha_q40[k]);
        area = real_times(area, real_of(glint_compute_square_root(
                                            (uint64_t)alpha_q40[k] << 20),
                                        -30));
    }
    if (slope_q16 >= MOST_SLOPE << 16)
        return 0;
    area = real_times(
        area, real_times(real_of(h.ho_q30, -30), real_of(h.hn_q30, -30)));
    area = real_times(
        area, real_times(real_of(h.hn_q30, -30), real_of(h.hn_q30, -30)));
    gain = real_of(q_exp2_q16((14 << 16) -
                              (int32_t)((int64_t)slope_q16 * LOG2_E_Q16 >> 16)),
                   -30);
    gain = real_over(real_times(gain, compute_lobe_weight(m->norm, &h)), area);
    for (int c = 0; c < 3; c++)
        rgb_q15[c] = (int32_t)real_integer(
            real_times(real_of((int64_t)level_q15[c] * m->specular_q15[c], -30),
                       gain),
            15, GLINT_SCENE_MOST_LIGHT);
    return 1;
}

enum {
    ONE_Q30 = 1 << 30,
    LEAST_COSINE_Q30 = 1 << 26,
    LEAST_SUN_Q30 = 187404 /* sine of 0.01 degrees, the min angular radius of
                              lights */
};

/* ------------------------------------------------------------------- memory */

static struct glint_ward_state *
allocate_ward_state(const struct glint_scene *scene, struct glint_arena *arena)
{
    const struct glint_scene_header *h = scene->model.header;
    const uint32_t n = h->n_wards;
    struct glint_ward_state measured;
    struct glint_ward_state *placed =
        glint_arena_allocate(arena, 1, sizeof *placed);
    struct glint_ward_state *w = placed ? placed : &measured;

    w->material = glint_arena_allocate(arena, n, sizeof *w->material);
    w->lobe = glint_arena_allocate(arena, n, sizeof *w->lobe);
    w->opened =
        glint_arena_allocate(arena, h->n_environments, sizeof *w->opened);
    w->sun =
        glint_arena_allocate(arena, h->n_environment_lights, sizeof *w->sun);
    return placed;
}

/* Recomputes the reflection lobe of metal I. Its colours have a common scale,
 * which is split into a factor of 1 .. 2 and a power of two. */
static void prepare_metal_lobe(const struct glint_scene *s, uint32_t i)
{
    struct glint_ward_state *w = s->wards;
    const struct glint_scene_ward *from = &s->model.ward[i];
    struct glint_ward_material *m = &w->material[i];
    struct glint_ward_lobe *lobe = &w->lobe[i];
    struct glint_ward_options options;

    for (int k = 0; k < 3; k++)
        m->specular_q15[k] = from->specular_q15[k];
    for (int k = 0; k < 2; k++)
        m->alpha_q24[k] = from->alpha_q24[k];
    m->norm = (enum glint_ward_norm)from->norm;
    glint_ward_hold(m->alpha_q24);
    if (!w->has_environment)
        return;
    glint_ward_defaults(&options);
    options.samples = s->cfg.ward_samples;
    options.sets = s->cfg.sets;
    glint_ward_prepare(lobe, &w->environment, m, &options);
    for (int k = 0; k < 3; k++)
        lobe->specular_q15[k] = (int32_t)q_shift(
            (int64_t)m->specular_q15[k] * w->scale.mantissa, 30);
    lobe->unit_log2 += w->scale.exponent + 30;
}

static void prepare_all_lobes(const struct glint_scene *scene)
{
    for (uint32_t i = 0; i < scene->model.header->n_wards; i++)
        prepare_metal_lobe(scene, i);
}

/* ------------------------------------------------------------- environment */

/* Sets the rotation of the environment and of its lights, which are the last of
 * the scene's lights that are on. */
static void rotate_environment(struct glint_scene *scene,
                               const int32_t turn_q30[2])
{
    struct glint_ward_state *w = scene->wards;
    const uint32_t n = w->environment.header->n_lights;
    const int64_t c = turn_q30[0], s = turn_q30[1];

    for (int k = 0; k < 2; k++)
        w->turn_q30[k] = turn_q30[k];
    for (uint32_t i = 0; i < n; i++) {
        const int32_t *v = w->environment.light[i].toward_q30;
        const int64_t to[3] = {q_shift(c * v[0] + s * v[2], 30), v[1],
                               q_shift(c * v[2] - s * v[0], 30)};
        int32_t toward_q30[3];

        glint_normalise_vector(to, toward_q30);
        glint_scene_set_light(scene, (int)(scene->n_lit - n + i), toward_q30);
    }
}

static void scale_environment(struct glint_scene *scene,
                              struct glint_real factor)
{
    struct glint_ward_state *w = scene->wards;
    const uint32_t n = w->environment.header->n_lights;

    w->scale = w->unit = factor;
    w->unit.exponent += w->environment.header->unit_log2;
    for (uint32_t i = 0; i < n; i++) {
        struct glint_lit *lit = &scene->lit[scene->n_lit - n + i];

        for (int c = 0; c < 3; c++) {
            w->sun[i].rgb[c] =
                real_times(w->environment.light[i].rgb[c], factor);
            lit->rgb_q15[c] = (int32_t)real_integer(w->sun[i].rgb[c], 15,
                                                    GLINT_SCENE_MOST_LIGHT);
        }
    }
    prepare_all_lobes(scene);
}

static void set_shown_environment(struct glint_scene *scene, uint32_t i)
{
    struct glint_ward_state *w = scene->wards;
    const struct glint_scene_header *h = scene->model.header;
    const struct glint_scene_environment *from = &scene->model.environment[i];
    const uint32_t first = h->n_lights - h->n_environment_lights;

    w->environment = w->opened[i];
    scene->n_lit = first + w->environment.header->n_lights;
    for (uint32_t k = first; k < scene->n_lit; k++) {
        struct glint_scene_light *sun = &w->sun[k - first];

        *sun = scene->model.light[k];
        sun->radius =
            q_larger(w->environment.light[k - first].radius_q30, LEAST_SUN_Q30);
        scene->lit[k].light = sun;
    }
    rotate_environment(scene, from->turn_q30);
    scale_environment(scene, from->scale);
}

/* ------------------------------------------------------------------ opening */

static enum glint_status open_environments_and_lobes(struct glint_scene *scene)
{
    const struct glint_scene_header *h = scene->model.header;
    struct glint_ward_state *w = scene->wards;
    const char *reason;

    w->has_environment = h->n_environments > 0;
    for (uint32_t i = 0; i < h->n_environments; i++) {
        const struct glint_scene_environment *from =
            &scene->model.environment[i];

        if (glint_environment_open(&w->opened[i],
                                   (const unsigned char *)h + from->file_at,
                                   from->file_bytes, &reason) != GLINT_OK ||
            w->opened[i].header->n_lights > h->n_environment_lights)
            return GLINT_E_FORMAT;
    }
    if (w->has_environment)
        set_shown_environment(scene, 0);
    else
        prepare_all_lobes(scene);
    return GLINT_OK;
}

/* ----------------------------------------------------------- tangent frames */

/* Returns the distance between the rays of neighbouring pixels where they reach
 * SURFACE, steps q8, below 2^32. */
static int64_t compute_pixel_size_q8(const struct glint_scene *s,
                                     const struct glint_scene_ray *ray,
                                     const struct glint_met_surface *surface)
{
    const int64_t step_q30 = s->view.step_q56[0] >> 18;
    int32_t off[3];
    int64_t t;

    v3_subtract(surface->place, ray->at, off);
    t = v3_dot(off, ray->toward_q30) >> 30; /* the distance T is below 2^30 */
    t = t < 0 ? 0 : t;
    t = t * (step_q30 < ONE_Q30 ? step_q30 : (int64_t)ONE_Q30) >> 22;
    return t < UINT32_MAX ? t : (int64_t)UINT32_MAX;
}

/* Returns the difference between the normals of vertices A and B, divided by
 * their distance and multiplied by PIXEL_Q8. */
static int32_t compute_normal_change(const int32_t a[3], const int32_t b[3],
                                     const int32_t na_q30[3],
                                     const int32_t nb_q30[3], int64_t pixel_q8)
{
    int32_t way[3], turn_q29[3];

    v3_subtract(a, b, way);
    for (int k = 0; k < 3; k++)
        turn_q29[k] = na_q30[k] / 2 - nb_q30[k] / 2;
    return glint_divide_rounded(
        (uint64_t)glint_compute_square_root(
            (uint64_t)v3_dot(turn_q29, turn_q29)) *
            (uint64_t)pixel_q8,
        (uint64_t)glint_compute_square_root((uint64_t)v3_dot(way, way)) << 7);
}

/* Returns the max change of the normal, per pixel, along the three edges of the
 * triangle. */
static int32_t
compute_max_normal_change_q30(const struct glint_scene *s,
                              const struct glint_met_surface *surface,
                              int64_t pixel)
{
    const struct glint_scene_mesh *m = glint_mesh_of(s, surface->object);
    const struct glint_scene_triangle *t =
        glint_mesh_triangle(s, m, surface->triangle);
    const int32_t *at[3], *normal[3];
    int32_t most = 0;

    if (!m->normal_at)
        return 0;
    glint_mesh_get_vertices(s, m, surface->triangle, at);
    for (int k = 0; k < 3; k++)
        normal[k] = (const int32_t *)glint_mesh_get_table(s, m->normal_at) +
                    3 * (size_t)t->vertex[k];
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3;

        most = q_larger(most, compute_normal_change(at[k], at[i], normal[k],
                                                    normal[i], pixel));
    }
    return most;
}

/* Returns the change of SURFACE's normal from pixel to pixel. The tilt of the
 * surface against the ray is ignored. */
static int32_t compute_curvature_q30(const struct glint_scene *s,
                                     const struct glint_scene_ray *ray,
                                     const struct glint_met_surface *surface)
{
    const struct glint_placed *p = &s->placed[surface->object];

    if (p->object->kind == GLINT_OBJECT_PLANE)
        return 0;
    if (p->object->kind == GLINT_OBJECT_MESH)
        return compute_max_normal_change_q30(
            s, surface, compute_pixel_size_q8(s, ray, surface));
    return glint_divide_rounded((uint64_t)compute_pixel_size_q8(s, ray, surface)
                                    << 22,
                                (uint64_t)p->radius);
}

/* Computes spread_q30 of struct glint_brushed: half of the square of a change
 * from pixel to pixel. This is the sum of the changes of the normal and of the
 * ray's direction. On a tilted surface, neighbouring pixels are 1 / n.o times
 * as far apart along the tilt, where n.o is the cosine between normal and
 * direction to the eye. A ray's direction changes by the angle of a pixel, and
 * the half vector by about half of that. This spread makes a highlight a
 * Gaussian of at least half a pixel, even if roughness and light are sharp.
 * Samples one pixel apart then sum to the same light at any position, to within
 * +-1.5 %. */
static int32_t
compute_normal_spread_q30(const struct glint_scene *s,
                          const struct glint_scene_ray *ray,
                          const struct glint_met_surface *surface)
{
    const int32_t no_q30 = q_larger(
        -v3_cosine_q30(surface->normal_q30, ray->toward_q30), LEAST_COSINE_Q30);
    const int64_t lean_q16 = glint_divide_rounded(
        UINT64_C(1) << 46, (uint64_t)no_q30); /* 1 / n.o, up to 2^20 */
    const int64_t turn_q30 =
        q_clamp_sat((compute_curvature_q30(s, ray, surface) * lean_q16 >> 16) +
                        (s->view.step_q56[0] >> 18),
                    0, ONE_Q30);

    return (int32_t)(turn_q30 * turn_q30 >> 31);
}

/* Metal is brushed along circles around the y axis of balls and meshes. Where
 * the normal is the y axis, as everywhere on planes, metal is brushed along the
 * x axis. */
static void
set_tangent_frame_of_brushed_metal(const struct glint_scene *scene,
                                   const struct glint_met_surface *surface,
                                   struct glint_brushed *brushed)
{
    const struct glint_placed *p = &scene->placed[surface->object];
    const int32_t *n_q30 = surface->normal_q30;
    int32_t axis_q30[2][3];
    int64_t across[3];

    for (int k = 0; k < 3; k++) {
        brushed->frame_q30[2][k] = n_q30[k];
        axis_q30[0][k] = p->turn.row_q30[k][0];
        axis_q30[1][k] = p->turn.row_q30[k][1];
    }
    v3_cross(axis_q30[1], n_q30, across);
    if ((q_magnitude(across[0]) | q_magnitude(across[1]) |
         q_magnitude(across[2])) >>
            36 ==
        0) {
        int64_t along[3];

        v3_cross(n_q30, axis_q30[0], along);
        for (int k = 0; k < 3; k++)
            brushed->frame_q30[1][k] = (int32_t)q_shift(along[k], 30);
        v3_cross(brushed->frame_q30[1], n_q30, across);
    }
    glint_normalise_vector(across, brushed->frame_q30[0]);
    v3_cross(n_q30, brushed->frame_q30[0], across);
    for (int k = 0; k < 3; k++)
        brushed->frame_q30[1][k] = (int32_t)q_shift(across[k], 30);
    brushed->spread_q30 = -1;
}

/* -------------------------------------------------------------- reflecting */

static void add_light_times_weight(int32_t *to_q15, int64_t light_q15,
                                   int32_t weight_q15)
{
    const int64_t sum_q15 =
        *to_q15 + ((light_q15 * weight_q15 + (1 << 14)) >> 15);

    *to_q15 = q_clamp_sat(sum_q15, 0, GLINT_SCENE_MOST_LIGHT);
}

static void
rotate_direction_to_environment_q14(const struct glint_ward_state *w,
                                    const int32_t v_q30[3], int32_t to_q14[3])
{
    int32_t to_q30[3];

    rotate_direction_to_environment(w, v_q30, to_q30);
    for (int k = 0; k < 3; k++)
        to_q14[k] = (int32_t)q_shift(to_q30[k], 16);
}

/* Adds the diffuse reflection at SURFACE, looked up in the irradiance map. */
static void add_diffuse_reflection(const struct glint_ward_state *w,
                                   const struct glint_met_surface *surface,
                                   const int32_t colour_q15[3],
                                   int32_t weight_q15, int32_t rgb_q15[3])
{
    const int32_t diffuse_q15 = surface->material->diffuse_q15;
    int32_t normal_q14[3], light[3];

    rotate_direction_to_environment_q14(w, surface->normal_q30, normal_q14);
    glint_environment_irradiance(&w->environment, normal_q14, light);
    for (int c = 0; c < 3; c++)
        add_light_times_weight(
            &rgb_q15[c],
            real_integer(real_times(real_of(light[c], 0), w->unit), 15,
                         GLINT_SCENE_MOST_LIGHT),
            q_mul(q_mul(diffuse_q15, colour_q15[c], 15), weight_q15, 15));
}

static void add_environment_reflection(const struct glint_scene *scene,
                                       const struct glint_scene_ray *ray,
                                       const struct glint_met_surface *surface,
                                       const struct glint_brushed *brushed,
                                       const int32_t colour_q15[3],
                                       int32_t weight_q15, int32_t rgb_q15[3])
{
    const struct glint_ward_state *w = scene->wards;
    const struct glint_scene_material *m = surface->material;
    struct glint_ward_place place;
    int32_t light[3];

    if (!w->has_environment)
        return;
    if (m->diffuse_q15 && (colour_q15[0] | colour_q15[1] | colour_q15[2]))
        add_diffuse_reflection(w, surface, colour_q15, weight_q15, rgb_q15);
    if (!brushed)
        return;
    for (int k = 0; k < 3; k++) {
        rotate_direction_to_environment_q14(w, brushed->frame_q30[k],
                                            place.frame_q14[k]);
        place.out_q14[k] = (int32_t)q_shift(
            -v3_dot(brushed->frame_q30[k], ray->toward_q30), 46);
    }
    glint_ward_compute_light(&w->lobe[m->ward], &w->environment, &place, light);
    for (int c = 0; c < 3; c++)
        add_light_times_weight(&rgb_q15[c], light[c], weight_q15);
}

const struct glint_scene_wards glint_scene_wards = {
    allocate_ward_state,        open_environments_and_lobes,
    prepare_metal_lobe,         set_shown_environment,
    scale_environment,          rotate_environment,
    compute_normal_spread_q30,  set_tangent_frame_of_brushed_metal,
    add_environment_reflection, add_highlight_of_light,
    look_up_blurred_environment};
