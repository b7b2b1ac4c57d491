/* SPDX-License-Identifier: MIT */
#include "bake/fit/regress.h"

#include "base/compiler.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

/* Share of its first length: a shorter column is a combination of others. */
#define DEPENDENT 1e-9
/* Share of its first value: a smaller square, worked out by differences, has
 * lost half of its digits. */
#define DOUBTFUL 1e-8

/* A candidate is represented by three numbers, was2, left2 and pull, which are
 * kept up to date by one product with each direction that is chosen. It is made
 * orthogonal only when it is chosen itself, or when left2 has become too small
 * to be trusted. */
struct column {
    uint8_t power[GLINT_VARIABLES];
    bool dead;
    double length;              /* length of the term's column */
    double on[GLINT_MAX_TERMS]; /* share of AT along each chosen direction */
    int clean; /* number of chosen directions that AT is orthogonal to */
    /* squared length of AT, and what it would be without all chosen directions
     */
    double was2, left2;
    double pull; /* product of AT with the residual */
    double *at;  /* [n] */
};

struct search {
    const struct glint_regress_samples *s;
    const struct glint_degrees *degrees;
    int n_chosen, n_columns;
    int chosen[GLINT_MAX_TERMS]; /* columns, in the order they entered */
    struct column column[GLINT_MAX_CANDIDATES];
    double *residual, *memory;
};

size_t glint_regress_doubles(int n)
{
    return (size_t)n * (GLINT_MAX_CANDIDATES + 1);
}

/* Returns the dot product of A and B. Four sums at once make shorter chains of
 * dependent additions. */
WIDE_VECTORS static double dot(const double *a, const double *b, int n)
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

WIDE_VECTORS static void subtract(double *a, double k, const double *b, int n)
{
    for (int i = 0; i < n; i++)
        a[i] -= k * b[i];
}

static bool allowed(const struct glint_degrees *d, const uint8_t *power)
{
    int total = 0;

    for (int k = 0; k < GLINT_VARIABLES; k++) {
        if (power[k] > d->most[k])
            return false;
        total += power[k] * d->weight[k];
    }
    return total <= d->total && (d->parity < 0 || power[1] % 2 == d->parity);
}

/* Notes the share of COLUMN along the chosen direction of rank RANK. */
static void note_share(const struct search *s, struct column *column, int rank)
{
    const double share =
        dot(s->column[s->chosen[rank]].at, column->at, s->s->n);

    column->on[rank] = share;
    column->left2 -= share * share;
}

/* Makes COLUMN orthogonal to all chosen directions, twice against rounding. */
static void make_orthogonal(const struct search *s, struct column *column)
{
    const int n = s->s->n;

    for (int k = column->clean; k < s->n_chosen; k++)
        subtract(column->at, column->on[k], s->column[s->chosen[k]].at, n);
    for (int k = 0; k < s->n_chosen; k++) {
        const double *q = s->column[s->chosen[k]].at;
        const double share = dot(q, column->at, n);

        subtract(column->at, share, q, n);
        column->on[k] += share;
    }
    column->clean = s->n_chosen;
    column->was2 = column->left2 = dot(column->at, column->at, n);
    column->pull = dot(column->at, s->residual, n);
}

static void fill(const struct search *s, struct column *column)
{
    const struct glint_regress_samples *v = s->s;

    memcpy(column->at, v->weight, (size_t)v->n * sizeof *column->at);
    for (int k = 0; k < GLINT_VARIABLES; k++)
        for (int p = 0; p < column->power[k]; p++)
            for (int i = 0; i < v->n; i++)
                column->at[i] *= v->x[k][i];
    column->was2 = column->left2 = dot(column->at, column->at, v->n);
    column->length = sqrt(column->left2);
    column->pull = dot(column->at, s->residual, v->n);
}

static void add_candidate(struct search *s, const uint8_t *power)
{
    struct column *column = &s->column[s->n_columns];

    if (s->n_columns == GLINT_MAX_CANDIDATES || !allowed(s->degrees, power))
        return;
    for (int i = 0; i < s->n_columns; i++)
        if (memcmp(s->column[i].power, power, GLINT_VARIABLES) == 0)
            return;
    *column = (struct column){.at = s->memory +
                                    (size_t)s->n_columns * (size_t)s->s->n};
    memcpy(column->power, power, GLINT_VARIABLES);
    fill(s, column);
    for (int rank = 0; rank < s->n_chosen; rank++)
        note_share(s, column, rank);
    s->n_columns++;
}

/* Adds all terms with one power more in one variable as candidates; two more in
 * a variable with parity. */
