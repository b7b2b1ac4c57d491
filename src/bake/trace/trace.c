/* SPDX-License-Identifier: MIT
 *
 * Exact sequential ray tracing: from path and start point to positions in the
 * stop and on the sensor, energy, and relative radius.
 *
 * Every intersection is computed relative to the vertex plane of its surface,
 * which avoids cancellation for any radius. With the curvature c, the point (X,
 * Y) where the ray meets that plane and its direction (l, m, n),
 *
 *     F = c (X^2 + Y^2),  G = n - c (X l + Y m),  W = +-sqrt(G^2 - c F),
 *     t = F / (G + W), where W has the sign of n.
 *
 * W is also the cosine between ray and normal. A plane has c = 0. The relative
 * error of coordinates is about 1e-14 for planes and for large and small radii.
 * [Hullin11] section 4
 */
#include <math.h>
#include <string.h>

#include "bake/trace/beam.h"
#include "bake/trace/coating.h"
#include "bake/table/form.h"
#include "base/compiler.h"
#include "bake/table/elements.h"
#include "engine/setup/degrees.h"
#include "glint/trace.h"
#include "glint/view.h"

/* ------------------------------------------------------------------- paths */

/* a path while its events are appended */
struct route {
    const struct glint_prescription *lens;
    struct glint_path *path;
    double wavelength_nm, phi_deg;
    int at; /* index of the element of the last event; -1: no event yet */
};

/* Sets the indices of refraction in front of and behind surface K. */
static void find_refractive_indices(const struct route *route, int k,
                                    double *front, double *behind)
{
    const struct glint_surface *s = &route->lens->surface[k];

    *front = k ? glint_surface_index(s - 1, route->wavelength_nm) : 1.0;
    *behind = glint_surface_index(s, route->wavelength_nm);
}

/* Returns the signed distance in z from the last event to element E, its
 * neighbour, mm. */
static double compute_event_distance_mm(const struct route *route, int e)
{
    /* rays start at the vertex plane of the first surface */
    if (route->at < 0)
        return route->lens->stop_after == 0
                   ? -get_element_gap_mm(route->lens, 0)
                   : 0.0;
    return e > route->at ? get_element_gap_mm(route->lens, route->at)
                         : -get_element_gap_mm(route->lens, e);
}

/* Appends an event of KIND at element E. FORWARD: the ray arrives at E running
 * towards the sensor. */
static void append_path_event(struct route *route, int e,
                              enum glint_event_kind kind, bool forward)
{
    const int k = get_element_surface(route->lens, e);
    struct glint_event *event = &route->path->event[route->path->n_events++];

    memset(event, 0, sizeof(*event));
    event->kind = k < 0 ? GLINT_STOP : kind;
    event->surface = k;
    event->curvature = get_element_curvature(route->lens, e);
    event->advance_mm = compute_event_distance_mm(route, e);
    event->semi_mm = get_element_semi_mm(route->lens, e);
    event->n_from = event->n_to = 1.0;
    route->at = e;
    if (k < 0)
        return;
    find_refractive_indices(route, k, forward ? &event->n_from : &event->n_to,
                            forward ? &event->n_to : &event->n_from);
    event->n_films =
        glint_coating_at(&route->lens->surface[k].coating, route->wavelength_nm,
                         route->path->film[k]);
    event->shaped = glint_surface_is_shaped(&route->lens->surface[k]);
    if (event->shaped)
        glint_form_init(&route->path->form[k], &route->lens->surface[k],
                        route->phi_deg);
}

/* Sets the matrix from sensor to picture coordinates of an anamorphic lens, for
 * light whose plane has the azimuth PHI_DEG. */
static void set_anamorphic_matrix(struct glint_path *path,
                                  const struct glint_prescription *lens,
                                  double phi_deg)
{
    const double c = glint_cos_deg(phi_deg), s = glint_sin_deg(phi_deg);
    struct glint_optics optics;

    path->round = glint_prescription_is_round(lens);
    glint_optics_of(lens, &optics);
    path->widen[0][0] = 1.0 + (optics.squeeze - 1.0) * c * c;
    path->widen[1][1] = 1.0 + (optics.squeeze - 1.0) * s * s;
    path->widen[0][1] = path->widen[1][0] = (1.0 - optics.squeeze) * c * s;
}

void glint_path_init(struct glint_path *path,
                     const struct glint_prescription *lens,
                     const struct glint_ghost *ghost, double wavelength_nm)
{
    glint_path_init_at(path, lens, ghost, wavelength_nm, 0.0);
}

