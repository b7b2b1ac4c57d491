/* SPDX-License-Identifier: MIT
 *
 * Rows as sums of a few kernels, each of a low rank.
 *
 * The singular value decomposition of the rows that are whole begins; weights
 * and kernels then follow in turn by least squares, kernels cut to their rank
 * each time, so that weights make up for what that takes away.
 */
#include "bake/translucent/rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/translucent/linear.h"

enum { ROUNDS = 4 };

struct factors {
    const struct glint_scatter_rows *rows;
    struct glint_scatter_fit *fit;
    int c;
    double *h, *f, *column, *row; /* of channel C: first of kernels, 3 apart */
    int *whole;                   /* texels whose rows are complete */
    double *gram, *side;          /* normal equations, one system for each
                                     entry */
};

static double *term(double *all, int j, size_t n)
{
    return all + (size_t)j * 3 * n;
}

static double *kernel_of(const struct factors *p, int j)
{
    return term(p->h, j, (size_t)glint_scatter_kernel2(p->fit->kernel));
}

static double *weights_of(const struct factors *p, int j)
{
    return term(p->f, j, (size_t)p->fit->side * (size_t)p->fit->side);
}

static void whole_row(const void *ctx, int i, double *to)
{
    const struct factors *p = ctx;
    const float *row = glint_scatter_row(p->rows, p->whole[i], p->c);

    for (int d = 0; d < glint_scatter_kernel2(p->fit->kernel); d++)
        to[d] = (double)row[d];
}

/* Initialises the kernels from the complete rows, or from all rows if none is
 * complete. */
static bool begin(struct factors *p)
{
    const int side = p->fit->side, n = p->fit->kernel, k2 = n * n;
    struct glint_tall a = {0, k2, whole_row, p};
    struct glint_terms terms;

    for (int some = 0; some < 2 && a.rows == 0; some++)
        for (int x = 0; x < side * side; x++) {
            const struct glint_scatter_inside in =
                glint_scatter_inside(side, n, x);

            if (some || (in.u_to - in.u_from) * (in.v_to - in.v_from) == k2)
                p->whole[a.rows++] = x;
        }
    if (!glint_terms_of(&a, p->fit->kernels, &terms))
        return false;
    for (int j = 0; j < terms.n; j++)
        memcpy(kernel_of(p, j), terms.right + (size_t)j * (size_t)k2,
               (size_t)k2 * sizeof *terms.right);
    glint_terms_close(&terms);
    return true;
}

/* Cuts kernel J to its rank. */
static void cut(const struct factors *p, int j)
{
    const int n = p->fit->kernel, rank = p->fit->rank;
    double *h = kernel_of(p, j), *a = p->gram, *turn = p->gram + n * n;
    double *column = term(p->column, j, (size_t)rank * (size_t)n);
    double *row = term(p->row, j, (size_t)rank * (size_t)n);

    for (int u = 0; u < n; u++)
        for (int v = 0; v < n; v++) {
            a[u * n + v] = h[v * n + u];
            turn[u * n + v] = u == v;
        }
    glint_jacobi(a, n, n, turn, n);
    memset(h, 0, (size_t)(n * n) * sizeof *h);
    memset(column, 0, (size_t)rank * (size_t)n * sizeof *column);
    memset(row, 0, (size_t)rank * (size_t)n * sizeof *row);
    for (int q = 0; q < rank && q < n; q++) {
        double length = 0, root;

        for (int v = 0; v < n; v++)
            length += a[q * n + v] * a[q * n + v];
        root = sqrt(sqrt(length)); /* the length is split between both
                                      factors */
        for (int v = 0; v < n && root > 0; v++) {
            column[q * n + v] = a[q * n + v] / root;
            row[q * n + v] = turn[q * n + v] * root;
        }
        for (int v = 0; v < n; v++)
            for (int u = 0; u < n; u++)
                h[v * n + u] += column[q * n + v] * row[q * n + u];
    }
}

/* Sets GRAM, [kernels][kernels], and SUMS of the kernels with the row of X. */
static void equations(const struct factors *p, int x, double *gram,
                      double *sums)
{
    const int n = p->fit->kernel, k = p->fit->kernels;
    const struct glint_scatter_inside in =
        glint_scatter_inside(p->fit->side, n, x);
    const float *data = glint_scatter_row(p->rows, x, p->c);

    memset(gram, 0, (size_t)(k * k) * sizeof *gram);
    memset(sums, 0, (size_t)k * sizeof *sums);
    for (int j = 0; j < k; j++)
        for (int v = in.v_from; v < in.v_to; v++) {
            const double *h = kernel_of(p, j) + v * n;

            for (int u = in.u_from; u < in.u_to; u++)
                sums[j] += h[u] * (double)data[v * n + u];
            for (int i = 0; i <= j; i++) {
                const double *other = kernel_of(p, i) + v * n;

                for (int u = in.u_from; u < in.u_to; u++)
                    gram[j * k + i] += h[u] * other[u];
            }
        }
}

