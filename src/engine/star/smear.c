/* SPDX-License-Identifier: MIT */
#include "engine/star/smear.h"

#include <math.h>
#include <stdlib.h>

#include "engine/setup/dirt.h"
#include "glint/view.h"

enum { N = GLINT_SMEAR_SIDE, HALF = N / 2 };

static const double cell = (double)GLINT_SMEAR_SPAN / N;

/* step_q: distance between neighbouring elements of the transform, cycles per
 * stop radius. edge_q: frequency from which the change D of the pattern is
 * extrapolated, cycles per stop radius. */
static const double step_q = 1.0 / GLINT_SMEAR_SPAN, edge_q = 112;

/* Sums over the cells that sample a stop. */
struct totals {
    double light, area; /* integrals of the transmission T and of the clear
                           stop, stop radii^2 */
    double rim, n_rim;  /* rim: sum of (amplitude with dirt / amplitude of the
                           clear stop) over the cells along the outline; n_rim:
                           number of these cells */
};

/* -------------------------------------------------------------- amplitudes */

/* Returns the fraction of a cell that lies within the stop's outline. DEPTH is
 * the distance of its middle from the outline, stop radii, positive inside. */
static double compute_inside_fraction(double depth)
{
    return fmin(fmax(depth / cell + 0.5, 0), 1);
}

/* Returns the transmission of a soft edge of width SOFT at a distance of DEPTH
 * stop radii inside the outline. */
static double compute_soft_edge_transmission(double soft, double depth)
{
    const double in = soft > 0 ? fmin(fmax(depth / soft, 0), 1) : 1;

    return in * in * (3 - 2 * in);
}

/* Sets AT[i] to the amplitudes of light in row J of cells of the stop: real
 * part g, with dirt; imaginary part o, without. Row 0 has the lowest y. Adds to
 * the sums T. */
static void set_amplitude_row(const struct glint_dirt *d, int j,
                              double (*at)[2], struct totals *t)
{
    for (int i = 0; i < HALF; i++) {
        const double x = (i + 0.5 - 0.5 * HALF) * cell;
        const double y = (j + 0.5 - 0.5 * HALF) * cell;
        const double depth = glint_iris_compute_edge_distance(&d->sides, x, y);
        const double part = compute_inside_fraction(depth);
        double clear, light;

        if (part <= 0)
            continue;
        clear =
            compute_soft_edge_transmission(d->iris.softness, fmax(depth, 0));
        light = d->through(d, x, y);
        at[i][0] = part * sqrt(light);
        at[i][1] = part * sqrt(clear);
        t->light += at[i][0] * at[i][0] * cell * cell;
        t->area += at[i][1] * at[i][1] * cell * cell;
        if (depth < 3 * cell + d->iris.softness && clear > 0.25) {
            t->rim += sqrt(light / clear);
            t->n_rim++;
        }
    }
}

/* --------------------------------------------------------------- transform */

/* Returns element (I, K) of the transform, where (0, 0) is zero frequency. */
static const double *get_transform_element(double (*at)[2], int i, int k)
{
    return at[(size_t)((i + N) % N) * N + (size_t)((k + N) % N)];
}

/* Returns D, the change of the diffraction pattern by dirt (smear.h), at
 * element (I, K), from the transforms G and O of the real and imaginary parts
 * of AT. */
static double compute_pattern_difference(double (*at)[2], int i, int k,
                                         const struct totals *t, double clear)
{
    const double *a = get_transform_element(at, i, k),
                 *b = get_transform_element(at, -i, -k);
    const double g_re = a[0] + b[0], g_im = a[1] - b[1];
    const double o_re = a[1] + b[1], o_im = a[0] - b[0];
    const double unit = cell * cell * cell * cell / 4;

    return unit * ((g_re * g_re + g_im * g_im) / t->light -
                   clear * (o_re * o_re + o_im * o_im) / t->area);
}

