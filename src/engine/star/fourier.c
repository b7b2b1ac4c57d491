/* SPDX-License-Identifier: MIT
 *
 * Computes the fast Fourier transform of a square array, radix 2 [Cooley65]. */
#include <math.h>
#include <stdlib.h>

#include "engine/star/smear.h"
#include "glint/view.h"

static void swap_complex(double a[2], double b[2])
{
    for (int k = 0; k < 2; k++) {
        const double t = a[k];

        a[k] = b[k];
        b[k] = t;
    }
}

/* Permutes N numbers: moves each number to the index with the reversed order of
 * bits. */
static void permute_bit_reversed(double (*at)[2], int n)
{
    for (int i = 1, j = 0; i < n; i++) {
        int bit = n >> 1;

        for (; j & bit; bit >>= 1)
            j ^= bit;
        j |= bit;
        if (i < j)
            swap_complex(at[i], at[j]);
    }
}

/* Transforms a row of N numbers in place. ROOT: the first N / 2 of the N roots
 * of unity. */
static void fourier_transform_row(double (*at)[2], int n,
                                  const double (*root)[2])
{
    permute_bit_reversed(at, n);
    for (int half = 1; half < n; half *= 2)
        for (int first = 0; first < n; first += 2 * half)
            for (int k = 0; k < half; k++) {
                const double *w = root[k * (n / (2 * half))];
                double *a = at[first + k], *b = at[first + k + half];
                const double re = b[0] * w[0] - b[1] * w[1];
                const double im = b[0] * w[1] + b[1] * w[0];

                b[0] = a[0] - re;
                b[1] = a[1] - im;
                a[0] += re;
                a[1] += im;
            }
}

typedef double complex_number[2]; /* real, imaginary */

enum glint_status glint_fourier_transform_2d(double (*at)[2], int n, int used)
{
    /* number of columns that are transformed together; neighbouring columns lie
     * in the same cache lines */
    enum { ABREAST = 8 };
    complex_number *const root = malloc((size_t)n * sizeof *root);
    complex_number *const column = malloc((size_t)n * ABREAST * sizeof *column);
    const enum glint_status status = root && column ? GLINT_OK : GLINT_E_MEMORY;

    for (int i = 0; i < n && root; i++) {
        root[i][0] = cos(2 * GLINT_PI * i / n);
        root[i][1] = -sin(2 * GLINT_PI * i / n);
    }
    for (int i = 0; i < used && root && column; i++)
        fourier_transform_row(at + (size_t)i * (size_t)n, n,
                              (const double(*)[2])root);
    for (int x = 0; x < n && root && column; x += ABREAST) {
        for (int y = 0; y < n; y++)
            for (int k = 0; k < ABREAST; k++)
                for (int c = 0; c < 2; c++)
                    column[k * n + y][c] =
                        at[(size_t)y * (size_t)n + (size_t)(x + k)][c];
        for (int k = 0; k < ABREAST; k++)
            fourier_transform_row(column + k * n, n, (const double(*)[2])root);
        for (int y = 0; y < n; y++)
            for (int k = 0; k < ABREAST; k++)
                for (int c = 0; c < 2; c++)
                    at[(size_t)y * (size_t)n + (size_t)(x + k)][c] =
                        column[k * n + y][c];
    }
    free(column);
    free(root);
    return status;
}
