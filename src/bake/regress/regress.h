/* SPDX-License-Identifier: MIT
 *
 * Sparse polynomial regression in up to five variables.
 *
 *   in   samples of the variables (each within -1 .. 1), a value and a weight
 *   out few monomials that fit the value within a tolerance
 *
 * Method: greedy growth. Candidates are the neighbours, one power up in one
 * variable, of the terms chosen so far [Zheng17]; the one that lowers the
 * weighted residual most enters. All columns are kept orthogonal to the chosen
 * ones, so the basis grows together with its QR factors: a candidate that is
 * nearly a combination of chosen terms has no length left and is skipped,
 * which makes the factorisation rank revealing.
 */
#ifndef GLINT_BAKE_REGRESS_REGRESS_H
#define GLINT_BAKE_REGRESS_REGRESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { GLINT_VARIABLES = 5, GLINT_MAX_TERMS = 120, GLINT_MAX_CANDIDATES = 280 };

/* Places of the variables of ghosts (glint/model.h) in polynomials. */
enum { GLINT_U, GLINT_V, GLINT_S, GLINT_W, GLINT_P };

struct glint_poly {
    int n;
    uint8_t power[GLINT_MAX_TERMS][GLINT_VARIABLES];
    double coef[GLINT_MAX_TERMS];
};

/* The terms that may be chosen. */
struct glint_degrees {
    uint8_t most[GLINT_VARIABLES];   /* largest power of each variable */
    uint8_t weight[GLINT_VARIABLES]; /* weight of each power in the total */
    int total;                       /* largest weighted sum of powers */
    int parity; /* parity of variable 1: 0 even, 1 odd, -1 any */
    int terms;  /* largest number of terms, 1 .. GLINT_MAX_TERMS */
    /* After PATIENCE terms the fit stops as soon as its error exceeds HOPELESS
     * times its limit; 0: it never stops early. */
    double hopeless;
    int patience;
    bool leaps; /* terms two powers up in variable 0 are neighbours, too, and in
                   variable 1 if it may have any parity */
};

struct glint_regress_samples {
    int n;
    const double *x[GLINT_VARIABLES]; /* NULL for variables that no term
                                         contains */
    const double *weight;
};

/* Number of doubles that the scratch of a fit to N samples needs, with at most
 * TERMS terms, chosen from CANDIDATES. MOMENTS is the product of 2 MOST + 1
 * over the variables. */
#define GLINT_REGRESS_DOUBLES(n, terms, candidates, moments) \
    ((size_t)(moments) + (size_t)(n) * (1 + (terms) + (candidates)))

/* Fits Y. Stops when the weighted residual is at most RMS in the root mean
 * square and PEAK everywhere, or when no term helps any more. There is at least
 * one term, unless all weights are 0. Returns the residual in units of RMS or
 * PEAK, the larger ratio: the fit succeeded if it is at most 1. */
double glint_regress_fit(double *scratch,
                         const struct glint_regress_samples *samples,
                         const double *y, const struct glint_degrees *degrees,
                         double rms, double peak, struct glint_poly *poly);

/* Returns the value of the polynomial of N terms at X. */
double glint_poly_at(int n, const uint8_t (*power)[GLINT_VARIABLES],
                     const double *coef, const double *x);

#endif
