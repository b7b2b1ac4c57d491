/* SPDX-License-Identifier: MIT */
#include "bake/fit/brightness.h"

#include <math.h>
#include <stdlib.h>

#include "engine/setup/degrees.h"
#include "glint/trace.h"

enum { ACROSS = 24, DOWN = 12, CELLS = ACROSS * DOWN };

/* The light of a cell of the grid on the sensor. Its mirror image at -y counts,
 * too. */
struct patch {
    double irradiance, area_mm2, x_mm, y_mm;
};

struct task {
    struct glint_brightness *out;
    const struct glint_setup *setup;
    double field_mm, nm;
    double half_mm[2]; /* half the width and height of the picture */
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

    return (struct patch){a->energy * pupil_mm2 / fmax(area, 1e-12), area,
                          a->sensor_x_mm, a->sensor_y_mm};
}

/* Adds the patches of one ghost; returns how many. */
static int add_ghost(const struct task *t, int ghost, double sine,
                     struct patch *patch)
{
    struct glint_row row = {.n = ACROSS + 1,
                            .direction = {sine, 0, sqrt(1 - sine * sine)}};
    struct glint_ray ray[2][ACROSS + 1];
    enum glint_ray_status status[2][ACROSS + 1];
    struct glint_pupil p;
    struct glint_path path;
    double dy;
    int n = 0;

    glint_path_init(&path, t->setup->lens, &t->setup->ghost[ghost], t->nm);
    path.places_only = true;
    if (!glint_pupil_find_within(&p, &path, asin(sine) * (180 / GLINT_PI),
                                 t->setup->optics.stop_radius_mm, t->field_mm,
                                 NULL))
        return 0;
    path.places_only = false;
    row.x0_mm = p.x0_mm;
    row.step_mm = (p.x1_mm - p.x0_mm) / ACROSS;
    dy = p.y1_mm / DOWN;
    for (int j = 0; j <= DOWN; j++) {
        const struct glint_ray *below = ray[~j & 1], *here = ray[j & 1];

        row.y_mm = j * dy;
        glint_trace_row(&path, &row, ray[j & 1], status[j & 1], NULL);
        for (int i = 0; i < ACROSS && j > 0; i++)
            if (status[~j & 1][i] == GLINT_RAY_OK &&
                status[~j & 1][i + 1] == GLINT_RAY_OK &&
                status[j & 1][i] == GLINT_RAY_OK && is_seen(t, &below[i]))
                patch[n++] = patch_of(&below[i], &below[i + 1], &here[i],
                                      row.step_mm * dy);
    }
    return n;
}

static int brighter_first(const void *a, const void *b)
{
    const double x = ((const struct patch *)a)->irradiance;
    const double y = ((const struct patch *)b)->irradiance;

    return (x < y) - (x > y);
}

/* Returns whether (X, Y) lies in the picture if the light's azimuth is PHI. */
static bool in_picture(const struct task *t, double x, double y, double phi)
{
    const double c = cos(phi), s = sin(phi);

    return fabs(c * x - s * y) <= t->half_mm[0] &&
           fabs(s * x + c * y) <= t->half_mm[1];
}

/* Returns the irradiance that 1/1000 of the picture exceeds; HUGE_VAL if less
 * of it has light. PATCH is sorted, the brightest first. */
static double level_at(const struct task *t, const struct patch *patch, int n,
                       double phi)
{
    double left = 0.001 * 4 * t->half_mm[0] * t->half_mm[1];

    for (int k = 0; k < n; k++) {
        const struct patch *p = &patch[k];

        left -= p->area_mm2 * (in_picture(t, p->x_mm, p->y_mm, phi) +
                               in_picture(t, p->x_mm, -p->y_mm, phi));
        if (left <= 0)
            return p->irradiance;
    }
    return HUGE_VAL;
}

/* Finds the level of one angle: the least over all azimuths, as the brightest
 * ghosts may lie outside of the picture, which is then exposed for others. */
static void angle_job(void *ctx, int job, int worker)
{
    enum { AZIMUTHS = 7 }; /* azimuths from 0 to 90 degrees */
    struct task *t = ctx;
    const int ghosts = t->setup->n_ghosts;
    struct patch *patch = malloc(((size_t)ghosts * CELLS + 1) * sizeof *patch);
    double level = HUGE_VAL;
    int n = 0;

    (void)worker;
    t->status[job] = patch ? GLINT_OK : GLINT_E_MEMORY;
    if (!patch)
        return;
    for (int k = 0; k < ghosts; k++)
        n += add_ghost(t, k, t->out->sine[job], patch + n);
    qsort(patch, (size_t)n, sizeof *patch, brighter_first);
    for (int k = 0; k < AZIMUTHS; k++)
        level = fmin(
            level, level_at(t, patch, n, 0.5 * GLINT_PI * k / (AZIMUTHS - 1)));
    t->out->level[job] = level < HUGE_VAL ? level
                         : n              ? patch[n - 1].irradiance
                                          : 0;
    free(patch);
}

static const double degrees[GLINT_BRIGHTNESS_ANGLES] = {0,  3,  6,  9,  12, 15,
                                                        18, 22, 27, 34, 45};

int glint_brightness_angles(struct glint_brightness *brightness, double max_deg)
{
    int n = 2;

    for (int k = 0; k < GLINT_BRIGHTNESS_ANGLES; k++)
        brightness->sine[k] = glint_sin_deg(degrees[k]);
    while (n < GLINT_BRIGHTNESS_ANGLES && degrees[n - 1] <= max_deg)
        n++;
    return n;
}

void glint_brightness_picture(const struct glint_prescription *lens,
                              double field_mm, double half_mm[2])
{
    const double scale =
        field_mm / (1.1 * hypot(lens->film_width_mm, lens->film_height_mm));

    half_mm[0] = scale * lens->film_width_mm;
    half_mm[1] = scale * lens->film_height_mm;
}

enum glint_status glint_brightness_find(struct glint_brightness *brightness,
                                        const struct glint_setup *setup,
                                        double field_mm, double max_deg,
                                        const double band_nm[2],
                                        struct glint_workers *workers)
{
    const int n = glint_brightness_angles(brightness, max_deg);
    struct task t = {.out = brightness,
                     .setup = setup,
                     .field_mm = field_mm,
                     .nm = 0.5 * (band_nm[0] + band_nm[1])};

    glint_brightness_picture(setup->lens, field_mm, t.half_mm);
    for (int k = 0; k < GLINT_BRIGHTNESS_ANGLES; k++)
        brightness->level[k] = 0;
    glint_workers_run(workers, n, angle_job, &t);
    for (int k = 0; k < n; k++)
        if (t.status[k] != GLINT_OK)
            return t.status[k];
    return GLINT_OK;
}

double glint_brightness_at(const struct glint_brightness *brightness,
                           double sine)
{
    int k = 0;

    while (k + 2 < GLINT_BRIGHTNESS_ANGLES && brightness->sine[k + 1] < sine)
        k++;
    return fmin(brightness->level[k], brightness->level[k + 1]);
}
