/* SPDX-License-Identifier: MIT
 *
 * Converts the scene's lights that the camera sees to lamps, for which the
 * engine draws lens flares. Computes the fraction of a region of the picture
 * that objects hide. */
#include "base/real.h"
#include "scene/state.h"

enum { POINTS = 16 };

/* Returns how many of the 16 sample points on the disc of LIT the camera sees;
 * 0 or 16 for a light of radius 0. RAY points to the disc's middle, at distance
 * T. */
static int count_visible_light_points(const struct glint_scene *s,
                                      const struct glint_lit *lit,
                                      const struct glint_scene_ray *ray,
                                      int32_t t)
{
    const int n = lit->light->radius ? POINTS : 1;
    int seen = 0;

    for (int i = 0; i < n; i++) {
        struct glint_scene_ray to = *ray;

        glint_scene_aim_at_light_point(&to, t, lit->light->radius, i, n);
        seen += !glint_scene_is_ray_blocked(s, &to, GLINT_NOTHING,
                                            GLINT_NOTHING, t);
    }
    return seen * (POINTS / n);
}

/* Sets the flux of LAMP, whose light LIT is at distance T. The flux is pi times
 * the light of a white surface at that distance, times the number of pixels per
 * solid angle, f^2 / cosine^3. f is the focal length in pixels. */
static void set_lamp_flux(const struct glint_scene *s,
                          const struct glint_lit *lit, int32_t t,
                          int32_t cosine_q30, struct glint_scene_lamp *lamp)
{
    const struct glint_real cosine = real_of(cosine_q30, -30);
    const struct glint_real pi = {
        Q_CONST(0.7853981634, 30) + Q_CONST(0.7853981634, 30), -29};
    struct glint_real factor =
        real_times(s->view.focal_q8[0], s->view.focal_q8[1]);

    factor = real_times(real_times(factor, pi), real_of(1, -16));
    for (int k = 0; k < 3; k++)
        factor = real_over(factor, cosine);
    if (t != GLINT_FAR) {
        const struct glint_real away = real_of(t, 0);

        factor.exponent += 2 * s->model.header->unit_log2;
        factor = real_over(real_over(factor, away), away);
    }
    for (int c = 0; c < 3; c++)
        lamp->rgb[c] = real_times(lit->light->rgb[c], factor);
}

/* Sets LAMP to the position, size and flux of light LIT in the picture. Returns
 * 1, or 0 if LIT is at or behind the camera, or too far off-screen. */
static int project_light_to_picture(const struct glint_scene *s,
                                    const struct glint_lit *lit,
                                    struct glint_scene_lamp *lamp)
{
    struct glint_scene_ray ray = {.at = {0}};
    int32_t level_q15[3], seen_q30[3], t;
    struct glint_corner corner;
    struct glint_real radius;

    for (int k = 0; k < 3; k++)
        ray.at[k] = s->view.at[k];
    t = glint_scene_compute_light_at(s, lit, ray.at, ray.toward_q30, level_q15);
    if (t == 0)
        return 0;
    v3_rotate(&s->view.turn, ray.toward_q30, seen_q30);
    if (seen_q30[2] <= 0)
        return 0;
    corner = glint_view_project_vertex(&s->view, seen_q30);
    if (corner.w != 1)
        return 0;
    lamp->share = count_visible_light_points(s, lit, &ray, t);
    lamp->x_q8 = corner.x + 128 * s->view.width;
    lamp->y_q8 = corner.y + 128 * s->view.height;
    radius = t == GLINT_FAR
                 ? real_of(lit->light->radius, -30)
                 : real_over(real_of(lit->light->radius, 0), real_of(t, 0));
    radius = real_over(real_times(radius, s->view.focal_q8[0]),
                       real_of(seen_q30[2], -30));
    lamp->radius_q8 = (int32_t)real_integer(radius, 0, 1 << 22);
    set_lamp_flux(s, lit, t, seen_q30[2], lamp);
    return 1;
}

int glint_scene_lights(const struct glint_scene *scene,
                       struct glint_scene_lamp *lamps)
{
    const struct glint_scene_header *h = scene->model.header;
    int n = 0;

    for (uint32_t i = 0; h->flare && i < scene->n_lit; i++) {
        lamps[n].light = (int)i;
        n += project_light_to_picture(scene, &scene->lit[i], &lamps[n]);
    }
    return n;
}

/* ---------------------------------------------------------------- coverage */

int glint_scene_cover(const struct glint_scene *scene, int32_t x_q8,
                      int32_t y_q8, int32_t radius_q8)
{
    enum { SIDE_Q8 = 256 << GLINT_COVER_LOG2 };
    const int r = q_larger(0, radius_q8) / SIDE_Q8 + 1;
    const int x = x_q8 / SIDE_Q8, y = y_q8 / SIDE_Q8;
    int64_t sum = 0, n = 0;

    for (int j = q_larger(0, y - r); j <= y + r && j < scene->cover_down; j++)
        for (int i = q_larger(0, x - r); i <= x + r && i < scene->cover_across;
             i++) {
            const int64_t dx = (int64_t)i * SIDE_Q8 + SIDE_Q8 / 2 - x_q8;
            const int64_t dy = (int64_t)j * SIDE_Q8 + SIDE_Q8 / 2 - y_q8;
            const int w =
                q_smaller(8, scene->cfg.width - (i << GLINT_COVER_LOG2));
            const int h =
                q_smaller(8, scene->cfg.height - (j << GLINT_COVER_LOG2));

            if ((i != x || j != y) &&
                dx * dx + dy * dy > (int64_t)radius_q8 * radius_q8)
                continue;
            sum += scene->cover[j * scene->cover_across + i];
            n += w * h;
        }
    return n ? glint_divide_rounded((uint64_t)sum, (uint64_t)n) : 0;
}
