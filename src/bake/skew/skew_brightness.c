/* SPDX-License-Identifier: MIT */
#include "bake/skew/skew_brightness.h"

#include <math.h>
#include <stdlib.h>

#include "bake/skew/skew_fit.h"
#include "engine/setup/degrees.h"
#include "glint/trace.h"

enum { CELLS = 24, RAYS = CELLS + 1, WAVES = 3 };

/* The light of a cell of a grid on the sensor. */
struct light {
    double irradiance, area_mm2;
};

struct task {
    struct glint_brightness *out;
    const struct glint_setup *setup;
    double field_mm;
    /* Wavelengths whose mean stands for that over the nodes of zones, as
     * coatings let ten times as much light into some colours as into others. */
    double nm[WAVES];
    double half_mm[2]; /* half the width and height of the picture */
    double pixel_mm;   /* of a picture 1920 wide */
    /* Azimuths, in turns: a quarter of one, with both ends, if the lens has two
     * planes of symmetry; else all around. */
    int n_azimuths;
    double turns;
    enum glint_status status[GLINT_BRIGHTNESS_ANGLES];
};

static bool is_seen(const struct task *t, const struct glint_ray *ray)
{
    return ray->rel_radius <= 1 &&
           hypot(ray->stop_x_mm, ray->stop_y_mm) <=
               t->setup->optics.stop_radius_mm &&
           fabs(ray->sensor_x_mm) <= t->half_mm[0] &&
           fabs(ray->sensor_y_mm) <= t->half_mm[1];
}

/* Returns the light between ray A and its neighbours B and C; its area is that
 * of their ellipse of inertia, blurred by a pixel. */
static struct light light_of(const struct task *t, const struct glint_ray *a,
                             const struct glint_ray *b,
                             const struct glint_ray *c, double pupil_mm2)
{
    const double bx = b->sensor_x_mm - a->sensor_x_mm;
    const double by = b->sensor_y_mm - a->sensor_y_mm;
    const double cx = c->sensor_x_mm - a->sensor_x_mm;
    const double cy = c->sensor_y_mm - a->sensor_y_mm;
    /* A pixel in all cells of a row. */
    const double blur = t->pixel_mm * t->pixel_mm / (CELLS * CELLS);
    const double xx = bx * bx + cx * cx + blur, yy = by * by + cy * cy + blur;
    const double xy = bx * by + cx * cy;
    const double area = sqrt(xx * yy - xy * xy);

    return (struct light){a->energy * pupil_mm2 / area, area};
}

/* Rays of a row, with their mean energies. */
struct rays {
    struct glint_ray at[RAYS];
    enum glint_ray_status status[RAYS];
};

static void trace_row(const struct glint_path path[WAVES],
                      const struct glint_row *row, struct rays *rays)
{
    struct rays other = {.at = {{0}}};

    glint_trace_row(&path[0], row, rays->at, rays->status, NULL);
    for (int k = 1; k < WAVES; k++) {
        glint_trace_row(&path[k], row, other.at, other.status, NULL);
        for (int i = 0; i < RAYS; i++)
            if (other.status[i] == GLINT_RAY_OK)
                rays->at[i].energy += other.at[i].energy;
    }
    for (int i = 0; i < RAYS; i++)
        rays->at[i].energy /= WAVES;
}

/* Adds the light of one ghost from DIRECTION; returns how many cells of it. */
static int add_ghost(const struct task *t, int ghost, const double direction[3],
                     struct light *light)
{
    struct glint_row row = {
        .n = RAYS, .direction = {direction[0], direction[1], direction[2]}};
    struct glint_path path[WAVES];
    struct rays rays[2];
    struct glint_pupil p;
    double dy;
    int n = 0;

