/* SPDX-License-Identifier: MIT */
#include "bake/fit/brightness.h"

#include <math.h>
#include <stdlib.h>

#include "engine/setup/degrees.h"
#include "glint/model.h"
#include "glint/trace.h"

/* Grid of rays over the pupil: ACROSS x DOWN cells over the upper half for
 * round lenses, else ACROSS x ACROSS cells over all of it. */
enum { ACROSS = 24, DOWN = 12, CELLS = ACROSS * DOWN, WAVES = 3 };

/* The light of one cell of the pupil grid where it hits the sensor. Round
 * lenses: each patch counts twice, at y and at -y. */
struct patch {
    double irradiance, area_mm2, x_mm, y_mm;
};

struct task {
    struct glint_brightness *out;
    const struct glint_setup *setup;
    double field_mm;
    /* Round lenses use nm[0], the middle of the band. Others use the mean
     * energy of all wavelengths, as their coatings may transmit ten times as
     * much light at one wavelength as at another. */
    double nm[WAVES];
    double half_mm[2]; /* half width and half height of the picture, mm */
    double pixel_mm;   /* width of a pixel in a picture of 1920 pixels, mm */
    /* Lenses that are not round: number of azimuths of the light, and the step
     * between them in turns. They cover 0 .. 90 degrees if the lens has two
     * planes of symmetry, else 360 degrees. */
    int n_azimuths;
    double turns;
    enum glint_status status[GLINT_BRIGHTNESS_ANGLES];
};

static bool is_ray_transmitted(const struct task *t,
                               const struct glint_ray *ray)
{
    return ray->rel_radius <= 1 && hypot(ray->stop_x_mm, ray->stop_y_mm) <=
                                       t->setup->optics.stop_radius_mm;
}

static int compare_irradiance(const void *a, const void *b)
{
    const double x = ((const struct patch *)a)->irradiance;
    const double y = ((const struct patch *)b)->irradiance;

    return (x < y) - (x > y);
}

/* ------------------------------------------------------------------- round */

static bool is_ray_in_field(const struct task *t, const struct glint_ray *ray)
{
    return is_ray_transmitted(t, ray) &&
           hypot(ray->sensor_x_mm, ray->sensor_y_mm) <= t->field_mm;
}

static struct patch compute_light_patch(const struct glint_ray *a,
                                        const struct glint_ray *b,
                                        const struct glint_ray *c,
                                        double pupil_mm2)
{
    const double area = fabs(
        (b->sensor_x_mm - a->sensor_x_mm) * (c->sensor_y_mm - a->sensor_y_mm) -
        (b->sensor_y_mm - a->sensor_y_mm) * (c->sensor_x_mm - a->sensor_x_mm));

    return (struct patch){a->energy * pupil_mm2 / fmax(area, 1e-12), area,
                          a->sensor_x_mm, a->sensor_y_mm};
}

/* Appends the patches of one ghost to PATCH, for light at the angle with sine
 * SINE. Returns their number. */
static int add_ghost_patches(const struct task *t, int ghost, double sine,
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

    glint_path_init(&path, t->setup->lens, &t->setup->ghost[ghost], t->nm[0]);
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
                status[j & 1][i] == GLINT_RAY_OK &&
                is_ray_in_field(t, &below[i]))
                patch[n++] = compute_light_patch(&below[i], &below[i + 1],
                                                 &here[i], row.step_mm * dy);
    }
    return n;
}

/* Returns whether the sensor position (X, Y), mm, lies inside the picture if
 * the light comes from azimuth PHI, radians. */
static bool is_point_in_picture(const struct task *t, double x, double y,
                                double phi)
{
    const double c = cos(phi), s = sin(phi);

    return fabs(c * x - s * y) <= t->half_mm[0] &&
           fabs(s * x + c * y) <= t->half_mm[1];
}

/* Returns the irradiance that is exceeded on 1/1000 of the picture's area;
 * HUGE_VAL if less than 1/1000 of the area has light. PATCH must be sorted by
 * descending irradiance. */
static double find_brightness_level(const struct task *t,
                                    const struct patch *patch, int n,
                                    double phi)
{
    double left = 0.001 * 4 * t->half_mm[0] * t->half_mm[1];

    for (int k = 0; k < n; k++) {
        const struct patch *p = &patch[k];

        left -= p->area_mm2 * (is_point_in_picture(t, p->x_mm, p->y_mm, phi) +
                               is_point_in_picture(t, p->x_mm, -p->y_mm, phi));
        if (left <= 0)
            return p->irradiance;
    }
    return HUGE_VAL;
}

/* Finds the brightness level of a round lens at one angle: the min over all
 * azimuths. At some azimuths the brightest ghosts lie outside the picture,
 * which is then exposed for other ghosts. */
