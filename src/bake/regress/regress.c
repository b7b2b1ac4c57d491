/* SPDX-License-Identifier: MIT */
#include "bake/regress/regress.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/compiler.h"

enum { VECTORS = 4 }; /* columns that are multiplied by another at once */

/* Number of sums of a dot product. */
enum { LANES = 4 };

/* Returns the dot product of A and B. Four sums at once make shorter chains of
 * dependent additions. */
static WIDE_VECTORS double dot(const double *a, const double *b, int n)
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
 * dot(). A is read once for all of them, and their sums do not
 * wait for each other. */
static WIDE_VECTORS void dots(const double *a, const double *const b[VECTORS],
                              int n, double sum[VECTORS])
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

/* Subtracts K times B from A. */
static WIDE_VECTORS void subtract(double *restrict a, double k,
                                  const double *restrict b, int n)
{
    int i = 0;

    for (; i + LANES <= n; i += LANES)
        for (int m = 0; m < LANES; m++)
            a[i + m] -= k * b[i + m];
    for (; i < n; i++)
        a[i] -= k * b[i];
}

/* Multiplies A by X, POWER times. */
static WIDE_VECTORS void multiply(double *restrict a, const double *restrict x,
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
static WIDE_VECTORS double largest(const double *a, int n)
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

/* Fraction of its first length: a shorter column is a combination of others. */
#define DEPENDENT 1e-9
/* A square computed by differences that is below this fraction of its first
 * value has lost half of its digits. */
#define DOUBTFUL 1e-8
/* A candidate is represented by three numbers, was2, left2 and pull, which are
 * updated from its fraction along each chosen direction. These fractions follow
 * from products of terms, as in a Cholesky factorisation. A candidate is
 * orthogonalised only when it is chosen itself, or when left2 has become too
 * small to be trusted. */
struct column {
    uint8_t power[GLINT_VARIABLES];
    bool dead, chosen;
    int place;                  /* of the term among moments */
    double length;              /* length of AT */
    double on[GLINT_MAX_TERMS]; /* fraction of AT along each chosen direction */
    /* squared length of AT without the directions that were chosen when it was
     * last made orthogonal, and without all chosen directions */
    double was2, left2;
    double pull;      /* product of AT with the residual */
    const double *at; /* [n], the term times the weight */
};

enum {
    NEIGHBOURS = GLINT_VARIABLES + 2,
    BLOCK = 512 /* number of rays whose values fit into the L1 cache */
};

struct search {
    const struct glint_regress_samples *s;
    const struct glint_degrees *degrees;
    int n_chosen, n_columns;
    int chosen[GLINT_MAX_TERMS]; /* columns, in the order they entered */
    struct column column[GLINT_MAX_CANDIDATES];
    /* Products of two terms, NAN if not computed yet. A product depends only on
     * the sums of both terms' powers, which many pairs have in common. */
    double *moment;
    double *residual;  /* [n] */
    double *direction; /* [terms][n], of length 1, orthogonal to each other */
    double *values;    /* [n_columns][n] */
};

/* Returns direction RANK; RANK may be the index of the next direction to
 * choose. */
static double *direction(const struct search *s, int rank)
{
    return s->direction + (size_t)rank * (size_t)s->s->n;
}

/* Returns how many of N rays there are in the block from ray I on. */
static int block(int n, int i)
{
    return n - i < BLOCK ? n - i : BLOCK;
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

static double *moment_of(const struct search *s, const struct column *a,
                         const struct column *b)
{
    return &s->moment[a->place + b->place];
}

/* Computes the missing products of CHOSEN and N columns, at most VECTORS. */
static void find_moments(const struct search *s, const struct column *chosen,
                         struct column *const column[], int n)
{
    const struct column *missing[VECTORS];
    const double *at[VECTORS];
    double product[VECTORS];
    int n_missing = 0;

    for (int k = 0; k < n; k++)
        if (isnan(*moment_of(s, chosen, column[k])))
            missing[n_missing++] = column[k];
    if (n_missing == 0)
        return;
    for (int k = 0; k < VECTORS; k++)
        at[k] = missing[k < n_missing ? k : 0]->at;
    dots(chosen->at, at, s->s->n, product);
    for (int k = 0; k < n_missing; k++)
        *moment_of(s, chosen, missing[k]) = product[k];
}

/* Notes the fractions of N columns, at most VECTORS, along the chosen
 * direction of rank RANK. */
static void note_shares(const struct search *s, struct column *const column[],
                        int n, int rank)
{
    const struct column *chosen = &s->column[s->chosen[rank]];

    find_moments(s, chosen, column, n);
    for (int k = 0; k < n; k++) {
        const double share = (*moment_of(s, chosen, column[k]) -
                              dot(chosen->on, column[k]->on, rank)) /
                             chosen->on[rank];

        column[k]->on[rank] = share;
        column[k]->left2 -= share * share;
    }
}

/* Adds to SUM the products of A, M rays from ray FIRST on, and all chosen
 * directions. */
static void add_products(const struct search *s, const double *a, int first,
                         int m, double sum[GLINT_MAX_TERMS])
{
    for (int k = 0; k < s->n_chosen; k += VECTORS) {
        const double *at[VECTORS];
        double product[VECTORS];

        for (int j = 0; j < VECTORS; j++)
            at[j] = direction(s, k + j < s->n_chosen ? k + j : k) + first;
        dots(a + first, at, m, product);
        for (int j = 0; j < VECTORS && k + j < s->n_chosen; j++)
            sum[k + j] += product[j];
    }
}

/* Subtracts SHARE times each chosen direction from M rays of A, from ray FIRST
 * on. */
static void subtract_all(const struct search *s, double *a, int first, int m,
                         const double share[GLINT_MAX_TERMS])
{
    for (int k = 0; k < s->n_chosen; k++)
        subtract(a + first, share[k], direction(s, k) + first, m);
}

/* Sets the next direction to the component of COLUMN orthogonal to all chosen
 * ones, not normalised yet. Orthogonalises twice, to all of them at once,
 * because of rounding. */
static void make_orthogonal(const struct search *s, struct column *column)
{
    const int n = s->s->n;
    double *const q = direction(s, s->n_chosen);
    double again[GLINT_MAX_TERMS] = {0};

    memcpy(q, column->at, (size_t)n * sizeof *q);
    for (int i = 0; i < n; i += BLOCK) {
        subtract_all(s, q, i, block(n, i), column->on);
        add_products(s, q, i, block(n, i), again);
    }
    for (int i = 0; i < n; i += BLOCK)
        subtract_all(s, q, i, block(n, i), again);
    for (int k = 0; k < s->n_chosen; k++)
        column->on[k] += again[k];
    column->was2 = column->left2 = dot(q, q, n);
    column->pull = dot(q, s->residual, n);
}

/* Sets the values AT[n] of COLUMN from the values of PARENT, whose term divides
 * its term, or from the weights if PARENT is NULL. */
static void set_values(const struct search *s, struct column *column,
                       const struct column *parent, double *at)
{
    const struct glint_regress_samples *v = s->s;
    const double *const from = parent ? parent->at : v->weight;

    for (int i = 0; i < v->n; i += BLOCK) {
        const int n = block(v->n, i);

        memcpy(at + i, from + i, (size_t)n * sizeof *at);
        for (int k = 0; k < GLINT_VARIABLES; k++)
            if (column->power[k])
                multiply(at + i, v->x[k] + i,
                         column->power[k] - (parent ? parent->power[k] : 0), n);
    }
    column->at = at;
    column->was2 = column->left2 = dot(at, at, v->n);
    column->length = sqrt(column->left2);
    column->pull = dot(at, s->residual, v->n);
}

/* Returns the index of the term POWER among moments. The index of a product is
 * the sum of both indices. */
static int place_of(const struct glint_degrees *d, const uint8_t *power)
{
    int place = 0;

    for (int k = 0; k < GLINT_VARIABLES; k++)
        place = place * (2 * d->most[k] + 1) + power[k];
    return place;
}

/* Adds the term POWER as a candidate; returns it, or NULL if there is nothing
 * to add. Its fractions are not set yet. */
static struct column *add_candidate(struct search *s, const uint8_t *power,
                                    const struct column *parent)
{
    struct column *column = &s->column[s->n_columns];

    if (s->n_columns == GLINT_MAX_CANDIDATES || !allowed(s->degrees, power))
        return NULL;
    for (int i = 0; i < s->n_columns; i++)
        if (memcmp(s->column[i].power, power, GLINT_VARIABLES) == 0)
            return NULL;
    *column = (struct column){.place = place_of(s->degrees, power)};
    memcpy(column->power, power, GLINT_VARIABLES);
    set_values(s, column, parent,
               s->values + (size_t)s->n_columns * (size_t)s->s->n);
    s->n_columns++;
    return column;
}

/* Adds the terms next to COLUMN's as candidates: one power more in a variable,
 * two more in one with parity. With leaps those with two powers more of
 * variable 0 are next to it, too, and of variable 1 if its parity is free:
 * where a ghost is symmetric, near the axis, the odd power in between explains
 * nothing and would never be chosen. */
static void add_neighbours(struct search *s, const struct column *column)
{
    struct column *added[NEIGHBOURS];
    const int leaps = 1 + (s->degrees->parity < 0);
    const int most = GLINT_VARIABLES + (s->degrees->leaps ? leaps : 0);
    int n = 0;

    for (int k = 0; k < most; k++) {
        const int v = k % GLINT_VARIABLES;
        uint8_t power[GLINT_VARIABLES];

        memcpy(power, column->power, sizeof power);
        power[v] = (uint8_t)(power[v] + (k >= GLINT_VARIABLES ? 2 : 1) +
                             (v == 1 && s->degrees->parity >= 0));
        added[n] = add_candidate(s, power, column);
        n += added[n] != NULL;
    }
    for (int rank = 0; n > 0 && rank < s->n_chosen; rank++)
        for (int k = 0; k < n; k += VECTORS)
            note_shares(s, added + k, n - k < VECTORS ? n - k : VECTORS, rank);
}

/* Returns the candidate that explains most of the residual, or -1. */
static int best_candidate(struct search *s)
{
    double most = 0;
    int best = -1;

    for (int i = 0; i < s->n_columns; i++) {
        struct column *c = &s->column[i];
        const double dependent = DEPENDENT * c->length;

        if (c->dead || c->chosen)
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
    struct column *group[VECTORS];
    int grouped = 0;
    double *const q = direction(s, rank);
    double share;

    make_orthogonal(s, c);
    c->on[rank] = sqrt(c->left2);
    for (int i = 0; i < n; i++)
        q[i] /= c->on[rank];
    c->chosen = true;
    s->chosen[s->n_chosen++] = index;
    share = c->pull / c->on[rank];
    subtract(s->residual, share, q, n);
    for (int i = 0; i < s->n_columns; i++) {
        if (!s->column[i].dead && !s->column[i].chosen)
            group[grouped++] = &s->column[i];
        if (grouped == VECTORS || (grouped > 0 && i + 1 == s->n_columns)) {
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

/* Returns the residual divided by its limit: the max of the RMS ratio and the
 * peak ratio. */
static double excess(const struct search *s, double rms, double peak)
{
    const double sum2 = dot(s->residual, s->residual, s->s->n);

    return fmax(sqrt(sum2 / s->s->n) / rms,
                largest(s->residual, s->s->n) / peak);
}

/* Works out the coefficients of the terms from the fractions of orthogonal
 * directions. */
static void solve(const struct search *s, const double *y,
                  struct glint_poly *poly)
{
    poly->n = s->n_chosen;
    for (int k = s->n_chosen - 1; k >= 0; k--) {
        const struct column *q = &s->column[s->chosen[k]];
        double share = 0;

        for (int i = 0; i < s->s->n; i++)
            share += direction(s, k)[i] * s->s->weight[i] * y[i];
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
    const size_t n = (size_t)samples->n;
    const int n_moments = place_of(degrees, degrees->most) * 2 + 1;
    struct search s = {.s = samples,
                       .degrees = degrees,
                       .moment = scratch,
                       .residual = scratch + n_moments};
    const uint8_t first[GLINT_VARIABLES] = {0, (uint8_t)(degrees->parity > 0),
                                            0, 0, 0};
    double left;

    s.direction = s.residual + n;
    s.values = s.direction + (size_t)degrees->terms * n;
    for (int i = 0; i < n_moments; i++)
        s.moment[i] = (double)NAN;
    for (int i = 0; i < samples->n; i++)
        s.residual[i] = samples->weight[i] * y[i];
    add_candidate(&s, first, NULL);
    while ((left = excess(&s, rms, peak)) > 1 && s.n_chosen < degrees->terms) {
        const int best = is_hopeless(&s, left) ? -1 : best_candidate(&s);

        if (best < 0)
            break;
        choose(&s, best);
    }
    if (s.n_chosen == 0 && s.n_columns > 0 && s.column[0].length > 0)
        choose(&s, 0); /* A polynomial has at least one term, however large its
                          tolerance. */
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
