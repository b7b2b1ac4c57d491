/* SPDX-License-Identifier: MIT
 *
 * Chooses the barrels that cut in a zone: those that let no ray get far past
 * any other barrel. */
#include <math.h>

#include "bake/fit/zone_rays.h"

/* Relative radius: of a barrel at which rays differ by less, what gets past it
 * counts as if they differed by so much. All of a ghost lies within 0.003 of a
 * half sphere's rim where light of a fisheye grazes that. */
#define LEAST_RANGE 0.1

/* Relative radius of a ray where it misses a surface. */
#define MISS 1.3

/* Samples of a zone: the relative radius of each ray at each barrel. */
struct sampling {
    int n, n_events;
    bool lost[GLINT_SAMPLING_RAYS]; /* whether a ray misses a surface, so that
                                       nobody knows if the stop lets it pass */
    double (*radius)[GLINT_MAX_EVENTS + 1];
    /* Range of the relative radii of rays that stop and field let pass. */
    double low[GLINT_MAX_EVENTS + 1], high[GLINT_MAX_EVENTS + 1];
    double factor[GLINT_MAX_EVENTS + 1]; /* on what gets past each barrel */
};

/* Returns whether an event is one that no ray has reached. */
static bool is_unreached(const double hit[2])
{
    return hit[0] == -1 && hit[1] == -1;
}

/* Notes that a ray misses the first surface that it has no hit at: it passes by
 * MISS at least outside of that. Returns the radius. */
static double note_missed(double *radius, double (*hits)[2], int n_events)
{
    int k = 0;

    while (k < n_events && !is_unreached(hits[k]))
        k++;
    if (k < n_events)
        radius[k] = MISS;
    return k < n_events ? MISS : 0;
}

/* Widens the ranges of S by RADIUS. */
static void note_range(struct sampling *s, const double *radius)
{
    for (int k = 0; k < s->n_events; k++) {
        s->low[k] = fmin(s->low[k], radius[k]);
        s->high[k] = fmax(s->high[k], radius[k]);
    }
}

/* Notes the relative radius of a ray at every event. Returns whether the ray
 * counts: stop and field let it pass, so that only barrels can stop it, and one
 * does. */
static bool sample_ray(const struct glint_visible *h,
                       const struct glint_path *path,
                       enum glint_ray_status status,
                       const struct glint_ray *ray, double (*hits)[2],
                       struct sampling *sampling)
{
    double *const radius = sampling->radius[sampling->n];
    const double stop = h->setup->optics.stop_radius_mm;
    double most = 0;

    for (int k = 0; k < path->n_events; k++) {
        const struct glint_event *e = &path->event[k];
        const double r = hypot(hits[k][0], hits[k][1]);

        radius[k] =
            e->kind == GLINT_STOP || is_unreached(hits[k]) ? 0 : r / e->semi_mm;
        most = fmax(most, radius[k]);
    }
    sampling->lost[sampling->n] = status != GLINT_RAY_OK;
    if (status == GLINT_RAY_MISSED && h->far)
        most = fmax(most, note_missed(radius, hits, path->n_events));
    if (status != GLINT_RAY_OK)
        return most > 1;
    if (hypot(ray->stop_x_mm, ray->stop_y_mm) >= 1.02 * stop ||
        hypot(ray->sensor_x_mm, ray->sensor_y_mm) >= h->field_mm)
        return false;
    note_range(sampling, radius);
    return most > 1;
}

/* Samples rays at scattered angles, as a barrel may cut in a narrow range of
 * angles only. */
static void sample_rays(const struct glint_zone *z,
                        const struct glint_visible *visible,
                        struct sampling *sampling)
{
    /* Zones of two components of the direction are many, and rays of shaped
     * lenses take long. */
    const int n = GLINT_SAMPLING_RAYS / (z->skew ? 2 : visible->shaped ? 3 : 1);
    struct glint_zone_batch t;

