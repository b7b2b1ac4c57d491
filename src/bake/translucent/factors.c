/* SPDX-License-Identifier: MIT
 *
 * Fits the rows of a scattering matrix. Each row is modelled as a sum of a few
 * kernels, with weights per texel. Kernels are matrices of low rank.
 *
 * A singular value decomposition of the complete rows gives initial kernels.
 * Weights and kernels are then updated in turn by least squares. Kernels are
 * truncated to their rank in each round, so that the weights compensate for the
 * truncation.
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
    /* h: kernels; f: weights of texels; column, row: factors of the truncated
     * kernels. All point to channel c of kernel 0. The arrays of three channels
     * follow each other, kernel by kernel. */
    double *h, *f, *column, *row;
    /* indices of the texels whose rows lie completely inside the map */
    int *complete;
    /* normal equations, one system per kernel entry: matrices (gram) and right
     * sides (side) */
    double *gram, *side;
};

static double *get_channel_array(double *all, int j, size_t n)
{
    return all + (size_t)j * 3 * n;
}

static double *get_kernel_entries(const struct factors *p, int j)
{
    return get_channel_array(
        p->h, j, (size_t)glint_scatter_count_entries(p->fit->kernel));
}

static double *get_kernel_weights_of_texels(const struct factors *p, int j)
{
    return get_channel_array(p->f, j,
                             (size_t)p->fit->side * (size_t)p->fit->side);
}

static void read_complete_row(const void *ctx, int i, double *to)
{
    const struct factors *p = ctx;
    const float *row = glint_scatter_get_row(p->rows, p->complete[i], p->c);

    for (int d = 0; d < glint_scatter_count_entries(p->fit->kernel); d++)
        to[d] = (double)row[d];
}

/* Sets initial kernels from the complete rows, or from all rows if none is
 * complete. Returns false if there is no memory. */
static bool set_initial_kernels(struct factors *p)
{
    const int side = p->fit->side, n = p->fit->kernel, k2 = n * n;
    struct glint_tall a = {0, k2, read_complete_row, p};
    struct glint_terms terms;

    for (int some = 0; some < 2 && a.rows == 0; some++)
        for (int x = 0; x < side * side; x++) {
            const struct glint_scatter_inside in =
                glint_scatter_find_offsets_inside(side, n, x);

            if (some || (in.u_to - in.u_from) * (in.v_to - in.v_from) == k2)
                p->complete[a.rows++] = x;
        }
    if (!glint_compute_leading_terms(&a, p->fit->kernels, &terms))
        return false;
    for (int j = 0; j < terms.n; j++)
        memcpy(get_kernel_entries(p, j), terms.right + (size_t)j * (size_t)k2,
               (size_t)k2 * sizeof *terms.right);
    glint_terms_free(&terms);
    return true;
}

/* Truncates kernel J to its rank, as a sum of products of a column and a
 * row. */
static void truncate_kernel(const struct factors *p, int j)
{
    const int n = p->fit->kernel, rank = p->fit->rank;
    double *h = get_kernel_entries(p, j), *a = p->gram, *turn = p->gram + n * n;
    double *column = get_channel_array(p->column, j, (size_t)rank * (size_t)n);
    double *row = get_channel_array(p->row, j, (size_t)rank * (size_t)n);

    for (int u = 0; u < n; u++)
        for (int v = 0; v < n; v++) {
            a[u * n + v] = h[v * n + u];
            turn[u * n + v] = u == v;
        }
    glint_jacobi_orthogonalise(a, n, n, turn, n);
    memset(h, 0, (size_t)(n * n) * sizeof *h);
    memset(column, 0, (size_t)rank * (size_t)n * sizeof *column);
    memset(row, 0, (size_t)rank * (size_t)n * sizeof *row);
    for (int q = 0; q < rank && q < n; q++) {
        double length = 0, root;

        for (int v = 0; v < n; v++)
            length += a[q * n + v] * a[q * n + v];
        /* distributes the magnitude equally between column and row */
        root = sqrt(sqrt(length));
        for (int v = 0; v < n && root > 0; v++) {
            column[q * n + v] = a[q * n + v] / root;
            row[q * n + v] = turn[q * n + v] * root;
        }
        for (int v = 0; v < n; v++)
            for (int u = 0; u < n; u++)
                h[v * n + u] += column[q * n + v] * row[q * n + u];
    }
}

/* Sets GRAM[kernels][kernels] and SUMS[kernels] to the normal equations for the
 * weights of texel X. */
static void set_weight_equations(const struct factors *p, int x, double *gram,
                                 double *sums)
{
    const int n = p->fit->kernel, k = p->fit->kernels;
    const struct glint_scatter_inside in =
        glint_scatter_find_offsets_inside(p->fit->side, n, x);
    const float *data = glint_scatter_get_row(p->rows, x, p->c);

    memset(gram, 0, (size_t)(k * k) * sizeof *gram);
    memset(sums, 0, (size_t)k * sizeof *sums);
    for (int j = 0; j < k; j++)
        for (int v = in.v_from; v < in.v_to; v++) {
            const double *h = get_kernel_entries(p, j) + v * n;

            for (int u = in.u_from; u < in.u_to; u++)
                sums[j] += h[u] * (double)data[v * n + u];
            for (int i = 0; i <= j; i++) {
                const double *other = get_kernel_entries(p, i) + v * n;

                for (int u = in.u_from; u < in.u_to; u++)
                    gram[j * k + i] += h[u] * other[u];
            }
        }
}