static void find_round_level_at_angle(void *ctx, int job, int worker)
{
    enum { AZIMUTHS = 7 }; /* number of azimuths, 0 .. 90 degrees */
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
        n += add_ghost_patches(t, k, t->out->sine[job], patch + n);
    qsort(patch, (size_t)n, sizeof *patch, compare_irradiance);
    for (int k = 0; k < AZIMUTHS; k++)
        level =
            fmin(level, find_brightness_level(
                            t, patch, n, 0.5 * GLINT_PI * k / (AZIMUTHS - 1)));
    t->out->level[job] = level < HUGE_VAL ? level
                         : n              ? patch[n - 1].irradiance
                                          : 0;
    free(patch);
}

/* --------------------------------------------------------------- not round */

/* Lenses that are not round: the flare does not simply rotate with the azimuth
 * of the light, so several azimuths are traced. Each patch of light is blurred
 * by a pixel, so that thin streaks do not count as bright. */
static bool is_ray_in_picture(const struct task *t, const struct glint_ray *ray)
{
    return is_ray_transmitted(t, ray) &&
           fabs(ray->sensor_x_mm) <= t->half_mm[0] &&
           fabs(ray->sensor_y_mm) <= t->half_mm[1];
}

/* Returns the patch of light between ray A and its neighbours B and C. Its area
 * is that of the inertia ellipse of the three sensor positions, blurred by a
 * pixel. */
static struct patch compute_skew_patch(const struct task *t,
                                       const struct glint_ray *a,
                                       const struct glint_ray *b,
                                       const struct glint_ray *c,
                                       double pupil_mm2)
{
    const double bx = b->sensor_x_mm - a->sensor_x_mm;
    const double by = b->sensor_y_mm - a->sensor_y_mm;
    const double cx = c->sensor_x_mm - a->sensor_x_mm;
    const double cy = c->sensor_y_mm - a->sensor_y_mm;
    /* area of a pixel / number of grid cells */
    const double blur = t->pixel_mm * t->pixel_mm / (ACROSS * ACROSS);
    const double xx = bx * bx + cx * cx + blur, yy = by * by + cy * cy + blur;
    const double xy = bx * by + cx * cy;
    const double area = sqrt(xx * yy - xy * xy);

    return (struct patch){.irradiance = a->energy * pupil_mm2 / area,
                          .area_mm2 = area};
}

/* One row of rays of the pupil grid. Energies are means over all
 * wavelengths. */
struct rays {
    struct glint_ray at[ACROSS + 1];
    enum glint_ray_status status[ACROSS + 1];
};

static void trace_mean_energy_row(const struct glint_path path[WAVES],
                                  const struct glint_row *row,
                                  struct rays *rays)
{
    struct rays other = {.at = {{0}}};

    glint_trace_row(&path[0], row, rays->at, rays->status, NULL);
    for (int k = 1; k < WAVES; k++) {
        glint_trace_row(&path[k], row, other.at, other.status, NULL);
        for (int i = 0; i <= ACROSS; i++)
            if (other.status[i] == GLINT_RAY_OK)
                rays->at[i].energy += other.at[i].energy;
    }
    for (int i = 0; i <= ACROSS; i++)
        rays->at[i].energy /= WAVES;
}

/* Appends the patches of one ghost to PATCH, for light from DIRECTION. Returns
 * their number. */
static int add_skew_ghost_patches(const struct task *t, int ghost,
                                  const double direction[3],
                                  struct patch *patch)
{
    struct glint_row row = {
        .n = ACROSS + 1,
        .direction = {direction[0], direction[1], direction[2]}};
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
    row.step_mm = (p.x1_mm - p.x0_mm) / ACROSS;
    dy = (p.y1_mm - p.y0_mm) / ACROSS;
    for (int j = 0; j <= ACROSS; j++) {
        const struct rays *const below = &rays[~j & 1], *const here =
                                                            &rays[j & 1];

        row.y_mm = p.y0_mm + j * dy;
        trace_mean_energy_row(path, &row, &rays[j & 1]);
        for (int i = 0; i < ACROSS && j > 0; i++)
            if (below->status[i] == GLINT_RAY_OK &&
                below->status[i + 1] == GLINT_RAY_OK &&
                here->status[i] == GLINT_RAY_OK &&
                is_ray_in_picture(t, &below->at[i]))
                patch[n++] =
                    compute_skew_patch(t, &below->at[i], &below->at[i + 1],
                                       &here->at[i], row.step_mm * dy);
    }
    return n;
}

/* Sorts PATCH by irradiance. Returns the irradiance that is exceeded on 1/1000
 * of the picture's area, or the min irradiance if less of the area has
 * light. */
static double find_skew_brightness_level(const struct task *t,
                                         struct patch *patch, int n)
{
    double left = 0.001 * 4 * t->half_mm[0] * t->half_mm[1];
    int k = 0;

    qsort(patch, (size_t)n, sizeof *patch, compare_irradiance);
    while (k + 1 < n && (left -= patch[k].area_mm2) > 0)
        k++;
    return patch[k].irradiance;
}

