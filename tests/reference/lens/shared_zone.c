/* SPDX-License-Identifier: MIT */
#include "reference/lens/shared_zone.h"

#include <math.h>
#include <string.h>

/* A coefficient of this size (mm, stop radii, ...) costs as much as an error of
 * the tolerance. So sums of coefficients stay below some thousand, and integers
 * of 32 bits resolve 1e-5. */
#define LARGE 100.0

/* A term counts as a combination of others if less than this fraction of its
 * length is left when they are subtracted. */
#define DEPENDENT 1e-7

/* Weights of a ray that is cut but needed between knots, and of one farther
 * out; the largest relative radius of the former. */
#define NEAR_WEIGHT 0.2
#define FAR_WEIGHT  0.01
#define NEAR_EXCESS 1.1

/* Relative radius that a invalid ray is fitted to if it would get through. */
#define LOST_RADIUS 1.1

/* ------------------------------------------------------------------ vectors */

/* Returns the dot product of A and B. Four sums at once make shorter chains of
 * dependent additions. */
static double dot(const double *a, const double *b, int n)
{
    double s[4] = {0, 0, 0, 0};
    int i = 0;

    for (; i + 4 <= n; i += 4)
        for (int k = 0; k < 4; k++)
            s[k] += a[i + k] * b[i + k];
    for (; i < n; i++)
        s[0] += a[i] * b[i];
    return (s[0] + s[1]) + (s[2] + s[3]);
}

static double dot3(const double *a, const double *b, const double *c, int n)
{
    double s[4] = {0, 0, 0, 0};
    int i = 0;

    for (; i + 4 <= n; i += 4)
        for (int k = 0; k < 4; k++)
            s[k] += a[i + k] * b[i + k] * c[i + k];
    for (; i < n; i++)
        s[0] += a[i] * b[i] * c[i];
    return (s[0] + s[1]) + (s[2] + s[3]);
}

static void add(double *a, double k, const double *b, int n)
{
    for (int i = 0; i < n; i++)
        a[i] += k * b[i];
}

static void monomial(const struct glint_shared_rays *rays, const uint8_t *power,
                     double *column)
{
    for (int i = 0; i < rays->n; i++)
        column[i] = 1;
    for (int k = 0; k < GLINT_VARIABLES; k++)
        for (int p = 0; p < power[k]; p++)
            for (int i = 0; i < rays->n; i++)
                column[i] *= rays->x[k][i];
}

/* ------------------------------------------------------------------ weights */

static bool stop_kind(enum glint_channel kind)
{
    return kind == GLINT_OUT_STOP_X || kind == GLINT_OUT_STOP_Y;
}

/* Returns whether the value FIT would let a ray through that is cut. */
static bool wrongly_seen(const struct glint_shared_rays *rays, int i,
                         enum glint_channel kind, double fit)
{
    const enum glint_channel other =
        kind == GLINT_OUT_STOP_X ? GLINT_OUT_STOP_Y : GLINT_OUT_STOP_X;
    const double radius = rays->at[GLINT_OUT_RADIUS][i];
    const double stop =
        hypot(rays->at[GLINT_OUT_STOP_X][i], rays->at[GLINT_OUT_STOP_Y][i]);

    if (kind == GLINT_OUT_RADIUS)
        return fit < 1 && (rays->lost[i] || (radius > 1 && stop < NEAR_EXCESS));
    if (stop_kind(kind))
        return !rays->lost[i] && stop > 1 && radius < NEAR_EXCESS &&
               hypot(fit, rays->at[other][i]) < 1;
    return false;
}

static double weight_of(const struct glint_shared_rays *rays, int i,
                        enum glint_channel kind, double fit)
{
    if (!rays->lost[i] && rays->excess[i] <= 1)
        return 1;
    if (wrongly_seen(rays, i, kind, fit))
        return 1;
    return rays->lost[i]                    ? 0
           : rays->excess[i] <= NEAR_EXCESS ? NEAR_WEIGHT
                                            : FAR_WEIGHT;
}

