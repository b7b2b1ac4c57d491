/* SPDX-License-Identifier: MIT */
#include "bake/translucent/separate.h"

#include <math.h>
#include <string.h>

#include "glint/scene/translucent_bake.h"

enum { MOST = GLINT_SCATTER_MAX_KERNEL, SWEEPS = 30 };

/* How light on a texel and on the next one are correlated. From .5 to .99 the
 * decibels under lamps are the same within .3; at 0 they are 1 to 10 fewer. */
static const double correlation = 0.8;

/* Transposed: A[i] and V[i] are columns. V begins as the unit matrix; A = K V
 * at all times. */
struct work {
    int n;
    double a[MOST][MOST], v[MOST][MOST];
};

static double dot(const double *a, const double *b, int n)
{
    double sum = 0;

    for (int k = 0; k < n; k++)
        sum += a[k] * b[k];
    return sum;
}

static void rotate(double *a, double *b, double cosine, double sine, int n)
{
    for (int k = 0; k < n; k++) {
        const double x = a[k], y = b[k];

        a[k] = cosine * x - sine * y;
        b[k] = sine * x + cosine * y;
    }
}

/* Makes columns I and J stand at right angles; returns whether they did not. */
static int part(struct work *w, int i, int j)
{
    const double p = dot(w->a[i], w->a[i], w->n);
    const double q = dot(w->a[j], w->a[j], w->n);
    const double r = dot(w->a[i], w->a[j], w->n);
    double zeta, tangent, cosine;

    if (!(fabs(r) > 1e-15 * sqrt(p * q)))
        return 0;
    zeta = (q - p) / (2 * r);
    tangent = copysign(1 / (fabs(zeta) + sqrt(1 + zeta * zeta)), zeta);
    cosine = 1 / sqrt(1 + tangent * tangent);
    rotate(w->a[i], w->a[j], cosine, cosine * tangent, w->n);
    rotate(w->v[i], w->v[j], cosine, cosine * tangent, w->n);
    return 1;
}

/* Of light whose correlation C falls by the same share from texel to texel,
 * C = L L', sets every STEP-th number of X[N] to L' X. */
static void weigh(double *x, int n, int step)
{
    const double own = sqrt(1 - correlation * correlation);
    double sum = 0;

    for (int i = n - 1; i >= 0; i--) {
        sum = x[i * step] + correlation * sum;
        x[i * step] = i > 0 ? own * sum : sum;
    }
}

/* Undoes that. */
static void unweigh(double *x, int n)
{
    const double own = sqrt(1 - correlation * correlation);

    for (int i = 1; i < n; i++)
        x[i] /= own;
    for (int i = 0; i < n - 1; i++)
        x[i] -= correlation * x[i + 1];
}

static void decompose(struct work *w, const double *kernel)
{
    int any = 1;

    memset(w->v, 0, sizeof w->v);
    for (int i = 0; i < w->n; i++) {
        w->v[i][i] = 1;
        for (int k = 0; k < w->n; k++)
            w->a[i][k] = kernel[k * w->n + i];
        weigh(w->a[i], w->n, 1);
    }
    for (int k = 0; k < w->n; k++)
        weigh(&w->a[0][k], w->n, MOST);
    for (int sweep = 0; any && sweep < SWEEPS; sweep++) {
        any = 0;
        for (int i = 0; i < w->n; i++)
            for (int j = i + 1; j < w->n; j++)
                any |= part(w, i, j);
    }
}

void glint_separate(const double *kernel, int n, int rank,
                    struct glint_separated *to)
{
    struct work w;
    double square[MOST];

    w.n = n;
    decompose(&w, kernel);
    to->all = 0;
    for (int i = 0; i < n; i++) {
        square[i] = dot(w.a[i], w.a[i], n);
        to->all += square[i];
    }
    to->lost = to->all;
    memset(to->column, 0, (size_t)rank * (size_t)n * sizeof *to->column);
    memset(to->row, 0, (size_t)rank * (size_t)n * sizeof *to->row);
    for (int r = 0; r < rank && r < n; r++) {
        int best = 0;

        for (int i = 1; i < n; i++)
            best = square[i] > square[best] ? i : best;
        if (!(square[best] > 0))
            break;
        for (int k = 0; k < n; k++) {
            to->column[r * n + k] = w.a[best][k];
            to->row[r * n + k] = w.v[best][k];
        }
        unweigh(to->column + r * n, n);
        unweigh(to->row + r * n, n);
        to->lost -= square[best];
        square[best] = 0;
    }
    to->lost = fmax(to->lost, 0);
}
