/* SPDX-License-Identifier: MIT
 *
 * Checks that sparse regression finds the terms of functions for which a greedy
 * choice of terms fails.
 */
#include "bake/regress/regress.h"
#include "support/lens_check.h"

enum { SIDE = 9, RAYS = SIDE * SIDE };

static const struct glint_degrees degrees = {.most = {6, 6, 0, 0},
                                             .weight = {1, 1, 1, 1},
                                             .total = 8,
                                             .parity = 0,
                                             .terms = 8,
                                             .leaps = true};

/* Fits a polynomial to VALUE(u, v) on a grid, LEAST .. 1 along u and -1 .. 1
 * along v. Returns the residual. */
static double fit_on_grid(double (*value)(double u, double v), double least,
                          struct glint_poly *poly)
{
    double u[RAYS], v[RAYS], zero[RAYS], one[RAYS], y[RAYS];
    const struct glint_regress_samples samples = {
        RAYS, {u, v, zero, zero}, one};
    double *scratch =
        malloc(GLINT_REGRESS_DOUBLES(RAYS, 1, 13 * 13, 1) * sizeof *scratch);
    double left;

    assert_non_null(scratch);
    for (int i = 0; i < RAYS; i++) {
        u[i] = least + (1 - least) * (i % SIDE) / (SIDE - 1);
        v[i] = 2.0 * (i / SIDE) / (SIDE - 1) - 1;
        zero[i] = 0;
        one[i] = 1;
        y[i] = value(u[i], v[i]);
    }
    left = glint_regress_fit_polynomial(scratch, &samples, y, &degrees, 1e-9,
                                        5e-9, poly);
    free(scratch);
    return left;
}

static double evaluate_even_polynomial(double u, double v)
{
    return 1 - 3 * u * u + 2 * u * u * u * u + v * v;
}

static double evaluate_odd_polynomial(double u, double v)
{
    return 0.1 + u - 0.5 * u * u * u + 0.25 * u * v * v;
}

static double evaluate_polynomial(const struct glint_poly *poly,
                                  const double *x)
{
    return glint_poly_evaluate(poly->n, poly->power, poly->coef, x);
}

/* On a grid symmetric in u, odd powers cannot represent an even function, nor
 * even powers an odd one: the fit must not use them. */
TEST(symmetric_grid_separates_even_and_odd_terms)
{
    const double x[GLINT_VARIABLES] = {0.3, -0.6, 0, 0};
    struct glint_poly poly;

    assert_true(fit_on_grid(evaluate_even_polynomial, -1, &poly) <= 1);
    assert_int_equal(poly.n, 4);
    assert_near(evaluate_polynomial(&poly, x),
                evaluate_even_polynomial(x[0], x[1]), 1e-8);
    assert_true(fit_on_grid(evaluate_odd_polynomial, -1, &poly) <= 1);
    assert_int_equal(poly.n, 4);
    assert_near(evaluate_polynomial(&poly, x),
                evaluate_odd_polynomial(x[0], x[1]), 1e-8);
}

static double evaluate_cubic_polynomial(double u, double v)
{
    (void)v;
    return 1 - u + 2 * u * u - 3 * u * u * u;
}

/* On a twentieth of the range, powers of u are nearly dependent: only 10^-5 of
 * the length of u^3 is orthogonal to lower powers. Differences of squares would
 * cancel this part, so the regression computes it separately. */
TEST(fits_nearly_dependent_powers)
{
    const double x[GLINT_VARIABLES] = {0.967, 0.4, 0, 0};
    struct glint_poly poly;

    assert_true(fit_on_grid(evaluate_cubic_polynomial, 0.95, &poly) <= 1);
    assert_near(evaluate_polynomial(&poly, x),
                evaluate_cubic_polynomial(x[0], x[1]), 1e-8);
}

/* Rays of no weight leave a polynomial of one term, as a model requires. */
TEST(fit_without_weights_has_a_term)
{
    double zero[RAYS] = {0};
    const struct glint_regress_samples samples = {
        RAYS, {zero, zero, zero, zero}, zero};
    double *scratch =
        malloc(GLINT_REGRESS_DOUBLES(RAYS, 1, 13 * 13, 1) * sizeof *scratch);
    struct glint_poly poly;

    assert_non_null(scratch);
    glint_regress_fit_polynomial(scratch, &samples, zero, &degrees, 1e-9, 5e-9,
                                 &poly);
    free(scratch);
    assert_int_equal(poly.n, 1);
    assert_near(poly.coef[0], 0, 0);
}

static double evaluate_pole(double u, double v)
{
    return 1 / (1.0001 - u) + v * v;
}

/* Where terms depend on each other so much that refining the fit diverges, the
 * fit ends before: it is never worse than no polynomial at all. */
TEST(refining_never_enlarges_the_residual)
{
    struct glint_poly poly;

    for (double least = 0; least < 0.9999999; least += 0.3 * (1 - least)) {
        const double none = fmax(1e4 / 3 / 1e-9, 1e4 / 5e-9);

        assert_true(fit_on_grid(evaluate_pole, least, &poly) <= 1.1 * none);
    }
}
