/* SPDX-License-Identifier: MIT */
#include "bake/zone.h"

#include <math.h>

#include "bake/degrees.h"
#include "base/compiler.h"

/* -------------------------------------------------------------------- boxes */

double glint_zone_node(int k, int n)
{
    return n == 1 ? 0 : -cos(GLINT_PI * k / (n - 1));
}

double glint_zone_at(const double poly[GLINT_BOX_TERMS], double s)
{
    double value = 0;

    for (int k = GLINT_BOX_TERMS - 1; k >= 0; k--)
        value = value * s + poly[k];
    return value;
}

/* Coefficients of the polynomial of at most DEGREE in s that follows N values
 * within TOLERANCE, or as well as it can. */
static void follow(int n, const double *s, const double *value, int degree,
                   double tolerance, double poly[GLINT_BOX_TERMS])
{
    static const double zero[GLINT_PROFILE];
    double scratch[GLINT_PROFILE * (GLINT_MAX_CANDIDATES + 1)];
    double weight[GLINT_PROFILE];
    const struct glint_samples samples = {n, {zero, zero, s, zero}, weight};
    const struct glint_degrees degrees = {.most = {0, 0, (uint8_t)degree, 0},
                                          .weight = {1, 1, 1, 1},
                                          .total = degree,
                                          .parity = -1,
                                          .terms = degree + 1};
    struct glint_poly fit;

    for (int i = 0; i < n; i++)
        weight[i] = 1;
    for (int k = 0; k < GLINT_BOX_TERMS; k++)
        poly[k] = 0;
    glint_regress_fit(scratch, &samples, value, &degrees, tolerance,
                      4 * tolerance, &fit);
    for (int k = 0; k < fit.n; k++)
        poly[fit.power[k][2]] = fit.coef[k];
}

/* Widens the box until it holds all that was found, and a hundredth more. */
static void widen(struct glint_zone *z, int n, const double *s,
                  const struct glint_pupil *p)
{
    double more_x = 0, more_y = 0, lowest_x = HUGE_VAL, lowest_y = HUGE_VAL;

    for (int i = 0; i < n; i++) {
        const double x = glint_zone_at(z->middle, s[i]);
        const double hx = glint_zone_at(z->half_x, s[i]);

        more_x = fmax(more_x, fmax(p[i].x1_mm - x, x - p[i].x0_mm) - hx);
        more_y = fmax(more_y, p[i].y1_mm - glint_zone_at(z->half_y, s[i]));
    }
    z->half_x[0] += more_x;
    z->half_y[0] += more_y;
    for (int k = -8; k <= 8; k++) {
        lowest_x = fmin(lowest_x, glint_zone_at(z->half_x, k / 8.0));
        lowest_y = fmin(lowest_y, glint_zone_at(z->half_y, k / 8.0));
    }
    z->half_x[0] += fmax(0.01 * z->half_x[0], -1.1 * lowest_x);
    z->half_y[0] += fmax(0.01 * z->half_y[0], -1.1 * lowest_y);
}

static double mean_fill(const struct glint_zone *z, int n, const double *s,
                        const struct glint_pupil *p)
{
    double sum = 0;

    for (int i = 0; i < n; i++)
        sum += (p[i].x1_mm - p[i].x0_mm) * p[i].y1_mm /
               (2 * glint_zone_at(z->half_x, s[i]) *
                glint_zone_at(z->half_y, s[i]));
    return sum / n;
}

static double smallest(int n, const double *value)
{
    double least = HUGE_VAL;

    for (int i = 0; i < n; i++)
        least = fmin(least, value[i]);
    return least;
}

