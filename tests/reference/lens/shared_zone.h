/* SPDX-License-Identifier: MIT
 *
 * Least squares over the rays of one zone in a sparse basis.
 *
 *   in   rays: x, y, r, 1 - r and the exact outputs; the terms of a basis
 *   out  coefficients, and the effect of other terms
 *
 * Rays that get through have weight 1. Others have little, except where the
 * polynomial would let a ray through that is cut [Bodonyi25]; so stop and
 * radius are fitted in a few rounds. Large coefficients have a small cost, a
 * row each in the least squares, so that none cancels another beyond what
 * integers can hold.
 *
 * Method: QR by modified Gram-Schmidt, each column twice. With the terms of a
 * basis orthonormal, the gain by a candidate as one more term, or in place of
 * any one of them, takes a dot product per term. The rays are the half y > 0 of
 * a symmetric set. */
#ifndef REFERENCE_LENS_SHARED_ZONE_H
#define REFERENCE_LENS_SHARED_ZONE_H

#include <stdbool.h>
#include <stdint.h>

#include "bake/regress/regress.h"
#include "glint/model.h"

enum {
    GLINT_SHARED_TERMS = 12,
    GLINT_SHARED_OUTPUTS = GLINT_OUT_RADIUS + 1,
    GLINT_SHARED_RAYS = 512,
    GLINT_SHARED_ROWS = GLINT_SHARED_RAYS + GLINT_SHARED_TERMS
};

/* Rays at one angle and wavelength. */
struct glint_shared_rays {
    int n;
    double x[GLINT_VARIABLES][GLINT_SHARED_RAYS];
    /* outputs of each ray, by kind */
    double at[GLINT_SHARED_OUTPUTS][GLINT_SHARED_RAYS];
    double excess[GLINT_SHARED_RAYS]; /* largest relative radius of the ray, at
                                         the stop and in the field, too; above 1
                                         it is cut */
    bool lost[GLINT_SHARED_RAYS]; /* true: the ray does not arrive and has no
                                     outputs */
};

struct glint_shared_basis {
    int n;
    uint8_t power[GLINT_SHARED_TERMS][GLINT_VARIABLES];
    double square; /* mean over the zones of the weighted squared error */
};

/* A zone's least squares, about 75 KB. */
struct glint_shared_zone {
    int n, seen;
    /* Factor on the outputs: energies are divided by their mean. */
    double scale;
    double cost; /* weight of a coefficient's own row in the least squares */
    double weight2[GLINT_SHARED_RAYS], value[GLINT_SHARED_RAYS];
    double fit[GLINT_SHARED_RAYS], column[GLINT_SHARED_RAYS];
    /* The orthonormal terms, and the residual of the output: a row for each
     * ray, times its weight, and one for each coefficient. */
    double q[GLINT_SHARED_TERMS][GLINT_SHARED_ROWS], left[GLINT_SHARED_ROWS];
    double r[GLINT_SHARED_TERMS][GLINT_SHARED_TERMS]; /* [column][row] */
    /* Fraction of the output along each row of q. */
    double share[GLINT_SHARED_TERMS];
    /* For each term, the direction that no other term shares, as coordinates on
     * q, and the output's share along it. */
    double apart[GLINT_SHARED_TERMS][GLINT_SHARED_TERMS];
    double alone[GLINT_SHARED_TERMS];
};

/* Sets the values of output KIND and forgets the last fit. TOLERANCE sets the
 * cost of coefficients. */
void glint_shared_begin(struct glint_shared_zone *zone,
                        const struct glint_shared_rays *rays,
                        enum glint_channel kind, double tolerance);

/* Fits BASIS, with weights that depend on what the last fit lets through. A
 * term that is a combination of others gets 0. Returns the mean squared error.
 */
double glint_shared_fit(struct glint_shared_zone *zone,
                        const struct glint_shared_rays *rays,
                        enum glint_channel kind,
                        const struct glint_shared_basis *basis, double *coef);

/* Prepares glint_shared_gain() after a fit with N terms, and adds to COST[n]
 * the error that dropping each term adds. */
void glint_shared_part(struct glint_shared_zone *zone, int n, double *cost);

/* Adds to GAIN[n] how much term POWER would lower the squared error as one more
 * term, and to GAIN[i] how much in place of term i, once that is dropped. */
void glint_shared_gain(struct glint_shared_zone *zone,
                       const struct glint_shared_rays *rays, int n,
                       const uint8_t *power, double *gain);

/* Begins and fits a zone for its final coefficients, COEF[basis->n]. Returns
 * the mean squared error of the rays that get through, for the energy relative
 * to its mean; -1 if there are none. */
double glint_shared_solve(struct glint_shared_zone *zone,
                          const struct glint_shared_rays *rays,
                          enum glint_channel kind,
                          const struct glint_shared_basis *basis,
                          double tolerance, double *coef);

#endif
