/* SPDX-License-Identifier: MIT
 *
 * A kernel as a sum of products of a column and a row, so that what both make
 * of light differs least. Light on a surface changes slowly, so that errors of
 * entries beside each other add up: rows and columns are weighted by how light
 * is correlated, and the products are the largest singular values of that, by
 * rotations of pairs of columns (one-sided Jacobi). */
#ifndef GLINT_BAKE_TRANSLUCENT_SEPARATE_H
#define GLINT_BAKE_TRANSLUCENT_SEPARATE_H

struct glint_separated {
    double *column, *row; /* [rank][n]; product r is column[r][v] row[r][u] */
    double all, lost;     /* squares of all weighted entries, and of what the
                             products leave out, summed */
};

/* Sets TO to RANK products for KERNEL[N][N], N at most
 * GLINT_SCATTER_MAX_KERNEL; those beyond N are 0. */
void glint_separate(const double *kernel, int n, int rank,
                    struct glint_separated *to);

#endif
