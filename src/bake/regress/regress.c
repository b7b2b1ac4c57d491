/* SPDX-License-Identifier: MIT */
#include "bake/regress/regress.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/compiler.h"

/* number of dot products with the same column that are computed together */
enum { VECTORS = 4 };

/* number of partial sums per dot product */
enum { LANES = 4 };

/* Returns the dot product of A[N] and B[N]. Four partial sums shorten the chain
 * of dependent additions. */
static WIDE_VECTORS double compute_dot_product(const double *a, const double *b,
                                               int n)
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

/* Sets SUM to the dot products of A with four columns B, bit-identical to
 * compute_dot_product(). A is loaded only once, and the four sums are
 * independent. */
static WIDE_VECTORS void
compute_four_dot_products(const double *a, const double *const b[VECTORS],
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

/* Subtracts K times B from A, both [N]. */
static WIDE_VECTORS void subtract_scaled_vector(double *restrict a, double k,
                                                const double *restrict b, int n)
{
    int i = 0;

    for (; i + LANES <= n; i += LANES)
        for (int m = 0; m < LANES; m++)
            a[i + m] -= k * b[i + m];
    for (; i < n; i++)
        a[i] -= k * b[i];
}

/* Multiplies A[N] elementwise by X, POWER times. */
static WIDE_VECTORS void multiply_by_variable_power(double *restrict a,
                                                    const double *restrict x,
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

/* Returns the max magnitude in A[N]. */
static WIDE_VECTORS double find_max_magnitude(const double *a, int n)
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

/* A column counts as a combination of chosen columns if its remaining length is
 * below this fraction of its original length. */
#define DEPENDENT 1e-9
/* A squared length counts as inaccurate (half of its digits lost) if
 * subtractions have reduced it below this fraction of its first value. */
#define DOUBTFUL 1e-8
/* A candidate term and its column: the term's values at all rays. was2, left2
 * and pull are updated from the column's components along the chosen
 * directions, which follow from products of terms as in a Cholesky
 * factorisation. The column itself is orthogonalised only when its term is
 * chosen, or when left2 has become too inaccurate. */
struct column {
    uint8_t power[GLINT_VARIABLES];
    bool dead, chosen;
    int place;     /* index of the term in the table of moments */
    double length; /* Euclidean length of the column at */
    /* components of the column (at) along each chosen direction */
    double on[GLINT_MAX_TERMS];
    /* squared length of the column (at) without its components along chosen
     * directions: along those that were chosen when it was last orthogonalised
     * (was2), and along all (left2) */
    double was2, left2;
    double pull;      /* dot product of the column (at) with the residual */
    const double *at; /* [n]: values of the term times the weights */
};

enum {
    NEIGHBOURS = GLINT_VARIABLES + 2,
    BLOCK = 512 /* number of rays whose values fit into the L1 cache */
};

struct search {
    const struct glint_regress_samples *s;
    const struct glint_degrees *degrees;
    int n_chosen, n_columns;
    /* indices of the chosen columns, in the order of choice */
    int chosen[GLINT_MAX_TERMS];
    struct column column[GLINT_MAX_CANDIDATES];
    /* Dot products of two terms; NAN: not computed yet. A product depends only
     * on the sums of both terms' powers, which many pairs have in common. */
    double *moment;
    double *residual;  /* [n] */
    double *direction; /* orthonormal directions, [terms][n] */
    double *values;    /* values of all columns, [n_columns][n] */
};

/* Returns the chosen direction with index RANK. Index n_chosen is the next
 * direction, which is not set yet. */
static double *get_chosen_direction(const struct search *s, int rank)
{
    return s->direction + (size_t)rank * (size_t)s->s->n;
}

/* Returns the number of rays in the block that begins at ray I, of N rays. */
static int count_rays_in_block(int n, int i)
{
    return n - i < BLOCK ? n - i : BLOCK;
}

static bool is_term_allowed(const struct glint_degrees *d, const uint8_t *power)
{
    int total = 0;

    for (int k = 0; k < GLINT_VARIABLES; k++) {
        if (power[k] > d->most[k])
            return false;
        total += power[k] * d->weight[k];
    }
    return total <= d->total && (d->parity < 0 || power[1] % 2 == d->parity);
}

static double *get_term_moment(const struct search *s, const struct column *a,
                               const struct column *b)
{
    return &s->moment[a->place + b->place];
}

/* Computes the missing dot products of CHOSEN with N columns, N <= VECTORS. */
static void compute_missing_moments(const struct search *s,
                                    const struct column *chosen,
                                    struct column *const column[], int n)
{
    const struct column *missing[VECTORS];
    const double *at[VECTORS];
    double product[VECTORS];
    int n_missing = 0;

    for (int k = 0; k < n; k++)
        if (isnan(*get_term_moment(s, chosen, column[k])))
            missing[n_missing++] = column[k];
    if (n_missing == 0)
        return;
    for (int k = 0; k < VECTORS; k++)
        at[k] = missing[k < n_missing ? k : 0]->at;
    compute_four_dot_products(chosen->at, at, s->s->n, product);
    for (int k = 0; k < n_missing; k++)
        *get_term_moment(s, chosen, missing[k]) = product[k];
}

/* Updates N columns, N <= VECTORS, by their components along the chosen
 * direction with index RANK. */
static void update_column_components(const struct search *s,
                                     struct column *const column[], int n,
                                     int rank)
{
    const struct column *chosen = &s->column[s->chosen[rank]];

    compute_missing_moments(s, chosen, column, n);
    for (int k = 0; k < n; k++) {
        const double share =
            (*get_term_moment(s, chosen, column[k]) -
             compute_dot_product(chosen->on, column[k]->on, rank)) /
            chosen->on[rank];

        column[k]->on[rank] = share;
        column[k]->left2 -= share * share;
    }
}

/* Adds the dot products of A with all chosen directions to SUM, over the M rays
 * from ray FIRST on. */
static void add_direction_products(const struct search *s, const double *a,
                                   int first, int m,
                                   double sum[GLINT_MAX_TERMS])
{
    for (int k = 0; k < s->n_chosen; k += VECTORS) {
        const double *at[VECTORS];
        double product[VECTORS];

        for (int j = 0; j < VECTORS; j++)
            at[j] = get_chosen_direction(s, k + j < s->n_chosen ? k + j : k) +
                    first;
        compute_four_dot_products(a + first, at, m, product);
        for (int j = 0; j < VECTORS && k + j < s->n_chosen; j++)
            sum[k + j] += product[j];
    }
}

/* Subtracts from A each chosen direction times its factor in SHARE, for the M
 * rays from ray FIRST on. */
static void subtract_chosen_directions(const struct search *s, double *a,
                                       int first, int m,
                                       const double share[GLINT_MAX_TERMS])
{
    for (int k = 0; k < s->n_chosen; k++)
        subtract_scaled_vector(a + first, share[k],
                               get_chosen_direction(s, k) + first, m);
}

/* Sets the next direction to the part of COLUMN that is orthogonal to all
 * chosen directions, not normalised. Orthogonalises twice because of
 * rounding. */
static void orthogonalise_column(const struct search *s, struct column *column)
{
    const int n = s->s->n;
    double *const q = get_chosen_direction(s, s->n_chosen);
    double again[GLINT_MAX_TERMS] = {0};

    memcpy(q, column->at, (size_t)n * sizeof *q);
    for (int i = 0; i < n; i += BLOCK) {
        subtract_chosen_directions(s, q, i, count_rays_in_block(n, i),
                                   column->on);
        add_direction_products(s, q, i, count_rays_in_block(n, i), again);
    }
    for (int i = 0; i < n; i += BLOCK)
        subtract_chosen_directions(s, q, i, count_rays_in_block(n, i), again);
    for (int k = 0; k < s->n_chosen; k++)
        column->on[k] += again[k];
    column->was2 = column->left2 = compute_dot_product(q, q, n);
    column->pull = compute_dot_product(q, s->residual, n);
}

/* Computes the values AT[n] of COLUMN from those of PARENT, whose term divides
 * COLUMN's term; if PARENT is NULL, from the weights. */
static void compute_column_values(const struct search *s, struct column *column,
                                  const struct column *parent, double *at)
{
    const struct glint_regress_samples *v = s->s;
    const double *const from = parent ? parent->at : v->weight;

    for (int i = 0; i < v->n; i += BLOCK) {
        const int n = count_rays_in_block(v->n, i);

        memcpy(at + i, from + i, (size_t)n * sizeof *at);
        for (int k = 0; k < GLINT_VARIABLES; k++)
            if (column->power[k])
                multiply_by_variable_power(
                    at + i, v->x[k] + i,
                    column->power[k] - (parent ? parent->power[k] : 0), n);
    }
    column->at = at;
    column->was2 = column->left2 = compute_dot_product(at, at, v->n);
    column->length = sqrt(column->left2);
    column->pull = compute_dot_product(at, s->residual, v->n);
}

/* Returns the index of the term POWER in the table of moments. The index of a
 * product of two terms is the sum of their indices. */
static int compute_moment_index(const struct glint_degrees *d,
                                const uint8_t *power)
{
    int place = 0;

    for (int k = 0; k < GLINT_VARIABLES; k++)
        place = place * (2 * d->most[k] + 1) + power[k];
    return place;
}

/* Adds the term POWER as a candidate; its components along chosen directions
 * are not computed yet. Returns it, or NULL if the term is not allowed or
 * exists already. */
static struct column *add_candidate_term(struct search *s, const uint8_t *power,
                                         const struct column *parent)
{
    struct column *column = &s->column[s->n_columns];

    if (s->n_columns == GLINT_MAX_CANDIDATES ||
        !is_term_allowed(s->degrees, power))
        return NULL;
    for (int i = 0; i < s->n_columns; i++)
        if (memcmp(s->column[i].power, power, GLINT_VARIABLES) == 0)
            return NULL;
    *column = (struct column){.place = compute_moment_index(s->degrees, power)};
    memcpy(column->power, power, GLINT_VARIABLES);
    compute_column_values(s, column, parent,
                          s->values + (size_t)s->n_columns * (size_t)s->s->n);
    s->n_columns++;
    return column;
}

/* Adds the neighbours of COLUMN's term as candidates: terms with one power more
 * in one variable, or two more in a variable of fixed parity. With leaps also
 * terms with two powers more in variable 0, and in variable 1 if its parity is
 * free: near the axis ghosts are symmetric, so the odd power in between would
 * not reduce the residual and would never be chosen. */
static void add_neighbour_terms(struct search *s, const struct column *column)
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
        added[n] = add_candidate_term(s, power, column);
        n += added[n] != NULL;
    }
    for (int rank = 0; n > 0 && rank < s->n_chosen; rank++)
        for (int k = 0; k < n; k += VECTORS)
            update_column_components(s, added + k,
                                     n - k < VECTORS ? n - k : VECTORS, rank);
}

