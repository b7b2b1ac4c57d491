/* SPDX-License-Identifier: MIT
 *
 * Reflectance of a boundary between two media, bare or coated, from given
 * cosines.
 *
 * Functions are inline, as the tracer calls them once per surface and has the
 * cosines. With one film, the reflectance is Airy's sum over all orders,
 * written for real numbers as in a characteristic matrix. With the admittances
 * a, f, b of first medium, film and second medium (n cos for s, n / cos for p)
 * and D half the phase,
 *
 *     R = (a - b)^2 C + (a b / f - f)^2 S     C = cos^2 D
 *         -------------------------------  ,
 *         (a + b)^2 C + (a b / f + f)^2 S     S = sin^2 D
 *
 * multiplied through so that both polarisations need one division. Beyond the
 * critical angle inside the film, f is imaginary, C and S become cosh^2 and
 * sinh^2, and one sign changes in each of the inner sums. [Hullin11]
 */
#ifndef GLINT_BAKE_TRACE_COATING_H
#define GLINT_BAKE_TRACE_COATING_H

#include <math.h>

#include "glint/trace.h"

/* Returns the mean of S / S_ALL and P / P_ALL, at most 1. Uses a single
 * division, because divisions are slow. */
static inline double compute_mean_ratio(double s, double s_all, double p,
                                        double p_all)
{
    const double mean = 0.5 * (s * p_all + p * s_all) / (s_all * p_all);

    return mean < 1.0 ? mean : 1.0;
}

/* Returns the reflectance of a bare boundary between media of indices N1 and N2
 * at the cosines C1 of incidence and C2 of refraction, both > 0. */
static inline double compute_bare_reflectance(double n1, double c1, double n2,
                                              double c2)
{
    const double s = n1 * c1 - n2 * c2, s_all = n1 * c1 + n2 * c2;
    const double p = n1 * c2 - n2 * c1, p_all = n1 * c2 + n2 * c1;

    return compute_mean_ratio(s * s, s_all * s_all, p * p, p_all * p_all);
}

/* Returns the squared cosine of the ray inside a film of index NF, which is
 * negative beyond the critical angle. Replaces values near 0 by 1e-60. */
static inline double compute_film_cosine2(double n1, double c1, double nf)
{
    const double ratio = n1 / nf;
    const double inside = 1.0 - ratio * ratio * (1.0 - c1 * c1);

    return fabs(inside) > 1e-60 ? inside : 1e-60;
}

/* Returns the square of sin(X), 0 <= X < 10^5, within 1e-15. It consists of
 * additions and multiplications only, so that compilers can vectorise loops
 * over rays, and its bits are the same on every CPU. */
static inline double compute_sine2(double x)
{
    /* pi as a sum of two numbers; the first has 20 trailing zero bits */
    const double pi = 3.14159265346825122834, rest = 1.21542010130123844986e-10;
    const double shift =
        6755399441055744.0; /* 1.5 * 2^52: rounds to integers */
    const double turns = (x * 0.31830988618379067154 + shift) - shift;
    const double r = (x - turns * pi) - turns * rest, z = r * r;
    /* series of sin(r) / r, |r| <= pi / 2 */
    const double a =
        1.0 / 355687428096000.0 -
        z * (1.0 / 121645100408832000.0 - z * (1.0 / 51090942171709440000.0));
    const double b =
        1.0 / 39916800.0 -
        z * (1.0 / 6227020800.0 - z * (1.0 / 1307674368000.0 - z * a));
    const double c =
        1.0 / 120.0 - z * (1.0 / 5040.0 - z * (1.0 / 362880.0 - z * b));
    const double sine = r * (1.0 - z * (1.0 / 6.0 - z * c));

    return sine * sine;
}

/* Returns sin^2 D for PHASE = 4 pi nf d / wavelength, or sinh^2 |D| if INSIDE,
 * the squared cosine, is negative. D: half the phase inside the film. */
static inline double compute_film_sine2(double inside, double phase)
{
    const double half = 0.5 * phase * sqrt(fabs(inside)); /* |D| */
    double root;

    if (!(inside < 0.0))
        return compute_sine2(half);
    /* limits the phase to 100: sinh(100) does not overflow, and no light passes
     * such a film */
    root = sinh(fmin(half, 100.0));
    return root * root;
}

/* Returns the reflectance of a boundary with a film of index NF. INSIDE: the
 * squared cosine inside the film; SIN2: sin^2 of half its phase; other
 * arguments as for a bare boundary. */
static inline double compute_film_reflectance(double n1, double c1, double n2,
                                              double c2, double nf,
                                              double inside, double sin2)
{
    const double size = fabs(inside), sign = inside < 0.0 ? -1.0 : 1.0;
    const double cos2 = 1.0 - sign * sin2;
    /* To avoid divisions, the terms of the formula above are multiplied by f
     * for s polarisation, and by f * size * c1 * c2 for p. The sign of f^2 is
     * kept in SIGN. */
    const double f2_s = nf * nf * size, f2_p = nf * nf;
    const double a_s = n1 * c1, b_s = n2 * c2;
    /* admittances n / c of polarisation p, multiplied by c1 c2 */
    const double a_p = n1 * c2, b_p = n2 * c1;
    const double ab_s = a_s * b_s, ab_p = n1 * n2 * size;
    const double g_s = sign * f2_s, g_p = sign * f2_p * c1 * c2;
    const double minus_s = (a_s - b_s) * (a_s - b_s) * f2_s * cos2 +
                           (ab_s - g_s) * (ab_s - g_s) * sin2;
    const double plus_s = (a_s + b_s) * (a_s + b_s) * f2_s * cos2 +
                          (ab_s + g_s) * (ab_s + g_s) * sin2;
    const double minus_p = (a_p - b_p) * (a_p - b_p) * f2_p * size * cos2 +
                           (ab_p - g_p) * (ab_p - g_p) * sin2;
    const double plus_p = (a_p + b_p) * (a_p + b_p) * f2_p * size * cos2 +
                          (ab_p + g_p) * (ab_p + g_p) * sin2;

    return compute_mean_ratio(minus_s, plus_s, minus_p, plus_p);
}

/* Sets S and P to the reflectance of FILM[N] per polarisation: the product of
 * the films' characteristic matrices. FILM[0] is next to the medium of lower
 * index. The matrix of a film is (cos D, i sin D / f; i f sin D, cos D), where
 * D is half the film's phase and f its admittance. Off-diagonal elements stay
 * imaginary, and in a film with total reflection both f and D are imaginary, so
 * real numbers are sufficient. [Macleod, Thin-Film Optical Filters, ch. 2] */
void glint_stack_compute_reflectance_sp(double n1, double c1, double n2,
                                        double c2,
                                        const struct glint_film_at *film, int n,
                                        double *s, double *p);

/* Returns the reflectance of FILM[N], the mean of both polarisations. */
static inline double compute_stack_reflectance(double n1, double c1, double n2,
                                               double c2,
                                               const struct glint_film_at *film,
                                               int n)
{
    double s, p;

    glint_stack_compute_reflectance_sp(n1, c1, n2, c2, film, n, &s, &p);
    return 0.5 * (s + p);
}

#endif