/* Sets values of a zone and forgets its last fit. */
void glint_shared_begin(struct glint_shared_zone *z,
                        const struct glint_shared_rays *rays,
                        enum glint_channel kind, double tolerance)
{
    double sum = 0;

    z->n = rays->n;
    z->cost = tolerance / LARGE;
    z->seen = 0;
    for (int i = 0; i < z->n; i++)
        if (!rays->lost[i] && rays->excess[i] <= 1) {
            z->seen++;
            sum += rays->at[kind][i];
        }
    z->scale = kind == GLINT_OUT_ENERGY && sum > 0 ? z->seen / sum : 1;
    for (int i = 0; i < z->n; i++) {
        z->value[i] =
            rays->lost[i] ? LOST_RADIUS : z->scale * rays->at[kind][i];
        z->fit[i] = HUGE_VAL; /* This value lets no ray through. */
    }
}

static void weigh(struct glint_shared_zone *z,
                  const struct glint_shared_rays *rays, enum glint_channel kind)
{
    /* A zone in which next to nothing gets through counts less. */
    const double count = fmax(z->seen, 0.05 * z->n);

    for (int i = 0; i < z->n; i++) {
        const double w = weight_of(rays, i, kind, z->fit[i]);

        z->weight2[i] = w * w / count;
    }
}

/* ------------------------------------------------------------ least squares */

/* Adds one more column; a column that depends on others becomes 0. */
static void add_column(struct glint_shared_zone *z, int rank,
                       const double *column)
{
    double *q = z->q[rank], *r = z->r[rank], before, length;
    const int rows = z->n + rank + 1;

    for (int i = 0; i < z->n; i++)
        q[i] = sqrt(z->weight2[i]) * column[i];
    for (int i = 0; i < GLINT_SHARED_TERMS; i++)
        q[z->n + i] = i == rank ? z->cost : 0;
    for (int k = 0; k < GLINT_SHARED_TERMS; k++)
        r[k] = 0;
    before = sqrt(dot(q, q, rows));
    for (int round = 0; round < 2; round++)
        for (int k = 0; k < rank; k++) {
            const double share = dot(z->q[k], q, rows);

            add(q, -share, z->q[k], rows);
            r[k] += share;
        }
    length = sqrt(dot(q, q, rows));
    if (!(length > DEPENDENT * before)) {
        memset(q, 0, (size_t)rows * sizeof *q);
        return;
    }
    r[rank] = length;
    for (int i = 0; i < rows; i++)
        q[i] /= length;
}

/* Works out coefficients from shares. */
static void solve(const struct glint_shared_zone *z, int n, double *coef)
{
    for (int k = n - 1; k >= 0; k--) {
        double share = z->share[k];

        for (int m = k + 1; m < n; m++)
            share -= z->r[m][k] * coef[m];
        coef[k] = z->r[k][k] > 0 ? share / z->r[k][k] : 0;
    }
}

static void factor(struct glint_shared_zone *z,
                   const struct glint_shared_rays *rays,
                   const struct glint_shared_basis *basis, double *coef)
{
    for (int i = 0; i < z->n; i++)
        z->left[i] = sqrt(z->weight2[i]) * z->value[i];
    for (int i = 0; i < GLINT_SHARED_TERMS; i++)
        z->left[z->n + i] = 0;
    for (int k = 0; k < basis->n; k++) {
        monomial(rays, basis->power[k], z->column);
        add_column(z, k, z->column);
        z->share[k] = dot(z->q[k], z->left, z->n + k + 1);
        add(z->left, -z->share[k], z->q[k], z->n + k + 1);
    }
    solve(z, basis->n, coef);
    memset(z->fit, 0, (size_t)z->n * sizeof *z->fit);
    for (int k = 0; k < basis->n; k++) {
        monomial(rays, basis->power[k], z->column);
        add(z->fit, coef[k], z->column, z->n);
    }
}

