/* SPDX-License-Identifier: MIT */
#include "bake/fit/zone_aim.h"

#include <math.h>

/* Min relative brightness of a ray for weighting its error. */
#define LEAST_LIGHT 1e-3
/* Min factor on position tolerances in skew zones. It applies if the ghost is
 * brighter than white, as shifts of its outline are then more visible by the
 * same factor. */
#define CLIPPED 0.4
/* Min factor on the position tolerance across a streak that is thinner than a
 * pixel: where such a streak crosses from one pixel row to the next, all of its
 * light moves to that row. */
#define THIN 0.1

/* Summary of the rays at one angle and wavelength: their sensor area, and the
 * numbers of visible and of all rays. */
struct ray_summary {
    int n, n_all;
    /* corners of the bounding box of visible rays on the sensor, mm */
    double low[2], high[2];
    double energy; /* mean energy of the visible rays, 0 .. 1 */
    double spread; /* mean RAY_SPREAD of the visible rays */
};

static struct ray_summary
summarise_rays_at_angle(const struct glint_zone_rays *r, int first)
{
    struct ray_summary s = {.low = {HUGE_VAL, HUGE_VAL},
                            .high = {-HUGE_VAL, -HUGE_VAL}};

    for (int i = first;
         i < r->n && glint_zone_rays_have_same_light(r, i, first);
         i++, s.n_all++) {
        if (!glint_zone_rays_is_visible(r, i))
            continue;
        for (int k = 0; k < 2; k++) {
            s.low[k] = fmin(s.low[k], r->at[RAY_SENSOR_X + k][i]);
            s.high[k] = fmax(s.high[k], r->at[RAY_SENSOR_X + k][i]);
        }
        s.energy += r->at[RAY_ENERGY][i];
        s.spread += r->at[RAY_SPREAD][i];
        s.n++;
    }
    s.energy /= s.n > 0 ? s.n : 1;
    s.spread /= s.n > 0 ? s.n : 1;
    return s;
}

/* Returns the sine of the angle between light and lens axis at zone coordinates
 * X. */
static double compute_light_sine(const struct glint_zone *zone,
                                 const double x[GLINT_VARIABLES])
{
    const double along =
        0.5 * (zone->lo + zone->hi) + 0.5 * x[GLINT_S] * (zone->hi - zone->lo);

    return !zone->skew
               ? along
               : hypot(along, 0.5 * (zone->y_lo + zone->y_hi) +
                                  0.5 * x[GLINT_P] * (zone->y_hi - zone->y_lo));
}

/* Estimates the area on the sensor that the visible rays summarised in V cover,
 * mm^2. */
static double estimate_sensor_area(const struct glint_zone *zone,
                                   const struct ray_summary *v, double blur_mm)
{
    /* round lenses: the rays' mirror images lie at -y */
    const double y = zone->skew ? 0.5 * (v->high[1] - v->low[1] + blur_mm)
                                : fmax(fabs(v->low[1]), fabs(v->high[1]));

    return fmax(1e-9, (v->high[0] - v->low[0] + blur_mm) * 1.6 * y);
}

/* Returns the brightness of the ghost relative to the brightness level of
 * struct glint_brightness: the max over angles and wavelengths, or the mean for
 * skew zones, which have few rays per direction. In skew zones light is spread
 * over at least a pixel. THIN receives the factors on the tolerances along x
 * and y. */
static double
compute_relative_brightness(const struct glint_tolerance *tolerance,
                            const struct glint_zone *zone,
                            const struct glint_zone_rays *r, double thin[2])
{
    /* number of visible rays up to which their area is too uncertain */
    enum { FEW = 4 };
    const double blur = zone->skew ? tolerance->pixel_mm : 0;
    double most = 0, light = 0, area = 0, covered = 0, on_screen[2] = {0},
           n = 0;

    for (int i = 0, next; i < r->n; i = next) {
        const struct ray_summary v = summarise_rays_at_angle(r, i);
        const double x[GLINT_VARIABLES] = {0, 0, r->x[GLINT_S][i],
                                           r->x[GLINT_W][i], r->x[GLINT_P][i]};
        const double pupil =
            4 * (1 - glint_zone_get_inner_rim(zone->annulus)) *
            glint_zone_evaluate_box_polynomial(zone, zone->half_x, x) *
            glint_zone_evaluate_box_polynomial(zone, zone->half_y, x) * v.n /
            v.n_all;
        const double level = glint_brightness_get_level(
            tolerance->brightness, compute_light_sine(zone, x));
        const double on = estimate_sensor_area(zone, &v, blur);

        next = i + v.n_all;
        if (v.n < FEW)
            continue;
        most = fmax(most, v.energy * pupil / on / fmax(level, 1e-30));
        light += v.energy * pupil / fmax(level, 1e-30);
        area += on;
        for (int k = 0; k < 2; k++)
            on_screen[k] += v.high[k] - v.low[k];
        covered += 4 * v.spread * v.n / v.n_all;
        n++;
    }
    for (int k = 0; k < 2; k++)
        thin[k] =
            !zone->skew
                ? 1
                : fmax(THIN,
                       fmin(1, covered / (on_screen[1 - k] + n * 1e-9) / blur));
    return zone->skew ? light / fmax(area, 1e-30) : most;
}

