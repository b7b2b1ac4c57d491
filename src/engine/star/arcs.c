/* SPDX-License-Identifier: MIT */
#include "engine/star/arcs.h"

#include <math.h>

#include "base/compiler.h"
#include "glint/view.h"

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

/* max number of frequencies that are computed together */
enum { BATCH = 64 };

/* Frequencies Q in one direction, cycles per stop radius, and the sum of
 * complex amplitudes at each. ROOT is sqrt(q). */
struct batch {
    int n;
    double q[BATCH], root[BATCH];
    double re[BATCH], im[BATCH];
};

/* Sets C and S to the cosine and sine of X, |X| < 2^31, with errors below
 * 1e-14. Sums the series of a quarter of the angle, then doubles it twice. */
static WHOLLY_INLINE void compute_cos_and_sin(double x, double *c, double *s)
{
    const double magic = 0x1.8p52; /* rounds to integers */
    const double turns = (x * (0.5 / GLINT_PI) + magic) - magic;
    const double r =
        0.25 * ((x - turns * 0x1.921fb544p+2) - turns * 0x1.0b4611a626331p-32);
    const double t = r * r;
    double even = 1 / 20922789888000., odd = -1 / 1307674368000., s2, c2;

    even = -1 / 87178291200. + t * even;
    even = 1 / 479001600. + t * even;
    even = -1 / 3628800. + t * even;
    even = 1 / 40320. + t * even;
    even = -1 / 720. + t * even;
    even = 1 / 24. + t * even;
    even = -0.5 + t * even;
    even = 1 + t * even;
    odd = 1 / 6227020800. + t * odd;
    odd = -1 / 39916800. + t * odd;
    odd = 1 / 362880. + t * odd;
    odd = -1 / 5040. + t * odd;
    odd = 1 / 120. + t * odd;
    odd = -1 / 6. + t * odd;
    odd = r + r * t * odd;
    s2 = 2 * odd * even;
    c2 = 1 - 2 * odd * odd;
    *s = 2 * s2 * c2;
    *c = 1 - 2 * s2 * s2;
}

/* Adds SIZE exp(-i ALONG q) to the sums of frequencies FROM .. END - 1. */
static WIDE_VECTORS void add_wave(struct batch *b, int from, int end,
                                  double size, double along)
{
    for (int k = from; k < end; k++) {
        double c, s;

        compute_cos_and_sin(along * b->q[k], &c, &s);
        b->re[k] += size * c;
        b->im[k] -= size * s;
    }
}

/* Multiplies the sums by exp(-i ALONG q). */
static WIDE_VECTORS void turn_phases(struct batch *b, double along)
{
    for (int k = 0; k < b->n; k++) {
        const double re = b->re[k], im = b->im[k];
        double c, s;

        compute_cos_and_sin(along * b->q[k], &c, &s);
        b->re[k] = re * c + im * s;
        b->im[k] = im * c - re * s;
    }
}

/* ------------------------------------------------------------- Fresnel */

/* Fresnel's integrals of pi t^2 / 2 are, for x >= 0,
 *
 *     C(x) + i S(x) = (1 + i) / 2 - (g(x) + i f(x)) exp(i pi x^2 / 2)
 *
 * With p = 1 / (x + MIDDLE) and u = 1 - 2 MIDDLE p, f / p and g / p^3 are
 * polynomials of u, -1 <= u < 1, with errors below 1e-10: Chebyshev series of
 * erfc, fitted in 40 digits. */
#define MIDDLE 2.2
enum { TERMS = 30 };
static const double fresnel_f[TERMS] = {
    0.62928880609058413,   -0.57641749550386789,  0.40202930572692652,
    -0.064839111093498061, -0.31617376365067629,  0.45790236370120213,
    -0.17877400120180742,  -0.2742878346999203,   0.36656977862444479,
    0.039139779743896048,  -0.36270984981448778,  0.099246413812234521,
    0.31258108392721534,   -0.15588246403195177,  -0.2705794921001789,
    0.16331129973669645,   0.23887184485644156,   -0.14192291192224582,
    -0.2011550744760198,   0.10461233811931739,   0.14670226788450741,
    -0.06354720798003087,  -0.0843344752438039,   0.030174666112910527,
    0.034704244615422757,  -0.010368486217409224, -0.008938340595144121,
    0.0022692884803778117, 0.0010726084497322897, -0.00023569516585230917};