/* Returns the mean squared error with the weights that the fit itself gives. */
static double square_of(const struct glint_shared_zone *z,
                        const struct glint_shared_rays *rays,
                        enum glint_channel kind)
{
    const double count = fmax(z->seen, 0.05 * z->n);
    double sum = 0;

    for (int i = 0; i < z->n; i++) {
        const double w = weight_of(rays, i, kind, z->fit[i]);
        const double error = z->fit[i] - z->value[i];

        sum += w * w * error * error;
    }
    return sum / count;
}

/* Fits a zone, in a few rounds if wrongly seen rays may enter. */
double glint_shared_fit(struct glint_shared_zone *z,
                        const struct glint_shared_rays *rays,
                        enum glint_channel kind,
                        const struct glint_shared_basis *basis, double *coef)
{
    const int rounds = stop_kind(kind) || kind == GLINT_OUT_RADIUS ? 3 : 1;

    for (int round = 0; round < rounds; round++) {
        weigh(z, rays, kind);
        factor(z, rays, basis, coef);
    }
    return square_of(z, rays, kind);
}

double glint_shared_solve(struct glint_shared_zone *z,
                          const struct glint_shared_rays *rays,
                          enum glint_channel kind,
                          const struct glint_shared_basis *basis,
                          double tolerance, double *coef)
{
    double sum = 0;

    glint_shared_begin(z, rays, kind, tolerance);
    glint_shared_fit(z, rays, kind, basis, coef);
    for (int k = 0; k < basis->n; k++)
        coef[k] /= z->scale;
    for (int i = 0; i < z->n; i++)
        if (!rays->lost[i] && rays->excess[i] <= 1)
            sum += (z->fit[i] - z->value[i]) * (z->fit[i] - z->value[i]);
    return z->seen ? sum / z->seen : -1;
}

/* -------------------------------------------------------------- other terms */

/* Row I of the inverse of r is the direction of term I that no other term
 * shares: the product of any other term with it is 0. */
void glint_shared_part(struct glint_shared_zone *z, int n, double *cost)
{
    for (int i = 0; i < z->n; i++) {
        const double w = sqrt(z->weight2[i]);

        z->left[i] *= w;
        for (int k = 0; k < n; k++)
            z->q[k][i] *= w;
    }
    for (int i = 0; i < n; i++) {
        double *a = z->apart[i], length;

        for (int k = 0; k < n; k++) {
            double sum = k == i;

            for (int m = 0; m < k; m++)
                sum -= z->r[k][m] * a[m];
            a[k] = z->r[k][k] > 0 ? sum / z->r[k][k] : 0;
        }
        length = sqrt(dot(a, a, n));
        z->alone[i] = 0;
        for (int k = 0; k < n && length > 0; k++) {
            a[k] /= length;
            z->alone[i] += a[k] * z->share[k];
        }
        cost[i] += z->alone[i] * z->alone[i];
    }
}

void glint_shared_gain(struct glint_shared_zone *z,
                       const struct glint_shared_rays *rays, int n,
                       const uint8_t *power, double *gain)
{
    const double *column = z->column;
    double length2, least, rest, apart2, on[GLINT_SHARED_TERMS];

    monomial(rays, power, z->column);
    length2 = dot3(z->weight2, column, column, z->n) + z->cost * z->cost;
    least = DEPENDENT * DEPENDENT * length2;
    rest = dot(z->left, column, z->n);
    apart2 = length2;
    for (int k = 0; k < n; k++) {
        on[k] = dot(z->q[k], column, z->n);
        apart2 -= on[k] * on[k];
    }
    apart2 = fmax(apart2, 0);
    if (apart2 > least)
        gain[n] += rest * rest / apart2;
    for (int i = 0; i < n; i++) {
        const double along = dot(z->apart[i], on, n);
        const double both2 = apart2 + along * along;
        const double share = rest + along * z->alone[i];

        if (both2 > least)
            gain[i] += share * share / both2;
    }
}
