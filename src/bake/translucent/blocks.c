/* SPDX-License-Identifier: MIT
 *
 * The middle of a grid's inverse, without the rest.
 *
 * With S_j the blocks that elimination from the top leaves on the diagonal and
 * E_j the joints downwards, T_j = S_j^-1 E_j carries columns of the inverse
 * upwards: G(j, l) = T_j G(j + 1, l) for l > j, and G(j, j) = S_j^-1 + T_j
 * G(j + 1, j). Only blocks up to REACH below are kept. Entries of T fall
 * exponentially away from the diagonal; what is below SMALL of the largest is
 * left out.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/translucent/slab.h"

#define SMALL 1e-11

struct inverse {
    const struct glint_blocks *b;
    int reach;
    double *eliminated; /* [side] S_j^-1, each [side][side] */
    double *t, *scratch;
    double **ring;  /* [reach + 1] G(j + 1, j + 1 + i) */
    int *from, *to; /* [side] entries of a row of T that count */
};

/* Makes U of the upper half of A, A = U' U. */
static void cholesky(double *a, int n)
{
    for (int k = 0; k < n; k++) {
        double *row = a + (size_t)k * (size_t)n;
        const double root = sqrt(row[k]);

        for (int m = k; m < n; m++)
            row[m] /= root;
        for (int i = k + 1; i < n; i++) {
            double *other = a + (size_t)i * (size_t)n;

            for (int m = i; m < n; m++)
                other[m] -= row[i] * row[m];
        }
    }
}

/* Makes A, symmetric and positive, its inverse. TO is scratch of the same size.
 */
static void invert(double *a, double *to, int n)
{
    cholesky(a, n);
    /* Rows of TO become those of U'^-1 from the top. */
    memset(to, 0, (size_t)n * (size_t)n * sizeof *to);
    for (int i = 0; i < n; i++) {
        double *row = to + (size_t)i * (size_t)n;

        for (int k = 0; k < i; k++) {
            const double share = a[k * n + i];
            const double *other = to + (size_t)k * (size_t)n;

            for (int m = 0; m <= k; m++)
                row[m] -= share * other[m];
        }
        row[i] = 1;
        for (int m = 0; m <= i; m++)
            row[m] /= a[i * n + i];
    }
    memset(a, 0, (size_t)n * (size_t)n * sizeof *a);
    for (int k = 0; k < n; k++) {
        const double *row = to + (size_t)k * (size_t)n;

        for (int i = 0; i <= k; i++)
            for (int m = 0; m <= i; m++)
                a[i * n + m] += row[i] * row[m];
    }
    for (int i = 0; i < n; i++)
        for (int k = 0; k < i; k++)
            a[k * n + i] = a[i * n + k];
}

static double *eliminated(const struct inverse *v, int j)
{
    const size_t n = (size_t)v->b->side;

    return v->eliminated + (size_t)j * n * n;
}

/* Sets S_j^-1 from the block above. */
static void eliminate(struct inverse *v, int j)
{
    const struct glint_blocks *b = v->b;
    const int n = b->side;
    const double *own = b->own + j * n, *right = b->right + j * n;
    double *s = eliminated(v, j);

    memset(s, 0, (size_t)n * (size_t)n * sizeof *s);
    if (j > 0) {
        const double *above = eliminated(v, j - 1), *e = b->down + (j - 1) * n;

        for (int i = 0; i < n; i++)
            for (int k = i; k < n; k++)
                s[i * n + k] = -e[i] * above[i * n + k] * e[k];
    }
    for (int i = 0; i < n; i++) {
        s[i * n + i] += own[i];
        if (i < n - 1)
            s[i * n + i + 1] -= right[i];
    }
    invert(s, v->scratch, n);
}

/* Sets T of row J and what of it counts. */
static void carry(struct inverse *v, int j)
{
    const int n = v->b->side;
    const double *s = eliminated(v, j), *e = v->b->down + j * n;
    double most = 0;

    for (int i = 0; i < n * n; i++) {
        v->t[i] = s[i] * e[i % n];
        most = fmax(most, v->t[i]);
    }
    for (int i = 0; i < n; i++) {
        const double *row = v->t + (size_t)i * (size_t)n;

        v->from[i] = 0;
        v->to[i] = n;
        while (v->from[i] < n - 1 && row[v->from[i]] < SMALL * most)
            v->from[i]++;
        while (v->to[i] > v->from[i] && row[v->to[i] - 1] < SMALL * most)
            v->to[i]--;
    }
}

