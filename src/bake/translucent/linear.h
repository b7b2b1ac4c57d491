/* SPDX-License-Identifier: MIT
 *
 * Linear algebra in double precision for fits of scattering matrices: leading
 * terms of the singular value decomposition of a tall matrix, the complete
 * decomposition of a small one, and small symmetric systems.
 *
 * Method: subspace iteration on the Gram matrix of the columns finds the space
 * of the leading terms. The rows projected on it are decomposed by one-sided
 * Jacobi rotations, which avoid the loss of digits by squaring [Golub13].
 */
#ifndef GLINT_BAKE_TRANSLUCENT_LINEAR_H
#define GLINT_BAKE_TRANSLUCENT_LINEAR_H

#include <stdbool.h>

#include "glint/status.h"

/* a tall matrix whose rows are computed one at a time */
struct glint_tall {
    int rows, columns;
    /* sets TO[columns] to row I */
    void (*row)(const void *ctx, int i, double *to);
    const void *ctx;
};

/* The leading terms of a matrix A = sum over j of value[j] left_j right_j'. */
struct glint_terms {
    /* number of terms, by descending value; the vectors of a value 0 are 0 */
    int n;
    double *value; /* [n] */
    double *left;  /* left vectors, [n][rows], unit length */
    double *right; /* right vectors, [n][columns], unit length */
};

/* Computes the leading terms of A: at most N and at most as many as A has
 * columns. The caller frees TERMS by glint_terms_free(). Returns false if
 * there is no memory. Needs 8 columns^2 + 8 rows (N + 8) bytes. */
bool glint_compute_leading_terms(const struct glint_tall *a, int n,
                                 struct glint_terms *terms);
void glint_terms_free(struct glint_terms *terms);

/* Rotates the N columns A[n][rows] until they are orthogonal and sorts them by
 * descending length. Applies the same rotations to TURN[n][m] unless it is
 * NULL. */
void glint_jacobi_orthogonalise(double *a, int rows, int n, double *turn,
                                int m);

/* Solves the symmetric system A[n][n] X = B[n]; X overwrites B. Components that
 * A does not determine become 0. Overwrites A. */
void glint_solve_symmetric_system(double *a, int n, double *b);

/* A kernel as a sum of products of a column and a row, chosen for the smallest
 * error of the scattered light. As light on a surface varies slowly, errors of
 * neighbouring entries add up. So rows and columns of the kernel are weighted
 * by the correlation of light. The products are the terms with the largest
 * singular values of the weighted kernel. */
struct glint_separated {
    /* factors of the products, [rank][n]; product r at (u, v) is column[r][v] *
     * row[r][u] */
    double *column, *row;
    /* all: sum of squares of the weighted entries; lost: that of their
     * residuals */
    double all, lost;
};

/* Separates KERNEL[N][N], N at most GLINT_SCATTER_MAX_KERNEL, into RANK
 * products. If RANK exceeds N, the products beyond N are 0. */
void glint_separate_kernel(const double *kernel, int n, int rank,
                           struct glint_separated *to);

#endif
