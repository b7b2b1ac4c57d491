/* SPDX-License-Identifier: MIT
 *
 * Published models of subsurface scattering. Each function fits a model to the
 * rows of a scattering matrix and rebuilds the rows from it.
 *
 * Row entries whose texels lie outside the square of the medium are 0. As in
 * the publications, all models fit these zeros, too, except the profiles of
 * [Song09]. In rebuilt rows such entries are set to 0.
 */
#ifndef REFERENCE_SCATTER_REBUILD_H
#define REFERENCE_SCATTER_REBUILD_H

#include "bake/translucent/rows.h"
#include "reference/scatter/translucent_report.h"

/* Fits the model with the parameters O to ROWS. Sets REBUILT, which the caller
 * has opened and cleared, to the rows of the model. May return GLINT_E_MEMORY
 * or GLINT_E_CLOSED. */
typedef enum glint_status glint_rebuild_fn(
    const struct glint_scatter_rows *rows, struct glint_scatter_candidate *o,
    const struct glint_watch *watch, struct glint_scatter_rows *rebuilt);

glint_rebuild_fn glint_rebuild_svd, glint_rebuild_svd_of_logarithms,
    glint_rebuild_tucker_terms, glint_rebuild_nonnegative_factors,
    glint_rebuild_cluster_factors, glint_rebuild_radial_profiles;

/* Returns the largest entry of ROWS. */
double glint_scatter_largest_entry(const struct glint_scatter_rows *rows);

/* Stores ROW as channel C of the row of texel X in REBUILT; entries outside the
 * square become 0. */
void glint_store_rebuilt_row(const struct glint_scatter_rows *rebuilt, int x,
                             int c, const double *row);

/* Fits one rank-1 term, weights F[n] times kernel H[k2], to the matrix
 * LEFT[n][k2], and subtracts the term from LEFT. Returns the square of its
 * singular value. */
double glint_fit_tucker_term(float *left, int n, int k2, double *f, double *h);

/* Factorises V, n rows of m entries, into non-negative F[terms][n] and
 * H[terms][m]. Fits them by alternating least squares, one term after the
 * other, clamped to 0 [Cichocki09]. No round increases the weighted error. */
struct glint_positive {
    int n, m, terms;
    void (*row)(const void *ctx, int i, double *value, double *weight);
    const void *ctx;
    double *f, *h;
};
enum glint_status
glint_fit_nonnegative_factors(const struct glint_positive *p, int rounds,
                              const struct glint_watch *watch);

#endif
