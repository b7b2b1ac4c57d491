/* SPDX-License-Identifier: MIT */
#include "bake/translucent/linear.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "glint/scene/translucent_bake.h"

enum {
    /* number of vectors beyond the requested ones; they make the iteration for
     * the last requested one converge faster */
    SPARE = 8,
    ROUNDS = 300,
    SWEEPS = 60
};

/* max cosine between columns that count as orthogonal */
#define SAME 1e-15
/* max length, relative to that before orthogonalisation, of a vector that
 * counts as 0 */
#define NOTHING 1e-13
/* relative change of the sum of eigenvalues at which the iteration stops */
#define STILL 1e-15

static double compute_dot_product(const double *a, const double *b, int n)
{
    double sum = 0;

    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

static void rotate_vectors(double *a, double *b, int n, double cosine,
                           double sine)
{
    for (int i = 0; i < n; i++) {
        const double x = a[i], y = b[i];

        a[i] = cosine * x - sine * y;
        b[i] = sine * x + cosine * y;
    }
}

static void swap_rows(double *a, double *b, int n)
{
    for (int i = 0; i < n; i++) {
        const double x = a[i];

        a[i] = b[i];
        b[i] = x;
    }
}

/* One Jacobi rotation: puts the longer of columns I and K of A first, makes
 * them orthogonal, and does the same to TURN, which may be NULL. Returns false
 * if they were orthogonal already. */
static bool orthogonalise_column_pair(double *a, int rows, int i, int k,
                                      double *turn, int m)
{
    double *x = a + (size_t)i * (size_t)rows, *y = a + (size_t)k * (size_t)rows;
    const double xx = compute_dot_product(x, x, rows),
                 yy = compute_dot_product(y, y, rows);
    const double xy = compute_dot_product(x, y, rows);
    double ratio, t, cosine;

    if (yy > xx) {
        swap_rows(x, y, rows);
        if (turn)
            swap_rows(turn + (size_t)i * (size_t)m,
                      turn + (size_t)k * (size_t)m, m);
    }
    if (fabs(xy) <= SAME * sqrt(xx) * sqrt(yy) || xy == 0)
        return false;
    ratio = (fmin(xx, yy) - fmax(xx, yy)) / (2 * xy);
    t = (ratio >= 0 ? 1 : -1) / (fabs(ratio) + sqrt(1 + ratio * ratio));
    cosine = 1 / sqrt(1 + t * t);
    rotate_vectors(x, y, rows, cosine, cosine * t);
    if (turn)
        rotate_vectors(turn + (size_t)i * (size_t)m,
                       turn + (size_t)k * (size_t)m, m, cosine, cosine * t);
    return true;
}

void glint_jacobi_orthogonalise(double *a, int rows, int n, double *turn, int m)
{
    bool turned = true;

    for (int sweep = 0; sweep < SWEEPS && turned; sweep++) {
        turned = false;
        for (int i = 0; i < n; i++)
            for (int k = i + 1; k < n; k++)
                turned |= orthogonalise_column_pair(a, rows, i, k, turn, m);
    }
}

void glint_solve_symmetric_system(double *a, int n, double *b)
{
    double most = 0;

    for (int i = 0; i < n; i++)
        most = fmax(most, a[i * n + i]);
    /* factorises A = L D L'; D replaces the diagonal of A */
    for (int i = 0; i < n; i++) {
        double *row = a + (size_t)i * (size_t)n;

        for (int k = 0; k <= i; k++) {
            const double *other = a + (size_t)k * (size_t)n;

            for (int m = 0; m < k; m++)
                row[k] -= row[m] * other[m] * a[m * n + m];
            if (k < i)
                row[k] = other[k] > 0 ? row[k] / other[k] : 0;
        }
        row[i] = row[i] > NOTHING * most ? row[i] : 0;
        b[i] -= compute_dot_product(row, b, i);
    }
    for (int i = n - 1; i >= 0; i--) {
        b[i] = a[i * n + i] > 0 ? b[i] / a[i * n + i] : 0;
        for (int k = i + 1; k < n; k++)
            b[i] -= a[k * n + i] * b[k];
        if (!(a[i * n + i] > 0))
            b[i] = 0;
    }
}

/* Rows of V[n][m] that depend on earlier rows become 0. */
static void orthonormalise_rows(double *v, int n, int m)
{
    for (int i = 0; i < n; i++) {
        double *x = v + (size_t)i * (size_t)m;
        const double before = sqrt(compute_dot_product(x, x, m));
        double length;

        for (int twice = 0; twice < 2; twice++)
            for (int k = 0; k < i; k++) {
                const double *y = v + (size_t)k * (size_t)m;
                const double share = compute_dot_product(x, y, m);

                for (int j = 0; j < m; j++)
                    x[j] -= share * y[j];
            }
        length = sqrt(compute_dot_product(x, x, m));
        for (int j = 0; j < m; j++)
            x[j] = length > NOTHING * before ? x[j] / length : 0;
    }
}

/* Sets TO[n][m] to V[n][m] times the symmetric matrix G[m][m]. */
static void multiply_by_symmetric_matrix(const double *g, const double *v,
                                         int n, int m, double *to)
{
    memset(to, 0, (size_t)n * (size_t)m * sizeof *to);
    for (int j = 0; j < m; j++)
        for (int i = 0; i < n; i++) {
            const double share = v[(size_t)i * (size_t)m + (size_t)j];
            const double *row = g + (size_t)j * (size_t)m;
            double *sum = to + (size_t)i * (size_t)m;

            for (int k = 0; k < m; k++)
                sum[k] += share * row[k];
        }
}

/* Sets V[n][m] to a basis of the eigenspace of the N largest eigenvalues of G,
 * by subspace iteration. Only the first WANTED vectors must converge. */
static void find_leading_subspace(const double *g, int m, double *v, int n,
                                  int wanted, double *scratch)
{
    uint32_t seed = 1;
    double before = -1;

    for (int i = 0; i < n * m; i++) {
        seed = seed * UINT32_C(1664525) + UINT32_C(1013904223);
        v[i] = (double)seed / 2147483648.0 - 1;
    }
    orthonormalise_rows(v, n, m);
    for (int round = 0; round < ROUNDS; round++) {
        double sum = 0;

        multiply_by_symmetric_matrix(g, v, n, m, scratch);
        for (int i = 0; i < wanted; i++)
            sum += compute_dot_product(v + (size_t)i * (size_t)m,
                                       scratch + (size_t)i * (size_t)m, m);
        memcpy(v, scratch, (size_t)n * (size_t)m * sizeof *v);
        orthonormalise_rows(v, n, m);
        if (fabs(sum - before) <= STILL * sum)
            return;
        before = sum;
    }
}

/* Sets G to the dot products of all pairs of columns of A. ROW is scratch. */
static void compute_gram_matrix(const struct glint_tall *a, double *g,
                                double *row)
{
    const int m = a->columns;

    memset(g, 0, (size_t)m * (size_t)m * sizeof *g);
    for (int i = 0; i < a->rows; i++) {
        a->row(a->ctx, i, row);
        for (int j = 0; j < m; j++) {
            double *to = g + (size_t)j * (size_t)m;

            if (row[j] == 0)
                continue;
            for (int k = j; k < m; k++)
                to[k] += row[j] * row[k];
        }
    }
    for (int j = 0; j < m; j++)
        for (int k = 0; k < j; k++)
            g[j * m + k] = g[k * m + j];
}

/* Sets TERMS to the leading terms of A. Y[][rows]: left vectors, which must be
 * orthogonal but not normalised. V[][columns]: right vectors. */
static void set_leading_terms(const double *y, const double *v,
                              const struct glint_tall *a,
                              struct glint_terms *terms)
{
    for (int i = 0; i < terms->n; i++) {
        const double *from = y + (size_t)i * (size_t)a->rows;
        double *left = terms->left + (size_t)i * (size_t)a->rows;

        terms->value[i] = sqrt(compute_dot_product(from, from, a->rows));
        for (int x = 0; x < a->rows; x++)
            left[x] = terms->value[i] > 0 ? from[x] / terms->value[i] : 0;
        memcpy(terms->right + (size_t)i * (size_t)a->columns,
               v + (size_t)i * (size_t)a->columns,
               (size_t)a->columns * sizeof *v);
    }
}

bool glint_compute_leading_terms(const struct glint_tall *a, int n,
                                 struct glint_terms *terms)
{
    const int m = a->columns, wanted = n < m ? n : m;
    const int wide = wanted + SPARE < m ? wanted + SPARE : m;
    const size_t rows = (size_t)a->rows, columns = (size_t)m;
    double *g = malloc((columns * columns + columns) * sizeof *g);
    double *v = calloc(2 * (size_t)wide * columns, sizeof *v);
    double *y = calloc((size_t)wide * rows, sizeof *y);
    double *row;
    bool good;

    terms->n = wanted;
    terms->value = malloc((size_t)wanted * sizeof *terms->value);
    terms->left = malloc((size_t)wanted * rows * sizeof *terms->left);
    terms->right = malloc((size_t)wanted * columns * sizeof *terms->right);
    good = g && v && y && terms->value && terms->left && terms->right;
    if (good) {
        row = g + columns * columns;
        compute_gram_matrix(a, g, row);
        find_leading_subspace(g, m, v, wide, wanted,
                              v + (size_t)wide * columns);
        for (int x = 0; x < a->rows; x++) {
            a->row(a->ctx, x, row);
            for (int i = 0; i < wide; i++)
                y[(size_t)i * rows + (size_t)x] =
                    compute_dot_product(row, v + (size_t)i * columns, m);
        }
        glint_jacobi_orthogonalise(y, a->rows, wide, v, m);
        set_leading_terms(y, v, a, terms);
    } else {
        glint_terms_free(terms);
    }
    free(g);
    free(v);
    free(y);
    return good;
}

void glint_terms_free(struct glint_terms *terms)
{
    free(terms->value);
    free(terms->left);
    free(terms->right);
    memset(terms, 0, sizeof *terms);
}

/* -------------------------------------------------------------- separation */

enum { MOST = GLINT_SCATTER_MAX_KERNEL, FEW_SWEEPS = 30 };

/* Correlation of light on neighbouring texels. Values of .5 to .99 change the
 * PSNR under lamps by less than .3 dB; 0 lowers it by 1 to 10 dB. */
static const double correlation = 0.8;

/* State of the singular value decomposition of a kernel K. a[i] and v[i] are
 * columns of A and V. V is initially the unit matrix; A = K V holds at all
 * times. */
struct work {
    int n;
    double a[MOST][MOST], v[MOST][MOST];
};

/* One Jacobi rotation: makes columns I and J orthogonal. Returns 0 if they were
 * orthogonal already, else 1. */
static int orthogonalise_work_columns(struct work *w, int i, int j)
{
    const double p = compute_dot_product(w->a[i], w->a[i], w->n);
    const double q = compute_dot_product(w->a[j], w->a[j], w->n);
    const double r = compute_dot_product(w->a[i], w->a[j], w->n);
    double zeta, tangent, cosine;

    if (!(fabs(r) > 1e-15 * sqrt(p * q)))
        return 0;
    zeta = (q - p) / (2 * r);
    tangent = copysign(1 / (fabs(zeta) + sqrt(1 + zeta * zeta)), zeta);
    cosine = 1 / sqrt(1 + tangent * tangent);
    rotate_vectors(w->a[i], w->a[j], w->n, cosine, cosine * tangent);
    rotate_vectors(w->v[i], w->v[j], w->n, cosine, cosine * tangent);
    return 1;
}

/* Multiplies the vector of N numbers at X, STEP apart, by L'. L L' is the
 * correlation matrix of light, which decreases by a constant factor per texel
 * of distance. */
static void apply_correlation_weights(double *x, int n, int step)
{
    const double own = sqrt(1 - correlation * correlation);
    double sum = 0;

    for (int i = n - 1; i >= 0; i--) {
        sum = x[i * step] + correlation * sum;
        x[i * step] = i > 0 ? own * sum : sum;
    }
}

/* Inverts apply_correlation_weights() for STEP = 1. */
static void invert_correlation_weights(double *x, int n)
{
    const double own = sqrt(1 - correlation * correlation);

    for (int i = 1; i < n; i++)
        x[i] /= own;
    for (int i = 0; i < n - 1; i++)
        x[i] -= correlation * x[i + 1];
}

static void decompose_kernel(struct work *w, const double *kernel)
{
    int any = 1;

    memset(w->v, 0, sizeof w->v);
    for (int i = 0; i < w->n; i++) {
        w->v[i][i] = 1;
        for (int k = 0; k < w->n; k++)
            w->a[i][k] = kernel[k * w->n + i];
        apply_correlation_weights(w->a[i], w->n, 1);
    }
    for (int k = 0; k < w->n; k++)
        apply_correlation_weights(&w->a[0][k], w->n, MOST);
    for (int sweep = 0; any && sweep < FEW_SWEEPS; sweep++) {
        any = 0;
        for (int i = 0; i < w->n; i++)
            for (int j = i + 1; j < w->n; j++)
                any |= orthogonalise_work_columns(w, i, j);
    }
}

void glint_separate_kernel(const double *kernel, int n, int rank,
                           struct glint_separated *to)
{
    struct work w;
    double square[MOST];

    w.n = n;
    decompose_kernel(&w, kernel);
    to->all = 0;
    for (int i = 0; i < n; i++) {
        square[i] = compute_dot_product(w.a[i], w.a[i], n);
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
        invert_correlation_weights(to->column + r * n, n);
        invert_correlation_weights(to->row + r * n, n);
        to->lost -= square[best];
        square[best] = 0;
    }
    to->lost = fmax(to->lost, 0);
}
