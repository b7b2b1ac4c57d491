/* SPDX-License-Identifier: MIT
 *
 * Chooses the barrels that cut in a zone: those that let no ray get far past
 * any other barrel. */
#include <math.h>

#include "bake/fit/zone_batch.h"
#include "bake/fit/zone_rays.h"

/* Samples of a zone: the relative radius of each ray at each barrel. */
struct sampling {
    int n, n_events;
    double (*radius)[GLINT_MAX_EVENTS + 1];
};

/* Notes the relative radius of a ray at every event. Returns whether the ray
 * counts: stop and field let it pass, so that only barrels can stop it, and one
 * does. */
static bool sample_ray(const struct glint_visible *h,
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
                                      glint_zone_batch_hits(&t, i),
                                      sampling->radius[sampling->n]);
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
        most = fmax(most, r[k] - 1);
    return fmin(most, 0.3);
}

/* Returns the sum of the escapes of all rays past N CHOSEN barrels; *MOST
 * receives the largest. */
static double escapes(const struct sampling *s, int *chosen, int n,
                      double *most)
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

/* Chooses barrels, the most useful first, until no ray gets farther than SHOWS
 * past one that was not chosen. */
static void choose_barrels(const struct sampling *s, double shows,
                           struct glint_zone_rays *rays)
{
    double most;

    rays->n_barrels = 0;
    escapes(s, rays->barrel, 0, &most);
    while (most > shows && rays->n_barrels < GLINT_MAX_BARRELS) {
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

void glint_zone_choose_barrels(const struct glint_zone *zone,
                               const struct glint_visible *visible,
                               double shows, glint_zone_sampling *sampling,
                               struct glint_zone_rays *rays)
{
    struct sampling s = {.radius = *sampling};

    sample_rays(zone, visible, &s);
    choose_barrels(&s, shows, rays);
}