void glint_zone_init(struct glint_zone *zone,
                     const struct glint_profile *profile, double lo, double hi)
{
    double s[GLINT_PROFILE] = {0}, middle[GLINT_PROFILE] = {0};
    double half_x[GLINT_PROFILE] = {0}, half_y[GLINT_PROFILE] = {0};
    struct glint_pupil box[GLINT_PROFILE];
    int n = 0, first = 0, last = profile->n - 1, degree;

    /* one beyond each end, so that the ends are covered */
    while (first + 1 < last && profile->sine[first + 1] <= lo)
        first++;
    while (last - 1 > first && profile->sine[last - 1] >= hi)
        last--;
    for (int k = first; k <= last; k++) { /* at least once */
        const struct glint_pupil *b = &profile->box[k];

        s[n] = (2 * profile->sine[k] - lo - hi) / (hi - lo);
        middle[n] = 0.5 * (b->x0_mm + b->x1_mm);
        half_x[n] = 0.5 * (b->x1_mm - b->x0_mm);
        half_y[n] = b->y1_mm;
        box[n++] = *b;
    }
    *zone = (struct glint_zone){.lo = lo, .hi = hi};
    degree = n > 12 ? GLINT_BOX_TERMS - 1 : (n - 1) / 2;
    follow(n, s, middle, degree, 0.02 * smallest(n, half_x), zone->middle);
    degree = degree < 2 ? degree : 2;
    follow(n, s, half_x, degree, 0.02 * smallest(n, half_x), zone->half_x);
    follow(n, s, half_y, degree, 0.02 * smallest(n, half_y), zone->half_y);
    widen(zone, n, s, box);
    zone->fill = mean_fill(zone, n, s, box);
}

/* ------------------------------------------------------------------ barrels */

enum { SURVEY_S = 9, SURVEY_U = 32, SURVEY_V = 16 };
STATIC_ASSERT(GLINT_SURVEY_RAYS == SURVEY_S * (SURVEY_U + 1) * (SURVEY_V + 1));

/* What a ray of the survey says: how far past each barrel it is. */
struct survey {
    int n, n_events;
    double (*radius)[GLINT_MAX_EVENTS + 1];
};

static void direction_of(const struct glint_zone *z, double s, double d[3])
{
    d[0] = 0.5 * (z->lo + z->hi) + 0.5 * s * (z->hi - z->lo);
    d[1] = 0;
    d[2] = sqrt(1 - d[0] * d[0]);
}

/* Traces one ray of the zone; HITS of events it did not reach are -1, -1. */
static enum glint_ray_status ray_of(const struct glint_zone *z,
                                    const struct glint_path *path, double u,
                                    double v, double s, struct glint_ray *ray,
                                    double (*hits)[2])
{
    double d[3];

    direction_of(z, s, d);
    for (int k = 0; k < path->n_events; k++)
        hits[k][0] = hits[k][1] = -1;
    return glint_trace(
        path, glint_zone_at(z->middle, s) + u * glint_zone_at(z->half_x, s),
        v * glint_zone_at(z->half_y, s), d, ray, hits);
}

/* Notes the ray's radius at every event if the stop and the field let it pass,
 * so that only barrels can stop it. */
static bool survey_ray(const struct glint_hunt *h,
                       const struct glint_path *path,
                       enum glint_ray_status status,
                       const struct glint_ray *ray, double (*hits)[2],
                       double *radius)
{
    const double stop = h->setup->optics.stop_radius_mm;
    double most = 0;

    for (int k = 0; k < path->n_events; k++) {
        const struct glint_event *e = &path->event[k];
        const double r = hypot(hits[k][0], hits[k][1]);

        radius[k] =
            e->kind == GLINT_STOP || (hits[k][0] == -1 && hits[k][1] == -1)
                ? 0
                : r / e->semi_mm;
        most = fmax(most, radius[k]);
    }
    if (most <= 1)
        return false;
    return status != GLINT_RAY_OK ||
           (hypot(ray->stop_x_mm, ray->stop_y_mm) < 1.02 * stop &&
            hypot(ray->sensor_x_mm, ray->sensor_y_mm) < h->field_mm);
}

static void run_survey(const struct glint_zone *z, const struct glint_hunt *h,
                       struct survey *survey)
{
    const struct glint_path *path = &h->path[GLINT_HUNT_WAVES / 2];
    double hits[GLINT_MAX_EVENTS + 1][2];

    survey->n = 0;
    survey->n_events = path->n_events;
    for (int k = 0; k < GLINT_SURVEY_RAYS; k++) {
        const int i = k % (SURVEY_U + 1);
        const int j = k / (SURVEY_U + 1) % (SURVEY_V + 1);
        const int m = k / (SURVEY_U + 1) / (SURVEY_V + 1);
        struct glint_ray ray;
        const enum glint_ray_status status =
            ray_of(z, path, 2.0 * i / SURVEY_U - 1, (double)j / SURVEY_V,
                   glint_zone_node(m, SURVEY_S), &ray, hits);

        survey->n +=
            survey_ray(h, path, status, &ray, hits, survey->radius[survey->n]);
    }
}

