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

enum {
    LANES = 4,   /* sums of a dot product */
    AT_ONCE = 4, /* columns that are multiplied by a direction at once */
    NEIGHBOURS = GLINT_VARIABLES + 1,
    BLOCK = 512 /* rays whose values stay in the nearest cache */
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
    double s[LANES] = {0, 0, 0, 0};
    int i = 0;

    for (; i + LANES <= n; i += LANES)
        for (int k = 0; k < LANES; k++)
            s[k] += a[i + k] * b[i + k];
    for (; i < n; i++)
        s[0] += a[i] * b[i];
    return (s[0] + s[1]) + (s[2] + s[3]);
}

/* Sets SUM to the dot products of A and four columns, each with the bits of
 * dot(). A is read once for all of them, and their sums do not wait for each
 * other. */
WIDE_VECTORS static void dots(const double *a, const double *const b[AT_ONCE],
                              int n, double sum[AT_ONCE])
{
    const double *const b0 = b[0], *const b1 = b[1], *const b2 = b[2],
                        *const b3 = b[3];
    double s0[LANES] = {0, 0, 0, 0}, s1[LANES] = {0, 0, 0, 0};
    double s2[LANES] = {0, 0, 0, 0}, s3[LANES] = {0, 0, 0, 0};
    int i = 0;

    for (; i + LANES <= n; i += LANES) {
        for (int k = 0; k < LANES; k++) {
            s0[k] += a[i + k] * b0[i + k];
            s1[k] += a[i + k] * b1[i + k];
            s2[k] += a[i + k] * b2[i + k];
            s3[k] += a[i + k] * b3[i + k];
        }
    }
    for (; i < n; i++) {
        s0[0] += a[i] * b0[i];
        s1[0] += a[i] * b1[i];
        s2[0] += a[i] * b2[i];
        s3[0] += a[i] * b3[i];
    }
    sum[0] = (s0[0] + s0[1]) + (s0[2] + s0[3]);
    sum[1] = (s1[0] + s1[1]) + (s1[2] + s1[3]);
    sum[2] = (s2[0] + s2[1]) + (s2[2] + s2[3]);
    sum[3] = (s3[0] + s3[1]) + (s3[2] + s3[3]);
}

WIDE_VECTORS static void subtract(double *restrict a, double k,
                                  const double *restrict b, int n)
{
    int i = 0;

    for (; i + LANES <= n; i += LANES)
        for (int m = 0; m < LANES; m++)
            a[i + m] -= k * b[i + m];
    for (; i < n; i++)
        a[i] -= k * b[i];
}

/* Subtracts K times B from A and returns the dot product of NEXT and what is
 * left of it, with the bits of subtract() and dot(). */
WIDE_VECTORS static double subtract_dot(double *restrict a, double k,
                                        const double *restrict b,
                                        const double *restrict next, int n)
{
    double s[LANES] = {0, 0, 0, 0};
    int i = 0;

    for (; i + LANES <= n; i += LANES) {
        double left[LANES];

        for (int m = 0; m < LANES; m++)
            left[m] = a[i + m] - k * b[i + m];
        for (int m = 0; m < LANES; m++)
            a[i + m] = left[m];
        for (int m = 0; m < LANES; m++)
            s[m] += next[i + m] * left[m];
    }
    for (; i < n; i++) {
        a[i] -= k * b[i];
        s[0] += next[i] * a[i];
    }
    return (s[0] + s[1]) + (s[2] + s[3]);
}

/* Multiplies A by X, POWER times. */
WIDE_VECTORS static void multiply(double *restrict a, const double *restrict x,
                                  int power, int n)
{
    for (int p = 0; p < power; p++) {
        int i = 0;

        for (; i + LANES <= n; i += LANES)
            for (int k = 0; k < LANES; k++)
                a[i + k] *= x[i + k];
        for (; i < n; i++)
            a[i] *= x[i];
    }
}