static void mirror(double *a, int n)
{
    for (int i = 0; i < n; i++)
        for (int k = 0; k < i; k++)
            a[k * n + i] = a[i * n + k];
}

/* Sets the weights by least squares for the current kernels. */
static void set_weights(const struct factors *p)
{
    double gram[GLINT_SCATTER_MAX_TERMS * GLINT_SCATTER_MAX_TERMS];
    double sums[GLINT_SCATTER_MAX_TERMS];
    const int k = p->fit->kernels;

    for (int x = 0; x < p->fit->side * p->fit->side; x++) {
        equations(p, x, gram, sums);
        mirror(gram, k);
        glint_solve(gram, k, sums);
        for (int j = 0; j < k; j++)
            weights_of(p, j)[x] = sums[j];
    }
}

/* Adds the row of X to the equations of its entries. */
static void add_entries(const struct factors *p, int x)
{
    const int n = p->fit->kernel, k = p->fit->kernels;
    const struct glint_scatter_inside in =
        glint_scatter_inside(p->fit->side, n, x);
    const float *data = glint_scatter_row(p->rows, x, p->c);
    double f[GLINT_SCATTER_MAX_TERMS];

    for (int j = 0; j < k; j++)
        f[j] = weights_of(p, j)[x];
    for (int v = in.v_from; v < in.v_to; v++)
        for (int d = v * n + in.u_from; d < v * n + in.u_to; d++) {
            double *gram = p->gram + (size_t)d * (size_t)(k * k);

            for (int j = 0; j < k; j++) {
                p->side[d * k + j] += f[j] * (double)data[d];
                for (int i = 0; i <= j; i++)
                    gram[j * k + i] += f[j] * f[i];
            }
        }
}

/* Sets the kernels by least squares for the current weights. */
static void set_kernels(const struct factors *p)
{
    const int k2 = glint_scatter_kernel2(p->fit->kernel), k = p->fit->kernels;

    memset(p->gram, 0, (size_t)(k2 * k * k) * sizeof *p->gram);
    memset(p->side, 0, (size_t)(k2 * k) * sizeof *p->side);
    for (int x = 0; x < p->fit->side * p->fit->side; x++)
        add_entries(p, x);
    for (int d = 0; d < k2; d++) {
        double *gram = p->gram + (size_t)d * (size_t)(k * k);

        mirror(gram, k);
        glint_solve(gram, k, p->side + d * k);
        for (int j = 0; j < k; j++)
            kernel_of(p, j)[d] = p->side[d * k + j];
    }
}

static enum glint_status run(struct factors *p, const struct glint_watch *watch)
{
    const size_t texels = (size_t)p->fit->side * (size_t)p->fit->side;
    const size_t k2 = (size_t)glint_scatter_kernel2(p->fit->kernel);
    const size_t line = (size_t)p->fit->rank * (size_t)p->fit->kernel;

    for (p->c = 0; p->c < 3; p->c++) {
        p->h = p->fit->h + (size_t)p->c * k2;
        p->f = p->fit->f + (size_t)p->c * texels;
        p->column = p->fit->column + (size_t)p->c * line;
        p->row = p->fit->row + (size_t)p->c * line;
        if (!begin(p))
            return GLINT_E_MEMORY;
        for (int i = 0; i < ROUNDS; i++) {
            if (glint_watch_ends(watch, (p->c + (i + 1.0) / (ROUNDS + 1)) / 3))
                return GLINT_E_CLOSED;
            if (i > 0)
                set_kernels(p);
            for (int j = 0; j < p->fit->kernels; j++)
                cut(p, j);
            set_weights(p);
        }
    }
    return GLINT_OK;
}

enum glint_status glint_scatter_factors(const struct glint_scatter_rows *rows,
                                        const struct glint_watch *watch,
                                        struct glint_scatter_fit *fit)
{
    const size_t texels = (size_t)fit->side * (size_t)fit->side;
    const size_t k2 = (size_t)glint_scatter_kernel2(fit->kernel);
    const size_t k = (size_t)fit->kernels;
    const size_t line = (size_t)fit->rank * (size_t)fit->kernel;
    struct factors p = {.rows = rows, .fit = fit};
    enum glint_status status = GLINT_E_MEMORY;

    fit->h = calloc(3 * k * k2, sizeof *fit->h);
    fit->f = calloc(3 * k * texels, sizeof *fit->f);
    fit->column = calloc(3 * k * line, sizeof *fit->column);
    fit->row = calloc(3 * k * line, sizeof *fit->row);
    p.whole = malloc(texels * sizeof *p.whole);
    /* cut() has two kernels there */
    p.gram = malloc(k2 * (k * k + k + 2) * sizeof *p.gram);
    p.side = p.gram + k2 * (k * k + 2);
    if (fit->h && fit->f && fit->column && fit->row && p.whole && p.gram)
        status = run(&p, watch);
    free(p.whole);
    free(p.gram);
    return status;
}