static const double fresnel_g[TERMS] = {
    0.76757647124169215,  -2.0133736299872322,   2.9050266346622182,
    -2.265008344506577,   -0.19895310861622154,  2.6308840867678378,
    -2.2052256763239408,  -1.0587653136799509,   2.9345723094168159,
    -0.37482729496903394, -2.8582761805479886,   1.2177964320740353,
    2.6491774556044261,   -1.5754784776936894,   -2.5319506177879996,
    1.5914413037992232,   2.4415194291756936,    -1.3616911310290301,
    -2.1873041359398133,  0.98122367352387196,   1.6577673091702061,
    -0.57463281663165378, -0.97534411026134249,  0.25943595575687345,
    0.40711038118687054,  -0.083776384868219214, -0.10580973540024226,
    0.017071076328298462, 0.012774166256150467,  -0.001638543063239233};

/* An end of an arc, seen from the frequency vector. */
struct arc_end {
    double w;    /* |sine| of half the angle between the vector and the normal
                    at the end */
    double side; /* 1, or -1 if the arc's fan ends before the vector */
};

/* Adds the contribution of an end of an arc to the sums: the rest of the
 * Fresnel integral beyond the end, and a correction, as the slowly varying
 * factor differs there from its value at w = 0, which the integral uses. */
static WIDE_VECTORS void add_arc_end(struct batch *b, double round,
                                     const struct arc_end *end)
{
    const double w = end->w, side = end->side;
    const double g0 = 2 * (1 - 2 * w * w) / sqrt(1 - w * w) - 2;
    const double more = w < 1e-9 ? 0 : g0 / (2 * w);
    const double scale = sqrt(8 / round), kappa = 4 * GLINT_PI / round;

    for (int k = 0; k < b->n; k++) {
        const double s = scale * b->root[k], p = 1 / (w * s + MIDDLE);
        const double u = 1 - 2 * MIDDLE * p, half = 2 / s;
        double f = fresnel_f[TERMS - 1], g = fresnel_g[TERMS - 1];
        double re, im, cosine, sine;

        for (int i = TERMS - 2; i >= 0; i--) {
            f = fresnel_f[i] + u * f;
            g = fresnel_g[i] + u * g;
        }
        re = -side * half * g * p * p * p;
        im = -side * (half * f * p + more / (kappa * b->q[k]));
        compute_cos_and_sin(kappa * w * w * b->q[k], &cosine, &sine);
        b->re[k] += re * cosine - im * sine;
        b->im[k] += re * sine + im * cosine;
    }
}

/* Sets the sums to the integral along one arc divided by q / round, by its
 * approximation for large frequencies, without the phase of the arc's middle.
 * TO: angle between the arc's normal and the frequency vector, radians. For an
 * arc on the far side of the stop the integral is the complex conjugate. */
static void integrate_arc_asymptotically(const struct glint_arcs *a, double to,
                                         struct batch *b)
{
    const double at = fabs(remainder(to, 2 * GLINT_PI));
    const double near = at > 0.5 * GLINT_PI ? GLINT_PI - at : at;
    const double w = sin(0.5 * (a->turn - near));
    const struct arc_end first = {sin(0.5 * (a->turn + near)), 1};
    const struct arc_end last = {fabs(w), w < 0 ? -1 : 1};

    for (int k = 0; k < b->n; k++)
        b->re[k] = b->im[k] = w < 0 ? 0 : 2 / (sqrt(8 / a->round) * b->root[k]);
    add_arc_end(b, a->round, &first);
    add_arc_end(b, a->round, &last);
}

/* --------------------------------------------------------------------- near */

static int count_simpson_steps(const struct glint_arcs *a, double q, double to)
{
    return 4 + (int)(6 * q * (1 / a->round) * a->turn *
                     fmin(1, fabs(sin(to)) + a->turn));
}

/* Sets the sums to the integral along one arc, including the phase of the arc's
 * middle, by Simpson's rule with a few points per turn of the phase. */
static void integrate_arc_numerically(const struct glint_arcs *a, double to,
                                      struct batch *b)
{
    const double radius = 1 / a->round;

    for (int from = 0, end; from < b->n; from = end) {
        const int steps = count_simpson_steps(a, b->q[from], to);

        for (end = from;
             end < b->n && count_simpson_steps(a, b->q[end], to) == steps;
             end++)
            b->re[end] = b->im[end] = 0;
        for (int i = 0; i <= 2 * steps; i++) {
            const double phi = a->turn * (i - steps) / steps;
            const double weight = i == 0 || i == 2 * steps ? 1 : i & 1 ? 4 : 2;
            const double here = cos(phi - to);

            add_wave(b, from, end, weight * here,
                     2 * GLINT_PI * (radius * here - a->behind * cos(to)));
        }
        for (int k = from; k < end; k++) {
            const double size = b->q[k] * radius * a->turn / steps / 3;

            b->re[k] *= size;
            b->im[k] *= size;
        }
    }
}

