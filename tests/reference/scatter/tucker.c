/* SPDX-License-Identifier: MIT
 *
 * Models the mean of the R, G, B rows by a Tucker factorisation, term by term,
 * and each row of each channel by a polynomial of the modelled mean [Kurt14].
 *
 * A Tucker(1, 1) fit of a matrix is one term f h', found by alternating least
 * squares. The next term fits the residual.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/scatter/rebuild.h"
#include "bake/translucent/linear.h"

enum {
    ROUNDS = 300, /* max number of iterations per term */
    COEFFICIENTS = 6
};

/* relative change of the square of a term at which the iteration stops */
#define STILL 1e-11

struct tucker {
    const struct glint_scatter_rows *rows;
    int n, k2;
    float *left;   /* [n][k2]: residual */
    double *f, *h; /* [n] and [k2]: weights f and kernel h of one term */
    float *model;  /* [n][k2]: sum of the terms so far */
    int *first;    /* [n]: index of the largest entry of each row */
    /* [n]: divisor of each row: its largest entry; 1 if rows are not rotated */
    double *most;
};

static float *address_of_residual_row(const struct tucker *p, float *all, int x)
{
    return all + (size_t)x * (size_t)p->k2;
}

/* Sets the residual to the mean of the R, G, B rows. TURNED: rotates each row
 * to begin with its largest entry, and divides it by that entry. */
static void compute_residual_rows(const struct tucker *p, bool turned)
{
    for (int x = 0; x < p->n; x++) {
        const float *rgb = glint_scatter_get_row(p->rows, x, 0);
        float *to = address_of_residual_row(p, p->left, x),
              *scratch = address_of_residual_row(p, p->model, x);
        int first = 0;

        for (int d = 0; d < p->k2; d++) {
            scratch[d] = (rgb[d] + rgb[p->k2 + d] + rgb[2 * p->k2 + d]) / 3;
            if (turned && scratch[d] > scratch[first])
                first = d;
        }
        p->first[x] = first;
        p->most[x] = turned && scratch[first] > 0 ? (double)scratch[first] : 1;
        for (int d = 0; d < p->k2; d++)
            to[d] = (float)((double)scratch[(d + first) % p->k2] / p->most[x]);
        memset(scratch, 0, (size_t)p->k2 * sizeof *scratch);
    }
}

/* Sets the weights F to the least-squares solution LEFT H / |H|^2 for a fixed
 * kernel H. */
static void fit_row_weights(const float *left, int n, int k2, double *f,
                            const double *h)
{
    double square = 0;

    for (int d = 0; d < k2; d++)
        square += h[d] * h[d];
    for (int x = 0; x < n; x++) {
        const float *row = left + (size_t)x * (size_t)k2;
        double sum = 0;

        for (int d = 0; d < k2; d++)
            sum += (double)row[d] * h[d];
        f[x] = square > 0 ? sum / square : 0;
    }
}

/* Sets the kernel H to the least-squares solution LEFT' F / |F|^2 for fixed
 * weights F. Returns |F|^2 |H|^2, the square of the term's norm. */
static double fit_term_kernel(const float *left, int n, int k2, const double *f,
                              double *h)
{
    double square = 0, length = 0;

    memset(h, 0, (size_t)k2 * sizeof *h);
    for (int x = 0; x < n; x++) {
        const float *row = left + (size_t)x * (size_t)k2;

        square += f[x] * f[x];
        for (int d = 0; d < k2; d++)
            h[d] += f[x] * (double)row[d];
    }
    for (int d = 0; d < k2; d++) {
        h[d] = square > 0 ? h[d] / square : 0;
        length += h[d] * h[d];
    }
    return square * length;
}

double glint_fit_tucker_term(float *left, int n, int k2, double *f, double *h)
{
    double before = -1, square = 0;

    for (int d = 0; d < k2; d++)
        h[d] = 1 + (double)(d * 7919 % 101) / 101;
    for (int i = 0; i < ROUNDS; i++) {
        fit_row_weights(left, n, k2, f, h);
        square = fit_term_kernel(left, n, k2, f, h);
        if (fabs(square - before) <= STILL * square)
            break;
        before = square;
    }
    for (int x = 0; x < n; x++)
        for (int d = 0; d < k2; d++)
            left[(size_t)x * (size_t)k2 + (size_t)d] -= (float)(f[x] * h[d]);
    return square;
}