/* Returns the index of the candidate that reduces the residual most; -1:
 * none. */
static int find_best_candidate(struct search *s)
{
    double most = 0;
    int best = -1;

    for (int i = 0; i < s->n_columns; i++) {
        struct column *c = &s->column[i];
        const double dependent = DEPENDENT * c->length;

        if (c->dead || c->chosen)
            continue;
        if (!(c->left2 > DOUBTFUL * c->was2))
            orthogonalise_column(s, c);
        c->dead = !(c->left2 > dependent * dependent);
        if (!c->dead && c->pull * c->pull / c->left2 > most) {
            most = c->pull * c->pull / c->left2;
            best = i;
        }
    }
    return best;
}

static void add_chosen_candidate(struct search *s, int index)
{
    struct column *c = &s->column[index];
    const int n = s->s->n, rank = s->n_chosen;
    struct column *group[VECTORS];
    int grouped = 0;
    double *const q = get_chosen_direction(s, rank);
    double share;

    orthogonalise_column(s, c);
    c->on[rank] = sqrt(c->left2);
    for (int i = 0; i < n; i++)
        q[i] /= c->on[rank];
    c->chosen = true;
    s->chosen[s->n_chosen++] = index;
    share = c->pull / c->on[rank];
    subtract_scaled_vector(s->residual, share, q, n);
    for (int i = 0; i < s->n_columns; i++) {
        if (!s->column[i].dead && !s->column[i].chosen)
            group[grouped++] = &s->column[i];
        if (grouped == VECTORS || (grouped > 0 && i + 1 == s->n_columns)) {
            update_column_components(s, group, grouped, rank);
            for (int k = 0; k < grouped; k++)
                group[k]->pull -= share * group[k]->on[rank];
            grouped = 0;
        }
    }
    add_neighbour_terms(s, c);
}