/* Sets the sums to the integral along one arc, including the phase of the arc's
 * middle, by its approximation for large frequencies. */
static void integrate_arc_far_from_centre(const struct glint_arcs *a, double to,
                                          struct batch *b)
{
    const int is_behind = cos(to) < 0;
    const double along =
        2 * GLINT_PI * ((is_behind ? -1 : 1) / a->round - a->behind * cos(to));

    integrate_arc_asymptotically(a, to, b);
    for (int k = 0; k < b->n; k++) {
        b->re[k] *= (is_behind ? -1 : 1) * b->q[k] / a->round;
        b->im[k] *= b->q[k] / a->round;
    }
    turn_phases(b, along);
}

/* Fills B with the first frequencies of Q. Returns their number: at most N and
 * BATCH, and either all below FAR or none. */
static int fill_batch(struct batch *b, const double *q, int n, double far)
{
    for (b->n = 0; b->n < n && b->n < BATCH && (q[b->n] > far) == (q[0] > far);
         b->n++) {
        b->q[b->n] = q[b->n];
        b->root[b->n] = sqrt(q[b->n]);
    }
    return b->n;
}

void glint_arcs_compute_patterns(const struct glint_arcs *a, double direction,
                                 const double *q, int n, double *pattern)
{
    const double far = 5;
    struct batch b;

    for (int from = 0; from < n; from += b.n) {
        double re[BATCH] = {0}, im[BATCH] = {0};

        fill_batch(&b, q + from, n - from, far);
        for (int i = 0; i < count_summed_sides(a->n); i++) {
            (b.q[0] > far ? integrate_arc_far_from_centre
                          : integrate_arc_numerically)(
                a, direction - compute_side_normal_angle(a, i), &b);
            for (int k = 0; k < b.n; k++) {
                re[k] += b.re[k];
                im[k] += b.im[k];
            }
        }
        for (int k = 0; k < b.n; k++) {
            const double size = (a->n % 2 ? hypot(re[k], im[k]) : 2 * im[k]) /
                                (2 * GLINT_PI * b.q[k] * b.q[k] * a->area);

            pattern[from + k] = b.q[k] < 1e-5 ? 1 : size * size;
        }
    }
}

/* ---------------------------------------------------------------------- far */

/* Adds the squared integral along one arc to SUM, and subtracts the light that
 * interference at the corner after the arc takes. At the corner each arc
 * contributes (q n) / (2 pi i q t), where q is the frequency, n the arc's
 * normal and t its direction there. One arc ends and the other begins, so the
 * signs differ. Twice the real part of the product of both contributions is
 * subtracted. */
static void add_far_light_of_arc(const struct glint_arcs *a, double normal,
                                 double to, struct batch *b, double *sum)
{
    /* angles between q and the normals of both arcs at the corner after this
     * arc */
    const double one = to - (normal + a->turn);
    const double other = to - (normal + 2 * GLINT_PI / a->n - a->turn);
    const double s = sin(one), t = sin(other);
    const double both =
        2 * cos(one) * cos(other) / (4 * GLINT_PI * GLINT_PI) * s * t;

    integrate_arc_asymptotically(a, normal - to, b);
    for (int k = 0; k < b->n; k++) {
        const double q = b->q[k], size = q / a->round;
        /* squared sine of the angle to an arc's end below which the
         * contributions of the end and of the arc's middle merge */
        const double limit = 0.25 / (q * q);

        sum[k] += (b->re[k] * b->re[k] + b->im[k] * b->im[k]) * size * size -
                  both / ((s * s + limit) * (t * t + limit));
    }
}

void glint_arcs_compute_far_patterns(const struct glint_arcs *a,
                                     double direction, const double *q, int n,
                                     double *pattern)
{
    struct batch b;

    for (int from = 0; from < n; from += b.n) {
        double sum[BATCH] = {0};

        fill_batch(&b, q + from, n - from, 0);
        for (int i = 0; i < count_summed_sides(a->n); i++)
            add_far_light_of_arc(a, compute_side_normal_angle(a, i), direction,
                                 &b, sum);
        for (int k = 0; k < b.n; k++) {
            const double q2 = b.q[k] * b.q[k];

            pattern[from + k] =
                fmax(sum[k] * (a->n % 2 ? 1 : 2), 0) /
                (4 * GLINT_PI * GLINT_PI * q2 * q2 * a->area * a->area);
        }
    }
}
