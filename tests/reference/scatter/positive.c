/* SPDX-License-Identifier: MIT
 *
 * Fits non-negative factors to the rows of a scattering matrix, or to the rows
 * divided by the mean row of their cluster [Peers06].
 */
#include "reference/scatter/rebuild.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    ROUNDS = 30,
    SWEEPS = 2,         /* updates of each term per round */
    CLUSTER_ROUNDS = 20 /* rounds of k-means */
};

/* Sets ROW to the sum of the terms that model row X. */
static void sum_row_terms(const struct glint_positive *p, int x, double *row)
{
    memset(row, 0, (size_t)p->m * sizeof *row);
    for (int j = 0; j < p->terms; j++) {
        const double f = p->f[(size_t)j * (size_t)p->n + (size_t)x];
        const double *h = p->h + (size_t)j * (size_t)p->m;

        for (int d = 0; d < p->m; d++)
            row[d] += f * h[d];
    }
}

/* Memory for one update of the kernels h. up: [terms][m] sums of weighted
 * values; gram: [terms][terms][m] sums of weights; value, weight and left
 * (residual): scratch rows. */
struct sums {
    double *up, *gram, *value, *weight, *left;
};

/* Fits the factors of row X by least squares, one term after the other, clamped
 * to 0. */
static void fit_row_factors(const struct glint_positive *p, int x,
                            const struct sums *s)
{
    sum_row_terms(p, x, s->left);
    for (int d = 0; d < p->m; d++)
        s->left[d] = s->value[d] - s->left[d];
    for (int j = 0; j < p->terms * SWEEPS; j++) {
        const size_t term = (size_t)(j % p->terms);
        const double *h = p->h + term * (size_t)p->m;
        double *f = &p->f[term * (size_t)p->n + (size_t)x];
        double up = 0, down = 0, step;

        for (int d = 0; d < p->m; d++) {
            up += s->weight[d] * s->left[d] * h[d];
            down += s->weight[d] * h[d] * h[d];
        }
        step = down > 0 ? fmax(up / down, -*f) : 0;
        *f += step;
        for (int d = 0; d < p->m; d++)
            s->left[d] -= step * h[d];
    }
}

static void add_row_to_kernel_sums(const struct glint_positive *p, int x,
                                   const struct sums *s)
{
    const size_t m = (size_t)p->m, n = (size_t)p->n;

    for (size_t j = 0; j < (size_t)p->terms; j++) {
        const double f = p->f[j * n + (size_t)x];

        for (size_t d = 0; d < m; d++)
            s->up[j * m + d] += f * s->weight[d] * s->value[d];
        for (size_t i = 0; i <= j; i++) {
            const double both = f * p->f[i * n + (size_t)x];
            double *gram = s->gram + (j * (size_t)p->terms + i) * m;

            for (size_t d = 0; d < m; d++)
                gram[d] += both * s->weight[d];
        }
    }
}

/* Fits the kernels h of all terms by least squares, one term after the other,
 * clamped to 0. */
static void fit_kernels_h(const struct glint_positive *p, const struct sums *s)
{
    const size_t m = (size_t)p->m, terms = (size_t)p->terms;

    for (size_t k = 0; k < terms * SWEEPS; k++) {
        const size_t j = k % terms;

        for (size_t d = 0; d < m; d++) {
            const double own = s->gram[(j * terms + j) * m + d];
            double up = s->up[j * m + d];

            for (size_t i = 0; i < terms; i++)
                if (i != j)
                    up -= p->h[i * m + d] *
                          s->gram[(i < j ? j * terms + i : i * terms + j) * m +
                                  d];
            p->h[j * m + d] = own > 0 ? fmax(0, up / own) : 0;
        }
    }
}

/* Sets the initial weights f and kernels h from two different pseudo-random
 * sequences. Terms with equal initial values would stay equal. */
static void set_initial_factors(const struct glint_positive *p)
{
    for (int i = 0; i < p->terms * p->n; i++)
        p->f[i] = 0.5 + (double)(i * 7919LL % 1009) / 1009;
    for (int i = 0; i < p->terms * p->m; i++)
        p->h[i] = 0.5 + (double)(i * 104729LL % 997) / 997;
}

enum glint_status glint_fit_nonnegative_factors(const struct glint_positive *p,
                                                int rounds,
                                                const struct glint_watch *watch)
{
    const size_t m = (size_t)p->m, terms = (size_t)p->terms;
    const size_t all = terms * m * (terms + 1);
    double *memory = malloc((all + 3 * m) * sizeof *memory);
    const struct sums s = {memory, memory + terms * m, memory + all,
                           memory + all + m, memory + all + 2 * m};
    enum glint_status status = memory ? GLINT_OK : GLINT_E_MEMORY;

    set_initial_factors(p);
    for (int i = 0; i < rounds && status == GLINT_OK; i++) {
        memset(memory, 0, all * sizeof *memory);
        for (int x = 0; x < p->n; x++) {
            p->row(p->ctx, x, s.value, s.weight);
            fit_row_factors(p, x, &s);
            add_row_to_kernel_sums(p, x, &s);
        }
        fit_kernels_h(p, &s);
        if (glint_watch_report_progress(watch, (double)i / rounds))
            status = GLINT_E_CLOSED;
    }
    free(memory);
    return status;
}

/* The matrix to factorise: rows divided by the mean row of their cluster;
 * PLAIN: the unchanged rows. */
struct over {
    const struct glint_scatter_rows *rows;
    int c, clusters;
    bool plain;
    double *mean; /* [clusters][kernel * kernel]: mean rows of one channel */
    int *cluster; /* [texels]: cluster index of each row */
};

