/* SPDX-License-Identifier: MIT */
#include "glint/view.h"

#include <math.h>

#include "engine/setup/degrees.h"

struct glint_view glint_view_fit(int width, int height, double film_width_mm,
                                 double film_height_mm)
{
    const double shape = (double)width / height;
    const double tall = film_height_mm * shape;

    return (struct glint_view){width, height,
                               tall < film_width_mm ? tall : film_width_mm};
}

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

    lamp->theta_deg = atan(hypot(dx, dy) / fabs(focal_mm)) * degrees;
    lamp->phi_deg = atan2(dy, dx) * degrees;
    lamp->axis[0] = lamp->axis[1] = lamp->turn_deg = 0;
    if (focal_mm < 0)
        lamp->phi_deg += 180;
}

void glint_view_to_pixel(const struct glint_view *view, double focal_mm,
                         const struct glint_lamp *lamp, double *x, double *y)
{
    const double mm = view->sensor_width_mm / view->width;
    const double r =
        focal_mm *
        (glint_sin_deg(lamp->theta_deg) / glint_cos_deg(lamp->theta_deg)) / mm;

    *x = 0.5 * view->width + r * glint_cos_deg(lamp->phi_deg);
    *y = 0.5 * view->height - r * glint_sin_deg(lamp->phi_deg);
}
