/* SPDX-License-Identifier: MIT
 *
 * Sparse regression: terms that a greedy choice has to find.
 */
#include <math.h>
#include <stdlib.h>

#include "bake/regress/regress.h"
#include "support/lens_check.h"

enum { SIDE = 9, RAYS = SIDE * SIDE };

static const struct glint_degrees degrees = {.most = {6, 6, 0, 0},
                                             .weight = {1, 1, 1, 1},
                                             .total = 8,
                                             .parity = 0,
                                             .terms = 8,
                                             .leaps = true};

/* Fits VALUE of a place on a grid, LEAST .. 1 along u and -1 .. 1 along v. */
static double fit(double (*value)(double u, double v), double least,
                  struct glint_poly *poly)
{
    double u[RAYS], v[RAYS], zero[RAYS], one[RAYS], y[RAYS];
    const struct glint_regress_samples samples = {
        RAYS, {u, v, zero, zero}, one};
    double *scratch =
        malloc(GLINT_REGRESS_DOUBLES(RAYS, 8, 49, 13 * 13) * sizeof *scratch);
    double left;

    assert_non_null(scratch);
    for (int i = 0; i < RAYS; i++) {
        u[i] = least + (1 - least) * (i % SIDE) / (SIDE - 1);
        v[i] = 2.0 * (i / SIDE) / (SIDE - 1) - 1;
        zero[i] = 0;
        one[i] = 1;
        y[i] = value(u[i], v[i]);
    }
    left = glint_regress_fit(scratch, &samples, y, &degrees, 1e-9, 5e-9, poly);
    free(scratch);
    return left;
}

static double even(double u, double v)
{
    return 1 - 3 * u * u + 2 * u * u * u * u + v * v;
}

static double odd(double u, double v)
{
    return 0.1 + u - 0.5 * u * u * u + 0.25 * u * v * v;
}

static double at(const struct glint_poly *poly, const double *x)
{
    return glint_poly_at(poly->n, poly->power, poly->coef, x);
}

/* On a grid that is symmetric in u odd powers explain nothing of an even
 * function, and the other way round: no term in between must be needed. */
TEST(symmetric)
{
    const double x[GLINT_VARIABLES] = {0.3, -0.6, 0, 0};
    struct glint_poly poly;

    assert_true(fit(even, -1, &poly) <= 1);
    assert_int_equal(poly.n, 4);
    assert_near(at(&poly, x), even(x[0], x[1]), 1e-8);
    assert_true(fit(odd, -1, &poly) <= 1);
    assert_int_equal(poly.n, 4);
    assert_near(at(&poly, x), odd(x[0], x[1]), 1e-8);
}

static double cubic(double u, double v)
{
    (void)v;
    return 1 - u + 2 * u * u - 3 * u * u * u;
}

/* Of a twentieth of the range powers of u are nearly alike: what u^3 has beside
 * the lower ones, 10^-5 of its length, is lost in differences of squares, and
 * is worked out again. */
TEST(nearly_dependent)
{
    const double x[GLINT_VARIABLES] = {0.967, 0.4, 0, 0};
    struct glint_poly poly;

    assert_true(fit(cubic, 0.95, &poly) <= 1);
    assert_near(at(&poly, x), cubic(x[0], x[1]), 1e-8);
}
