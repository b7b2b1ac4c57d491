/* SPDX-License-Identifier: MIT
 *
 * Exact sequential rays: path, start -> stop, sensor, energy, relative radius.
 *
 * Every intersection is worked out about the vertex plane of its surface,
 * where nothing cancels however large the radius: with the curvature c, the
 * point (X, Y) where the ray meets that plane and its direction (l, m, n),
 *
 *     F = c (X^2 + Y^2),  G = n - c (X l + Y m),  W = +-sqrt(G^2 - c F),
 *     t = F / (G + W), the sign of W that of n.
 *
 * W is also the cosine between ray and normal. A plane is c = 0. Planes, huge
 * and small radii keep about 1e-14 of the coordinates. [Hullin11] section 4
 */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "bake/coating.h"
#include "bake/prescription.h"

static const double pi = 3.14159265358979323846;

/* ------------------------------------------------------------------- paths */

/* What a path is made from, and how far it has come. */
struct route {
    const struct glint_prescription *lens;
    struct glint_path *path;
    double wavelength_nm;
    int at; /* last element, -1: none yet */
};

/* Indices in front of surface K and behind it. */
static void media_of(const struct route *route, int k, double *front,
                     double *behind)
{
    const struct glint_surface *s = &route->lens->surface[k];

    *front = k ? glint_index(s[-1].nd, s[-1].vd, route->wavelength_nm) : 1.0;
    *behind = glint_index(s->nd, s->vd, route->wavelength_nm);
}

/* z from the last event to element E, a neighbour. */
static double step_mm(const struct route *route, int e)
{
    if (route->at < 0) /* from the vertex plane of the first surface */
        return route->lens->stop_after == 0 ? -element_gap_mm(route->lens, 0)
                                            : 0.0;
    return e > route->at ? element_gap_mm(route->lens, route->at)
                         : -element_gap_mm(route->lens, e);
}

/* Appends the meeting with element E; FORWARD is the way it is met. */
static void append(struct route *route, int e, enum glint_event_kind kind,
                   bool forward)
{
    const int k = element_surface(route->lens, e);
    struct glint_event *event = &route->path->event[route->path->n_events++];

    memset(event, 0, sizeof(*event));
    event->kind = k < 0 ? GLINT_STOP : kind;
    event->surface = k;
    event->curvature = element_curvature(route->lens, e);
    event->advance_mm = step_mm(route, e);
    event->semi_mm = element_semi_mm(route->lens, e);
    event->n_from = event->n_to = 1.0;
    route->at = e;
    if (k < 0)
        return;
    media_of(route, k, forward ? &event->n_from : &event->n_to,
             forward ? &event->n_to : &event->n_from);
    if (route->lens->surface[k].coating_nm > 0.0) {
        event->film_n = route->lens->surface[k].coating_n;
        /* A quarter wave thick: 4 pi n d / wavelength, n d = design / 4. */
        event->film_phase =
            pi * route->lens->surface[k].coating_nm / route->wavelength_nm;
    }
}

void glint_path_init(struct glint_path *path,
                     const struct glint_prescription *lens,
                     const struct glint_ghost *ghost, double wavelength_nm)
{
    struct route route = {lens, path, wavelength_nm, -1};
    const int n = element_count(lens);
    int e = 0;

    path->n_events = 0;
    path->places_only = false;
    if (ghost && ghost->i >= 0) {
        const int near = surface_element(lens, ghost->i);
        const int far = surface_element(lens, ghost->j);

        for (; e < far; e++)
            append(&route, e, GLINT_REFRACT, true);
        append(&route, far, GLINT_REFLECT, true);
        for (e = far - 1; e > near; e--)
            append(&route, e, GLINT_REFRACT, false);
        append(&route, near, GLINT_REFLECT, false);
        e = near + 1;
    }
    for (; e < n; e++)
        append(&route, e, GLINT_REFRACT, true);
    path->to_sensor_mm = element_gap_mm(lens, n - 1);
}

/* -------------------------------------------------------------------- rays */

struct beam {
    double x, y, z; /* mm, from the vertex of the last event */
    double l, m, n; /* direction, unit length */
    double energy;
};

/* Goes straight on to the plane ADVANCE away. */
static inline void go(struct beam *b, double advance_mm)
{
    const double s = (advance_mm - b->z) / b->n;

    b->x += s * b->l;
    b->y += s * b->m;
    b->z = 0.0;
}

/* Goes from the vertex plane to the surface; COSINE is between the ray and the
 * normal (-c x, -c y, 1 - c z) there. False: it misses. Comparisons are such
 * that a NaN misses. */
