/* SPDX-License-Identifier: MIT
 *
 * Traces the chief rays of a lens and fits a polynomial to their positions on
 * the sensor.
 *
 *   in   a lens table that is round about its axis
 *   out  the mapping from field angle to sensor (struct glint_projection)
 *
 * A chief ray passes the centre of the stop. Its start point on the front is
 * found by bisection. Rays start on the vertex plane of the first surface,
 * which light at 90 degrees never crosses, so angles are limited to 85 degrees.
 */
#include "glint/bake.h"

#include <math.h>
#include <stdio.h>

#include "bake/regress/regress.h"
#include "engine/setup/degrees.h"

enum {
    ANGLES = 86, /* max number of angles at which chief rays are traced */
    /* min number of unblocked chief rays; with fewer the next smaller angle
     * step is tried */
    LEAST = 8,
    HALVINGS = 50,
    D_LINE_NM = 588
};

/* Sets *MM to the distance from the axis, mm, at which the chief ray of light
 * at THETA_DEG hits the sensor. Returns false if the ray is blocked. */
static bool trace_chief_ray(const struct glint_path *path, double stop_mm,
                            double theta_deg, double *mm)
{
    const double d[3] = {glint_sin_deg(theta_deg), 0, glint_cos_deg(theta_deg)};
    struct glint_pupil box;
    struct glint_ray low, ray;
    double x0, x1;

    if (!glint_pupil_find(&box, path, theta_deg, stop_mm, NULL))
        return false;
    x0 = box.x0_mm;
    x1 = box.x1_mm;
    if (glint_trace(path, x0, 0, d, &low, NULL) != GLINT_RAY_OK)
        return false;
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = 0.5 * (x0 + x1);

        if (glint_trace(path, middle, 0, d, &ray, NULL) != GLINT_RAY_OK)
            return false;
        if ((ray.stop_x_mm < 0) == (low.stop_x_mm < 0))
            x0 = middle;
        else
            x1 = middle;
    }
    *mm = ray.sensor_x_mm;
    return fabs(ray.stop_x_mm) < 1e-6 * stop_mm && ray.rel_radius <= 1;
}

/* Sets RHO to the distances from the axis, in focal lengths, at which chief
 * rays at multiples of STEP_DEG hit the sensor. Returns the number of rays,
 * up to 85 degrees. */
static int trace_chief_rays(const struct glint_path *path,
                            const struct glint_optics *optics, double step_deg,
                            double *rho)
{
    double mm;
    int n = 0;

    while (n < ANGLES - 1 &&
           trace_chief_ray(path, optics->stop_radius_mm, (n + 1) * step_deg,
                           &mm) &&
           mm / optics->focal_mm > (n ? rho[n - 1] : 0)) {
        rho[n] = mm / optics->focal_mm;
        n++;
    }
    return n;
}

/* Fits the mapping P from position to field angle to N chief rays. RHO[k]:
 * distance from the axis, in focal lengths, of the ray at (k + 1) STEP_DEG. */
static void fit_projection(struct glint_projection *p, const double *rho, int n,
                           double step_deg)
{
    static const double zero[ANGLES];
    double scratch[GLINT_REGRESS_DOUBLES(ANGLES, ANGLES, 1,
                                         GLINT_PROJECTION_TERMS)];
    double r2[ANGLES], bend[ANGLES], weight[ANGLES], scale = 1;
    const struct glint_regress_samples samples = {
        n, {zero, zero, zero, r2}, weight};
    const struct glint_degrees degrees = {
        .most = {0, 0, 0, GLINT_PROJECTION_TERMS - 1},
        .weight = {1, 1, 1, 1},
        .total = GLINT_PROJECTION_TERMS - 1,
        .parity = -1,
        .terms = GLINT_PROJECTION_TERMS};
    struct glint_poly poly;

    p->reach = rho[n - 1];
    for (int k = 0; k < n; k++) {
        const double square = rho[k] * rho[k];

        r2[k] = square / (p->reach * p->reach);
        weight[k] = atan(rho[k]) * square;
        bend[k] =
            ((k + 1) * step_deg * (GLINT_PI / 180) / atan(rho[k]) - 1) / square;
    }
    glint_regress_fit_polynomial(scratch, &samples, bend, &degrees, 1e-12,
                                 1e-12, &poly);
    for (int i = 0; i < poly.n; i++)
        p->b[poly.power[i][3]] = poly.coef[i];
    for (int k = 0; k < GLINT_PROJECTION_TERMS; k++) {
        p->b[k] *= scale;
        scale /= p->reach * p->reach;
    }
}

enum glint_status glint_projection_of(struct glint_projection *projection,
                                      const struct glint_prescription *lens,
                                      double *miss_deg,
                                      struct glint_error *error)
{
    struct glint_projection *const p = projection;
    /* degrees between chief rays; the smaller steps are for small fields of
     * view */
    static const double steps[] = {1, 0.25, 0.05};
    double rho[ANGLES], step = 0;
    struct glint_optics optics;
    struct glint_path path;
    int n = 0;

    *p = (struct glint_projection){.reach = 0};
    *miss_deg = 0;
    if (!glint_prescription_is_round(lens)) {
        snprintf(error->text, sizeof error->text,
                 "%s is not rotationally symmetric: its own projection cannot "
                 "be computed; use --projection tan",
                 lens->name);
        return GLINT_E_LENS;
    }
    glint_optics_of(lens, &optics);
    glint_path_init(&path, lens, NULL, D_LINE_NM);
    for (size_t k = 0; k < sizeof steps / sizeof *steps && n < LEAST; k++) {
        step = steps[k];
        n = trace_chief_rays(&path, &optics, step, rho);
    }
    if (n < LEAST) {
        snprintf(
            error->text, sizeof error->text,
            "%s: only %d chief rays, %g degrees apart, reach the sensor: its "
            "own projection cannot be computed; use --projection tan",
            lens->name, n, step);
        return GLINT_E_LENS;
    }
    fit_projection(p, rho, n, step);
    for (int k = 0; k < n; k++)
        *miss_deg = fmax(
            *miss_deg, fabs(glint_projection_deg(p, rho[k]) - (k + 1) * step));
    return GLINT_OK;
}
