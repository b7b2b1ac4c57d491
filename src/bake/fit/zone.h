/* SPDX-License-Identifier: MIT
 *
 * A range of angles of one ghost, and the box on the pupil that follows the
 * visible part through it.
 *
 *   in   boxes of what is visible at many angles and wavelengths
 *   out  the box's middle and half sizes as polynomials of s and w
 *
 * Coordinates of a zone, each -1 .. 1:
 *   u, v  place in the box, the light's plane along u
 *   s     the sine of the light's angle within the range
 *   w     1 / wavelength^2 within the band
 * In these coordinates a ghost is tame, and symmetric in v, so v >= 0 is all
 * that is traced.
 */
#ifndef GLINT_BAKE_FIT_ZONE_H
#define GLINT_BAKE_FIT_ZONE_H

#include "bake/fit/visible.h"
#include "bake/fit/regress.h"
#include "glint/model.h"
#include "glint/trace.h"

struct glint_zone {
    double lo, hi;                  /* sine of the angle */
    double middle[GLINT_BOX_TERMS]; /* mm; terms as in a model */
    double half_x[GLINT_BOX_TERMS], half_y[GLINT_BOX_TERMS];
    double fill; /* mean share of the box that the ghost needs */
    int annulus; /* same meaning as in struct glint_model_system */
};

/* A part of a zone's box and band: U0 .. U1 of its u, up to TOP of its v, W0 ..
 * W1 of its w. */
struct glint_zone_part {
    double u0, u1, top, w0, w1;
    int annulus;
};

/* One of these at S and W. */
double glint_zone_at(const double side[GLINT_BOX_TERMS], double s, double w);

/* Sets the box for LO .. HI of PROFILE: one for all colours, or one that moves
 * with them and takes more terms. */
void glint_zone_init(struct glint_zone *zone,
                     const struct glint_visible_profile *profile, double lo,
                     double hi, bool by_colour);

/* Returns where an annular box begins, a share of its half height. */
double glint_zone_rim(int annulus);

/* The halves of PART, along v (inner and outer) or along u. */
void glint_zone_part_halve(const struct glint_zone_part *part, bool along_v,
                           struct glint_zone_part *first,
                           struct glint_zone_part *second);

/* Reduces the box to PART of it. */
void glint_zone_cut(struct glint_zone *zone,
                    const struct glint_zone_part *part);

/* Reduces PART, to which ZONE has been cut and VISIBLE narrowed, to what can be
 * seen of it, and a margin. Returns by how much, 1: by nothing; 0: there is
 * nothing. */
double glint_zone_crop(const struct glint_zone *zone,
                       const struct glint_visible *visible,
                       struct glint_zone_part *part);

/* Node K of N over -1 .. 1, the ends among them. */
double glint_zone_node(int k, int n);

#endif