/* TO += T G. */
static void multiply_add(const struct inverse *v, const double *g, double *to)
{
    const int n = v->b->side;

    for (int i = 0; i < n; i++) {
        double *sum = to + (size_t)i * (size_t)n;

        for (int k = v->from[i]; k < v->to[i]; k++) {
            const double share = v->t[i * n + k];
            const double *row = g + (size_t)k * (size_t)n;

            for (int m = 0; m < n; m++)
                sum[m] += share * row[m];
        }
    }
}

/* Sets the block that is free to G(j, j), S_j^-1 where nothing is below; G of
 * (J, J + 1) is BELOW. */
static void close_row(const struct inverse *v, int j, const double *below,
                      double *to)
{
    const int n = v->b->side;

    memcpy(to, eliminated(v, j), (size_t)n * (size_t)n * sizeof *to);
    if (!below)
        return;
    /* G(j + 1, j) is its transpose. */
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            v->scratch[i * n + k] = below[k * n + i];
    multiply_add(v, v->scratch, to);
}

/* Makes the ring that of row J from that of J + 1. */
static void climb(struct inverse *v, int j)
{
    const int below = v->b->side - 1 - j;
    const int kept = below < v->reach ? below : v->reach;
    const size_t block = (size_t)v->b->side * (size_t)v->b->side;
    double *free_block = v->ring[v->reach];

    carry(v, j);
    for (int i = 0; i < kept; i++) {
        double *to = v->scratch;

        memset(to, 0, block * sizeof *to);
        multiply_add(v, v->ring[i], to);
        v->scratch = v->ring[i];
        v->ring[i] = to;
    }
    memmove(v->ring + 1, v->ring, (size_t)v->reach * sizeof *v->ring);
    v->ring[0] = free_block;
    close_row(v, j, kept ? v->ring[1] : NULL, free_block);
}

static enum glint_status walk(struct inverse *v, int reach,
                              const struct glint_watch *watch,
                              glint_blocks_fn *take, void *ctx)
{
    const int n = v->b->side;
    /* A row of REACH + 1 blocks costs half of that eliminations, as measured.
     */
    const double first = 2.0 / (reach + 2.0);

    for (int j = 0; j < n; j++) {
        eliminate(v, j);
        if (glint_watch_ends(watch, first * (j + 1) / n))
            return GLINT_E_CLOSED;
    }
    for (int j = n - 1; j >= 0; j--) {
        const int done = n - j;

        climb(v, j);
        for (int l = j; l < n && l <= j + reach; l++)
            take(ctx, j, l, v->ring[l - j]);
        if (glint_watch_ends(watch, first + (1.0 - first) * done / n))
            return GLINT_E_CLOSED;
    }
    return GLINT_OK;
}

enum glint_status glint_blocks_inverse(const struct glint_blocks *blocks,
                                       int reach,
                                       const struct glint_watch *watch,
                                       glint_blocks_fn *take, void *ctx)
{
    const size_t n = (size_t)blocks->side, block = n * n;
    struct inverse v = {.b = blocks, .reach = reach > 0 ? reach : 1};
    const size_t in_ring = (size_t)v.reach + 1;
    double *memory = malloc((n + 2 + in_ring) * block * sizeof *memory);
    enum glint_status status = GLINT_E_MEMORY;

    v.ring = malloc(in_ring * sizeof *v.ring);
    v.from = malloc(2 * n * sizeof *v.from);
    if (memory && v.ring && v.from) {
        v.to = v.from + n;
        v.eliminated = memory;
        v.t = memory + n * block;
        v.scratch = v.t + block;
        for (size_t i = 0; i < in_ring; i++)
            v.ring[i] = v.scratch + (i + 1) * block;
        status = walk(&v, reach, watch, take, ctx);
    }
    free(memory);
    free(v.ring);
    free(v.from);
    return status;
}
