/* SPDX-License-Identifier: MIT */
#include "glint/view.h"

#include <math.h>
#include <stdbool.h>

#include "engine/setup/degrees.h"

struct glint_view glint_view_fit(int width, int height, double film_width_mm,
                                 double film_height_mm)
{
    const double shape = (double)width / height;
    const double tall = film_height_mm * shape;

    return (struct glint_view){.width = width,
                               .height = height,
                               .sensor_width_mm =
                                   tall < film_width_mm ? tall : film_width_mm};
}

/* ------------------------------------------------------------- projections */

/* angle off the axis, degrees, to which results are clamped */
#define MOST_DEG 89.9
#define MOST_RHO 1e6

static bool is_rectilinear(const struct glint_projection *p)
{
    bool zero = true;

    for (int k = 0; k < GLINT_PROJECTION_TERMS; k++)
        zero &= p->b[k] == 0;
    return zero;
}

static double compute_polynomial_angle_deg(const struct glint_projection *p,
                                           double rho)
{
    const double r = fmin(rho, p->reach), r2 = r * r;
    double sum = 0;

    for (int k = GLINT_PROJECTION_TERMS - 1; k >= 0; k--)
        sum = (sum + p->b[k]) * r2;
    return atan(rho) * (180 / GLINT_PI) * (1 + sum);
}

double glint_projection_deg(const struct glint_projection *projection,
                            double rho)
{
    return is_rectilinear(projection)
               ? atan(rho) * (180 / GLINT_PI)
               : fmin(MOST_DEG, compute_polynomial_angle_deg(projection, rho));
}

double glint_projection_rho(const struct glint_projection *projection,
                            double theta_deg)
{
    enum { DOUBLINGS = 64, HALVINGS = 60 };
    double lo = 0, hi = 1;

    if (is_rectilinear(projection))
        return glint_sin_deg(theta_deg) / glint_cos_deg(theta_deg);
    for (int k = 0; k < DOUBLINGS && hi < MOST_RHO &&
                    compute_polynomial_angle_deg(projection, hi) < theta_deg;
         k++) {
        lo = hi;
        hi *= 2;
    }
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = 0.5 * (lo + hi);

        if (compute_polynomial_angle_deg(projection, middle) < theta_deg)
            lo = middle;
        else
            hi = middle;
    }
    return fmin(MOST_RHO, 0.5 * (lo + hi));
}

/* ------------------------------------------------------------------- views */

double glint_view_pixel_tangent(const struct glint_view *view, double focal_mm)
{
    return view->sensor_width_mm / view->width / fabs(focal_mm);
}

void glint_view_to_angles(const struct glint_view *view, double focal_mm,
                          double x, double y, struct glint_lamp *lamp)
{
    const double mm = view->sensor_width_mm / view->width;
    const double dx = (x - 0.5 * view->width) * mm;
    const double dy = (0.5 * view->height - y) * mm;
    const double degrees = 180 / GLINT_PI;

    lamp->theta_deg =
        glint_projection_deg(&view->projection, hypot(dx, dy) / fabs(focal_mm));
    lamp->phi_deg = atan2(dy, dx) * degrees;
    lamp->axis[0] = lamp->axis[1] = lamp->turn_deg = 0;
    if (focal_mm < 0)
        lamp->phi_deg += 180;
}

void glint_view_to_pixel(const struct glint_view *view, double focal_mm,
                         const struct glint_lamp *lamp, double *x, double *y)
{
    const double mm = view->sensor_width_mm / view->width;
    const double r = focal_mm *
                     glint_projection_rho(&view->projection, lamp->theta_deg) /
                     mm;

    *x = 0.5 * view->width + r * glint_cos_deg(lamp->phi_deg);
    *y = 0.5 * view->height - r * glint_sin_deg(lamp->phi_deg);
}
