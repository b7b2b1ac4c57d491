/* SPDX-License-Identifier: MIT
 *
 * Truncated singular value decompositions of rows, and of their logarithms
 * [Kurt14].
 */
#include "reference/scatter/rebuild.h"

#include <math.h>
#include <stdlib.h>

#include "bake/translucent/linear.h"

enum { SEARCHED = 256 /* rows of which a and b are found */ };

struct channel {
    const struct glint_scatter_rows *rows;
    int c, step; /* each STEPth row */
    bool logs;   /* ln(R' / a + b) */
    double a, b;
};

static void fetch(const void *ctx, int i, double *to)
{
    const struct channel *p = ctx;
    const float *row = glint_scatter_row(p->rows, i * p->step, p->c);

    for (int d = 0; d < glint_scatter_kernel2(p->rows->kernel); d++)
        to[d] = p->logs ? log((double)row[d] / p->a + p->b) : (double)row[d];
}

static double back(const struct channel *p, double value)
{
    return p->logs ? p->a * (exp(value) - p->b) : value;
}

static void term_row(const struct glint_terms *t, int rows, int k2, int x,
                     double *row)
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

static struct glint_tall matrix_of(const struct channel *p)
{
    const int texels = p->rows->side * p->rows->side;

    return (struct glint_tall){(texels + p->step - 1) / p->step,
                               glint_scatter_kernel2(p->rows->kernel), fetch,
                               p};
}

static enum glint_status rebuild_channel(const struct channel *p, int n,
                                         struct glint_scatter_rows *rebuilt)
{
    const struct glint_tall m = matrix_of(p);
    double *row = malloc((size_t)m.columns * sizeof *row);
    struct glint_terms terms;

    if (!row || !glint_terms_of(&m, n, &terms)) {
        free(row);
        return GLINT_E_MEMORY;
    }
    for (int x = 0; x < m.rows; x++) {
        term_row(&terms, m.rows, m.columns, x, row);
        for (int d = 0; d < m.columns; d++)
            row[d] = back(p, row[d]);
        glint_rebuilt_row(rebuilt, x, p->c, row);
    }
    free(row);
    glint_terms_close(&terms);
    return GLINT_OK;
}

static enum glint_status rebuild(struct channel *p, int n,
                                 const struct glint_watch *watch,
                                 struct glint_scatter_rows *rebuilt)
{
    enum glint_status status = GLINT_OK;

    p->step = 1;
    for (p->c = 0; p->c < 3 && status == GLINT_OK; p->c++)
        status = glint_watch_ends(watch, p->c / 3.0)
                     ? GLINT_E_CLOSED
                     : rebuild_channel(p, n, rebuilt);
    return status;
}

enum glint_status glint_rebuild_svd(const struct glint_scatter_rows *rows,
                                    struct glint_scatter_candidate *o,
                                    const struct glint_watch *watch,
                                    struct glint_scatter_rows *rebuilt)
{
    struct channel p = {.rows = rows};

    return rebuild(&p, o->terms, watch, rebuilt);
}

/* Sets SQUARE to the squared error of some rows of green. */
static bool try_logs(const struct channel *p, int n, double *square)
{
    const struct glint_tall m = matrix_of(p);
    double *row = malloc((size_t)m.columns * sizeof *row);
    struct glint_terms terms;

    *square = 0;
    if (!row || !glint_terms_of(&m, n, &terms)) {
        free(row);
        return false;
    }
    for (int x = 0; x < m.rows; x++) {
        const float *data = glint_scatter_row(p->rows, x * p->step, p->c);

        term_row(&terms, m.rows, m.columns, x, row);
        for (int d = 0; d < m.columns; d++)
            *square += pow(back(p, row[d]) - (double)data[d], 2);
    }
    free(row);
    glint_terms_close(&terms);
    return true;
}

/* Sets O's a and b to the best of a grid. */
static enum glint_status search(const struct glint_scatter_rows *rows,
                                struct glint_scatter_candidate *o,
                                const struct glint_watch *watch)
{
    static const double as[] = {1e-4, 1e-3, 1e-2, 1e-1, 1, 10, 100, 1000};
    static const double bs[] = {1e-2, 0.1, 1};
    const int texels = rows->side * rows->side;
    const double peak = glint_scatter_peak(rows);
    struct channel p = {.rows = rows,
                        .c = 1,
                        .step = texels > SEARCHED ? texels / SEARCHED : 1,
                        .logs = true};
    double best = HUGE_VAL;

    for (int i = 0; i < 24; i++) {
        double square;

        p.a = as[i % 8] * peak;
        p.b = bs[i / 8];
        if (glint_watch_ends(watch, i / 24.0))
            return GLINT_E_CLOSED;
        if (!try_logs(&p, o->terms, &square))
            return GLINT_E_MEMORY;
        if (square < best) {
            best = square;
            o->a = as[i % 8];
            o->b = p.b;
        }
    }
    return GLINT_OK;
}

enum glint_status glint_rebuild_log_svd(const struct glint_scatter_rows *rows,
                                        struct glint_scatter_candidate *o,
                                        const struct glint_watch *watch,
                                        struct glint_scatter_rows *rebuilt)
{
    struct glint_watch_part first = {watch, 0, 0.5}, second = {watch, 0.5, 0.5};
    const struct glint_watch early = glint_watch_of(&first);
    const struct glint_watch late = glint_watch_of(&second);
    const double peak = glint_scatter_peak(rows);
    struct channel p = {.rows = rows, .logs = true};
    enum glint_status status = GLINT_OK;

    if (!(peak > 0))
        return GLINT_OK; /* a black translucent medium is 0 */
    if (!(o->a > 0))
        status = search(rows, o, &early);
    p.a = o->a * peak;
    p.b = o->b;
    return status == GLINT_OK ? rebuild(&p, o->terms, &late, rebuilt) : status;
}
