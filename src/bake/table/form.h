/* SPDX-License-Identifier: MIT
 *
 * Surfaces that are not centred spheres: conics, even aspheres, cylinders,
 * torics, and any of them shifted and tilted.
 *
 *   in   a surface of a table, the azimuth of the light
 *   out  a form: constants, and the way into the surface's own frame
 *
 * A ray meets a form where z less the sag changes sign. Steps that grow walk
 * from the vertex plane towards it until they have passed it; Newton's method
 * between the last two, with halving where it would leave them, finds it to the
 * last bits. Of several intersections it finds the nearest, except for two
 * within one step, as where a ray grazes a ripple. Limits: a cylinder or toric
 * is missed by rays that cross its vertex plane farther from the axis than its
 * circles reach. */
#ifndef GLINT_BAKE_TABLE_FORM_H
#define GLINT_BAKE_TABLE_FORM_H

#include <stdbool.h>

#include "glint/prescription.h"

/* Sets FORM to S, met by light in the plane at PHI_DEG. */
void glint_form_init(struct glint_form *form, const struct glint_surface *s,
                     double phi_deg);

/* Returns the sag at (X, Y) in the form's own frame, or NAN outside the form;
 * SLOPE receives its derivatives by x and y. */
double glint_form_sag(const struct glint_form *form, double x, double y,
                      double slope[2]);

/* Takes the ray at AT along DIRECTION from the light's frame to the form's own,
 * and on to its vertex plane. */
void glint_form_enter(const struct glint_form *form, double at[3],
                      double direction[3]);

/* Takes it back. */
void glint_form_leave(const struct glint_form *form, double at[3],
                      double direction[3]);

/* Moves the ray at AT along the unit vector DIRECTION, both in the form's own
 * frame and AT in its vertex plane, to the form. NORMAL receives the unit
 * normal, with positive z, and COSINE the cosine between it and DIRECTION, with
 * the sign of DIRECTION's z. Returns false if the ray misses; NORMAL and COSINE
 * may then be those of the axis. */
bool glint_form_meet(const struct glint_form *form, double at[3],
                     const double direction[3], double normal[3],
                     double *cosine);

#endif
