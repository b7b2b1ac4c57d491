/* SPDX-License-Identifier: MIT
 *
 * Computes the Fraunhofer diffraction pattern of a stop with arcs as sides, in
 * doubles.
 *
 * The Fourier transform at the frequency vector q is an integral along the
 * outline, with points s and normal n:
 *
 *     F(q) = 1 / (2 pi |q|^2) integral of (q n) exp(-2 pi i q s) ds
 *
 * An arc diffracts light along its normals: into a fan, as wide as the angle of
 * the arc, whose light falls with r^-3; a straight edge diffracts into a line
 * instead. Far from the lamp the integral along an arc becomes a Fresnel
 * integral: if w is the sine of half the angle to the direction of q, the phase
 * is 4 pi |q| w^2 / curvature, and the slowly varying factor is replaced by its
 * value at w = 0, with corrections at both ends [Bleistein66]. */
#ifndef GLINT_ENGINE_STAR_ARCS_H
#define GLINT_ENGINE_STAR_ARCS_H

#include "glint/light.h"

struct glint_arcs {
    int n; /* sides */
    double rotation_deg;
    double round;  /* curvature, above 0, 1 / stop radius */
    double turn;   /* half the angle that an arc subtends at its centre,
                      radians */
    double behind; /* distance from the stop's centre to an arc's centre, stop
                      radii */
    double area, perimeter;
};

void glint_arcs_init(struct glint_arcs *arcs, int n, double rotation_deg,
                     double round);

/* Sets PATTERN[0 .. N - 1] to |F(q)|^2 / A^2, the pattern relative to its
 * centre, at the frequencies Q, 0 or more, in one DIRECTION. A is the area of
 * the stop. Q is in cycles per stop radius, DIRECTION in radians, y up. */
void glint_arcs_compute_patterns(const struct glint_arcs *arcs,
                                 double direction, const double *q, int n,
                                 double *pattern);

/* Sets PATTERN to the same as glint_arcs_compute_patterns(), without the
 * interference fringes between different arcs, for frequencies far from the
 * centre, above 0. */
void glint_arcs_compute_far_patterns(const struct glint_arcs *arcs,
                                     double direction, const double *q, int n,
                                     double *pattern);

#endif