/* Fits one term to the residual and subtracts it. */
static void fit_and_subtract_term(const struct tucker *p)
{
    glint_fit_tucker_term(p->left, p->n, p->k2, p->f, p->h);
    for (int x = 0; x < p->n; x++) {
        float *model = address_of_residual_row(p, p->model, x);

        for (int d = 0; d < p->k2; d++)
            model[d] += (float)(p->f[x] * p->h[d]);
    }
}

/* Sets COEF to the polynomial of MEAN that best fits the row of texel X in
 * channel C, over the entries inside the square. */
static void fit_row_polynomial(const struct tucker *p, int x, int c, int degree,
                               const double *mean, double *coef)
{
    double gram[COEFFICIENTS * COEFFICIENTS] = {0};
    const float *row = glint_scatter_get_row(p->rows, x, c);
    const int n = degree + 1;

    memset(coef, 0, COEFFICIENTS * sizeof *coef);
    for (int d = 0; d < p->k2; d++) {
        double power[2 * COEFFICIENTS] = {1};

        if (glint_scatter_get_target_texel(p->rows->side, p->rows->kernel, x,
                                           d) < 0)
            continue;
        for (int i = 1; i <= 2 * degree; i++)
            power[i] = power[i - 1] * mean[d];
        for (int i = 0; i < n; i++) {
            coef[i] += power[i] * (double)row[d];
            for (int k = 0; k < n; k++)
                gram[i * n + k] += power[i + k];
        }
    }
    glint_solve_symmetric_system(gram, n, coef);
}

/* Sets MEAN[k2] to the row of texel X as the terms model it, rotated back. */
static void compute_modelled_mean_row(const struct tucker *p, int x,
                                      double *mean)
{
    const float *model = address_of_residual_row(p, p->model, x);

    for (int d = 0; d < p->k2; d++)
        mean[(d + p->first[x]) % p->k2] = (double)model[d];
}

static void rebuild_row(const struct tucker *p, int x, int degree, double *mean,
                        double *row, struct glint_scatter_rows *rebuilt)
{
    double most = 0;

    compute_modelled_mean_row(p, x, mean);
    for (int d = 0; d < p->k2; d++)
        most = fmax(most, fabs(mean[d]));
    for (int d = 0; d < p->k2 && most > 0; d++)
        mean[d] /= most;
    for (int c = 0; c < 3; c++) {
        double coef[COEFFICIENTS];

        fit_row_polynomial(p, x, c, degree, mean, coef);
        for (int d = 0; d < p->k2; d++) {
            row[d] = coef[degree];
            for (int i = degree - 1; i >= 0; i--)
                row[d] = row[d] * mean[d] + coef[i];
        }
        glint_store_rebuilt_row(rebuilt, x, c, row);
    }
}

static enum glint_status rebuild_rows(const struct tucker *p,
                                      const struct glint_scatter_candidate *o,
                                      const struct glint_watch *watch,
                                      struct glint_scatter_rows *rebuilt)
{
    compute_residual_rows(p, o->turned);
    for (int t = 0; t < o->terms; t++) {
        if (glint_watch_report_progress(watch, (double)t / (o->terms + 1)))
            return GLINT_E_CLOSED;
        fit_and_subtract_term(p);
    }
    for (int x = 0; x < p->n; x++)
        rebuild_row(p, x, o->degree, p->h, p->f, rebuilt);
    return GLINT_OK;
}

enum glint_status glint_rebuild_tucker_terms(
    const struct glint_scatter_rows *rows, struct glint_scatter_candidate *o,
    const struct glint_watch *watch, struct glint_scatter_rows *rebuilt)
{
    const size_t n = (size_t)rows->side * (size_t)rows->side;
    const size_t k2 = (size_t)glint_scatter_count_entries(rows->kernel);
    struct tucker p = {.rows = rows, .n = (int)n, .k2 = (int)k2};
    enum glint_status status = GLINT_E_MEMORY;

    p.left = malloc(2 * n * k2 * sizeof *p.left);
    p.model = p.left + n * k2;
    /* the weights f also serve as scratch memory for a row */
    p.f = malloc((2 * n + 2 * k2) * sizeof *p.f);
    p.h = p.f + n + k2;
    p.most = p.h + k2;
    p.first = malloc(n * sizeof *p.first);
    if (p.left && p.f && p.first)
        status = rebuild_rows(&p, o, watch, rebuilt);
    free(p.left);
    free(p.f);
    free(p.first);
    return status;
}