static bool is_fit_hopeless(const struct search *s, double left)
{
    const struct glint_degrees *d = s->degrees;

    return d->hopeless > 0 && left > d->hopeless && s->n_chosen >= d->patience;
}

/* Returns the residual relative to its limits: the larger of RMS residual / RMS
 * and max residual / PEAK. */
static double compute_residual_excess(const struct search *s, double rms,
                                      double peak)
{
    const double sum2 = compute_dot_product(s->residual, s->residual, s->s->n);

    return fmax(sqrt(sum2 / s->s->n) / rms,
                find_max_magnitude(s->residual, s->s->n) / peak);
}

/* Computes the coefficients of all chosen terms by back substitution. */
static void solve_coefficients(const struct search *s, const double *y,
                               struct glint_poly *poly)
{
    poly->n = s->n_chosen;
    for (int k = s->n_chosen - 1; k >= 0; k--) {
        const struct column *q = &s->column[s->chosen[k]];
        double share = 0;

        for (int i = 0; i < s->s->n; i++)
            share += get_chosen_direction(s, k)[i] * s->s->weight[i] * y[i];
        for (int m = k + 1; m < s->n_chosen; m++)
            share -= s->column[s->chosen[m]].on[k] * poly->coef[m];
        poly->coef[k] = share / q->on[k];
        memcpy(poly->power[k], q->power, GLINT_VARIABLES);
    }
}

double glint_regress_fit_polynomial(double *scratch,
                                    const struct glint_regress_samples *samples,
                                    const double *y,
                                    const struct glint_degrees *degrees,
                                    double rms, double peak,
                                    struct glint_poly *poly)
{
    const size_t n = (size_t)samples->n;
    const int n_moments = compute_moment_index(degrees, degrees->most) * 2 + 1;
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
    add_candidate_term(&s, first, NULL);
    while ((left = compute_residual_excess(&s, rms, peak)) > 1 &&
           s.n_chosen < degrees->terms) {
        const int best =
            is_fit_hopeless(&s, left) ? -1 : find_best_candidate(&s);

        if (best < 0)
            break;
        add_chosen_candidate(&s, best);
    }
    /* a polynomial has at least one term, however large its tolerance */
    if (s.n_chosen == 0 && s.n_columns > 0 && s.column[0].length > 0)
        add_chosen_candidate(&s, 0);
    solve_coefficients(&s, y, poly);
    return left;
}

double glint_poly_evaluate(int n, const uint8_t (*power)[GLINT_VARIABLES],
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