/* Returns the largest magnitude of A. */
WIDE_VECTORS static double largest(const double *a, int n)
{
    double most[LANES] = {0, 0, 0, 0};
    int i = 0;

    for (; i + LANES <= n; i += LANES)
        for (int k = 0; k < LANES; k++)
            most[k] = fabs(a[i + k]) > most[k] ? fabs(a[i + k]) : most[k];
    for (; i < n; i++)
        most[0] = fmax(most[0], fabs(a[i]));
    return fmax(fmax(most[0], most[1]), fmax(most[2], most[3]));
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

/* Notes the shares of N columns, at most AT_ONCE, along the chosen direction of
 * rank RANK. */
static void note_shares(const struct search *s, struct column *const column[],
                        int n, int rank)
{
    const double *at[AT_ONCE];
    double share[AT_ONCE];

    for (int k = 0; k < AT_ONCE; k++)
        at[k] = column[k < n ? k : 0]->at;
    dots(s->column[s->chosen[rank]].at, at, s->s->n, share);
    for (int k = 0; k < n; k++) {
        column[k]->on[rank] = share[k];
        column[k]->left2 -= share[k] * share[k];
    }
}

/* Makes COLUMN orthogonal to all chosen directions, twice against rounding. */
static void make_orthogonal(const struct search *s, struct column *column)
{
    const int n = s->s->n;
    double share = 0;

    for (int k = column->clean; k < s->n_chosen; k++)
        subtract(column->at, column->on[k], s->column[s->chosen[k]].at, n);
    if (s->n_chosen > 0)
        share = dot(s->column[s->chosen[0]].at, column->at, n);
    for (int k = 0; k < s->n_chosen; k++) {
        const double *q = s->column[s->chosen[k]].at;

        column->on[k] += share;
        if (k + 1 < s->n_chosen)
            share = subtract_dot(column->at, share, q,
                                 s->column[s->chosen[k + 1]].at, n);
        else
            subtract(column->at, share, q, n);
    }
    column->clean = s->n_chosen;
    column->was2 = column->left2 = dot(column->at, column->at, n);
    column->pull = dot(column->at, s->residual, n);
}

static void fill(const struct search *s, struct column *column)
{
    const struct glint_regress_samples *v = s->s;

    for (int i = 0; i < v->n; i += BLOCK) {
        const int n = v->n - i < BLOCK ? v->n - i : BLOCK;

        memcpy(column->at + i, v->weight + i, (size_t)n * sizeof *column->at);
        for (int k = 0; k < GLINT_VARIABLES; k++)
            multiply(column->at + i, v->x[k] + i, column->power[k], n);
    }
    column->was2 = column->left2 = dot(column->at, column->at, v->n);
    column->length = sqrt(column->left2);
    column->pull = dot(column->at, s->residual, v->n);
}

/* Adds the term POWER as a candidate; returns it, or NULL if there is nothing
 * to add. Its shares are not noted yet. */
static struct column *add_candidate(struct search *s, const uint8_t *power)
{
    struct column *column = &s->column[s->n_columns];

    if (s->n_columns == GLINT_MAX_CANDIDATES || !allowed(s->degrees, power))
        return NULL;
    for (int i = 0; i < s->n_columns; i++)
        if (memcmp(s->column[i].power, power, GLINT_VARIABLES) == 0)
            return NULL;
    *column = (struct column){.at = s->memory +
                                    (size_t)s->n_columns * (size_t)s->s->n};
    memcpy(column->power, power, GLINT_VARIABLES);
    fill(s, column);
    s->n_columns++;
    return column;
}

/* Adds the terms next to COLUMN's as candidates: one power more in a variable,
 * two more in one with parity. With leaps those with two powers more of
 * variable 0 are next to it, too: where a ghost is symmetric, near the axis,
 * the odd power in between explains nothing and would never be chosen. */
static void add_neighbours(struct search *s, const struct column *column)
{
    struct column *added[NEIGHBOURS];
    const int most = s->degrees->leaps ? NEIGHBOURS : GLINT_VARIABLES;
    int n = 0;

    for (int k = 0; k < most; k++) {
        const int v = k % GLINT_VARIABLES;
        uint8_t power[GLINT_VARIABLES];

        memcpy(power, column->power, sizeof power);
        power[v] = (uint8_t)(power[v] + (k >= GLINT_VARIABLES ? 2 : 1) +
                             (v == 1 && s->degrees->parity >= 0));
        added[n] = add_candidate(s, power);
        n += added[n] != NULL;
    }
    for (int rank = 0; n > 0 && rank < s->n_chosen; rank++)
        for (int k = 0; k < n; k += AT_ONCE)
            note_shares(s, added + k, n - k < AT_ONCE ? n - k : AT_ONCE, rank);
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
    struct column *group[AT_ONCE];
    int grouped = 0;
    double share;

    make_orthogonal(s, c);
    c->on[rank] = sqrt(c->left2);
    for (int i = 0; i < n; i++)
        c->at[i] /= c->on[rank];
    s->chosen[s->n_chosen++] = index;
    share = c->pull / c->on[rank];
    subtract(s->residual, share, c->at, n);
    for (int i = 0; i < s->n_columns; i++) {
        if (!s->column[i].dead && !is_chosen(s, i))
            group[grouped++] = &s->column[i];
        if (grouped == AT_ONCE || (grouped > 0 && i + 1 == s->n_columns)) {
            note_shares(s, group, grouped, rank);
            for (int k = 0; k < grouped; k++)
                group[k]->pull -= share * group[k]->on[rank];
            grouped = 0;
        }
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

    return fmax(sqrt(sum2 / s->s->n) / rms,
                largest(s->residual, s->s->n) / peak);
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