/* How far ray RAY gets past the barrels that are not among the N CHOSEN, the
 * relative radius beyond 1; 0 if one of them stops it. */
static double escape(const struct survey *s, int ray, const int *chosen, int n)
{
    const double *r = s->radius[ray];
    double most = 0;

    for (int k = 0; k < n; k++)
        if (r[chosen[k]] > 1)
            return 0;
    for (int k = 0; k < s->n_events; k++)
        most = fmax(most, r[k] - 1);
    return fmin(most, 0.3);
}

/* What escapes with barrel K as the last of N: sum, and the largest. */
static double escapes(const struct survey *s, int *chosen, int n, double *most)
{
    double sum = 0;

    *most = 0;
    for (int i = 0; i < s->n; i++) {
        const double e = escape(s, i, chosen, n);

        sum += e;
        *most = fmax(*most, e);
    }
    return sum;
}

/* Takes barrels, the most useful first, until what escapes does not show. */
static void choose_barrels(const struct survey *s, struct glint_rays *rays)
{
    double most;

    rays->n_barrels = 0;
    escapes(s, rays->barrel, 0, &most);
    while (most > 1e-3 && rays->n_barrels < GLINT_MAX_BARRELS) {
        const int n = rays->n_barrels;
        double least = HUGE_VAL;
        int best = 0;

        for (int k = 0; k < s->n_events; k++) {
            double sum;

            rays->barrel[n] = k;
            sum = escapes(s, rays->barrel, n + 1, &most);
            if (sum < least) {
                least = sum;
                best = k;
            }
        }
        rays->barrel[n] = best;
        rays->n_barrels++;
        escapes(s, rays->barrel, n + 1, &most);
    }
    rays->missed_cut = most;
}

/* ------------------------------------------------------------------ samples */

static void add_ray(const struct glint_hunt *h, const struct glint_path *path,
                    const double x[GLINT_VARIABLES],
                    const struct glint_ray *ray, double (*hits)[2],
                    struct glint_rays *rays)
{
    const double stop = h->setup->optics.stop_radius_mm;
    const int i = rays->n++;

    for (int k = 0; k < GLINT_VARIABLES; k++)
        rays->x[k][i] = x[k];
    rays->at[RAY_SENSOR_X][i] = ray->sensor_x_mm;
    rays->at[RAY_SENSOR_Y][i] = ray->sensor_y_mm;
    rays->at[RAY_STOP_X][i] = ray->stop_x_mm / stop;
    rays->at[RAY_STOP_Y][i] = ray->stop_y_mm / stop;
    rays->at[RAY_ENERGY][i] = ray->energy;
    rays->at[RAY_EXCESS][i] =
        fmax(ray->rel_radius, hypot(ray->stop_x_mm, ray->stop_y_mm) / stop);
    rays->at[RAY_FIELD][i] =
        hypot(ray->sensor_x_mm, ray->sensor_y_mm) / h->field_mm;
    for (int k = 0; k < rays->n_barrels; k++) {
        const int e = rays->barrel[k];

        rays->radius[k][i] =
            hypot(hits[e][0], hits[e][1]) / path->event[e].semi_mm;
    }
}

/* More nodes than powers in every variable, or a fit would be perfect at the
 * nodes and nowhere else. */
enum { SINES = 9, ACROSS = 24, DOWN = 12 };

/* Rays at one angle and wavelength. Every third of those far outside of what is
 * seen is enough. */
