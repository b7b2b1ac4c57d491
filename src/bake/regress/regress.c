/* SPDX-License-Identifier: MIT */
#include "bake/regress/regress.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/compiler.h"

enum {
    LANES = 4, /* number of partial sums; rays of a plane are padded to it */
    MANY = 16, /* number of rays at which a polynomial is evaluated together */
    /* max number of powers of variable 0 times that of variable 1 */
    PLACES = (GLINT_REGRESS_POWER + 1) * (GLINT_REGRESS_POWER + 1)
};

/* A column counts as a combination of chosen columns if its remaining length is
 * below this fraction of its original length. */
#define DEPENDENT 1e-9
/* A squared length that subtractions have reduced below this fraction of its
 * first value is measured again on the rays, as most of its digits are lost. */
#define DOUBTFUL 1e-12
/* The squared residual is measured on the rays if it is below this fraction of
 * the squared length of the fitted values. */
#define NOISE 1e-13
/* The solution is refined if its squared residual, measured on the rays,
 * exceeds the computed one by more than this fraction. */
#define INEXACT 1e-3

/* A candidate term. Its column holds the term's values at all rays, times their
 * weights; it is never stored. left2 and pull are updated from the column's
 * components along the chosen directions, which follow from products of columns
 * as in a Cholesky factorisation. */
struct column {
    uint8_t power[GLINT_VARIABLES];
    bool dead, chosen;
    int place;         /* index of the powers of variables 0 and 1 */
    const double *mix; /* [n_rows]: powers of the other variables */
    double length2;    /* squared Euclidean length of the column */
    /* squared length without components along chosen directions: along those
     * that were chosen when it was last measured (was2), and along all
     * (left2) */
    double was2, left2;
    double pull; /* dot product of the column with the residual */
    /* components of the column along each chosen direction */
    double on[GLINT_MAX_TERMS];
};

enum { NEIGHBOURS = GLINT_VARIABLES + 2 };

/* Rays are grouped in planes: consecutive rays that share variables 2 to 4.
 * Arrays over rays are padded with rays of weight 0, so that each plane has a
 * multiple of LANES rays. */
struct search {
    const struct glint_regress_samples *s;
    const struct glint_degrees *degrees;
    int n_chosen, n_columns;
    /* indices of the chosen columns, in the order of choice */
    int chosen[GLINT_MAX_TERMS];
    struct column column[GLINT_MAX_CANDIDATES];
    int n_planes, n_rows; /* n_rows: n_planes, rounded up to LANES */
    /* [n_rows + 1]: first ray of each plane; the last planes may be empty */
    int first[GLINT_REGRESS_PLANES + LANES];
    int sample[GLINT_REGRESS_PLANES + 1]; /* first sample of each plane */
    int row; /* number of places per power of variable 1 */
    /* powers of variable 1 that occur: from first_v in steps of step_v */
    int first_v, step_v;
    double *u, *v, *weight; /* variables 0 and 1, weights */
    double *target;         /* fitted values times weights */
    double *residual;       /* target - polynomial times weights */
    double *spare[3];       /* temporary values of each ray */
    /* sums over the rays of each plane, [places][n_rows]: powers of variables 0
     * and 1, times the squared weight, or times target and weight */
    double *sums, *target_sums, *spare_sums;
    double *mixes; /* powers of variables 2 to 4, [powers][n_rows] */
    double share[GLINT_MAX_TERMS]; /* components of the target along each
                                      chosen direction */
    double target2, left2;         /* squared lengths of target and residual */
    double peak;      /* max magnitude of residual, if is_measured */
    bool is_measured; /* residual, left2 and peak are measured on rays */
    bool diverges;    /* more terms would not improve the fit */
};

/* ------------------------------------------------------------------- loops */

static WHOLLY_INLINE double add_lanes(const double s[LANES])
{
    return (s[0] + s[1]) + (s[2] + s[3]);
}

/* Returns the dot product of A[N] and B[N]. Four partial sums shorten the chain
 * of dependent additions. */