static void mirror_lower_triangle(double *a, int n)
{
    for (int i = 0; i < n; i++)
        for (int k = 0; k < i; k++)
            a[k * n + i] = a[i * n + k];
}

/* Fits the weights of all texels by least squares, for the current kernels. */
static void fit_texel_weights(const struct factors *p)
{
    double gram[GLINT_SCATTER_MAX_TERMS * GLINT_SCATTER_MAX_TERMS];
    double sums[GLINT_SCATTER_MAX_TERMS];
    const int k = p->fit->kernels;

    for (int x = 0; x < p->fit->side * p->fit->side; x++) {
        set_weight_equations(p, x, gram, sums);
        mirror_lower_triangle(gram, k);
        glint_solve_symmetric_system(gram, k, sums);
        for (int j = 0; j < k; j++)
            get_kernel_weights_of_texels(p, j)[x] = sums[j];
    }
}

/* Adds the row of texel X to the normal equations of all kernel entries. */
static void add_row_to_equations(const struct factors *p, int x)
{
    const int n = p->fit->kernel, k = p->fit->kernels;
    const struct glint_scatter_inside in =
        glint_scatter_find_offsets_inside(p->fit->side, n, x);
    const float *data = glint_scatter_get_row(p->rows, x, p->c);
    double f[GLINT_SCATTER_MAX_TERMS];

    for (int j = 0; j < k; j++)
        f[j] = get_kernel_weights_of_texels(p, j)[x];
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

/* Fits all kernels by least squares, for the current weights. */
static void fit_factor_kernels(const struct factors *p)
{
    const int k2 = glint_scatter_count_entries(p->fit->kernel),
              k = p->fit->kernels;

    memset(p->gram, 0, (size_t)(k2 * k * k) * sizeof *p->gram);
    memset(p->side, 0, (size_t)(k2 * k) * sizeof *p->side);
    for (int x = 0; x < p->fit->side * p->fit->side; x++)
        add_row_to_equations(p, x);
    for (int d = 0; d < k2; d++) {
        double *gram = p->gram + (size_t)d * (size_t)(k * k);

        mirror_lower_triangle(gram, k);
        glint_solve_symmetric_system(gram, k, p->side + d * k);
        for (int j = 0; j < k; j++)
            get_kernel_entries(p, j)[d] = p->side[d * k + j];
    }
}

static enum glint_status fit_all_channels(struct factors *p,
                                          const struct glint_watch *watch)
{
    const size_t texels = (size_t)p->fit->side * (size_t)p->fit->side;
    const size_t k2 = (size_t)glint_scatter_count_entries(p->fit->kernel);
    const size_t line = (size_t)p->fit->rank * (size_t)p->fit->kernel;

    for (p->c = 0; p->c < 3; p->c++) {
        p->h = p->fit->h + (size_t)p->c * k2;
        p->f = p->fit->f + (size_t)p->c * texels;
        p->column = p->fit->column + (size_t)p->c * line;
        p->row = p->fit->row + (size_t)p->c * line;
        if (!set_initial_kernels(p))
            return GLINT_E_MEMORY;
        for (int i = 0; i < ROUNDS; i++) {
            if (glint_watch_report_progress(
                    watch, (p->c + (i + 1.0) / (ROUNDS + 1)) / 3))
                return GLINT_E_CLOSED;
            if (i > 0)
                fit_factor_kernels(p);
            for (int j = 0; j < p->fit->kernels; j++)
                truncate_kernel(p, j);
            fit_texel_weights(p);
        }
    }
    return GLINT_OK;
}

enum glint_status
glint_scatter_fit_factors(const struct glint_scatter_rows *rows,
                          const struct glint_watch *watch,
                          struct glint_scatter_fit *fit)
{
    const size_t texels = (size_t)fit->side * (size_t)fit->side;
    const size_t k2 = (size_t)glint_scatter_count_entries(fit->kernel);
    const size_t k = (size_t)fit->kernels;
    const size_t line = (size_t)fit->rank * (size_t)fit->kernel;
    struct factors p = {.rows = rows, .fit = fit};
    enum glint_status status = GLINT_E_MEMORY;

    fit->h = calloc(3 * k * k2, sizeof *fit->h);
    fit->f = calloc(3 * k * texels, sizeof *fit->f);
    fit->column = calloc(3 * k * line, sizeof *fit->column);
    fit->row = calloc(3 * k * line, sizeof *fit->row);
    p.complete = malloc(texels * sizeof *p.complete);
    /* truncate_kernel() also stores two kernels in gram */
    p.gram = malloc(k2 * (k * k + k + 2) * sizeof *p.gram);
    p.side = p.gram + k2 * (k * k + 2);
    if (fit->h && fit->f && fit->column && fit->row && p.complete && p.gram)
        status = fit_all_channels(&p, watch);
    free(p.complete);
    free(p.gram);
    return status;
}