void glint_path_init_at(struct glint_path *path,
                        const struct glint_prescription *lens,
                        const struct glint_ghost *ghost, double wavelength_nm,
                        double phi_deg)
{
    struct route route = {lens, path, wavelength_nm, phi_deg, -1};
    const int n = count_elements(lens);
    int e = 0;

    path->n_events = 0;
    path->places_only = false;
    set_anamorphic_matrix(path, lens, phi_deg);
    if (ghost && ghost->i >= 0) {
        const int near = get_surface_element(lens, ghost->i);
        const int far = get_surface_element(lens, ghost->j);

        for (; e < far; e++)
            append_path_event(&route, e, GLINT_REFRACT, true);
        append_path_event(&route, far, GLINT_REFLECT, true);
        for (e = far - 1; e > near; e--)
            append_path_event(&route, e, GLINT_REFRACT, false);
        append_path_event(&route, near, GLINT_REFLECT, false);
        e = near + 1;
    }
    for (; e < n; e++)
        append_path_event(&route, e, GLINT_REFRACT, true);
    path->to_sensor_mm = get_element_gap_mm(lens, n - 1);
}

/* -------------------------------------------------------------------- rays */

/* Moves N rays along straight lines to the plane ADVANCE_MM away. */
static WHOLLY_INLINE void move_rays_to_plane(struct beam *b, int n,
                                             double advance_mm)
{
    for (int k = 0; k < n; k++) {
        const double s = (advance_mm - b->z[k]) / b->n[k];

        b->x[k] += s * b->l[k];
        b->y[k] += s * b->m[k];
        b->z[k] = 0.0;
    }
}

/* Moves N rays from the vertex plane to a sphere of curvature C, whose normal
 * at a point is (-c x, -c y, 1 - c z). Comparisons are written so that NaN
 * counts as a miss. */
static WHOLLY_INLINE void move_rays_to_sphere(struct beam *b, int n, double c)
{
    for (int k = 0; k < n; k++) {
        const double x = b->x[k], y = b->y[k];
        const double f = c * (x * x + y * y);
        const double g = b->n[k] - c * (x * b->l[k] + y * b->m[k]);
        const double square = g * g - c * f;
        const double root = sqrt(square);
        const double cosine = b->n[k] < 0.0 ? -root : root;
        const double t = f / (g + cosine);

        b->cosine[k] = cosine;
        b->x[k] = x + t * b->l[k];
        b->y[k] = y + t * b->m[k];
        b->z[k] = t * b->n[k];
        b->status[k] = update_ray_status(
            b->status[k], (square > 0.0) & (1.0 - c * b->z[k] > 0.0),
            GLINT_RAY_MISSED);
    }
}

/* Sets the direction of ray K to S * direction + PART * normal. Marks the ray
 * as missed unless the z direction keeps its sign (WAY = 1: refraction) or
 * changes it (WAY = -1: reflection). */
static WHOLLY_INLINE void deflect_ray_at_sphere(struct beam *b, int k, double c,
                                                double s, double part,
                                                double way)
{
    const double before = b->n[k];

    b->l[k] = s * b->l[k] - part * c * b->x[k];
    b->m[k] = s * b->m[k] - part * c * b->y[k];
    b->n[k] = s * before + part * (1.0 - c * b->z[k]);
    b->status[k] = update_ray_status(b->status[k], way * before * b->n[k] > 0.0,
                                     GLINT_RAY_MISSED);
}

/* Sets PART[N] to the reflectances for N rays at the surface of event E, coated
 * with FILM. OUT[N]: cosines of the refracted rays; where it is 0 (total
 * reflection), PART is 1. */
static WHOLLY_INLINE void compute_reflectances(const struct beam *b, int n,
                                               const struct glint_event *e,
                                               const struct glint_film_at *film,
                                               const double *out, double *part)
{
    const double n1 = e->n_from, n2 = e->n_to;
    const bool bare = e->n_films == 0, single = e->n_films == 1;
    double inside[LANES], sine2[LANES];

    for (int k = 0; k < n && bare; k++)
        part[k] = compute_bare_reflectance(n1, fabs(b->cosine[k]), n2, out[k]);
    for (int k = 0; k < n && single; k++) {
        inside[k] = compute_film_cosine2(n1, fabs(b->cosine[k]), film->n);
        sine2[k] = compute_sine2(0.5 * film->phase * sqrt(fabs(inside[k])));
    }
    for (int k = 0; k < n && single; k++)
        if (inside[k] < 0.0)
            sine2[k] = compute_film_sine2(inside[k], film->phase);
    for (int k = 0; k < n && single; k++)
        part[k] = compute_film_reflectance(n1, fabs(b->cosine[k]), n2, out[k],
                                           film->n, inside[k], sine2[k]);
    for (int k = 0; k < n && !bare && !single; k++)
        part[k] = compute_stack_reflectance(n1, fabs(b->cosine[k]), n2, out[k],
                                            film, e->n_films);
    for (int k = 0; k < n; k++)
        part[k] = out[k] > 0.0 ? part[k] : 1.0;
}

