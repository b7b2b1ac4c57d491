/* SPDX-License-Identifier: MIT */
#include "bake/fit/zone_aim.h"

#include <math.h>

/* Light of a ray below which its errors show no less. */
#define LEAST_LIGHT 1e-3
/* Min factor on the position tolerances of skew zones that are brighter than
 * white: a shift of their outlines shows more by the same factor. */
#define CLIPPED 0.4
/* Min factor on the position tolerance across a streak that is thinner than a
 * pixel: where the streak crosses from one pixel row to the next, all of its
 * light moves. */
#define THIN 0.1

/* The rays of one angle and wavelength: how many are seen, and where they land.
 */
struct sight {
    int n, n_all;
    double low[2], high[2]; /* corners of the area on the sensor on which seen
                               rays land, mm */
    double energy;          /* mean energy of the seen rays */
    double spread;          /* their mean RAY_SPREAD */
};

static struct sight look(const struct glint_zone_rays *r, int first)
{
    struct sight s = {.low = {HUGE_VAL, HUGE_VAL},
                      .high = {-HUGE_VAL, -HUGE_VAL}};

    for (int i = first; i < r->n && glint_zone_rays_alike(r, i, first);
         i++, s.n_all++) {
        if (!glint_zone_rays_seen(r, i))
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

/* Returns the sine of the light's angle at X. */
static double sine_of(const struct glint_zone *zone,
                      const double x[GLINT_VARIABLES])
{
    const double along =
        0.5 * (zone->lo + zone->hi) + 0.5 * x[GLINT_S] * (zone->hi - zone->lo);

    return !zone->skew
               ? along
               : hypot(along, 0.5 * (zone->y_lo + zone->y_hi) +
                                  0.5 * x[GLINT_P] * (zone->y_hi - zone->y_lo));
}

/* Returns the area that the rays of V land on, of a ghost in ZONE, mm^2. */
static double area_on_sensor(const struct glint_zone *zone,
                             const struct sight *v, double blur_mm)
{
    /* The light of a round lens is symmetric in y. */
    const double y = zone->skew ? 0.5 * (v->high[1] - v->low[1] + blur_mm)
                                : fmax(fabs(v->low[1]), fabs(v->high[1]));

    return fmax(1e-9, (v->high[0] - v->low[0] + blur_mm) * 1.6 * y);
}

/* Returns how bright the ghost is in the zone, relative to the level that
 * counts: at its brightest, or of skew zones, which have few rays at each of
 * many directions, in the mean. Of these light spreads over a pixel at least.
 */
static double share_of(const struct glint_tolerance *tolerance,
                       const struct glint_zone *zone,
                       const struct glint_zone_rays *r, double thin[2])
{
    enum { FEW = 4 }; /* this few rays have no area to speak of */
    const double blur = zone->skew ? tolerance->pixel_mm : 0;
    double most = 0, light = 0, area = 0, covered = 0, on_screen[2] = {0},
           n = 0;

    for (int i = 0, next; i < r->n; i = next) {
        const struct sight v = look(r, i);
        const double x[GLINT_VARIABLES] = {0, 0, r->x[GLINT_S][i],
                                           r->x[GLINT_W][i], r->x[GLINT_P][i]};
        const double pupil = 4 * (1 - glint_zone_rim(zone->annulus)) *
                             glint_zone_side(zone, zone->half_x, x) *
                             glint_zone_side(zone, zone->half_y, x) * v.n /
                             v.n_all;
        const double level =
            glint_brightness_at(tolerance->brightness, sine_of(zone, x));
        const double on = area_on_sensor(zone, &v, blur);

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

double glint_zone_aim_stretch(const struct glint_zone_rays *rays,
                              const double *a, const double *b, double near)
{
    double moved2 = 0, change2 = 0;

    for (int i = 1; i < rays->n; i++) {
        const double *x = rays->at[RAY_SENSOR_X], *y = rays->at[RAY_SENSOR_Y];

        if ((rays->x[GLINT_V][i] != rays->x[GLINT_V][i - 1] &&
             !rays->scattered) ||
            !glint_zone_rays_alike(rays, i, i - 1) ||
            !glint_zone_rays_seen(rays, i) ||
            !glint_zone_rays_seen(rays, i - 1) || a[i] < near)
            continue;
        moved2 += (x[i] - x[i - 1]) * (x[i] - x[i - 1]) +
                  (y[i] - y[i - 1]) * (y[i] - y[i - 1]);
        change2 += (a[i] - a[i - 1]) * (a[i] - a[i - 1]);
        if (b)
            change2 += (b[i] - b[i - 1]) * (b[i] - b[i - 1]);
    }
    return change2 > 0 ? sqrt(moved2 / change2) : 0;
}

static double outline(const struct glint_zone_aim *aim, double least,
                      double most, double stretch_mm)
{
    return fmax(least, fmin(most, aim->edge_mm / fmax(1e-12, stretch_mm)));
}

double glint_zone_aim_outline(const struct glint_zone_aim *aim, double least,
                              double most, double stretch_mm)
{
    return outline(aim, least * most, most, stretch_mm);
}

struct glint_zone_aim glint_zone_aim_of(const struct glint_tolerance *tolerance,
                                        const struct glint_zone *zone,
                                        const struct glint_zone_rays *rays)
{
    const struct glint_tolerance *t = tolerance;
    double thin[2];
    const double share = share_of(t, zone, rays, thin);
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
    aim.stop = outline(&aim, t->stop_least, t->stop,
                       glint_zone_aim_stretch(rays, rays->at[RAY_STOP_X],
                                              rays->at[RAY_STOP_Y], -HUGE_VAL));
    return aim;
}

double glint_zone_aim_off(const struct glint_zone_rays *r,
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
        glint_zone_rays_x(r, i, x);
        error = glint_poly_at(o->n_terms, o->power, o->coef, x) - value[i];
        error *= light ? light[i] : 1;
        sum2 += error * error;
        n++;
    }
    return n ? sqrt(sum2 / n) : 0;
}

/* ------------------------------------------------------------------- light */

/* Returns the ray nearest to ray I in the previous row of the same plane, or
 * -1. */
static int ray_before(const struct glint_zone_rays *r, int i)
{
    int row = i, near = -1;

    while (row >= 0 && glint_zone_rays_alike(r, row, i) &&
           r->x[GLINT_V][row] == r->x[GLINT_V][i])
        row--;
    for (int k = row; k >= 0 && glint_zone_rays_alike(r, k, i) &&
                      r->x[GLINT_V][k] == r->x[GLINT_V][row];
         k--)
        if (near < 0 || fabs(r->x[GLINT_U][k] - r->x[GLINT_U][i]) <
                            fabs(r->x[GLINT_U][near] - r->x[GLINT_U][i]))
            near = k;
    return near;
}

/* Returns the area between channels C and D of ray I, A and B. */
static double area_of(const double *c, const double *d, int i, int a, int b)
{
    return fabs((c[a] - c[i]) * (d[b] - d[i]) - (d[a] - d[i]) * (c[b] - c[i]));
}

/* Returns the light of ray I by how far its neighbours A and B, in its plane,
 * land from it. */
static double light_of(const struct glint_zone *zone,
                       const struct glint_zone_rays *r, int i, int a, int b)
{
    double x[GLINT_VARIABLES], pupil;

    glint_zone_rays_x(r, i, x);
    pupil = glint_zone_side(zone, zone->half_x, x) *
            glint_zone_side(zone, zone->half_y, x) *
            area_of(r->x[GLINT_U], r->x[GLINT_V], i, a, b);

    return r->at[RAY_ENERGY][i] * pupil /
           fmax(1e-12,
                area_of(r->at[RAY_SENSOR_X], r->at[RAY_SENSOR_Y], i, a, b));
}

/* Returns the light of ray I of a skew zone, as glint_zone_aim_light(). */
static double light_of_skew(const struct glint_tolerance *tolerance,
                            const struct glint_zone *zone,
                            const struct glint_zone_aim *aim,
                            const struct glint_zone_rays *r, int i)
{
    double x[GLINT_VARIABLES], level, pupil;

    glint_zone_rays_x(r, i, x);
    level = glint_brightness_at(tolerance->brightness, sine_of(zone, x)) *
            aim->share;
    pupil = glint_zone_side(zone, zone->half_x, x) *
            glint_zone_side(zone, zone->half_y, x);
    return fmin(
        1, fmax(LEAST_LIGHT, r->at[RAY_ENERGY][i] * pupil /
                                 fmax(1e-30, r->at[RAY_SPREAD][i] * level)));
}

void glint_zone_aim_light(const struct glint_tolerance *tolerance,
                          const struct glint_zone *zone,
                          const struct glint_zone_aim *aim,
                          const struct glint_zone_rays *rays, double *light)
{
    for (int i = 0; i < rays->n && zone->skew; i++)
        light[i] = light_of_skew(tolerance, zone, aim, rays, i);
    for (int i = 0; i < rays->n && !zone->skew; i++) {
        const int before = ray_before(rays, i);
        const int beside =
            i + 1 < rays->n && glint_zone_rays_alike(rays, i, i + 1) &&
                    rays->x[GLINT_V][i] == rays->x[GLINT_V][i + 1]
                ? i + 1
                : i - 1;
        double x[GLINT_VARIABLES], level;

        glint_zone_rays_x(rays, i, x);
        level = glint_brightness_at(tolerance->brightness, sine_of(zone, x)) *
                aim->share;
        light[i] = 1;
        if (before >= 0 && beside != before && beside >= 0 &&
            glint_zone_rays_alike(rays, i, beside))
            light[i] = fmin(
                1, fmax(LEAST_LIGHT, light_of(zone, rays, i, beside, before) /
                                         fmax(level, 1e-30)));
    }
}