    sampling->n = 0;
    sampling->n_events = visible->path[0].n_events;
    for (int k = 0; k < sampling->n_events; k++) {
        sampling->low[k] = HUGE_VAL;
        sampling->high[k] = 0;
    }
    for (int k = 0; k < n / GLINT_ZONE_BATCH; k++) {
        const int members = 1 + visible->n_beside;
        const struct glint_visible *const h =
            glint_visible_member(visible, k % members);
        const int wave =
            glint_visible_colour[k / members % GLINT_VISIBLE_COLOURS];
        double x[GLINT_VARIABLES];

        t.path = &h->position_path[wave];
        for (t.n = 0; t.n < GLINT_ZONE_BATCH;) {
            glint_zone_scatter(z, k * GLINT_ZONE_BATCH + t.n, x);
            x[3] = glint_zone_node(wave, GLINT_VISIBLE_WAVES);
            glint_zone_batch_add(&t, z, x);
        }
        glint_zone_batch_trace(&t);
        for (int i = 0; i < GLINT_ZONE_BATCH; i++)
            sampling->n += sample_ray(h, t.path, t.status[i], &t.ray[i],
                                      glint_zone_batch_hits(&t, i), sampling);
    }
    for (int k = 0; k < sampling->n_events; k++) {
        const double range = sampling->high[k] - sampling->low[k];

        sampling->factor[k] = visible->far && range > 0 && range < LEAST_RANGE
                                  ? LEAST_RANGE / range
                                  : 1;
    }
}

/* Returns how far ray RAY gets past the barrels that are not among the N
 * CHOSEN: relative radius beyond 1; 0 if a chosen one stops it. */
static double escape(const struct sampling *s, int ray, const int *chosen,
                     int n)
{
    const double *r = s->radius[ray];
    double most = 0;

    for (int k = 0; k < n; k++)
        if (r[chosen[k]] > 1)
            return 0;
    for (int k = 0; k < s->n_events; k++)
        most = fmax(most, s->factor[k] * (r[k] - 1));
    return fmin(most, 0.3);
}

/* Returns the sum of the escapes of all rays past N CHOSEN barrels; *MOST
 * receives the largest. */
static double escapes(const struct sampling *s, bool lost, const int *chosen,
                      int n, double *most)
{
    double sum = 0;

    *most = 0;
    for (int i = 0; i < s->n; i++) {
        const double e = !lost && s->lost[i] ? 0 : escape(s, i, chosen, n);

        sum += e;
        *most = fmax(*most, e);
    }
    return sum;
}

/* Adds barrels, the most useful first, until no ray, or none but LOST ones,
 * gets farther than SHOWS past one that was not chosen. */
static void choose_barrels(const struct sampling *s, bool lost, double shows,
                           struct glint_zone_rays *rays)
{
    double most;

    escapes(s, lost, rays->barrel, rays->n_barrels, &most);
    while (most > shows && rays->n_barrels < GLINT_MAX_BARRELS) {
        const int n = rays->n_barrels;
        double least = HUGE_VAL;
        int best = 0;

        for (int k = 0; k < s->n_events; k++) {
            double sum;

            rays->barrel[n] = k;
            sum = escapes(s, lost, rays->barrel, n + 1, &most);
            if (sum < least) {
                least = sum;
                best = k;
            }
        }
        rays->barrel[n] = best;
        rays->n_barrels++;
        escapes(s, lost, rays->barrel, n + 1, &most);
    }
    rays->missed_cut = most;
}

void glint_zone_choose_barrels(const struct glint_zone *zone,
                               const struct glint_visible *visible,
                               double shows, glint_zone_sampling *sampling,
                               struct glint_zone_rays *rays)
{
    struct sampling s = {.radius = *sampling};

    sample_rays(zone, visible, &s);
    rays->n_barrels = 0;
    if (visible->far)
        choose_barrels(&s, false, shows, rays);
    choose_barrels(&s, true, shows, rays);
}