/* Refracts or reflects N rays at the surface of event E. ENERGIES: also updates
 * their energies. */
static WHOLLY_INLINE void
refract_or_reflect_rays(struct beam *b, int n, const struct glint_event *e,
                        const struct glint_film_at *film, bool energies)
{
    const double ratio = e->n_from / e->n_to, c = e->curvature;
    const bool reflects = e->kind == GLINT_REFLECT;
    double out[LANES], part[LANES];

    for (int k = 0; k < n; k++) {
        const double cosine = b->cosine[k];
        const double out2 = 1.0 - ratio * ratio * (1.0 - cosine * cosine);

        out[k] = sqrt(out2 > 0.0 ? out2 : 0.0);
    }
    if (energies)
        compute_reflectances(b, n, e, film, out, part);
    for (int k = 0; k < n && energies; k++)
        b->energy[k] *= reflects ? part[k] : 1.0 - part[k];
    if (e->shaped) {
        glint_beam_deflect_at_form(b, n, reflects, ratio, out);
        return;
    }
    for (int k = 0; k < n && reflects; k++)
        deflect_ray_at_sphere(b, k, c, 1.0, -2.0 * b->cosine[k], -1.0);
    for (int k = 0; k < n && !reflects; k++) {
        b->status[k] = update_ray_status(b->status[k], out[k] > 0.0,
                                         GLINT_RAY_TOTAL_REFLECTION);
        deflect_ray_at_sphere(
            b, k, c, ratio,
            (b->n[k] < 0.0 ? -out[k] : out[k]) - ratio * b->cosine[k], 1.0);
    }
}

static WHOLLY_INLINE void update_max_radius(struct beam *b, int n,
                                            double semi_mm)
{
    const double semi2 = semi_mm * semi_mm;

    for (int k = 0; k < n; k++) {
        const double height2 = b->x[k] * b->x[k] + b->y[k] * b->y[k];
        const bool wider = height2 * b->semi2[k] > b->height2[k] * semi2;

        b->height2[k] = wider ? height2 : b->height2[k];
        b->semi2[k] = wider ? semi2 : b->semi2[k];
    }
}

/* N: LANES or 1. */
static WHOLLY_INLINE bool are_all_rays_invalid(const struct beam *b, int n)
{
    enum { QUARTER = 4 };
    double least[QUARTER];

    if (n == 1)
        return b->status[0] > GLINT_RAY_OK;
    for (int k = 0; k < QUARTER; k++)
        least[k] = b->status[k];
    for (int at = QUARTER; at < LANES; at += QUARTER)
        for (int k = 0; k < QUARTER; k++)
            least[k] =
                least[k] < b->status[at + k] ? least[k] : b->status[at + k];
    return (least[0] > GLINT_RAY_OK) & (least[1] > GLINT_RAY_OK) &
           (least[2] > GLINT_RAY_OK) & (least[3] > GLINT_RAY_OK);
}

static WHOLLY_INLINE void init_beam_ray(struct beam *b, int k,
                                        const struct glint_launch *from)
{
    b->x[k] = from->x_mm;
    b->y[k] = from->y_mm;
    b->z[k] = b->height2[k] = b->stop_x[k] = b->stop_y[k] = 0.0;
    b->l[k] = from->direction[0];
    b->m[k] = from->direction[1];
    b->n[k] = from->direction[2];
    b->energy[k] = b->semi2[k] = 1.0;
    b->status[k] =
        update_ray_status(GLINT_RAY_OK, b->n[k] > 0.0, GLINT_RAY_MISSED);
}

/* Sets HIT to the position of ray K in the surface's own frame. */
static WHOLLY_INLINE void record_ray_hit(const struct beam *b, int k,
                                         const struct glint_form *form,
                                         double hit[2])
{
    hit[0] = b->x[k];
    hit[1] = b->y[k];
    for (int i = 0; i < 2 && form && form->level; i++)
        hit[i] = form->turn[i][0] * b->x[k] + form->turn[i][1] * b->y[k];
}

/* Traces N rays through event E. For each of the first ASKED rays, stores the
 * position of ray k in HITS[k * n_events]. */
static WHOLLY_INLINE void trace_rays_through_event(
    struct beam *b, int n, int asked, const struct glint_path *path,
    const struct glint_event *e, bool energies, double (*hits)[2])
{
    move_rays_to_plane(b, n, e->advance_mm);
    if (e->kind == GLINT_STOP)
        for (int k = 0; k < n; k++) {
            b->stop_x[k] = b->x[k];
            b->stop_y[k] = b->y[k];
        }
    else if (e->shaped)
        glint_beam_move_to_form(b, n, &path->form[e->surface]);
    else
        move_rays_to_sphere(b, n, e->curvature);
    for (int k = 0; k < asked && hits; k++)
        if (!(b->status[k] > GLINT_RAY_OK))
            record_ray_hit(b, k, e->shaped ? &path->form[e->surface] : NULL,
                           hits[k * path->n_events]);
    if (e->kind == GLINT_STOP)
        return;
    update_max_radius(b, n, e->semi_mm);
    refract_or_reflect_rays(b, n, e, path->film[e->surface], energies);
    if (e->shaped)
        glint_beam_leave_form_frame(b, n, &path->form[e->surface]);
}

