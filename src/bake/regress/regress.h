/* SPDX-License-Identifier: MIT
 *
 * Sparse polynomial regression in up to five variables.
 *
 *   in   samples of the variables (each within -1 .. 1), a value and a weight
 *   out  few monomials that fit the value within a tolerance
 *
 * Method: greedy growth. Candidates are the neighbours of the chosen terms,
 * with one power more in one variable [Zheng17]. The candidate that reduces the
 * weighted residual most is chosen (orthogonal matching pursuit). All products
 * of terms come from tables of sums: consecutive samples that share variables 2
 * to 4 form a plane, and in a plane a product of two terms is a sum of powers
 * of variables 0 and 1. The columns of the terms are never computed. Components
 * along chosen terms follow as in a Cholesky factorisation; a candidate that is
 * nearly a combination of chosen terms has a remaining length near 0 and is
 * skipped. The residual is measured on the samples before a fit is accepted.
 */
#ifndef GLINT_BAKE_REGRESS_REGRESS_H
#define GLINT_BAKE_REGRESS_REGRESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { GLINT_VARIABLES = 5, GLINT_MAX_TERMS = 120, GLINT_MAX_CANDIDATES = 280 };

/* indices of a ghost's variables (glint/model.h) in polynomials */
enum { GLINT_U, GLINT_V, GLINT_S, GLINT_W, GLINT_P };

struct glint_poly {
    int n;
    uint8_t power[GLINT_MAX_TERMS][GLINT_VARIABLES];
    double coef[GLINT_MAX_TERMS];
};

/* the terms that may be chosen */
struct glint_degrees {
    uint8_t most[GLINT_VARIABLES]; /* max power of each variable */
    /* factor on the power of each variable in the weighted sum */
    uint8_t weight[GLINT_VARIABLES];
    int total;  /* max weighted sum of powers */
    int parity; /* parity of variable 1: 0 even, 1 odd, -1 any */
    int terms;  /* max number of terms, 1 .. GLINT_MAX_TERMS */
    /* After patience terms the fit stops if its error exceeds its limit by more
     * than the factor hopeless; 0: it never stops early. */
    double hopeless;
    int patience;
    /* true: a term's neighbours also have two powers more of variable 0, and of
     * variable 1 if its parity is free */
    bool leaps;
};

struct glint_regress_samples {
    int n;
    /* NULL for variables that occur in no term */
    const double *x[GLINT_VARIABLES];
    const double *weight;
};

enum {
    GLINT_REGRESS_POWER = 15,  /* max power of variables 0 and 1 */
    GLINT_REGRESS_PLANES = 544 /* max number of planes */
};

/* Size of the scratch memory of a fit, in doubles, for N samples in at most
 * PLANES planes. PLACES: product of (2 most + 1) over variables 0 and 1.
 * MIXES: product of (most + 1) over the other variables. */
#define GLINT_REGRESS_DOUBLES(n, planes, places, mixes) \
    (8 * ((size_t)(n) + 3 * (size_t)(planes)) +         \
     ((size_t)(planes) + 3) * (3 * (size_t)(places) + (size_t)(mixes)))

/* Fits POLY to Y. Stops when the weighted residual is at most RMS (root mean
 * square) and PEAK (max magnitude), or when no other term reduces it. The
 * result has at least one term, unless all weights are 0. Returns the max of
 * RMS residual / RMS and max residual / PEAK, which is at most 1 if the fit met
 * its tolerance. */
double glint_regress_fit_polynomial(double *scratch,
                                    const struct glint_regress_samples *samples,
                                    const double *y,
                                    const struct glint_degrees *degrees,
                                    double rms, double peak,
                                    struct glint_poly *poly);

/* Returns the value at X of the polynomial with N terms. */
double glint_poly_evaluate(int n, const uint8_t (*power)[GLINT_VARIABLES],
                           const double *coef, const double *x);

#endif
