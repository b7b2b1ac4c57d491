/* SPDX-License-Identifier: MIT */
#include "engine/star/arcs.h"

#include <complex.h>
#include <math.h>

#include "glint/view.h"

static const double complex i_unit = (double complex)I;

void glint_arcs_init(struct glint_arcs *a, int n, double rotation_deg,
                     double round)
{
    const double half_side = sin(GLINT_PI / n), apothem = cos(GLINT_PI / n);

    *a = (struct glint_arcs){
        .n = n, .rotation_deg = rotation_deg, .round = round};
    a->turn = asin(round * half_side);
    a->behind = cos(a->turn) / round - apothem;
    a->perimeter = 2 * n * a->turn / round;
    a->area = 0.5 * n * sin(2 * GLINT_PI / n) +
              n * (2 * a->turn - sin(2 * a->turn)) / (2 * round * round);
}

/* Returns the number of sides to sum: N if N is odd, half of N if N is even, as
 * the contribution of an opposite side is the complex conjugate. */
static int count_summed_sides(int n)
{
    return n % 2 ? n : n / 2;
}

/* Returns the direction of the normal in the middle of side I, radians. */
static double compute_side_normal_angle(const struct glint_arcs *a, int i)
{
    return a->rotation_deg * (GLINT_PI / 180) + (i + 0.5) * 2 * GLINT_PI / a->n;
}

/* Returns C(x) + i S(x), Fresnel's integrals of pi t^2 / 2: (1 + i) / 2 erf(z)
 * with z = sqrt(pi) (1 - i) x / 2, by its series or by the continued fraction
 * of erfc(z) = exp(-z^2) / sqrt(pi) / (z + 1/2 / (z + 1 / (z + 3/2 / ...))). */
static double complex compute_fresnel_integral(double x)
{
    const double ax = fabs(x), half = 0.5 * sqrt(GLINT_PI) * ax;
    double complex value;

    if (ax < 1.6) {
        double complex term = ax;

        value = ax;
        for (int k = 1; k < 22; k++) {
            term *= i_unit * (0.5 * GLINT_PI * ax * ax / k);
            value += term / (2.0 * k + 1);
        }
    } else {
        double re = 0, im = 0, size;

        for (int k = 6 + (int)(90 / (ax * ax)); k > 0; k--) {
            re += half;
            im -= half;
            size = 0.5 * k / (re * re + im * im);
            re *= size;
            im *= -size;
        }
        re += half;
        im -= half;
        size = sqrt(GLINT_PI) * (re * re + im * im);
        value = 0.5 * (1 + i_unit) *
                (1 - (cos(2 * half * half) + i_unit * sin(2 * half * half)) *
                         ((re - i_unit * im) / size));
    }
    return x < 0 ? -value : value;
}

/* Returns the correction of the Fresnel integral at an end of an arc, where the
 * slowly varying factor differs from its value at w = 0, which the integral
 * uses. W is the sine of half the angle between the normal at the end and the
 * frequency vector q. */
static double complex compute_arc_end_correction(double w, double kappa)
{
    const double g = 2 * (1 - 2 * w * w) / sqrt(1 - w * w) - 2;
    const double phase = kappa * w * w;

    return fabs(w) < 1e-9 ? 0
                          : -i_unit * (g / (2 * kappa * w)) *
                                (cos(phase) + i_unit * sin(phase));
}

/* Returns the integral along one arc by its approximation for large
 * frequencies, without the phase of the arc's middle. TO: angle between the
 * arc's normal and the frequency vector, radians; Q: its length. For an arc on
 * the far side of the stop the integral is the complex conjugate. */
static double complex integrate_arc_asymptotically(const struct glint_arcs *a,
                                                   double q, double to)
{
    const double at = fabs(remainder(to, 2 * GLINT_PI));
    const double near = at > 0.5 * GLINT_PI ? GLINT_PI - at : at;
    const double kappa = 4 * GLINT_PI * q / a->round;
    const double w1 = sin(0.5 * (-a->turn - near));
    const double w2 = sin(0.5 * (a->turn - near));
    const double scale = sqrt(2 * kappa / GLINT_PI);
    const double complex middle = 2 *
                                  (compute_fresnel_integral(w2 * scale) -
                                   compute_fresnel_integral(w1 * scale)) /
                                  scale;

    return q / a->round *
           (middle + compute_arc_end_correction(w2, kappa) -
            compute_arc_end_correction(w1, kappa));
}

