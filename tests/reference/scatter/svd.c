/* SPDX-License-Identifier: MIT
 *
 * Models the rows of a scattering matrix by truncated singular value
 * decompositions of their values, or of their logarithms [Kurt14].
 */
#include "reference/scatter/rebuild.h"

#include <math.h>
#include <stdlib.h>

#include "bake/translucent/linear.h"

enum {
    /* number of rows that the search for the parameters a and b uses */
    SEARCHED = 256
};

struct channel {
    const struct glint_scatter_rows *rows;
    int c, step; /* c: channel; step: stride between the rows that are used */
    bool logs;   /* true: decomposes ln(R' / a + b) instead of R' */
    double a, b;
};

static void copy_row_to_doubles(const void *ctx, int i, double *to)
{
    const struct channel *p = ctx;
    const float *row = glint_scatter_get_row(p->rows, i * p->step, p->c);

    for (int d = 0; d < glint_scatter_count_entries(p->rows->kernel); d++)
        to[d] = p->logs ? log((double)row[d] / p->a + p->b) : (double)row[d];
}

static double invert_log_encoding(const struct channel *p, double value)
{
    return p->logs ? p->a * (exp(value) - p->b) : value;
}

static void sum_terms_of_row(const struct glint_terms *t, int rows, int k2,
                             int x, double *row)
{
    for (int d = 0; d < k2; d++)
        row[d] = 0;
    for (int j = 0; j < t->n; j++) {
        const double f =
            t->value[j] * t->left[(size_t)j * (size_t)rows + (size_t)x];
        const double *h = t->right + (size_t)j * (size_t)k2;

        for (int d = 0; d < k2; d++)
            row[d] += f * h[d];
    }
}

static struct glint_tall make_row_matrix(const struct channel *p)
{
    const int texels = p->rows->side * p->rows->side;

    return (struct glint_tall){(texels + p->step - 1) / p->step,
                               glint_scatter_count_entries(p->rows->kernel),
                               copy_row_to_doubles, p};
}

static enum glint_status
rebuild_channel_by_svd(const struct channel *p, int n,
                       struct glint_scatter_rows *rebuilt)
{
    const struct glint_tall m = make_row_matrix(p);
    double *row = malloc((size_t)m.columns * sizeof *row);
    struct glint_terms terms;

    if (!row || !glint_compute_leading_terms(&m, n, &terms)) {
        free(row);
        return GLINT_E_MEMORY;
    }
    for (int x = 0; x < m.rows; x++) {
        sum_terms_of_row(&terms, m.rows, m.columns, x, row);
        for (int d = 0; d < m.columns; d++)
            row[d] = invert_log_encoding(p, row[d]);
        glint_store_rebuilt_row(rebuilt, x, p->c, row);
    }
    free(row);
    glint_terms_free(&terms);
    return GLINT_OK;
}

static enum glint_status rebuild_channels(struct channel *p, int n,
                                          const struct glint_watch *watch,
                                          struct glint_scatter_rows *rebuilt)
{
    enum glint_status status = GLINT_OK;

    p->step = 1;
    for (p->c = 0; p->c < 3 && status == GLINT_OK; p->c++)
        status = glint_watch_report_progress(watch, p->c / 3.0)
                     ? GLINT_E_CLOSED
                     : rebuild_channel_by_svd(p, n, rebuilt);
    return status;
}

enum glint_status glint_rebuild_svd(const struct glint_scatter_rows *rows,
                                    struct glint_scatter_candidate *o,
                                    const struct glint_watch *watch,
                                    struct glint_scatter_rows *rebuilt)
{
    struct channel p = {.rows = rows};

    return rebuild_channels(&p, o->terms, watch, rebuilt);
}

/* Sets SQUARE to the squared error of the fit of logarithms to the sampled rows
 * of the green channel. */
static bool measure_log_fit_error(const struct channel *p, int n,
                                  double *square)
{
    const struct glint_tall m = make_row_matrix(p);
    double *row = malloc((size_t)m.columns * sizeof *row);
    struct glint_terms terms;

    *square = 0;
    if (!row || !glint_compute_leading_terms(&m, n, &terms)) {
        free(row);
        return false;
    }
    for (int x = 0; x < m.rows; x++) {
        const float *data = glint_scatter_get_row(p->rows, x * p->step, p->c);

        sum_terms_of_row(&terms, m.rows, m.columns, x, row);
        for (int d = 0; d < m.columns; d++)
            *square += pow(invert_log_encoding(p, row[d]) - (double)data[d], 2);
    }
    free(row);
    glint_terms_free(&terms);
    return true;
}

/* Searches a grid of values for the a and b with the smallest error, and stores
 * them in O. */
static enum glint_status
search_parameters(const struct glint_scatter_rows *rows,
                  struct glint_scatter_candidate *o,
                  const struct glint_watch *watch)
{
    static const double as[] = {1e-4, 1e-3, 1e-2, 1e-1, 1, 10, 100, 1000};
    static const double bs[] = {1e-2, 0.1, 1};
    const int texels = rows->side * rows->side;
    const double peak = glint_scatter_largest_entry(rows);
    struct channel p = {.rows = rows,
                        .c = 1,
                        .step = texels > SEARCHED ? texels / SEARCHED : 1,
                        .logs = true};
    double best = HUGE_VAL;

    for (int i = 0; i < 24; i++) {
        double square;

        p.a = as[i % 8] * peak;
        p.b = bs[i / 8];
        if (glint_watch_report_progress(watch, i / 24.0))
            return GLINT_E_CLOSED;
        if (!measure_log_fit_error(&p, o->terms, &square))
            return GLINT_E_MEMORY;
        if (square < best) {
            best = square;
            o->a = as[i % 8];
            o->b = p.b;
        }
    }
    return GLINT_OK;
}

enum glint_status glint_rebuild_svd_of_logarithms(
    const struct glint_scatter_rows *rows, struct glint_scatter_candidate *o,
    const struct glint_watch *watch, struct glint_scatter_rows *rebuilt)
{
    struct glint_watch_part first = {watch, 0, 0.5}, second = {watch, 0.5, 0.5};
    const struct glint_watch early = glint_watch_make_for_part(&first);
    const struct glint_watch late = glint_watch_make_for_part(&second);
    const double peak = glint_scatter_largest_entry(rows);
    struct channel p = {.rows = rows, .logs = true};
    enum glint_status status = GLINT_OK;

    if (!(peak > 0))
        return GLINT_OK; /* a black medium: the rebuilt rows stay 0 */
    if (!(o->a > 0))
        status = search_parameters(rows, o, &early);
    p.a = o->a * peak;
    p.b = o->b;
    return status == GLINT_OK ? rebuild_channels(&p, o->terms, &late, rebuilt)
                              : status;
}
