/* SPDX-License-Identifier: MIT
 *
 * Computes focal lengths, pupil and stop of a lens at the d line by
 * first-order optics.
 *
 * Paraxial rays (y, n u) pass all elements in turn: a surface reduces n u by y
 * times its power, a gap increases y by n u times the reduced gap. A lens
 * without power has infinite focal lengths; glint_prescription_parse() rejects
 * it.
 */
#include "bake/table/elements.h"

#include <stddef.h>

/* a ray at one element: height, and slope times index of refraction */
struct paraxial_ray {
    double y_mm, nu;
};

/* Returns the curvature of element E in PLANE (enum glint_bend), 1
 * / mm, ignoring tilts and shifts. */
static double compute_curvature_in_plane(const struct glint_prescription *lens,
                                         int e, int plane)
{
    const int k = get_element_surface(lens, e);
    const struct glint_shape *const s = &lens->surface[k < 0 ? 0 : k].shape;

    if (k < 0 || s->bend == GLINT_BEND_ROUND || s->bend == plane)
        return get_element_curvature(lens, e);
    return s->across_mm != 0.0 ? 1.0 / s->across_mm : 0.0;
}

/* Traces RAY in PLANE from the front surface's vertex plane through element
 * LAST. */
static void trace_paraxial_ray(struct paraxial_ray *ray,
                               const struct glint_prescription *lens, int last,
                               int plane)
{
    double n = 1.0;

    /* Rays run backwards through air to a stop in front of the first
     * surface. */
    if (lens->stop_after == 0)
        ray->y_mm -= ray->nu * get_element_gap_mm(lens, 0);
    for (int e = 0; e <= last; e++) {
        const int k = get_element_surface(lens, e);

        if (e > 0)
            ray->y_mm += ray->nu / n * get_element_gap_mm(lens, e - 1);
        if (k >= 0) {
            ray->nu -= ray->y_mm * (lens->surface[k].nd - n) *
                       compute_curvature_in_plane(lens, e, plane);
            n = lens->surface[k].nd;
        }
    }
}

double glint_image_compute_distance_mm(const struct glint_prescription *lens,
                                       double object_mm)
{
    struct paraxial_ray ray = {object_mm, 1.0};

    trace_paraxial_ray(&ray, lens,
                       get_surface_element(lens, lens->n_surfaces - 1),
                       GLINT_BEND_Y);
    return -ray.y_mm / ray.nu;
}

/* Returns the focal length that maps angles to the sensor, mm. It is y / tan(a)
 * for a chief ray, which passes the centre of the entrance pupil: a is the
 * ray's angle to the axis, y the height at which it hits the sensor. */
static double compute_chief_ray_scale(const struct glint_prescription *lens,
                                      const struct glint_optics *optics)
{
    struct paraxial_ray chief = {-optics->entrance_z_mm, 1.0};

    trace_paraxial_ray(&chief, lens,
                       get_surface_element(lens, lens->n_surfaces - 1),
                       GLINT_BEND_Y);
    return chief.y_mm +
           chief.nu * get_element_gap_mm(lens, count_elements(lens) - 1);
}

void glint_optics_of(const struct glint_prescription *lens,
                     struct glint_optics *optics)
{
    struct paraxial_ray marginal = {1.0, 0.0}, to_stop = {1.0, 0.0};
    struct paraxial_ray slanted = {0.0, 1.0}, flat = {1.0, 0.0};

    trace_paraxial_ray(&marginal, lens,
                       get_surface_element(lens, lens->n_surfaces - 1),
                       GLINT_BEND_Y);
    trace_paraxial_ray(&to_stop, lens, lens->stop_after, GLINT_BEND_Y);
    trace_paraxial_ray(&slanted, lens, lens->stop_after, GLINT_BEND_Y);
    trace_paraxial_ray(&flat, lens,
                       get_surface_element(lens, lens->n_surfaces - 1),
                       GLINT_BEND_X);

    optics->squeeze = flat.nu / marginal.nu;
    optics->focal_mm = -1.0 / marginal.nu;
    optics->back_focal_mm = -marginal.y_mm / marginal.nu;
    optics->entrance_radius_mm = optics->focal_mm / (2.0 * lens->f_number);
    optics->stop_radius_mm = optics->entrance_radius_mm * to_stop.y_mm;
    if (optics->stop_radius_mm < 0.0)
        optics->stop_radius_mm = -optics->stop_radius_mm;
    /* A ray that starts with height h and slope u reaches the stop at the
     * height h * to_stop.y + u * slanted.y. This is 0 for the chief ray, which
     * crosses the axis at -h / u. */
    optics->entrance_z_mm = slanted.y_mm / to_stop.y_mm;
    optics->length_mm = 0.0;
    for (int e = lens->stop_after == 0; e < count_elements(lens); e++)
        optics->length_mm += get_element_gap_mm(lens, e);
    optics->scale_mm = lens->focus_m > 0.0
                           ? compute_chief_ray_scale(lens, optics)
                           : optics->focal_mm;
}
