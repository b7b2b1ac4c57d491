/* SPDX-License-Identifier: MIT
 *
 * Sparse polynomial regression in up to four variables.
 *
 *   in   samples of the variables (each within -1 .. 1), a value and a weight
 *   out  the few monomials that describe the value well enough
 *
 * Method: greedy growth. Candidates are the neighbours, one power up in one
 * variable, of the terms chosen so far [Zheng17]; the one that lowers the
 * weighted residual most enters. All columns are kept orthogonal to the chosen
 * ones, so the basis grows together with its QR factors: a candidate that is
 * nearly a combination of chosen terms has no length left and is passed over,
 * which makes the factorisation rank revealing.
 */
#ifndef GLINT_BAKE_FIT_REGRESS_H
#define GLINT_BAKE_FIT_REGRESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { GLINT_VARIABLES = 4, GLINT_MAX_TERMS = 120, GLINT_MAX_CANDIDATES = 280 };

struct glint_poly {
    int n;
    uint8_t power[GLINT_MAX_TERMS][GLINT_VARIABLES];
    double coef[GLINT_MAX_TERMS];
};

/* The terms that may be chosen. */
struct glint_degrees {
    uint8_t most[GLINT_VARIABLES];   /* power of each variable */
    uint8_t weight[GLINT_VARIABLES]; /* weight of each power in the total */
    int total;                       /* weighted sum of powers, at most */
    int parity; /* parity of variable 1: 0 even, 1 odd, -1 any */
    int terms;  /* 1 .. GLINT_MAX_TERMS */
    /* More than HOPELESS times of what may be, left after so many terms, ends
     * it; 0: never. */
    double hopeless;
    int patience;
};

struct glint_regress_samples {
    int n;
    const double *x[GLINT_VARIABLES];
    const double *weight;
};

/* Doubles that regression over N samples needs. */
size_t glint_regress_doubles(int n);

/* Fits Y. Stops where the weighted residual is at most RMS in the mean and PEAK
 * everywhere, or where nothing more helps; there is a term at least, unless all
 * weights are 0. Returns how much of these is left,
 * the larger ratio: up to 1 it got there. */
double glint_regress_fit(double *scratch,
                         const struct glint_regress_samples *samples,
                         const double *y, const struct glint_degrees *degrees,
                         double rms, double peak, struct glint_poly *poly);

/* The polynomial of N terms at X. */
double glint_poly_at(int n, const uint8_t (*power)[GLINT_VARIABLES],
                     const double *coef, const double *x);

#endif
