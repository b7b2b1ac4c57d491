/* SPDX-License-Identifier: MIT */
#include "lens_figures/figure.h"

#include <math.h>

#include "lens_figures/fans.h"

/* Share of the film's end at which the outermost field is, so that rays end
 * within it. */
#define FIELD_ENDS 0.995

const char *const figure_field_colour[DRAWING_FIELDS] = {"#1f5fa8", "#2f8a3c",
                                                         "#c0392b"};

double figure_px(const struct figure *f, double z)
{
    return f->left + f->scale * z;
}

double figure_py(const struct figure *f, double x)
{
    return f->middle - f->scale * x;
}

double figure_round_up(double value)
{
    const double power = pow(10, floor(log10(fmax(value, 1e-9))));
    const double share = value / power;

    return power * (share <= 1 ? 1 : share <= 2 ? 2 : share <= 5 ? 5 : 10);
}

/* Returns how far from the centre the picture has the light of THETA_DEG, below
 * 0 if it gets none. */
static double image_height_mm(const struct figure *f, double theta_deg)
{
    double hits[GLINT_MAX_EVENTS + 1][2];
    struct fan fan;
    struct glint_ray ray;

    if (!fan_init(&fan, f->drawing->lens, NULL, FIGURE_NM,
                  f->drawing->plane_deg, theta_deg) ||
        !fan_ray(&fan, 0, 0, &ray, hits))
        return -1;
    return fabs(ray.sensor_x_mm);
}

double figure_angle_deg(const struct figure *f, double height_mm)
{
    double low = 0, high = 89;

    for (int i = 0; i < 18; i++) {
        const double middle = 0.5 * (low + high);
        const double found = image_height_mm(f, middle);

        if (found >= 0 && found < height_mm)
            low = middle;
        else
            high = middle;
    }
    return low;
}

double figure_field_deg(const struct figure *f, int field)
{
    static const double share[DRAWING_FIELDS] = {0, 0.7, 1};

    return figure_angle_deg(f, FIELD_ENDS * share[field] * f->film_mm);
}