static void sum_pattern_differences(struct glint_smear *s, double (*at)[2],
                                    const struct totals *t)
{
    double ring = 0;
    int n = 0;

    for (int k = 0; k <= N; k++)
        s->sum[k] = 0;
    for (int i = 0; i < N; i++) {
        double *row = s->sum + (size_t)(i + 1) * (N + 1);
        double along = 0;

        row[0] = 0;
        for (int k = 0; k < N; k++) {
            const double d =
                compute_pattern_difference(at, i - HALF, k - HALF, t, s->clear);
            const double q = step_q * hypot(i - HALF, k - HALF);

            along += d * step_q * step_q;
            row[k + 1] = row[k + 1 - (N + 1)] + along;
            if (q > edge_q * 0.9 && q < edge_q * 1.1) {
                ring += d;
                n++;
            }
        }
    }
    s->edge = fmax(ring / n, 0);
}

typedef double amplitude[2]; /* real, imaginary */

enum glint_status glint_smear_init(struct glint_smear *smear,
                                   const struct glint_setup *setup)
{
    amplitude *const at = calloc((size_t)N * N, sizeof *at);
    struct totals t = {0, 0, 0, 0};
    enum glint_status status = GLINT_E_MEMORY;

    *smear = (struct glint_smear){
        .sum = malloc((size_t)(N + 1) * (N + 1) * sizeof *smear->sum)};
    for (int j = 0; j < HALF && at; j++)
        set_amplitude_row(setup->dirt, j, at + (size_t)j * N, &t);
    if (at && smear->sum)
        status = glint_fourier_transform_2d(at, N, HALF);
    if (status == GLINT_OK && t.light > 1e-6) {
        const double rim = t.n_rim > 0 ? t.rim / t.n_rim : 0;

        smear->clear = fmin(rim * rim * t.area / t.light, 1);
        sum_pattern_differences(smear, at, &t);
    } else if (status == GLINT_OK) {
        glint_smear_finish(smear);
    }
    free(at);
    if (status != GLINT_OK)
        glint_smear_finish(smear);
    return status;
}

void glint_smear_finish(struct glint_smear *smear)
{
    free(smear->sum);
    smear->sum = NULL;
}

/* ------------------------------------------------------------------- means */

/* Returns the running integral of D (s->sum) at row Y and column X,
 * interpolated between elements. */
static double interpolate_difference_integral(const struct glint_smear *s,
                                              double y, double x)
{
    const int i = (int)fmin(fmax(y, 0), N - 1),
              k = (int)fmin(fmax(x, 0), N - 1);
    const double a = fmin(fmax(y - i, 0), 1), b = fmin(fmax(x - k, 0), 1);
    const double *low = s->sum + (size_t)i * (N + 1) + k;
    const double *high = low + N + 1;

    return (1 - a) * ((1 - b) * low[0] + b * low[1]) +
           a * ((1 - b) * high[0] + b * high[1]);
}

double glint_smear_compute_mean(const struct glint_smear *s, double qx,
                                double qy, double half)
{
    const double q = hypot(qx, qy), wide = fmax(half, 0.5 * step_q);
    /* Each element lies in the middle of a square of size 1. */
    const double x = qx / step_q + HALF + 0.5, y = qy / step_q + HALF + 0.5;
    const double h = wide / step_q;

    if (fmax(fabs(qx), fabs(qy)) + wide > HALF * step_q - 1)
        return s->edge * pow(edge_q / fmax(q, edge_q), 3);
    return (interpolate_difference_integral(s, y + h, x + h) -
            interpolate_difference_integral(s, y - h, x + h) -
            interpolate_difference_integral(s, y + h, x - h) +
            interpolate_difference_integral(s, y - h, x - h)) /
           (4 * wide * wide);
}

double glint_smear_integrate_within(const struct glint_smear *s, double q)
{
    const double held = fmin(q, HALF * step_q - 2);
    const double far = fmax(q, held);
    double sum = 0;

    for (int i = -HALF; i < HALF; i++) {
        const double y = i * step_q;
        const double x = held * held > y * y ? sqrt(held * held - y * y) : 0;
        const double mid = HALF + 0.5, row = i + HALF;

        if (x > 0)
            sum +=
                interpolate_difference_integral(s, row + 1, mid + x / step_q) -
                interpolate_difference_integral(s, row, mid + x / step_q) -
                interpolate_difference_integral(s, row + 1, mid - x / step_q) +
                interpolate_difference_integral(s, row, mid - x / step_q);
    }
    return sum + 2 * GLINT_PI * s->edge * edge_q * edge_q * edge_q *
                     (1 / held - 1 / far);
}
