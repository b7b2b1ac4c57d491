/* SPDX-License-Identifier: MIT
 *
 * Published models of scattering, each as the rows that it makes of rows.
 *
 * Entries outside the square are data as any other for all of them but the
 * profiles of [Song09], as published: they are 0. What a model makes of them is
 * dropped. */
#ifndef REFERENCE_SCATTER_REBUILD_H
#define REFERENCE_SCATTER_REBUILD_H

#include "bake/translucent/rows.h"
#include "reference/scatter/translucent_report.h"

/* Sets REBUILT, which is open and 0, to what a model of O makes of ROWS.
 * GLINT_E_MEMORY, GLINT_E_CLOSED. */
typedef enum glint_status glint_rebuild_fn(
    const struct glint_scatter_rows *rows, struct glint_scatter_candidate *o,
    const struct glint_watch *watch, struct glint_scatter_rows *rebuilt);

glint_rebuild_fn glint_rebuild_svd, glint_rebuild_log_svd, glint_rebuild_tucker,
    glint_rebuild_als, glint_rebuild_peers, glint_rebuild_subedit;

/* The largest entry. */
double glint_scatter_peak(const struct glint_scatter_rows *rows);

/* Sets channel C of the row of texel X of REBUILT, 0 outside the square. */
void glint_rebuilt_row(const struct glint_scatter_rows *rebuilt, int x, int c,
                       const double *row);

/* Sets F[n] and H[k2] to the Tucker(1, 1) fit of LEFT[n][k2] and takes it off;
 * returns the square of its singular value. */
double glint_tucker_term(float *left, int n, int k2, double *f, double *h);

/* Non-negative F[terms][n] and H[terms][m] of V, n rows of m, by alternating
 * least squares, one term after the other and clamped to 0 [Cichocki09]; ROUNDS
 * of them, of which none raises the weighted error. */
struct glint_positive {
    int n, m, terms;
    void (*row)(const void *ctx, int i, double *value, double *weight);
    const void *ctx;
    double *f, *h;
};
enum glint_status glint_positive_fit(const struct glint_positive *p, int rounds,
                                     const struct glint_watch *watch);

#endif
