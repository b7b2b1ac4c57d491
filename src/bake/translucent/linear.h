/* SPDX-License-Identifier: MIT
 *
 * Linear algebra of the fits, in double precision: the leading terms of a
 * singular value decomposition of a tall matrix, all of a small one, small
 * symmetric systems.
 *
 * Method: subspace iteration on the Gram matrix of the columns finds the space;
 * the rows projected on it are decomposed by one-sided Jacobi rotations, which
 * lose nothing to squares [Golub13]. */
#ifndef GLINT_BAKE_TRANSLUCENT_LINEAR_H
#define GLINT_BAKE_TRANSLUCENT_LINEAR_H

#include <stdbool.h>

#include "glint/status.h"

/* A tall matrix whose rows are computed one at a time. */
struct glint_tall {
    int rows, columns;
    void (*row)(const void *ctx, int i, double *to); /* sets TO[columns] */
    const void *ctx;
};

/* A = sum over j of value[j] left_j right_j'. */
struct glint_terms {
    int n;         /* values in falling order; a value of 0 has zero vectors */
    double *value; /* [n] */
    double *left;  /* [n][rows] unit vectors */
    double *right; /* [n][columns] unit vectors */
};

/* Sets TERMS, N of them at most, as many as A has columns. Owned. Returns false
 * without memory. Takes 8 columns^2 + 8 rows (N + 8) bytes. */
bool glint_terms_of(const struct glint_tall *a, int n,
                    struct glint_terms *terms);
void glint_terms_close(struct glint_terms *terms);

/* Rotates N columns of A, [n][rows], until they are orthogonal, and sorts them
 * by falling length. The same rotations are applied to TURN[n][m] unless it is
 * NULL. */
void glint_jacobi(double *a, int rows, int n, double *turn, int m);

/* Solves the symmetric system A[n][n] X = B[n], X overwrites B; components that
 * A does not determine become 0. Changes A. */
void glint_solve(double *a, int n, double *b);

/* A kernel as a sum of products of a column and a row that minimises the
 * difference of the resulting light. Light on a surface changes slowly, so that
 * errors of entries beside each other add up: rows and columns are weighted by
 * how light is correlated, and the products are the largest singular values of
 * that. */
struct glint_separated {
    double *column, *row; /* [rank][n]; product r is column[r][v] row[r][u] */
    double all, lost;     /* sum of squares of all weighted entries, and of the
                             residual of the products */
};

/* Sets TO to RANK products for KERNEL[N][N], N at most
 * GLINT_SCATTER_MAX_KERNEL; entries from N on are 0. */
void glint_separate(const double *kernel, int n, int rank,
                    struct glint_separated *to);

#endif