/* --------------------------------------------------------------------- near */

/* Returns the integral along one arc, including the phase of the arc's middle,
 * by Simpson's rule with a few points per turn of the phase. */
static double complex integrate_arc_numerically(const struct glint_arcs *a,
                                                double normal, double q,
                                                double direction)
{
    const double to = direction - normal, radius = 1 / a->round;
    const int steps =
        4 + (int)(6 * q * radius * a->turn * fmin(1, fabs(sin(to)) + a->turn));
    double complex sum = 0;

    for (int i = 0; i <= 2 * steps; i++) {
        const double phi = a->turn * (i - steps) / steps;
        const double weight = i == 0 || i == 2 * steps ? 1 : i & 1 ? 4 : 2;
        const double phase =
            2 * GLINT_PI * q * (radius * cos(phi - to) - a->behind * cos(to));

        sum += weight * cos(phi - to) * (cos(phase) - i_unit * sin(phase));
    }
    return sum * (q * radius * a->turn / steps / 3);
}

/* Returns the integral along one arc, including the phase of the arc's middle,
 * by its approximation for large Q. */
static double complex integrate_arc_far_from_centre(const struct glint_arcs *a,
                                                    double normal, double q,
                                                    double direction)
{
    const double to = direction - normal;
    const double complex size = integrate_arc_asymptotically(a, q, to);
    const int is_behind = cos(to) < 0;
    const double phase =
        2 * GLINT_PI * q *
        ((is_behind ? -1 : 1) / a->round - a->behind * cos(to));

    return (is_behind ? -conj(size) : size) *
           (cos(phase) - i_unit * sin(phase));
}

double glint_arcs_compute_pattern(const struct glint_arcs *a, double qx,
                                  double qy)
{
    const double q = hypot(qx, qy), direction = atan2(qy, qx);
    double complex sum = 0;
    double size;

    if (q < 1e-5)
        return 1;
    for (int i = 0; i < count_summed_sides(a->n); i++)
        sum +=
            (q > 5 ? integrate_arc_far_from_centre : integrate_arc_numerically)(
                a, compute_side_normal_angle(a, i), q, direction);
    size = (a->n % 2 ? cabs(sum) : 2 * cimag(sum)) /
           (2 * GLINT_PI * q * q * a->area);
    return size * size;
}

/* ---------------------------------------------------------------------- far */

double glint_arcs_compute_far_pattern(const struct glint_arcs *a, double qx,
                                      double qy)
{
    const double q = hypot(qx, qy), to = atan2(qy, qx);
    /* squared sine of the angle to an arc's end below which the contributions
     * of the end and of the arc's middle merge */
    const double limit = 0.25 / (q * q);
    double sum = 0;

    for (int i = 0; i < count_summed_sides(a->n); i++) {
        const double normal = compute_side_normal_angle(a, i);
        const double size =
            cabs(integrate_arc_asymptotically(a, q, normal - to));
        /* angles between q and the normals of both arcs at the corner after
         * this arc */
        const double one = to - (normal + a->turn);
        const double other = to - (normal + 2 * GLINT_PI / a->n - a->turn);
        const double s = sin(one), t = sin(other);

        sum += size * size;
        /* At the corner each arc contributes (q n) / (2 pi i q t), where q is
         * the frequency, n the arc's normal and t its direction there. One arc
         * ends and the other begins, so the signs differ. Twice the real part
         * of the product of both contributions is subtracted. */
        sum -= 2 * cos(one) * cos(other) / (4 * GLINT_PI * GLINT_PI) *
               (s / (s * s + limit)) * (t / (t * t + limit));
    }
    sum = fmax(sum * (a->n % 2 ? 1 : 2), 0);
    return sum / (4 * GLINT_PI * GLINT_PI * q * q * q * q * a->area * a->area);
}