/* Finds the brightness level of a lens that is not round at one angle: the min
 * over all azimuths with light; HUGE_VAL if no azimuth has light. */
static void find_skew_level_at_angle(void *ctx, int job, int worker)
{
    struct task *t = ctx;
    const int ghosts = t->setup->n_ghosts;
    const double sine = t->out->sine[job];
    struct patch *patch =
        malloc(((size_t)ghosts * ACROSS * ACROSS + 1) * sizeof *patch);
    double level = HUGE_VAL;

    (void)worker;
    t->status[job] = patch ? GLINT_OK : GLINT_E_MEMORY;
    if (!patch)
        return;
    for (int a = 0; a < (job ? t->n_azimuths : 1); a++) {
        const double phi = 2 * GLINT_PI * t->turns * a;
        const double direction[3] = {sine * cos(phi), sine * sin(phi),
                                     sqrt(1 - sine * sine)};
        int n = 0;

        for (int k = 0; k < ghosts; k++)
            n += add_skew_ghost_patches(t, k, direction, patch + n);
        if (n > 0)
            level = fmin(level, find_skew_brightness_level(t, patch, n));
    }
    t->out->level[job] = level;
    free(patch);
}

/* --------------------------------------------------------------------- both */

static const double degrees[GLINT_BRIGHTNESS_ANGLES] = {0,  3,  6,  9,  12, 15,
                                                        18, 22, 27, 34, 45};

int glint_brightness_set_angles(struct glint_brightness *brightness,
                                double max_deg)
{
    int n = 2;

    for (int k = 0; k < GLINT_BRIGHTNESS_ANGLES; k++)
        brightness->sine[k] = glint_sin_deg(degrees[k]);
    while (n < GLINT_BRIGHTNESS_ANGLES && degrees[n - 1] <= max_deg)
        n++;
    return n;
}

uint32_t glint_skew_find_mirror_planes(const struct glint_prescription *lens)
{
    uint32_t mirrors = GLINT_MIRRORS_X | GLINT_MIRRORS_Y;

    for (int k = 0; k < lens->n_surfaces; k++) {
        const struct glint_shape *const a = &lens->surface[k].shape;

        /* a tilt about the y axis breaks the symmetry in x, a tilt about x that
         * in y */
        if (a->decentre_mm[0] != 0.0 || a->tilt_deg[1] != 0.0)
            mirrors &= ~(uint32_t)GLINT_MIRRORS_X;
        if (a->decentre_mm[1] != 0.0 || a->tilt_deg[0] != 0.0)
            mirrors &= ~(uint32_t)GLINT_MIRRORS_Y;
    }
    return mirrors;
}

enum glint_status
glint_brightness_find_levels(struct glint_brightness *brightness,
                             const struct glint_setup *setup, double field_mm,
                             double max_deg, const double band_nm[2],
                             struct glint_workers *workers)
{
    const bool round = glint_prescription_is_round(setup->lens);
    const bool quarter = glint_skew_find_mirror_planes(setup->lens) ==
                         (GLINT_MIRRORS_X | GLINT_MIRRORS_Y);
    const double scale = field_mm / (1.1 * hypot(setup->lens->film_width_mm,
                                                 setup->lens->film_height_mm));
    struct task t = {.out = brightness,
                     .setup = setup,
                     .field_mm = field_mm,
                     .half_mm = {scale * setup->lens->film_width_mm,
                                 scale * setup->lens->film_height_mm},
                     .nm = {0.5 * (band_nm[0] + band_nm[1])},
                     .n_azimuths = quarter ? 3 : 6,
                     .turns = quarter ? 0.125 : 1 / 6.0};
    const int n = glint_brightness_set_angles(brightness, max_deg);

    t.pixel_mm = 2 * t.half_mm[0] / 1920;
    for (int k = 0; k < WAVES && !round; k++) {
        /* order of the wavelengths: the middle one first, then both ends */
        const double node = (k + 1) % WAVES - 1.0;
        const double lo = pow(band_nm[1], -2), hi = pow(band_nm[0], -2);

        t.nm[k] = pow(0.5 * (lo + hi) + 0.433 * node * (hi - lo), -0.5);
    }
    for (int k = 0; k < GLINT_BRIGHTNESS_ANGLES; k++)
        brightness->level[k] = round ? 0 : HUGE_VAL;
    glint_workers_run(
        workers, n,
        round ? find_round_level_at_angle : find_skew_level_at_angle, &t);
    for (int k = 0; k < n; k++)
        if (t.status[k] != GLINT_OK)
            return t.status[k];
    return GLINT_OK;
}

double glint_brightness_get_level(const struct glint_brightness *brightness,
                                  double sine)
{
    int k = 0;

    while (k + 2 < GLINT_BRIGHTNESS_ANGLES && brightness->sine[k + 1] < sine)
        k++;
    return fmin(brightness->level[k], brightness->level[k + 1]);
}
