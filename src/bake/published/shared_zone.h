/* SPDX-License-Identifier: MIT
 *
 * Least squares over the rays of one zone in a sparse basis.
 *
 *   in   rays: x, y, r, 1 - r and the exact outputs; the terms of a basis
 *   out  coefficients, and what other terms would do
 *
 * Rays that get through have weight 1, others next to none, except where the
 * polynomial would let a ray through that is cut [Bodonyi25]; so stop and
 * radius are fitted in a few rounds. Large coefficients have a small cost, a
 * row each in the least squares, so that none cancels another beyond what
 * integers can hold.
 *
 * Method: QR by modified Gram-Schmidt, each column twice. With the terms of a
 * basis orthonormal, what a candidate would gain as one more term, or instead
 * of any one of them, takes a dot product per term. The rays are the half y > 0
 * of a symmetric set.
 */
#ifndef GLINT_BAKE_PUBLISHED_SHARED_ZONE_H
#define GLINT_BAKE_PUBLISHED_SHARED_ZONE_H

#include <stdbool.h>
#include <stdint.h>

#include "bake/fit/regress.h"
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
    double excess[GLINT_SHARED_RAYS]; /* the largest of all relative radii, stop
                                         and field too; above 1 it is cut */
    bool lost[GLINT_SHARED_RAYS];     /* true: the ray got nowhere and has no
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
    double scale; /* scale of the outputs: energy is divided by its mean */
    double cost;  /* cost of a coefficient: its row in the least squares */
    double weight2[GLINT_SHARED_RAYS], value[GLINT_SHARED_RAYS];
    double fit[GLINT_SHARED_RAYS], column[GLINT_SHARED_RAYS];
    /* The orthonormal terms, and what is left of the output: a row for each
     * ray, times its weight, and one for each coefficient. */
    double q[GLINT_SHARED_TERMS][GLINT_SHARED_ROWS], left[GLINT_SHARED_ROWS];
    double r[GLINT_SHARED_TERMS][GLINT_SHARED_TERMS]; /* [column][row] */
    double share[GLINT_SHARED_TERMS]; /* share of each row of q in the output */
    /* Directions of the terms apart from all the others, on q, and the output's
     * share of them. */
    double apart[GLINT_SHARED_TERMS][GLINT_SHARED_TERMS];
    double alone[GLINT_SHARED_TERMS];
};

/* The values of one output; every ray that is cut counts as such. TOLERANCE
 * sets what coefficients cost. */
void glint_shared_begin(struct glint_shared_zone *zone,
                        const struct glint_shared_rays *rays,
                        enum glint_channel kind, double tolerance);

/* Fits BASIS, from what the fit before lets through. A term that is a
 * combination of others gets 0. Returns the mean squared error. */
double glint_shared_fit(struct glint_shared_zone *zone,
                        const struct glint_shared_rays *rays,
                        enum glint_channel kind,
                        const struct glint_shared_basis *basis, double *coef);

/* After a fit with N terms: makes glint_shared_gain() possible and adds to
 * COST[n] what dropping each term costs. */
void glint_shared_part(struct glint_shared_zone *zone, int n, double *cost);

/* Adds what term POWER would take from the squared error: to GAIN[n] as one
 * more term, to GAIN[i] in place of term i once that is dropped. */
void glint_shared_gain(struct glint_shared_zone *zone,
                       const struct glint_shared_rays *rays, int n,
                       const uint8_t *power, double *gain);

/* The first two together, for the final coefficients, COEF[basis->n]. Returns
 * the mean squared error of the rays that get through, of the energy relative
 * to its mean; -1: there are none. */
double glint_shared_solve(struct glint_shared_zone *zone,
                          const struct glint_shared_rays *rays,
                          enum glint_channel kind,
                          const struct glint_shared_basis *basis,
                          double tolerance, double *coef);

#endif