static void read_row_divided_by_mean(const void *ctx, int x, double *value,
                                     double *weight)
{
    const struct over *p = ctx;
    const int k2 = glint_scatter_count_entries(p->rows->kernel);
    const float *row = glint_scatter_get_row(p->rows, x, p->c);
    const double *g = p->mean + (size_t)p->cluster[x] * (size_t)k2;

    for (int d = 0; d < k2; d++) {
        value[d] = p->plain   ? (double)row[d]
                   : g[d] > 0 ? (double)row[d] / g[d]
                              : 1;
        weight[d] = p->plain ? 1 : g[d] * g[d];
    }
}

static double compute_row_distance(const struct over *p, int x, const double *g)
{
    const float *row = glint_scatter_get_row(p->rows, x, p->c);
    double sum = 0;

    for (int d = 0; d < glint_scatter_count_entries(p->rows->kernel); d++)
        sum += pow((double)row[d] - g[d], 2);
    return sum;
}

static void set_cluster_means(struct over *p)
{
    const size_t k2 = (size_t)glint_scatter_count_entries(p->rows->kernel);
    int n[GLINT_SCATTER_MAX_TERMS] = {0};

    memset(p->mean, 0, (size_t)p->clusters * k2 * sizeof *p->mean);
    for (int x = 0; x < p->rows->side * p->rows->side; x++) {
        const float *row = glint_scatter_get_row(p->rows, x, p->c);

        n[p->cluster[x]]++;
        for (size_t d = 0; d < k2; d++)
            p->mean[(size_t)p->cluster[x] * k2 + d] += (double)row[d];
    }
    for (int i = 0; i < p->clusters; i++)
        for (size_t d = 0; d < k2 && n[i] > 0; d++)
            p->mean[(size_t)i * k2 + d] /= n[i];
}

/* Clusters the rows by k-means. The initial clusters are consecutive ranges of
 * rows. */
static void cluster_rows(struct over *p)
{
    const int texels = p->rows->side * p->rows->side;
    const int k2 = glint_scatter_count_entries(p->rows->kernel);

    for (int x = 0; x < texels; x++)
        p->cluster[x] = (int)((long long)x * p->clusters / texels);
    for (int round = 0; round < CLUSTER_ROUNDS; round++) {
        bool moved = false;

        set_cluster_means(p);
        for (int x = 0; x < texels && p->clusters > 1; x++) {
            double best = compute_row_distance(
                p, x, p->mean + (size_t)p->cluster[x] * (size_t)k2);

            for (int i = 0; i < p->clusters; i++) {
                const double far = compute_row_distance(
                    p, x, p->mean + (size_t)i * (size_t)k2);

                if (far < best) {
                    best = far;
                    p->cluster[x] = i;
                    moved = true;
                }
            }
        }
        if (!moved)
            return;
    }
}

static enum glint_status
rebuild_channel_by_factors(struct over *p, struct glint_positive *q,
                           double *row, const struct glint_watch *watch,
                           struct glint_scatter_rows *rebuilt)
{
    enum glint_status status;

    if (!p->plain)
        cluster_rows(p);
    status = glint_fit_nonnegative_factors(q, ROUNDS, watch);
    for (int x = 0; x < q->n && status == GLINT_OK; x++) {
        const double *g = p->mean + (size_t)p->cluster[x] * (size_t)q->m;

        sum_row_terms(q, x, row);
        for (int d = 0; d < q->m && !p->plain; d++)
            row[d] *= g[d];
        glint_store_rebuilt_row(rebuilt, x, p->c, row);
    }
    return status;
}

static enum glint_status rebuild_rows(struct over *p, int terms,
                                      const struct glint_watch *watch,
                                      struct glint_scatter_rows *rebuilt)
{
    const int texels = p->rows->side * p->rows->side;
    const int k2 = glint_scatter_count_entries(p->rows->kernel);
    struct glint_positive q = {texels, k2,   terms, read_row_divided_by_mean,
                               p,      NULL, NULL};
    double *row = malloc((size_t)k2 * sizeof *row);
    enum glint_status status = GLINT_E_MEMORY;

    q.f = malloc((size_t)terms * (size_t)texels * sizeof *q.f);
    q.h = malloc((size_t)terms * (size_t)k2 * sizeof *q.h);
    p->mean = calloc((size_t)p->clusters * (size_t)k2, sizeof *p->mean);
    p->cluster = calloc((size_t)texels, sizeof *p->cluster);
    if (row && q.f && q.h && p->mean && p->cluster)
        status = GLINT_OK;
    for (p->c = 0; p->c < 3 && status == GLINT_OK; p->c++) {
        struct glint_watch_part part = {watch, p->c / 3.0, 1 / 3.0};
        const struct glint_watch share = glint_watch_make_for_part(&part);

        status = rebuild_channel_by_factors(p, &q, row, &share, rebuilt);
    }
    free(row);
    free(q.f);
    free(q.h);
    free(p->mean);
    free(p->cluster);
    return status;
}

enum glint_status glint_rebuild_nonnegative_factors(
    const struct glint_scatter_rows *rows, struct glint_scatter_candidate *o,
    const struct glint_watch *watch, struct glint_scatter_rows *rebuilt)
{
    struct over p = {.rows = rows, .clusters = 1, .plain = true};

    return rebuild_rows(&p, o->terms, watch, rebuilt);
}

enum glint_status glint_rebuild_cluster_factors(
    const struct glint_scatter_rows *rows, struct glint_scatter_candidate *o,
    const struct glint_watch *watch, struct glint_scatter_rows *rebuilt)
{
    struct over p = {.rows = rows, .clusters = o->clusters};

    return rebuild_rows(&p, o->terms, watch, rebuilt);
}