static void trace_plane(const struct glint_zone *zone,
                        const struct glint_hunt *hunt, int sine, int wave,
                        int stride, struct glint_rays *rays)
{
    const int full = rays->n + GLINT_ZONE_RAYS / (4 * SINES);
    const struct glint_path *path = &hunt->path[wave];
    double hits[GLINT_MAX_EVENTS + 1][2];

    for (int j = 0; j <= DOWN; j += stride)
        for (int i = 0; i <= ACROSS && rays->n < full; i += stride) {
            const double x[GLINT_VARIABLES] = {
                glint_zone_node(i, ACROSS + 1), sin(0.5 * GLINT_PI * j / DOWN),
                glint_zone_node(sine, SINES),
                glint_zone_node(wave, GLINT_HUNT_WAVES)};
            struct glint_ray ray;

            if (ray_of(zone, path, x[0], x[1], x[2], &ray, hits) !=
                GLINT_RAY_OK)
                continue;
            add_ray(hunt, path, x, &ray, hits, rays);
            if (stride == 1 && (i + j) % 3 &&
                fmax(rays->at[RAY_EXCESS][rays->n - 1],
                     rays->at[RAY_FIELD][rays->n - 1]) > 1.1)
                rays->n--;
        }
}

static int count_visible(const struct glint_rays *rays)
{
    int n = 0;

    for (int i = 0; i < rays->n; i++)
        n += rays->at[RAY_EXCESS][i] <= 1 && rays->at[RAY_FIELD][i] <= 1;
    return n;
}

/* Positions are tame in w: four wavelengths at each angle, in turn, are enough.
 * A coarse grid first; a fine one where few of its rays got through.
 */
static void trace_positions(const struct glint_zone *zone,
                            const struct glint_hunt *hunt,
                            struct glint_rays *rays)
{
    static const int shift[] = {0, 3, 5, 8};

    for (int stride = 2; stride > 0; stride--) {
        rays->n = 0;
        for (int k = 0; k < 4 * SINES; k++)
            trace_plane(zone, hunt, k / 4,
                        (k / 4 + shift[k % 4]) % GLINT_HUNT_WAVES, stride,
                        rays);
        if (count_visible(rays) > 500)
            break;
    }
}

/* Energy hardly changes over the pupil, but films make it swing with the
 * wavelength. */
static void trace_energies(const struct glint_zone *zone,
                           const struct glint_hunt *hunt,
                           struct glint_rays *rays)
{
    enum { STRIDE = 4 };

    rays->n = 0;
    for (int k = 0; k < SINES * GLINT_HUNT_WAVES; k++)
        trace_plane(zone, hunt, k / GLINT_HUNT_WAVES, k % GLINT_HUNT_WAVES,
                    STRIDE, rays);
}

void glint_zone_trace(const struct glint_zone *zone,
                      const struct glint_hunt *hunt, glint_zone_survey *survey,
                      struct glint_rays *rays, struct glint_rays *energies)
{
    struct survey s = {.radius = *survey};

    run_survey(zone, hunt, &s);
    choose_barrels(&s, rays);
    trace_positions(zone, hunt, rays);
    energies->n_barrels = 0;
    trace_energies(zone, hunt, energies);
}

/* Low-discrepancy numbers -1 .. 1: multiples of powers of the root of
 * x^5 = x + 1, which fill four dimensions evenly. */
static void between(int k, double x[GLINT_VARIABLES])
{
    const double root = 1.16730397826141868426;
    double step = 1;

    for (int i = 0; i < GLINT_VARIABLES; i++) {
        step /= root;
        x[i] = 2 * fmod(0.5 + (k + 1) * step, 1) - 1;
    }
}

void glint_zone_check(const struct glint_zone *zone,
                      const struct glint_hunt *hunt, struct glint_rays *rays)
{
    enum { BUNDLES = 24, RAYS = 16 };
    double hits[GLINT_MAX_EVENTS + 1][2];
    double x[GLINT_VARIABLES], bundle[GLINT_VARIABLES];
    struct glint_path path;

    rays->n = rays->n_barrels = 0;
    for (int k = 0; k < BUNDLES * RAYS; k++) {
        struct glint_ray ray;

        between(k, x);
        if (k % RAYS == 0) {
            between(k / RAYS, bundle);
            glint_hunt_path(hunt, bundle[3], &path);
        }
        x[1] = fabs(x[1]);
        x[2] = bundle[2];
        x[3] = bundle[3];
        if (ray_of(zone, &path, x[0], x[1], x[2], &ray, hits) == GLINT_RAY_OK)
            add_ray(hunt, &path, x, &ray, hits, rays);
    }
}
