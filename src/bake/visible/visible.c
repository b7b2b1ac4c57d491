/* SPDX-License-Identifier: MIT */
#include "bake/visible/visible.h"

#include <math.h>

#include "bake/table/form.h"
#include "engine/setup/degrees.h"

const int glint_visible_colour[GLINT_VISIBLE_COLOURS] = {
    GLINT_VISIBLE_WAVES / 2, 0, GLINT_VISIBLE_WAVES - 1};

static double wave_of(const struct glint_visible *visible, double w)
{
    return 0.5 * (visible->wave_lo + visible->wave_hi) +
           0.5 * w * (visible->wave_hi - visible->wave_lo);
}

void glint_visible_path(const struct glint_visible *visible, double w,
                        struct glint_path *path)
{
    glint_path_init(path, visible->setup->lens,
                    &visible->setup->ghost[visible->ghost],
                    1e3 / sqrt(wave_of(visible, w)));
}

static void set_paths(struct glint_visible *visible)
{
    for (int k = 0; k < GLINT_VISIBLE_WAVES; k++) {
        glint_visible_path(visible,
                           -cos(GLINT_PI * k / (GLINT_VISIBLE_WAVES - 1)),
                           &visible->path[k]);
        visible->position_path[k] = visible->path[k];
        visible->position_path[k].places_only = true;
    }
}

void glint_visible_init(struct glint_visible *visible,
                        const struct glint_setup *setup, int ghost,
                        double field_mm, const double band_nm[2])
{
    visible->setup = setup;
    visible->ghost = ghost;
    visible->field_mm = field_mm;
    visible->wide = setup->lens->f_number < GLINT_WIDE;
    visible->far = visible->shaped = false;
    for (int k = 0; k < setup->lens->n_surfaces; k++)
        visible->shaped |= glint_surface_is_shaped(&setup->lens->surface[k]);
    visible->shaped &=
        visible->wide && glint_prescription_is_round(setup->lens);
    visible->wave_lo = 1e6 / (band_nm[1] * band_nm[1]);
    visible->wave_hi = 1e6 / (band_nm[0] * band_nm[0]);
    visible->n_beside = 0;
    set_paths(visible);
}

void glint_visible_reach(struct glint_visible *visible, double max_deg)
{
    visible->far = max_deg > GLINT_FAR &&
                   glint_prescription_is_round(visible->setup->lens);
    visible->wide |= visible->far;
}

void glint_visible_narrow(struct glint_visible *visible,
                          const struct glint_visible *whole, double w0,
                          double w1)
{
    visible->setup = whole->setup;
    visible->ghost = whole->ghost;
    visible->field_mm = whole->field_mm;
    visible->wide = whole->wide;
    visible->far = whole->far;
    visible->shaped = whole->shaped;
    visible->wave_lo = wave_of(whole, w0);
    visible->wave_hi = wave_of(whole, w1);
    set_paths(visible);
    visible->n_beside = whole->n_beside;
    for (int k = 0; k < whole->n_beside; k++)
        glint_visible_narrow(&visible->beside[k], &whole->beside[k], w0, w1);
}

bool glint_visible_passes(const struct glint_visible *visible,
                          const struct glint_ray *ray)
{
    return ray->rel_radius <= 1 &&
           hypot(ray->stop_x_mm, ray->stop_y_mm) <=
               visible->setup->optics.stop_radius_mm &&
           hypot(ray->sensor_x_mm, ray->sensor_y_mm) <= visible->field_mm;
}

void glint_visible_join(struct glint_pupil *a, const struct glint_pupil *b)
{
    a->x0_mm = fmin(a->x0_mm, b->x0_mm);
    a->x1_mm = fmax(a->x1_mm, b->x1_mm);
    a->y1_mm = fmax(a->y1_mm, b->y1_mm);
}