double glint_zone_aim_compute_stretch(const struct glint_zone_rays *rays,
                                      const double *a, const double *b,
                                      double near)
{
    double moved2 = 0, change2 = 0;

    for (int i = 1; i < rays->n; i++) {
        const double *x = rays->at[RAY_SENSOR_X], *y = rays->at[RAY_SENSOR_Y];

        if ((rays->x[GLINT_V][i] != rays->x[GLINT_V][i - 1] &&
             !rays->scattered) ||
            !glint_zone_rays_have_same_light(rays, i, i - 1) ||
            !glint_zone_rays_is_visible(rays, i) ||
            !glint_zone_rays_is_visible(rays, i - 1) || a[i] < near)
            continue;
        moved2 += (x[i] - x[i - 1]) * (x[i] - x[i - 1]) +
                  (y[i] - y[i - 1]) * (y[i] - y[i - 1]);
        change2 += (a[i] - a[i - 1]) * (a[i] - a[i - 1]);
        if (b)
            change2 += (b[i] - b[i - 1]) * (b[i] - b[i - 1]);
    }
    return change2 > 0 ? sqrt(moved2 / change2) : 0;
}

static double clamp_outline_tolerance(const struct glint_zone_aim *aim,
                                      double least, double most,
                                      double stretch_mm)
{
    return fmax(least, fmin(most, aim->edge_mm / fmax(1e-12, stretch_mm)));
}

double glint_zone_aim_get_outline_tolerance(const struct glint_zone_aim *aim,
                                            double least, double most,
                                            double stretch_mm)
{
    return clamp_outline_tolerance(aim, least * most, most, stretch_mm);
}

struct glint_zone_aim
glint_zone_aim_compute_tolerances(const struct glint_tolerance *tolerance,
                                  const struct glint_zone *zone,
                                  const struct glint_zone_rays *rays)
{
    const struct glint_tolerance *t = tolerance;
    double thin[2];
    const double share = compute_relative_brightness(t, zone, rays, thin);
    const double faint = pow(fmax(share, 1e-9), -0.42);
    const double shows = fmax(1, faint);
    const double ease = fmin(t->ease, shows);
    const double axis = zone->lo <= 0 ? t->axis : 1;
    const double bright = zone->skew ? fmax(CLIPPED, fmin(1, faint)) : 1;
    struct glint_zone_aim aim = {
        .sensor_mm =
            bright * axis * fmin(ease * t->sensor_mm, t->faint_sensor_mm),
        .edge_mm = bright * ease * t->edge_mm,
        .energy = ease * t->energy,
        .ease = ease,
        .share = share,
        .thin = {thin[0], thin[1]}};

    aim.hidden = shows * t->sensor_mm / aim.sensor_mm;
    aim.stop = clamp_outline_tolerance(
        &aim, t->stop_least, t->stop,
        glint_zone_aim_compute_stretch(rays, rays->at[RAY_STOP_X],
                                       rays->at[RAY_STOP_Y], -HUGE_VAL));
    return aim;
}

double glint_zone_aim_compute_rms_error(const struct glint_zone_rays *r,
                                        const struct glint_fitted_output *o,
                                        const double *light, int step)
{
    const double *value = r->at[o->kind];
    double sum2 = 0;
    int n = 0;

    for (int i = step / 2; i < r->n; i += step) {
        double x[GLINT_VARIABLES], error;

        if (r->at[RAY_EXCESS][i] > 1.02 || r->at[RAY_FIELD][i] > 1)
            continue;
        glint_zone_rays_get_coordinates(r, i, x);
        error =
            glint_poly_evaluate(o->n_terms, o->power, o->coef, x) - value[i];
        error *= light ? light[i] : 1;
        sum2 += error * error;
        n++;
    }
    return n ? sqrt(sum2 / n) : 0;
}