static void add_neighbours(struct search *s, const struct column *column)
{
    for (int k = 0; k < GLINT_VARIABLES; k++) {
        uint8_t power[GLINT_VARIABLES];

        memcpy(power, column->power, sizeof power);
        power[k] =
            (uint8_t)(power[k] + (k == 1 && s->degrees->parity >= 0 ? 2 : 1));
        add_candidate(s, power);
    }
}

static bool is_chosen(const struct search *s, int column)
{
    for (int i = 0; i < s->n_chosen; i++)
        if (s->chosen[i] == column)
            return true;
    return false;
}

/* Returns the candidate that explains most of the residual, or -1. */
static int best_candidate(struct search *s)
{
    double most = 0;
    int best = -1;

    for (int i = 0; i < s->n_columns; i++) {
        struct column *c = &s->column[i];
        const double dependent = DEPENDENT * c->length;

        if (c->dead || is_chosen(s, i))
            continue;
        if (!(c->left2 > DOUBTFUL * c->was2))
            make_orthogonal(s, c);
        c->dead = !(c->left2 > dependent * dependent);
        if (!c->dead && c->pull * c->pull / c->left2 > most) {
            most = c->pull * c->pull / c->left2;
            best = i;
        }
    }
    return best;
}

static void choose(struct search *s, int index)
{
    struct column *c = &s->column[index];
    const int n = s->s->n, rank = s->n_chosen;
    double share;

    make_orthogonal(s, c);
    c->on[rank] = sqrt(c->left2);
    for (int i = 0; i < n; i++)
        c->at[i] /= c->on[rank];
    s->chosen[s->n_chosen++] = index;
    share = c->pull / c->on[rank];
    subtract(s->residual, share, c->at, n);
    for (int i = 0; i < s->n_columns; i++) {
        struct column *other = &s->column[i];

        if (other->dead || is_chosen(s, i))
            continue;
        note_share(s, other, rank);
        other->pull -= share * other->on[rank];
    }
    add_neighbours(s, c);
}

static bool is_hopeless(const struct search *s, double left)
{
    const struct glint_degrees *d = s->degrees;

    return d->hopeless > 0 && left > d->hopeless && s->n_chosen >= d->patience;
}

/* Returns the residual over its limit: the larger ratio of RMS and of peak. */
static double excess(const struct search *s, double rms, double peak)
{
    const double sum2 = dot(s->residual, s->residual, s->s->n);
    double most = 0;

    for (int i = 0; i < s->s->n; i++)
        most = fmax(most, fabs(s->residual[i]));
    return fmax(sqrt(sum2 / s->s->n) / rms, most / peak);
}

/* Works out the coefficients of the terms from the shares of orthogonal
 * directions. */
static void solve(const struct search *s, const double *y,
                  struct glint_poly *poly)
{
    poly->n = s->n_chosen;
    for (int k = s->n_chosen - 1; k >= 0; k--) {
        const struct column *q = &s->column[s->chosen[k]];
        double share = 0;

        for (int i = 0; i < s->s->n; i++)
            share += q->at[i] * s->s->weight[i] * y[i];
        for (int m = k + 1; m < s->n_chosen; m++)
            share -= s->column[s->chosen[m]].on[k] * poly->coef[m];
        poly->coef[k] = share / q->on[k];
        memcpy(poly->power[k], q->power, GLINT_VARIABLES);
    }
}

double glint_regress_fit(double *scratch,
                         const struct glint_regress_samples *samples,
                         const double *y, const struct glint_degrees *degrees,
                         double rms, double peak, struct glint_poly *poly)
{
    struct search s = {.s = samples,
                       .degrees = degrees,
                       .residual = scratch,
                       .memory = scratch + samples->n};
    const uint8_t first[GLINT_VARIABLES] = {0, (uint8_t)(degrees->parity > 0),
                                            0, 0};
    double left;

    for (int i = 0; i < samples->n; i++)
        s.residual[i] = samples->weight[i] * y[i];
    add_candidate(&s, first);
    while ((left = excess(&s, rms, peak)) > 1 && s.n_chosen < degrees->terms) {
        const int best = is_hopeless(&s, left) ? -1 : best_candidate(&s);

        if (best < 0)
            break;
        choose(&s, best);
    }
    if (s.n_chosen == 0 && s.column[0].length > 0)
        choose(&s, 0); /* A polynomial has at least one term, however little is
                          asked of it. */
    solve(&s, y, poly);
    return left;
}

double glint_poly_at(int n, const uint8_t (*power)[GLINT_VARIABLES],
                     const double *coef, const double *x)
{
    double sum = 0;

    for (int i = 0; i < n; i++) {
        double term = coef[i];

        for (int k = 0; k < GLINT_VARIABLES; k++)
            for (int p = 0; p < power[i][k]; p++)
                term *= x[k];
        sum += term;
    }
    return sum;
}