/* Converts positions on the sensor to those in the picture of an anamorphic
 * lens. */
static void apply_anamorphic_matrix(struct beam *b, int n,
                                    const double widen_by[2][2])
{
    for (int k = 0; k < n; k++) {
        const double x = b->x[k], y = b->y[k];

        b->x[k] = widen_by[0][0] * x + widen_by[0][1] * y;
        b->y[k] = widen_by[1][0] * x + widen_by[1][1] * y;
    }
}

static inline enum glint_ray_status copy_traced_ray(const struct beam *b, int k,
                                                    struct glint_ray *ray)
{
    if (b->status[k] > GLINT_RAY_OK)
        return (enum glint_ray_status)b->status[k];
    if (!isfinite(b->x[k]) || !isfinite(b->y[k]))
        return GLINT_RAY_MISSED; /* the ray is almost parallel to the sensor */
    *ray = (struct glint_ray){b->stop_x[k], b->stop_y[k],
                              b->x[k],      b->y[k],
                              b->energy[k], sqrt(b->height2[k] / b->semi2[k])};
    return GLINT_RAY_OK;
}

/* Traces a batch of LANES rays: the first N are FROM[N], the others repeat the
 * first ray. */
static WHOLLY_INLINE void
trace_ray_lanes(const struct glint_path *path, int lanes, int n, bool energies,
                const struct glint_launch *from, struct glint_ray *ray,
                enum glint_ray_status *status, double (*hits)[2])
{
    struct beam b;

    for (int k = 0; k < lanes; k++)
        init_beam_ray(&b, k, &from[k < n ? k : 0]);
    for (int i = 0; i < path->n_events && !are_all_rays_invalid(&b, lanes); i++)
        trace_rays_through_event(&b, lanes, n, path, &path->event[i], energies,
                                 hits ? hits + i : NULL);
    move_rays_to_plane(&b, lanes, path->to_sensor_mm);
    if (!path->round)
        apply_anamorphic_matrix(&b, n, path->widen);
    for (int k = 0; k < n; k++)
        status[k] = copy_traced_ray(&b, k, &ray[k]);
}

WIDE_VECTORS
void glint_trace_many(const struct glint_path *path, int n,
                      const struct glint_launch *from, struct glint_ray *ray,
                      enum glint_ray_status *status, double (*hits)[2])
{
    for (int at = 0; at < n; at += LANES) {
        const int now = n - at < LANES ? n - at : LANES;
        double(*h)[2] = hits ? hits + at * path->n_events : NULL;

        if (path->places_only)
            trace_ray_lanes(path, LANES, now, false, from + at, ray + at,
                            status + at, h);
        else
            trace_ray_lanes(path, LANES, now, true, from + at, ray + at,
                            status + at, h);
    }
}

void glint_trace_grid(const struct glint_path *path,
                      const struct glint_row *row, int rows, const double *y_mm,
                      struct glint_ray *ray, enum glint_ray_status *status,
                      double (*hits)[2])
{
    struct glint_launch from[LANES];
    int n = 0, at = 0;

    for (int j = 0; j < rows; j++)
        for (int i = 0; i < row->n; i++) {
            from[n++] = (struct glint_launch){
                row->x0_mm + i * row->step_mm,
                y_mm[j],
                {row->direction[0], row->direction[1], row->direction[2]}};
            if (n < LANES && (i + 1 < row->n || j + 1 < rows))
                continue;
            glint_trace_many(path, n, from, ray + at, status + at,
                             hits ? hits + at * path->n_events : NULL);
            at += n;
            n = 0;
        }
}

void glint_trace_row(const struct glint_path *path, const struct glint_row *row,
                     struct glint_ray *ray, enum glint_ray_status *status,
                     double (*hits)[2])
{
    glint_trace_grid(path, row, 1, &row->y_mm, ray, status, hits);
}

enum glint_ray_status glint_trace(const struct glint_path *path, double px_mm,
                                  double py_mm, const double direction[3],
                                  struct glint_ray *ray, double (*hits)[2])
{
    const struct glint_launch from = {
        px_mm, py_mm, {direction[0], direction[1], direction[2]}};
    enum glint_ray_status status;

    trace_ray_lanes(path, 1, 1, !path->places_only, &from, ray, &status, hits);
    return status;
}