/* ------------------------------------------------------------------- light */

/* Returns the nearest ray to ray I in the previous row of the same angle and
 * wavelength; -1: no such row. */
static int find_ray_in_previous_row(const struct glint_zone_rays *r, int i)
{
    int row = i, near = -1;

    while (row >= 0 && glint_zone_rays_have_same_light(r, row, i) &&
           r->x[GLINT_V][row] == r->x[GLINT_V][i])
        row--;
    for (int k = row; k >= 0 && glint_zone_rays_have_same_light(r, k, i) &&
                      r->x[GLINT_V][k] == r->x[GLINT_V][row];
         k--)
        if (near < 0 || fabs(r->x[GLINT_U][k] - r->x[GLINT_U][i]) <
                            fabs(r->x[GLINT_U][near] - r->x[GLINT_U][i]))
            near = k;
    return near;
}

/* Returns the area, in the plane of channels C and D, of the parallelogram that
 * rays A and B span at ray I. */
static double compute_parallelogram_area(const double *c, const double *d,
                                         int i, int a, int b)
{
    return fabs((c[a] - c[i]) * (d[b] - d[i]) - (d[a] - d[i]) * (c[b] - c[i]));
}

/* Returns the irradiance at ray I of a round lens, from the sensor positions of
 * its neighbours A and B. */
static double compute_round_irradiance(const struct glint_zone *zone,
                                       const struct glint_zone_rays *r, int i,
                                       int a, int b)
{
    double x[GLINT_VARIABLES], pupil;

    glint_zone_rays_get_coordinates(r, i, x);
    pupil = glint_zone_evaluate_box_polynomial(zone, zone->half_x, x) *
            glint_zone_evaluate_box_polynomial(zone, zone->half_y, x) *
            compute_parallelogram_area(r->x[GLINT_U], r->x[GLINT_V], i, a, b);

    return r->at[RAY_ENERGY][i] * pupil /
           fmax(1e-12, compute_parallelogram_area(
                           r->at[RAY_SENSOR_X], r->at[RAY_SENSOR_Y], i, a, b));
}

/* Returns the relative brightness at ray I of a skew zone, see
 * glint_zone_aim_set_ray_brightness(). */
static double compute_skew_brightness(const struct glint_tolerance *tolerance,
                                      const struct glint_zone *zone,
                                      const struct glint_zone_aim *aim,
                                      const struct glint_zone_rays *r, int i)
{
    double x[GLINT_VARIABLES], level, pupil;

    glint_zone_rays_get_coordinates(r, i, x);
    level = glint_brightness_get_level(tolerance->brightness,
                                       compute_light_sine(zone, x)) *
            aim->share;
    pupil = glint_zone_evaluate_box_polynomial(zone, zone->half_x, x) *
            glint_zone_evaluate_box_polynomial(zone, zone->half_y, x);
    return fmin(
        1, fmax(LEAST_LIGHT, r->at[RAY_ENERGY][i] * pupil /
                                 fmax(1e-30, r->at[RAY_SPREAD][i] * level)));
}

void glint_zone_aim_set_ray_brightness(const struct glint_tolerance *tolerance,
                                       const struct glint_zone *zone,
                                       const struct glint_zone_aim *aim,
                                       const struct glint_zone_rays *rays,
                                       double *light)
{
    for (int i = 0; i < rays->n && zone->skew; i++)
        light[i] = compute_skew_brightness(tolerance, zone, aim, rays, i);
    for (int i = 0; i < rays->n && !zone->skew; i++) {
        const int before = find_ray_in_previous_row(rays, i);
        const int beside =
            i + 1 < rays->n &&
                    glint_zone_rays_have_same_light(rays, i, i + 1) &&
                    rays->x[GLINT_V][i] == rays->x[GLINT_V][i + 1]
                ? i + 1
                : i - 1;
        double x[GLINT_VARIABLES], level;

        glint_zone_rays_get_coordinates(rays, i, x);
        level = glint_brightness_get_level(tolerance->brightness,
                                           compute_light_sine(zone, x)) *
                aim->share;
        light[i] = 1;
        if (before >= 0 && beside != before && beside >= 0 &&
            glint_zone_rays_have_same_light(rays, i, beside))
            light[i] =
                fmin(1, fmax(LEAST_LIGHT, compute_round_irradiance(
                                              zone, rays, i, beside, before) /
                                              fmax(level, 1e-30)));
    }
}
