/* SPDX-License-Identifier: MIT */
#include "lens_figures/fans.h"

#include <math.h>

#include "glint/glint.h"

bool fan_init(struct fan *fan, const struct glint_prescription *lens,
              const struct glint_ghost *ghost, double nm, double phi_deg,
              double theta_deg)
{
    const double theta = theta_deg * GLINT_PI / 180;
    struct glint_optics optics;

    glint_optics_of(lens, &optics);
    glint_path_init_at(&fan->path, lens, ghost, nm, phi_deg);
    fan->path.places_only = true;
    fan->direction[0] = sin(theta);
    fan->direction[1] = 0;
    fan->direction[2] = cos(theta);
    fan->stop_radius_mm = optics.stop_radius_mm;
    return glint_pupil_find(&fan->pupil, &fan->path, theta_deg,
                            optics.stop_radius_mm, NULL);
}

double fan_start_mm(const struct fan *fan, double u)
{
    const struct glint_pupil *p = &fan->pupil;

    return 0.5 * (p->x0_mm + p->x1_mm) + 0.5 * u * (p->x1_mm - p->x0_mm);
}

bool fan_ray(const struct fan *fan, double u, double v, struct glint_ray *ray,
             double (*hits)[2])
{
    return glint_trace(&fan->path, fan_start_mm(fan, u), v * fan->pupil.y1_mm,
                       fan->direction, ray, hits) == GLINT_RAY_OK &&
           ray->rel_radius <= 1 &&
           hypot(ray->stop_x_mm, ray->stop_y_mm) <=
               fan->stop_radius_mm * (1 + 1e-9);
}

bool fan_edges(const struct fan *fan, double u[2])
{
    enum { STEPS = 100, HALVINGS = 12 };
    double hits[GLINT_MAX_EVENTS + 1][2];
    struct glint_ray ray;
    bool any = false;

    for (int i = -STEPS; i <= STEPS; i++) {
        const double at = (double)i / STEPS;

        if (!fan_ray(fan, at, 0, &ray, hits))
            continue;
        if (!any)
            u[0] = at;
        u[1] = at;
        any = true;
    }
    for (int side = 0; any && side < 2; side++) {
        double out = (side ? 1.0 : -1.0) / STEPS;

        for (int i = 0; i < HALVINGS; i++) {
            out *= 0.5;
            if (fan_ray(fan, u[side] + out, 0, &ray, hits))
                u[side] += out;
        }
    }
    return any;
}
