/* SPDX-License-Identifier: MIT
 *
 * Products and sums of columns of N doubles, by vectors of four of them; each
 * has the same bits on every CPU. */
#ifndef GLINT_BAKE_REGRESS_VECTORS_H
#define GLINT_BAKE_REGRESS_VECTORS_H

enum { GLINT_VECTORS = 4 }; /* columns that are multiplied by another at once */

/* Returns the dot product of A and B. */
double glint_vector_dot(const double *a, const double *b, int n);

/* Sets SUM to the dot products of A and four columns, each with the bits of
 * glint_vector_dot(). */
void glint_vector_dots(const double *a, const double *const b[GLINT_VECTORS],
                       int n, double sum[GLINT_VECTORS]);

/* Subtracts K times B from A. */
void glint_vector_subtract(double *restrict a, double k,
                           const double *restrict b, int n);

/* Multiplies A by X, POWER times. */
void glint_vector_multiply(double *restrict a, const double *restrict x,
                           int power, int n);

/* Returns the largest magnitude of A. */
double glint_vector_largest(const double *a, int n);

#endif