static WHOLLY_INLINE double multiply_vectors(const double *a, const double *b,
                                             int n)
{
    double s[LANES] = {0, 0, 0, 0};
    int i = 0;

    for (; i + LANES <= n; i += LANES)
        for (int k = 0; k < LANES; k++)
            s[k] += a[i + k] * b[i + k];
    for (; i < n; i++)
        s[0] += a[i] * b[i];
    return add_lanes(s);
}

static WIDE_VECTORS double compute_dot_product(const double *a, const double *b,
                                               int n)
{
    return multiply_vectors(a, b, n);
}

/* Returns the sum of A[k] B[k] C[k] for k < N, a multiple of LANES. */
static WHOLLY_INLINE double
sum_triple_products(const double *a, const double *b, const double *c, int n)
{
    double s[LANES] = {0, 0, 0, 0};

    for (int i = 0; i < n; i += LANES)
        for (int k = 0; k < LANES; k++)
            s[k] += a[i + k] * (b[i + k] * c[i + k]);
    return add_lanes(s);
}

/* Sets SUM[c STRIDE] for c = 0 .. MOST to the sums of Q[k] U[k]^c over N rays,
 * a multiple of LANES. Overwrites Q. */
static WHOLLY_INLINE void sum_powers(double *restrict q,
                                     const double *restrict u, int n, int most,
                                     int stride, double *restrict sum)
{
    for (int c = 0; c <= most; c += 4) {
        double s[4][LANES] = {{0}};

        for (int i = 0; i < n; i += LANES)
            for (int k = 0; k < LANES; k++) {
                const double a = q[i + k], x = u[i + k];
                const double b = a * x, d = b * x, e = d * x;

                s[0][k] += a;
                s[1][k] += b;
                s[2][k] += d;
                s[3][k] += e;
                q[i + k] = e * x;
            }
        for (int k = 0; k < 4 && c + k <= most; k++)
            sum[(c + k) * stride] = add_lanes(s[k]);
    }
}

/* Sets the entries of OUT for powers up to MOST_U of variable 0 and FIRST_V,
 * FIRST_V + STEP_V .. MOST_V of variable 1 to the sums of Q, a value per ray,
 * times these powers over the rays of each plane. */
static WIDE_VECTORS void sum_over_planes(const struct search *s,
                                         const double *q, int most_u,
                                         int first_v, int step_v, int most_v,
                                         double *out)
{
    for (int p = 0; p < s->n_rows; p++) {
        const int i = s->first[p], n = s->first[p + 1] - i;
        double *const high = s->spare[0] + i, *const wide = s->spare[1] + i;
        const double *const v = s->v + i;

        for (int k = 0; k < n; k++)
            high[k] = first_v ? q[i + k] * v[k] : q[i + k];
        for (int d = first_v; d <= most_v; d += step_v) {
            memcpy(wide, high, (size_t)n * sizeof *wide);
            sum_powers(wide, s->u + i, n, most_u, s->n_rows,
                       out + (size_t)(d * s->row) * (size_t)s->n_rows + p);
            for (int k = 0; k < n; k++)
                high[k] *= step_v == 2 ? v[k] * v[k] : v[k];
        }
    }
}

/* Sets OUT[N] to the polynomial in variables 0 and 1 with coefficients COEF,
 * [powers of variable 1][row], at N rays, a constant. */
static WHOLLY_INLINE void evaluate_at_rays(const struct search *s,
                                           const double *coef, const double *u,
                                           const double *v, int n, double *out)
{
    const int most_u = s->degrees->most[0], most_v = s->degrees->most[1];
    const int last = most_v - (most_v - s->first_v) % s->step_v;
    double sum[MANY] = {0}, line[MANY];

    for (int d = last; d >= s->first_v; d -= s->step_v) {
        const double *const at = coef + d * (most_u + 1);

        for (int k = 0; k < n; k++)
            line[k] = at[most_u];
        for (int c = most_u - 1; c >= 0; c--)
            for (int k = 0; k < n; k++)
                line[k] = line[k] * u[k] + at[c];
        for (int k = 0; k < n; k++)
            sum[k] = sum[k] * (s->step_v == 2 ? v[k] * v[k] : v[k]) + line[k];
    }
    for (int k = 0; k < n; k++)
        out[k] = s->first_v ? sum[k] * v[k] : sum[k];
}

