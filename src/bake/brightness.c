/* SPDX-License-Identifier: MIT */
#include "bake/brightness.h"

#include <math.h>
#include <stdlib.h>

#include "bake/degrees.h"

enum { ACROSS = 24, DOWN = 12, CELLS = ACROSS * DOWN };

/* A cell's irradiance and its area on the sensor. */
struct patch {
    double irradiance, area_mm2;
};

struct task {
    struct glint_brightness *out;
    const struct glint_setup *setup;
    double field_mm, nm;
    enum glint_status status[GLINT_BRIGHTNESS_ANGLES];
};

static bool is_seen(const struct task *t, const struct glint_ray *ray)
{
    return ray->rel_radius <= 1 &&
           hypot(ray->stop_x_mm, ray->stop_y_mm) <=
               t->setup->optics.stop_radius_mm &&
           hypot(ray->sensor_x_mm, ray->sensor_y_mm) <= t->field_mm;
}

static struct patch patch_of(const struct glint_ray *a,
                             const struct glint_ray *b,
                             const struct glint_ray *c, double pupil_mm2)
{
    const double area = fabs(
        (b->sensor_x_mm - a->sensor_x_mm) * (c->sensor_y_mm - a->sensor_y_mm) -
        (b->sensor_y_mm - a->sensor_y_mm) * (c->sensor_x_mm - a->sensor_x_mm));

    /* the other half of the picture is the same */
    return (struct patch){a->energy * pupil_mm2 / fmax(area, 1e-12), 2 * area};
}

/* Adds the patches of one ghost; returns how many. */
static int add_ghost(const struct task *t, int ghost, double sine,
                     struct patch *patch)
{
    const double direction[3] = {sine, 0, sqrt(1 - sine * sine)};
    struct glint_ray ray[2][ACROSS + 1];
    bool ok[2][ACROSS + 1];
    struct glint_pupil p;
    struct glint_path path;
    double dx, dy;
    int n = 0;

    glint_path_init(&path, t->setup->lens, &t->setup->ghost[ghost], t->nm);
    if (!glint_pupil_find_within(&p, &path, asin(sine) * (180 / GLINT_PI),
                                 t->setup->optics.stop_radius_mm, t->field_mm,
                                 NULL))
        return 0;
    dx = (p.x1_mm - p.x0_mm) / ACROSS;
    dy = p.y1_mm / DOWN;
    for (int j = 0; j <= DOWN; j++)
        for (int i = 0; i <= ACROSS; i++) {
            const int now = j & 1, before = now ^ 1;

            ok[now][i] = glint_trace(&path, p.x0_mm + i * dx, j * dy, direction,
                                     &ray[now][i], NULL) == GLINT_RAY_OK;
            if (i && j && ok[before][i - 1] && ok[before][i] &&
                ok[now][i - 1] && is_seen(t, &ray[before][i - 1]))
                patch[n++] = patch_of(&ray[before][i - 1], &ray[before][i],
                                      &ray[now][i - 1], dx * dy);
        }
    return n;
}

static int brighter_first(const void *a, const void *b)
{
    const double x = ((const struct patch *)a)->irradiance;
    const double y = ((const struct patch *)b)->irradiance;

    return (x < y) - (x > y);
}

static void angle_job(void *ctx, int job, int worker)
{
    struct task *t = ctx;
    const int ghosts = t->setup->n_ghosts;
    const double enough = 0.001 * GLINT_PI * t->field_mm * t->field_mm;
    struct patch *patch = malloc(((size_t)ghosts * CELLS + 1) * sizeof *patch);
    double covered = 0;
    int n = 0;

    (void)worker;
    t->status[job] = patch ? GLINT_OK : GLINT_E_MEMORY;
    if (!patch)
        return;
    for (int k = 0; k < ghosts; k++)
        n += add_ghost(t, k, t->out->sine[job], patch + n);
    qsort(patch, (size_t)n, sizeof *patch, brighter_first);
    t->out->level[job] = n ? patch[n - 1].irradiance : 0;
    for (int k = 0; k < n; k++) {
        covered += patch[k].area_mm2;
        if (covered >= enough) {
            t->out->level[job] = patch[k].irradiance;
            break;
        }
    }
    free(patch);
}

enum glint_status glint_brightness_find(struct glint_brightness *brightness,
                                        const struct glint_setup *setup,
                                        double field_mm,
                                        const double band_nm[2],
                                        struct glint_workers *workers)
{
    static const double degrees[GLINT_BRIGHTNESS_ANGLES] = {0,  4,  9, 15,
                                                            22, 32, 45};
    struct task t = {brightness,
                     setup,
                     field_mm,
                     0.5 * (band_nm[0] + band_nm[1]),
                     {GLINT_OK}};

    for (int k = 0; k < GLINT_BRIGHTNESS_ANGLES; k++)
        brightness->sine[k] = glint_sin_deg(degrees[k]);
    glint_workers_run(workers, GLINT_BRIGHTNESS_ANGLES, angle_job, &t);
    for (int k = 0; k < GLINT_BRIGHTNESS_ANGLES; k++)
        if (t.status[k] != GLINT_OK)
            return t.status[k];
    return GLINT_OK;
}

double glint_brightness_at(const struct glint_brightness *brightness,
                           double sine)
{
    int best = 0;

    for (int k = 1; k < GLINT_BRIGHTNESS_ANGLES; k++)
        if (fabs(brightness->sine[k] - sine) <
            fabs(brightness->sine[best] - sine))
            best = k;
    return brightness->level[best];
}