    for (int k = 0; k < WAVES; k++)
        glint_path_init(&path[k], t->setup->lens, &t->setup->ghost[ghost],
                        t->nm[k]);
    path[0].places_only = true;
    if (!glint_pupil_find_towards(&p, &path[0], direction,
                                  t->setup->optics.stop_radius_mm, t->field_mm,
                                  NULL))
        return 0;
    path[0].places_only = false;
    row.x0_mm = p.x0_mm;
    row.step_mm = (p.x1_mm - p.x0_mm) / CELLS;
    dy = (p.y1_mm - p.y0_mm) / CELLS;
    for (int j = 0; j < RAYS; j++) {
        const struct rays *const below = &rays[~j & 1], *const here =
                                                            &rays[j & 1];

        row.y_mm = p.y0_mm + j * dy;
        trace_row(path, &row, &rays[j & 1]);
        for (int i = 0; i < CELLS && j > 0; i++)
            if (below->status[i] == GLINT_RAY_OK &&
                below->status[i + 1] == GLINT_RAY_OK &&
                here->status[i] == GLINT_RAY_OK && is_seen(t, &below->at[i]))
                light[n++] = light_of(t, &below->at[i], &below->at[i + 1],
                                      &here->at[i], row.step_mm * dy);
    }
    return n;
}

static int brighter_first(const void *a, const void *b)
{
    const double x = ((const struct light *)a)->irradiance;
    const double y = ((const struct light *)b)->irradiance;

    return (x < y) - (x > y);
}

/* Returns the irradiance that 1/1000 of the picture exceeds; if less of it has
 * light, the least. */
static double level_of(const struct task *t, struct light *light, int n)
{
    double left = 0.001 * 4 * t->half_mm[0] * t->half_mm[1];
    int k = 0;

    qsort(light, (size_t)n, sizeof *light, brighter_first);
    while (k + 1 < n && (left -= light[k].area_mm2) > 0)
        k++;
    return light[k].irradiance;
}

/* Finds the level of one angle: the least over the azimuths that have light,
 * HUGE_VAL if none has. */
static void angle_job(void *ctx, int job, int worker)
{
    struct task *t = ctx;
    const int ghosts = t->setup->n_ghosts;
    const double sine = t->out->sine[job];
    struct light *light =
        malloc(((size_t)ghosts * CELLS * CELLS + 1) * sizeof *light);
    double level = HUGE_VAL;

    (void)worker;
    t->status[job] = light ? GLINT_OK : GLINT_E_MEMORY;
    if (!light)
        return;
    for (int a = 0; a < (job ? t->n_azimuths : 1); a++) {
        const double phi = 2 * GLINT_PI * t->turns * a;
        const double direction[3] = {sine * cos(phi), sine * sin(phi),
                                     sqrt(1 - sine * sine)};
        int n = 0;

        for (int k = 0; k < ghosts; k++)
            n += add_ghost(t, k, direction, light + n);
        if (n > 0)
            level = fmin(level, level_of(t, light, n));
    }
    t->out->level[job] = level;
    free(light);
}

enum glint_status
glint_skew_brightness_find(struct glint_brightness *brightness,
                           const struct glint_setup *setup, double field_mm,
                           double max_deg, const double band_nm[2],
                           struct glint_workers *workers)
{
    const bool quarter =
        glint_skew_mirrors(setup->lens) == (GLINT_MIRRORS_X | GLINT_MIRRORS_Y);
    struct task t = {.out = brightness,
                     .setup = setup,
                     .field_mm = field_mm,
                     .n_azimuths = quarter ? 3 : 6,
                     .turns = quarter ? 0.125 : 1 / 6.0};
    const int n = glint_brightness_angles(brightness, max_deg);

    glint_brightness_picture(setup->lens, field_mm, t.half_mm);
    t.pixel_mm = 2 * t.half_mm[0] / 1920;
    for (int k = 0; k < WAVES; k++) {
        /* The middle one first. */
        const double node = (k + 1) % WAVES - 1.0;
        const double lo = pow(band_nm[1], -2), hi = pow(band_nm[0], -2);

        t.nm[k] = pow(0.5 * (lo + hi) + 0.433 * node * (hi - lo), -0.5);
    }
    for (int k = 0; k < GLINT_BRIGHTNESS_ANGLES; k++)
        brightness->level[k] = HUGE_VAL;
    glint_workers_run(workers, n, angle_job, &t);
    for (int k = 0; k < n; k++)
        if (t.status[k] != GLINT_OK)
            return t.status[k];
    return GLINT_OK;
}
