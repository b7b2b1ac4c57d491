/* SPDX-License-Identifier: MIT
 *
 * Fits in use: their entries, and what they make of light.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/translucent/rows.h"

void glint_scatter_fit_close(struct glint_scatter_fit *fit)
{
    free(fit->h);
    free(fit->column);
    free(fit->row);
    free(fit->f);
    free(fit->in);
    free(fit->out);
    free(fit->albedo);
    free(fit->cluster);
    memset(fit, 0, sizeof *fit);
}

/* Kernel J of channel C: [kernel * kernel]. */
static const double *kernel_of(const struct glint_scatter_fit *fit, int j,
                               int c)
{
    return fit->h +
           (size_t)(j * 3 + c) * (size_t)glint_scatter_kernel2(fit->kernel);
}

/* Weight of kernel J in what leaves texel X. */
static double weight_of(const struct glint_scatter_fit *fit, int j, int c,
                        int x)
{
    if (fit->model == GLINT_SCATTER_FACTORED)
        return fit->f[(size_t)(j * 3 + c) * (size_t)(fit->side * fit->side) +
                      (size_t)x];
    if (fit->model == GLINT_SCATTER_CLUSTERED && fit->cluster[x] != j)
        return 0;
    return fit->out[3 * x + c];
}

double glint_scatter_entry(const struct glint_scatter_fit *fit, int x, int c,
                           int d)
{
    const int to = glint_scatter_target(fit->side, fit->kernel, x, d);
    double sum = 0;

    if (to < 0)
        return 0;
    for (int j = 0; j < fit->kernels; j++)
        sum += weight_of(fit, j, c, to) * kernel_of(fit, j, c)[d];
    return fit->in ? sum * fit->in[3 * x + c] : sum;
}

/* Sum of kernel H, whose offsets lead to texel X, with channel C of LIGHT. */
static double gather(const struct glint_scatter_fit *fit, int x,
                     const double *h, const double *light, int c)
{
    const int side = fit->side, n = fit->kernel, half = n / 2;
    const struct glint_scatter_inside in = glint_scatter_inside(side, n, x);
    double sum = 0;

    for (int v = in.v_from; v < in.v_to; v++)
        for (int u = in.u_from; u < in.u_to; u++) {
            const int from = x + (v - half) * side + u - half;
            const double e = light[3 * from + c];

            sum += h[n * n - 1 - (v * n + u)] *
                   (fit->in ? e * fit->in[3 * from + c] : e);
        }
    return sum;
}

void glint_scatter_light(const struct glint_scatter_fit *fit,
                         const double *irradiance, double *radiosity)
{
    for (int x = 0; x < fit->side * fit->side; x++)
        for (int c = 0; c < 3; c++) {
            double sum = 0;

            for (int j = 0; j < fit->kernels; j++) {
                const double weight = weight_of(fit, j, c, x);

                if (weight != 0)
                    sum += weight *
                           gather(fit, x, kernel_of(fit, j, c), irradiance, c);
            }
            radiosity[3 * x + c] = sum;
        }
}

/* A ramp with a shadow's edge across it, and three lamps: sharp and wide. */
void glint_scatter_test_light(int side, double *irradiance)
{
    static const double lamp[3][4] = {/* place, radius, light */
                                      {0.3, 0.35, 0.03, 4},
                                      {0.7, 0.25, 0.12, 1.5},
                                      {0.55, 0.75, 0.008, 8}};
    static const double colour[3][3] = {
        {1, 0.8, 0.6}, {0.7, 0.9, 1}, {1, 1, 1}};

    for (int x = 0; x < side * side; x++) {
        const int row = x / side;
        const double u = (x % side + 0.5) / side, v = (row + 0.5) / side;
        const double ramp = u + 0.5 * v > 0.8 ? 0.25 + 0.5 * v : 0.02;

        for (int c = 0; c < 3; c++)
            irradiance[3 * x + c] = ramp;
        for (int i = 0; i < 3; i++) {
            const double far = hypot(u - lamp[i][0], v - lamp[i][1]);

            for (int c = 0; c < 3 && far < lamp[i][2]; c++)
                irradiance[3 * x + c] += lamp[i][3] * colour[i][c];
        }
    }
}