/* Sets COEF to the coefficients, in variables 0 and 1, of the N terms TERM
 * times FACTOR in plane P. */
static void collapse_terms_in_plane(const struct search *s, int p, int n,
                                    const struct column *const *term,
                                    const double *factor, double coef[PLACES])
{
    const int most_u = s->degrees->most[0], most_v = s->degrees->most[1];

    memset(coef, 0, (size_t)((most_u + 1) * (most_v + 1)) * sizeof *coef);
    for (int k = 0; k < n; k++)
        coef[term[k]->power[1] * (most_u + 1) + term[k]->power[0]] +=
            factor[k] * term[k]->mix[p];
}

/* Sets OUT to the sum of the N terms TERM times FACTOR at each ray, times the
 * weights. */
static WIDE_VECTORS void evaluate_terms(const struct search *s, int n,
                                        const struct column *const *term,
                                        const double *factor, double *out)
{
    double coef[PLACES];

    for (int p = 0; p < s->n_planes; p++) {
        int i = s->first[p];

        collapse_terms_in_plane(s, p, n, term, factor, coef);
        for (; i + MANY <= s->first[p + 1]; i += MANY)
            evaluate_at_rays(s, coef, s->u + i, s->v + i, MANY, out + i);
        for (; i < s->first[p + 1]; i += LANES)
            evaluate_at_rays(s, coef, s->u + i, s->v + i, LANES, out + i);
    }
    for (int i = 0; i < s->first[s->n_planes]; i++)
        out[i] *= s->weight[i];
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

/* ---------------------------------------------------------------- products */

/* Returns the entries of the table TABLE of sums at index PLACE. */
static WHOLLY_INLINE const double *get_sums(const struct search *s,
                                            const double *table, int place)
{
    return table + (size_t)place * (size_t)s->n_rows;
}

/* Returns the sum over all rays of the values in TABLE times the term of
 * COLUMN. */
static double compute_term_product(const struct search *s, const double *table,
                                   const struct column *column)
{
    return compute_dot_product(get_sums(s, table, column->place), column->mix,
                               s->n_rows);
}

/* Updates COLUMN by its component along the chosen direction with index
 * RANK. */
static WHOLLY_INLINE void update_component(const struct search *s,
                                           struct column *column, int rank)
{
    const struct column *chosen = &s->column[s->chosen[rank]];
    const double product =
        sum_triple_products(get_sums(s, s->sums, chosen->place + column->place),
                            chosen->mix, column->mix, s->n_rows);
    const double share =
        (product - multiply_vectors(chosen->on, column->on, rank)) /
        chosen->on[rank];

    column->on[rank] = share;
    column->left2 -= share * share;
}

/* Updates all open candidates by their components along the last chosen
 * direction, along which the residual had the component SHARE. */
static WIDE_VECTORS void update_candidates(struct search *s, double share)
{
    for (int i = 0; i < s->n_columns; i++) {
        struct column *const c = &s->column[i];

        if (c->dead || c->chosen)
            continue;
        update_component(s, c, s->n_chosen - 1);
        c->pull -= share * c->on[s->n_chosen - 1];
    }
}

/* Computes the components of the new candidate COLUMN along all chosen
 * directions. */
static WIDE_VECTORS void add_components(const struct search *s,
                                        struct column *column)
{
    for (int rank = 0; rank < s->n_chosen; rank++) {
        update_component(s, column, rank);
        column->pull -= s->share[rank] * column->on[rank];
    }
}

/* Sets FACTOR to the factors of the chosen terms whose sum has the components
 * ON along the chosen directions, by back substitution, and TERM to these
 * terms. */
static void solve_factors(const struct search *s, const double *on,
                          const struct column **term, double *factor)
{
    for (int k = s->n_chosen - 1; k >= 0; k--) {
        double share = on[k];

        term[k] = &s->column[s->chosen[k]];
        for (int m = k + 1; m < s->n_chosen; m++)
            share -= term[m]->on[k] * factor[m];
        factor[k] = share / term[k]->on[k];
    }
}

/* Sets SHARE to the components along the chosen directions of VALUES, a value
 * per ray. Leaves the sums of VALUES in spare_sums. Returns the sum of squares
 * of SHARE. */
static double project_on_directions(struct search *s, const double *values,
                                    double share[GLINT_MAX_TERMS])
{
    double sum2 = 0;

    for (int i = 0; i < s->first[s->n_planes]; i++)
        s->spare[0][i] = values[i] * s->weight[i];
    sum_over_planes(s, s->spare[0], s->degrees->most[0], s->first_v, s->step_v,
                    s->degrees->most[1], s->spare_sums);
    for (int k = 0; k < s->n_chosen; k++) {
        const struct column *c = &s->column[s->chosen[k]];

        share[k] = (compute_term_product(s, s->spare_sums, c) -
                    compute_dot_product(c->on, share, k)) /
                   c->on[k];
        sum2 += share[k] * share[k];
    }
    return sum2;
}

/* ------------------------------------------------------------ measurements */

/* Measures the residual on the rays. */
static void measure_residual(struct search *s)
{
    const struct column *term[GLINT_MAX_TERMS];
    double factor[GLINT_MAX_TERMS];
    const int n = s->first[s->n_planes];

    solve_factors(s, s->share, term, factor);
    evaluate_terms(s, s->n_chosen, term, factor, s->residual);
    for (int i = 0; i < n; i++)
        s->residual[i] = s->target[i] - s->residual[i];
    s->left2 = compute_dot_product(s->residual, s->residual, n);
    s->peak = find_max_magnitude(s->residual, n);
    s->is_measured = true;
}

/* Adds the components that the measured residual still has along the chosen
 * directions to the fit. Returns the squared residual that should remain. */
static double refine_fit(struct search *s)
{
    double share[GLINT_MAX_TERMS];
    const double sum2 = project_on_directions(s, s->residual, share);

    for (int k = 0; k < s->n_chosen; k++)
        s->share[k] += share[k];
    for (int i = 0; i < s->n_columns; i++) {
        struct column *const c = &s->column[i];

        if (!c->dead && !c->chosen)
            c->pull = compute_term_product(s, s->spare_sums, c) -
                      compute_dot_product(c->on, share, s->n_chosen);
    }
    return s->left2 - sum2;
}

/* Measures the residual on the rays and refines the fit until the residual is
 * as small as its terms allow. If the terms depend on each other so much that
 * refining diverges, returns to the fit before, which gets no more terms. */
static void refine_to_min_residual(struct search *s)
{
    enum { ROUNDS = 3 };
    double least = s->left2, share[GLINT_MAX_TERMS];

    measure_residual(s);
    for (int k = 0; k < ROUNDS && s->left2 > (1 + INEXACT) * least; k++) {
        const double before2 = s->left2;

        memcpy(share, s->share, sizeof share);
        least = refine_fit(s);
        measure_residual(s);
        if (!(s->left2 <= before2)) {
            memcpy(s->share, share, sizeof share);
            measure_residual(s);
            s->diverges = true;
            return;
        }
    }
}

/* Measures the part of COLUMN that is orthogonal to all chosen directions on
 * the rays. */
static void measure_column(struct search *s, struct column *column)
{
    const struct column *term[GLINT_MAX_TERMS + 1];
    double factor[GLINT_MAX_TERMS + 1], again[GLINT_MAX_TERMS];
    double *const values = s->spare[2];
    const int n = s->first[s->n_planes];

    if (!s->is_measured)
        measure_residual(s);
    solve_factors(s, column->on, term, factor);
    for (int k = 0; k < s->n_chosen; k++)
        factor[k] = -factor[k];
    term[s->n_chosen] = column;
    factor[s->n_chosen] = 1;
    evaluate_terms(s, s->n_chosen + 1, term, factor, values);
    column->left2 = compute_dot_product(values, values, n) -
                    project_on_directions(s, values, again);
    column->was2 = column->left2;
    column->pull = compute_dot_product(values, s->residual, n);
    for (int k = 0; k < s->n_chosen; k++)
        column->on[k] += again[k];
}

/* -------------------------------------------------------------- candidates */

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

/* Returns the index in mixes of the powers POWER of variables 2 to 4. */
static int compute_mix_index(const struct glint_degrees *d,
                             const uint8_t *power)
{
    return (power[2] * (d->most[3] + 1) + power[3]) * (d->most[4] + 1) +
           power[4];
}

/* Adds the term POWER as a candidate. Does nothing if the term is not allowed
 * or exists already. */
static void add_candidate_term(struct search *s, const uint8_t *power)
{
    struct column *c = &s->column[s->n_columns];

    if (s->n_columns == GLINT_MAX_CANDIDATES ||
        !is_term_allowed(s->degrees, power))
        return;
    for (int i = 0; i < s->n_columns; i++)
        if (memcmp(s->column[i].power, power, GLINT_VARIABLES) == 0)
            return;
    memcpy(c->power, power, GLINT_VARIABLES);
    c->dead = c->chosen = false;
    c->place = power[1] * s->row + power[0];
    c->mix = s->mixes +
             (size_t)compute_mix_index(s->degrees, power) * (size_t)s->n_rows;
    c->length2 = 0;
    for (int p = 0; p < s->n_rows; p++)
        c->length2 +=
            get_sums(s, s->sums, 2 * c->place)[p] * c->mix[p] * c->mix[p];
    c->was2 = c->left2 = c->length2;
    c->pull = compute_term_product(s, s->target_sums, c);
    add_components(s, c);
    s->n_columns++;
}

/* Adds the neighbours of COLUMN's term as candidates: terms with one power more
 * in one variable, or two more in a variable of fixed parity. With leaps also
 * terms with two powers more in variable 0, and in variable 1 if its parity is
 * free: near the axis ghosts are symmetric, so the odd power in between would
 * not reduce the residual and would never be chosen. */
static void add_neighbour_terms(struct search *s, const struct column *column)
{
    const int leaps = 1 + (s->degrees->parity < 0);
    const int most = GLINT_VARIABLES + (s->degrees->leaps ? leaps : 0);

    for (int k = 0; k < most; k++) {
        const int v = k % GLINT_VARIABLES;
        uint8_t power[GLINT_VARIABLES];

        memcpy(power, column->power, sizeof power);
        power[v] = (uint8_t)(power[v] + (k >= GLINT_VARIABLES ? 2 : 1) +
                             (v == 1 && s->degrees->parity >= 0));
        add_candidate_term(s, power);
    }
}

/* Returns the index of the candidate that reduces the residual most; -1:
 * none. */
static int find_best_candidate(struct search *s)
{
    double most = 0;
    int best = -1;

    for (int i = 0; i < s->n_columns; i++) {
        struct column *c = &s->column[i];

        if (c->dead || c->chosen)
            continue;
        if (!(c->left2 > DOUBTFUL * c->was2))
            measure_column(s, c);
        c->dead = !(c->left2 > DEPENDENT * DEPENDENT * c->length2);
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
    const int rank = s->n_chosen++;

    c->chosen = true;
    c->on[rank] = sqrt(c->left2);
    s->chosen[rank] = index;
    s->share[rank] = c->pull / c->on[rank];
    s->left2 -= s->share[rank] * s->share[rank];
    s->is_measured = false;
    update_candidates(s, s->share[rank]);
    add_neighbour_terms(s, c);
}

/* ------------------------------------------------------------------ tables */

/* Returns whether samples I and J are in different planes. */
static bool are_planes_different(const struct glint_regress_samples *v, int i,
                                 int j)
{
    for (int k = GLINT_S; k < GLINT_VARIABLES; k++)
        if (v->x[k] && v->x[k][i] != v->x[k][j])
            return true;
    return false;
}

/* Groups the samples in planes. */
static void find_planes(struct search *s)
{
    const struct glint_regress_samples *const v = s->s;
    int at = 0;

    for (int i = 0; i < v->n; i++, at++) {
        if (i > 0 && !are_planes_different(v, i, i - 1))
            continue;
        at = (at + LANES - 1) / LANES * LANES;
        s->first[s->n_planes] = at;
        s->sample[s->n_planes++] = i;
    }
    s->sample[s->n_planes] = v->n;
    s->n_rows = (s->n_planes + LANES - 1) / LANES * LANES;
    for (int p = s->n_planes; p <= s->n_rows; p++)
        s->first[p] = (at + LANES - 1) / LANES * LANES;
}

/* Sets the arrays over rays to the samples, whose fitted values are Y. */
static void set_rays(struct search *s, const double *y)
{
    const double *const u = s->s->x[GLINT_U], *const v = s->s->x[GLINT_V];

    for (int p = 0; p < s->n_planes; p++)
        for (int i = s->first[p], k = s->sample[p]; i < s->first[p + 1]; i++) {
            const bool pads = k == s->sample[p + 1];

            s->u[i] = !pads && u ? u[k] : 0;
            s->v[i] = !pads && v ? v[k] : 0;
            s->weight[i] = pads ? 0 : s->s->weight[k];
            s->target[i] = pads ? 0 : s->s->weight[k] * y[k];
            k += !pads;
        }
}

/* Returns the product of the powers POWER of variables 2 to 4 in plane P; 0 for
 * rows without a plane. */
static double compute_mix(const struct search *s, const uint8_t *power, int p)
{
    double mix = p < s->n_planes;

    for (int k = GLINT_S; k < GLINT_VARIABLES; k++)
        for (int n = 0; n < power[k] && p < s->n_planes; n++)
            mix *= s->s->x[k][s->sample[p]];
    return mix;
}

static void set_mixes(struct search *s)
{
    const uint8_t *const most = s->degrees->most;
    uint8_t power[GLINT_VARIABLES] = {0};
    double *mix = s->mixes;

    for (power[2] = 0; power[2] <= most[2]; power[2]++)
        for (power[3] = 0; power[3] <= most[3]; power[3]++)
            for (power[4] = 0; power[4] <= most[4]; power[4]++)
                for (int p = 0; p < s->n_rows; p++)
                    *mix++ = compute_mix(s, power, p);
}

/* Sets the tables of sums. */
static void set_sums(struct search *s)
{
    const struct glint_degrees *const d = s->degrees;
    const int n = s->first[s->n_rows];

    for (int i = 0; i < n; i++)
        s->spare[0][i] = s->weight[i] * s->weight[i];
    sum_over_planes(s, s->spare[0], 2 * d->most[0], 0, s->step_v,
                    2 * d->most[1], s->sums);
    for (int i = 0; i < n; i++)
        s->spare[0][i] = s->weight[i] * s->target[i];
    sum_over_planes(s, s->spare[0], d->most[0], s->first_v, s->step_v,
                    d->most[1], s->target_sums);
    s->target2 = s->left2 = compute_dot_product(s->target, s->target, n);
}

/* Initialises S in the memory SCRATCH. Y: the fitted values of all samples. */
static void init_search(struct search *s, double *scratch,
                        const struct glint_regress_samples *samples,
                        const double *y, const struct glint_degrees *degrees)
{
    const size_t row = 2U * degrees->most[0] + 1, lines = degrees->most[1];
    double **const rays[] = {&s->u,        &s->v,        &s->weight,
                             &s->target,   &s->residual, &s->spare[0],
                             &s->spare[1], &s->spare[2]};

    s->s = samples;
    s->degrees = degrees;
    s->n_chosen = s->n_columns = s->n_planes = 0;
    s->is_measured = s->diverges = false;
    s->row = (int)row;
    s->first_v = degrees->parity > 0;
    s->step_v = degrees->parity < 0 ? 1 : 2;
    find_planes(s);
    for (size_t k = 0; k < sizeof rays / sizeof *rays; k++) {
        *rays[k] = scratch;
        scratch += s->first[s->n_rows];
    }
    s->sums = scratch;
    s->target_sums = s->sums + row * (2 * lines + 1) * (size_t)s->n_rows;
    s->spare_sums = s->target_sums + row * (lines + 1) * (size_t)s->n_rows;
    s->mixes = s->spare_sums + row * (lines + 1) * (size_t)s->n_rows;
    set_rays(s, y);
    set_mixes(s);
    set_sums(s);
}

/* --------------------------------------------------------------------- fit */

static bool is_fit_hopeless(const struct search *s, double left)
{
    const struct glint_degrees *d = s->degrees;

    return d->hopeless > 0 && left > d->hopeless && s->n_chosen >= d->patience;
}

/* Returns the residual relative to its limits: the larger of RMS residual / RMS
 * and, if the residual is measured, max residual / PEAK. */
static double compute_residual_excess(const struct search *s, double rms,
                                      double peak)
{
    const double mean = sqrt(fmax(0, s->left2) / s->s->n) / rms;

    if (!isfinite(s->left2))
        return HUGE_VAL;
    return s->is_measured ? fmax(mean, s->peak / peak) : mean;
}

/* Returns whether the residual must be measured before the next term is chosen.
 * EXCESS: computed residual relative to its limit. */
static bool must_measure_residual(const struct search *s, double excess)
{
    const struct glint_degrees *d = s->degrees;

    return excess <= 1 || !(s->left2 > NOISE * s->target2) ||
           (d->hopeless > 0 && s->n_chosen == d->patience);
}

/* Chooses terms until the residual is at most RMS and PEAK. Returns the
 * residual relative to these limits. */
static double choose_terms(struct search *s, double rms, double peak)
{
    double left = compute_residual_excess(s, rms, peak);
    int best = 0;

    while (best >= 0) {
        if (must_measure_residual(s, left)) {
            refine_to_min_residual(s);
            left = compute_residual_excess(s, rms, peak);
        }
        if (left <= 1 || s->n_chosen == s->degrees->terms || s->diverges ||
            is_fit_hopeless(s, left))
            break;
        best = find_best_candidate(s);
        if (best >= 0)
            add_chosen_candidate(s, best);
        left = compute_residual_excess(s, rms, peak);
    }
    /* a polynomial has at least one term, however large its tolerance */
    if (s->n_chosen == 0 && s->n_columns > 0 && s->column[0].length2 > 0)
        add_chosen_candidate(s, 0);
    if (!s->is_measured)
        refine_to_min_residual(s);
    return compute_residual_excess(s, rms, peak);
}

double glint_regress_fit_polynomial(double *scratch,
                                    const struct glint_regress_samples *samples,
                                    const double *y,
                                    const struct glint_degrees *degrees,
                                    double rms, double peak,
                                    struct glint_poly *poly)
{
    const uint8_t first[GLINT_VARIABLES] = {0, degrees->parity > 0, 0, 0, 0};
    const struct column *term[GLINT_MAX_TERMS];
    struct search s;
    double left;

    init_search(&s, scratch, samples, y, degrees);
    add_candidate_term(&s, first);
    left = choose_terms(&s, rms, peak);
    solve_factors(&s, s.share, term, poly->coef);
    poly->n = s.n_chosen;
    for (int k = 0; k < s.n_chosen; k++)
        memcpy(poly->power[k], term[k]->power, GLINT_VARIABLES);
    if (poly->n == 0) { /* the first term is 0 at all rays that have weight */
        poly->n = 1;
        poly->coef[0] = 0;
        memcpy(poly->power[0], first, GLINT_VARIABLES);
    }
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