static inline bool meet(struct beam *b, double c, double *cosine)
{
    const double f = c * (b->x * b->x + b->y * b->y);
    const double g = b->n - c * (b->x * b->l + b->y * b->m);
    const double square = g * g - c * f;
    double t;

    if (!(square > 0.0))
        return false;
    *cosine = b->n < 0.0 ? -sqrt(square) : sqrt(square);
    t = f / (g + *cosine);
    b->x += t * b->l;
    b->y += t * b->m;
    b->z = t * b->n;
    return 1.0 - c * b->z > 0.0;
}

/* Adds K times the normal to S times the direction. */
static inline void turn(struct beam *b, double c, double s, double k)
{
    b->l = s * b->l - k * c * b->x;
    b->m = s * b->m - k * c * b->y;
    b->n = s * b->n + k * (1.0 - c * b->z);
}

static inline double reflectance(const struct glint_event *e, double cos_in,
                                 double cos_out)
{
    return e->film_n > 0.0
               ? film_reflectance(e->n_from, cos_in, e->n_to, cos_out,
                                  e->film_n, e->film_phase)
               : bare_reflectance(e->n_from, cos_in, e->n_to, cos_out);
}

/* Bends or mirrors the ray, which meets the surface of E at COSINE. */
static inline enum glint_ray_status
cross(struct beam *b, const struct glint_event *e, double cosine, bool energies)
{
    const double ratio = e->n_from / e->n_to;
    const double out2 = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    const double out = out2 > 0.0 ? sqrt(out2) : 0.0;
    const double part =
        energies && out > 0.0 ? reflectance(e, fabs(cosine), out) : 1.0;
    const double n = b->n;

    if (e->kind == GLINT_REFLECT) {
        b->energy *= part;
        turn(b, e->curvature, 1.0, -2.0 * cosine);
        return n * b->n < 0.0 ? GLINT_RAY_OK : GLINT_RAY_MISSED;
    }
    if (!(out > 0.0))
        return GLINT_RAY_TOTAL_REFLECTION;
    b->energy *= energies ? 1.0 - part : 1.0;
    turn(b, e->curvature, ratio, (n < 0.0 ? -out : out) - ratio * cosine);
    return n * b->n > 0.0 ? GLINT_RAY_OK : GLINT_RAY_MISSED;
}

/* The largest of height / semi-diameter so far, squared and undivided. */
struct largest {
    double height2, semi2;
};

static inline void widen(struct largest *max, const struct beam *b,
                         double semi_mm)
{
    const double height2 = b->x * b->x + b->y * b->y;
    const double semi2 = semi_mm * semi_mm;

    if (height2 * max->semi2 > max->height2 * semi2) {
        max->height2 = height2;
        max->semi2 = semi2;
    }
}

static inline enum glint_ray_status trace(const struct glint_path *path,
                                          double px_mm, double py_mm,
                                          const double direction[3],
                                          bool energies, struct glint_ray *ray,
                                          double (*hits)[2])
{
    struct beam b = {px_mm,        py_mm,        0.0, direction[0],
                     direction[1], direction[2], 1.0};
    struct largest max = {0.0, 1.0};
    double stop_x = 0.0, stop_y = 0.0, cosine;

    if (!(b.n > 0.0))
        return GLINT_RAY_MISSED;
    for (int i = 0; i < path->n_events; i++) {
        const struct glint_event *e = &path->event[i];
        enum glint_ray_status status = GLINT_RAY_OK;

        go(&b, e->advance_mm);
        if (e->kind == GLINT_STOP) {
            stop_x = b.x;
            stop_y = b.y;
        } else {
            if (!meet(&b, e->curvature, &cosine))
                return GLINT_RAY_MISSED;
            widen(&max, &b, e->semi_mm);
            status = cross(&b, e, cosine, energies);
        }
        if (hits) {
            hits[i][0] = b.x;
            hits[i][1] = b.y;
        }
        if (status != GLINT_RAY_OK)
            return status;
    }
    go(&b, path->to_sensor_mm);
    if (!isfinite(b.x) || !isfinite(b.y)) /* ran all but along the sensor */
        return GLINT_RAY_MISSED;
    *ray = (struct glint_ray){stop_x, stop_y,   b.x,
                              b.y,    b.energy, sqrt(max.height2 / max.semi2)};
    return GLINT_RAY_OK;
}

enum glint_ray_status glint_trace(const struct glint_path *path, double px_mm,
                                  double py_mm, const double direction[3],
                                  struct glint_ray *ray, double (*hits)[2])
{
    return path->places_only
               ? trace(path, px_mm, py_mm, direction, false, ray, hits)
               : trace(path, px_mm, py_mm, direction, true, ray, hits);
}
