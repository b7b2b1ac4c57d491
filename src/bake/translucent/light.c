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

/* Weight of kernel J in the row of texel X. */
static double weight_of(const struct glint_scatter_fit *fit, int j, int c,
                        int x)
{
    if (fit->model == GLINT_SCATTER_FACTORED)
        return fit->f[(size_t)(j * 3 + c) * (size_t)(fit->side * fit->side) +
                      (size_t)x];
    if (fit->model == GLINT_SCATTER_CLUSTERED && fit->cluster[x] != j)
        return 0;
    return fit->in[3 * x + c];
}

double glint_scatter_entry(const struct glint_scatter_fit *fit, int x, int c,
                           int d)
{
    const int to = glint_scatter_target(fit->side, fit->kernel, x, d);
    double sum = 0;

    if (to < 0)
        return 0;
    for (int j = 0; j < fit->kernels; j++)
        sum += weight_of(fit, j, c, x) * kernel_of(fit, j, c)[d];
    return fit->out ? sum * fit->out[3 * to + c] : sum;
}

/* Adds to TO what light POWER on texel X makes by kernel H. */
static void spread(const struct glint_scatter_fit *fit, int x, const double *h,
                   double power, int c, double *to)
{
    const int side = fit->side, n = fit->kernel, half = n / 2;
    const struct glint_scatter_inside in = glint_scatter_inside(side, n, x);

    for (int v = in.v_from; v < in.v_to; v++)
        for (int u = in.u_from; u < in.u_to; u++)
            to[3 * (x + (v - half) * side + u - half) + c] +=
                power * h[v * n + u];
}

void glint_scatter_light(const struct glint_scatter_fit *fit,
                         const double *irradiance, double *radiosity)
{
    const int texels = fit->side * fit->side;

    memset(radiosity, 0, 3 * (size_t)texels * sizeof *radiosity);
    for (int x = 0; x < texels; x++)
        for (int c = 0; c < 3; c++)
            for (int j = 0; j < fit->kernels; j++) {
                const double weight = weight_of(fit, j, c, x);

                if (weight != 0 && irradiance[3 * x + c] != 0)
                    spread(fit, x, kernel_of(fit, j, c),
                           weight * irradiance[3 * x + c], c, radiosity);
            }
    for (int x = 0; fit->out && x < texels; x++)
        for (int c = 0; c < 3; c++)
            radiosity[3 * x + c] *= fit->out[3 * x + c];
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
        const double u = (x % side + 0.5) / side, v = (x / side + 0.5) / side;
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
