/* SPDX-License-Identifier: MIT */
#include "bake/fit/critical.h"

#include <math.h>

/* Adds the ray at the zone coordinates X, as stored in glint_zone_rays, to
 * BATCH. */
static void add_stored_ray(struct glint_zone_batch *batch,
                           const struct glint_zone *zone,
                           double x[GLINT_VARIABLES])
{
    const double rim = glint_zone_get_inner_rim(zone->annulus);

    x[GLINT_V] = (x[GLINT_V] - rim) / (1 - rim);
    glint_zone_batch_add_ray(batch, zone, x);
}

/* Returns where ray K of T, whose path is PATH, ends by its angle. */
static struct glint_critical find_end(struct glint_zone_batch *t,
                                      const struct glint_path *path, int k)
{
    double(*const hits)[2] = glint_zone_batch_get_hits(t, k);
    const struct glint_launch *const from = &t->from[k];
    struct glint_path before = *path;
    struct glint_ray ray;
    int event = 0;

    while (event < path->n_events &&
           !(hits[event][0] == -1 && hits[event][1] == -1))
        event++;
    if (t->status[k] == GLINT_RAY_OK || event == 0)
        return (struct glint_critical){.event = -1};
    before.n_events = event;
    return event < path->n_events && t->status[k] == GLINT_RAY_MISSED &&
                   glint_trace(&before, from->x_mm, from->y_mm, from->direction,
                               &ray, NULL) == GLINT_RAY_OK
               ? (struct glint_critical){event, true}
               : (struct glint_critical){event - 1, false};
}

struct glint_critical glint_critical_find(const struct glint_zone *zone,
                                          const struct glint_visible *visible,
                                          const struct glint_zone_rays *rays,
                                          const int *index, int n)
{
    int count[GLINT_MAX_EVENTS + 1][2] = {{0}}, most = 0;
    struct glint_critical best = {.event = -1};
    struct glint_zone_batch t;
    struct glint_path path;
    double x[GLINT_VARIABLES];

    t.path = &path;
    for (int i = 0; i < n; i += t.n) {
        const double w = rays->invalid[GLINT_W][index[i]];

        glint_visible_init_path(visible, w, &path);
        path.places_only = true;
        for (t.n = 0; t.n < GLINT_ZONE_BATCH && i + t.n < n;) {
            glint_zone_rays_get_invalid(rays, index[i + t.n], x);
            if (x[GLINT_W] != w)
                break;
            add_stored_ray(&t, zone, x);
        }
        glint_zone_batch_trace_rays(&t, true);
        for (int k = 0; k < t.n; k++) {
            const struct glint_critical c = find_end(&t, &path, k);

            if (c.event >= 0 && ++count[c.event][c.misses] > most) {
                most = count[c.event][c.misses];
                best = c;
            }
        }
    }
    return best;
}

/* Returns the margin by which a ray passes at the surface of event E, at most
 * 1; below 0 it ends there. A, B: the ray, mm, on the plane through the vertex
 * and on that 1 mm behind it. SIGN: -1 if it runs towards the front, else 1. */
static double compute_margin(const struct glint_event *e, bool misses,
                             const struct glint_ray *a,
                             const struct glint_ray *b, double sign)
{
    const double x = a->sensor_x_mm, y = a->sensor_y_mm;
    const double dx = b->sensor_x_mm - x, dy = b->sensor_y_mm - y;
    const double n = sign / sqrt(1 + dx * dx + dy * dy);
    const double c = e->curvature, ratio = e->n_from / e->n_to;
    const double f = c * (x * x + y * y), g = n - c * n * (x * dx + y * dy);
    const double square = g * g - c * f, cosine = sign * sqrt(fmax(0, square));
    const double normal = 1 - c * n * f / (g + cosine);
    const double out2 = 1 - ratio * ratio * (1 - square);
    const double turn = fmax(0, -sign * ratio * (n - cosine * normal));

    if (misses)
        return square;
    if (square <= 0)
        return fmin(square, out2);
    if (e->kind == GLINT_REFLECT)
        return sign * (2 * cosine * normal - n);
    /* the component along the axis of a refracted ray, which must keep its
     * sign, is sign * (root of out2) * normal - sign * turn */
    return out2 * normal * normal - turn * turn;
}

/* Sets PATH to that of VISIBLE at W up to the plane through the vertex of event
 * EVENT. Returns the sign of the z direction of rays there. */
static double init_path_to_event(const struct glint_visible *visible, double w,
                                 int event, struct glint_path *path)
{
    double sign = 1;

    glint_visible_init_path(visible, w, path);
    for (int k = 0; k < event; k++)
        sign = path->event[k].kind == GLINT_REFLECT ? -sign : sign;
    path->places_only = true;
    path->n_events = event;
    path->to_sensor_mm = path->event[event].advance_mm;
    return sign;
}

static void append_batch(const struct glint_visible *visible,
                         struct glint_zone_batch *t, struct glint_critical c,
                         double sign, struct glint_path *path,
                         struct glint_zone_rays *out)
{
    const double stop = visible->setup->optics.stop_radius_mm;
    struct glint_ray at_vertex[GLINT_ZONE_BATCH];

    glint_zone_batch_trace_rays(t, false);
    for (int k = 0; k < t->n; k++)
        at_vertex[k] = t->ray[k];
    path->to_sensor_mm += 1;
    glint_zone_batch_trace_rays(t, false);
    path->to_sensor_mm -= 1;
    for (int k = 0; k < t->n; k++) {
        const struct glint_ray *const a = &at_vertex[k];
        const int i = out->n;
        double margin;

        if (t->status[k] != GLINT_RAY_OK || i == GLINT_ZONE_RAYS)
            continue;
        for (int v = 0; v < GLINT_VARIABLES; v++)
            out->x[v][i] = t->x[k][v];
        out->at[RAY_EXCESS][i] =
            fmax(a->rel_radius, hypot(a->stop_x_mm, a->stop_y_mm) / stop);
        margin = compute_margin(&path->event[c.event], c.misses, a, &t->ray[k],
                                sign);
        out->radius[0][i] = sqrt(fmax(0, 1 - margin));
        out->n++;
    }
}

void glint_critical_trace_rays(const struct glint_zone *zone,
                               const struct glint_visible *visible,
                               const struct glint_zone_rays *rays,
                               struct glint_critical c,
                               struct glint_zone_rays *out)
{
    const int n = rays->n + rays->n_invalid;
    const int step = 1 + (n - 1) / GLINT_ZONE_RAYS;
    struct glint_path path;
    struct glint_zone_batch t;

    t.path = &path;
    out->n = 0;
    for (int i = 0; i < n; i += t.n * step) {
        double x[GLINT_VARIABLES], s = 0, w = 0, sign = 1;

        for (t.n = 0; t.n < GLINT_ZONE_BATCH && i + t.n * step < n;) {
            const int k = i + t.n * step;

            if (k < rays->n)
                glint_zone_rays_get_coordinates(rays, k, x);
            else
                glint_zone_rays_get_invalid(rays, k - rays->n, x);
            if (t.n == 0)
                sign =
                    init_path_to_event(visible, w = x[GLINT_W], c.event, &path);
            if (t.n > 0 && (x[GLINT_W] != w || x[GLINT_S] != s))
                break;
            s = x[GLINT_S];
            add_stored_ray(&t, zone, x);
        }
        append_batch(visible, &t, c, sign, &path, out);
    }
}
