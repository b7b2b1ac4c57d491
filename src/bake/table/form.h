/* SPDX-License-Identifier: MIT
 *
 * Intersects rays with surfaces that are not centred spheres: conics, even
 * aspheres, cylinders and torics, shifted and tilted.
 *
 *   in   a surface of a lens table, the azimuth of the light
 *   out  a form: constants, and the transform to the surface's own frame
 *
 * A ray meets a form where z - sag changes its sign. Growing steps from the
 * vertex plane bracket the intersection; Newton's method, with bisection where
 * it would leave the bracket, finds it to the last bits. If a ray meets the
 * form several times, the nearest intersection is found, unless two lie within
 * one step, for example where a ray grazes a ripple. Limit: a ray misses a
 * cylinder or toric if it crosses the vertex plane farther from the axis than
 * the radius.
 */
#ifndef GLINT_BAKE_TABLE_FORM_H
#define GLINT_BAKE_TABLE_FORM_H

#include <stdbool.h>

#include "glint/prescription.h"

/* Initialises FORM from surface S, for light whose plane has the azimuth
 * PHI_DEG. */
void glint_form_init(struct glint_form *form, const struct glint_surface *s,
                     double phi_deg);

/* Returns the sag at (X, Y) in the form's own frame, mm; NAN where the form is
 * undefined. SLOPE receives its derivatives by x and y. */
double glint_form_compute_sag(const struct glint_form *form, double x, double y,
                              double slope[2]);

/* Transforms the ray at AT along DIRECTION from the light's frame to the
 * form's own frame, and moves AT to the form's vertex plane. */
void glint_form_enter_frame(const struct glint_form *form, double at[3],
                            double direction[3]);

/* Transforms the ray at AT along DIRECTION back to the light's frame. */
void glint_form_leave_frame(const struct glint_form *form, double at[3],
                            double direction[3]);

/* Moves AT along the unit vector DIRECTION to the form. Both are in the form's
 * own frame, AT in its vertex plane. NORMAL receives the unit normal, with
 * positive z, and COSINE the cosine between NORMAL and DIRECTION, with the sign
 * of DIRECTION's z. Returns false if the ray misses the form; NORMAL and COSINE
 * may then be those on the axis. */
bool glint_form_intersect_ray(const struct glint_form *form, double at[3],
                              const double direction[3], double normal[3],
                              double *cosine);

#endif
