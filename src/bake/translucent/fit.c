/* SPDX-License-Identifier: MIT
 *
 * Fits models to the rows of a scattering matrix and measures their errors.
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

/* Returns kernel J of channel C, [kernel][kernel]. */
static const double *get_fit_kernel(const struct glint_scatter_fit *fit, int j,
                                    int c)
{
    return fit->h + (size_t)(j * 3 + c) *
                        (size_t)glint_scatter_count_entries(fit->kernel);
}

/* Returns the factor of kernel J for light that leaves texel X in channel C. */
static double get_leaving_factor(const struct glint_scatter_fit *fit, int j,
                                 int c, int x)
{
    if (fit->model == GLINT_SCATTER_FACTORED && fit->f)
        return fit->f[(size_t)(j * 3 + c) * (size_t)(fit->side * fit->side) +
                      (size_t)x];
    if (fit->model == GLINT_SCATTER_CLUSTERED && fit->cluster[x] != j)
        return 0;
    return fit->out ? fit->out[3 * x + c] : 0;
}

double glint_scatter_entry(const struct glint_scatter_fit *fit, int x, int c,
                           int d)
{
    const int to = glint_scatter_get_target_texel(fit->side, fit->kernel, x, d);
    double sum = 0;

    if (to < 0)
        return 0;
    for (int j = 0; j < fit->kernels; j++)
        sum += get_leaving_factor(fit, j, c, to) * get_fit_kernel(fit, j, c)[d];
    return fit->in ? sum * fit->in[3 * x + c] : sum;
}

/* Returns the light of channel C that leaves texel X if LIGHT enters and kernel
 * H spreads it. Entries of H are offsets from the source of the light. */
static double gather_light_by_kernel(const struct glint_scatter_fit *fit, int x,
                                     const double *h, const double *light,
                                     int c)
{
    const int side = fit->side, n = fit->kernel, half = n / 2;
    const struct glint_scatter_inside in =
        glint_scatter_find_offsets_inside(side, n, x);
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
                const double weight = get_leaving_factor(fit, j, c, x);

                if (weight != 0)
                    sum += weight * gather_light_by_kernel(
                                        fit, x, get_fit_kernel(fit, j, c),
                                        irradiance, c);
            }
            radiosity[3 * x + c] = sum;
        }
}

/* Sets IRRADIANCE to a test illumination of SIDE x SIDE texels: a ramp, the
 * edge of a shadow across it, and three lamps, small and large. */
void glint_scatter_test_light(int side, double *irradiance)
{
    /* position x, y and radius, fractions of the side; light */
    static const double lamp[3][4] = {
        {0.3, 0.35, 0.03, 4}, {0.7, 0.25, 0.12, 1.5}, {0.55, 0.75, 0.008, 8}};
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

#define NO_ERROR_DB 999.0

enum { RIM_ROUNDS = 12 };

void glint_scatter_defaults(struct glint_scatter_options *options,
                            enum glint_scatter_model model)
{
    *options = (struct glint_scatter_options){
        .model = model,
        .kernels = model == GLINT_SCATTER_CLUSTERED  ? 4
                   : model == GLINT_SCATTER_FACTORED ? 5
                                                     : 1,
        .rank = model == GLINT_SCATTER_FACTORED ? 3 : 1,
    };
}

/* Sets ALBEDO to the sum of each row, per texel and channel. */
static void compute_row_albedo(const struct glint_scatter_rows *rows,
                               double *albedo)
{
    const int k2 = glint_scatter_count_entries(rows->kernel);

    for (int x = 0; x < rows->side * rows->side; x++)
        for (int c = 0; c < 3; c++) {
            const float *row = glint_scatter_get_row(rows, x, c);
            double sum = 0;

            for (int d = 0; d < k2; d++)
                sum += (double)row[d];
            albedo[3 * x + c] = sum;
        }
}

/* Returns the light that leaves texel X in channel C under uniform irradiance
 * 1. */
static double compute_uniform_response(const struct glint_scatter_fit *fit,
                                       int x, int c)
{
    const int n = fit->kernel;
    const struct glint_scatter_inside in =
        glint_scatter_find_offsets_inside(fit->side, n, x);
    double sum = 0;

    for (int v = in.v_from; v < in.v_to; v++)
        for (int u = in.u_from; u < in.u_to; u++) {
            const int d = v * n + u;

            sum += glint_scatter_entry(
                fit, glint_scatter_get_target_texel(fit->side, n, x, d), c,
                n * n - 1 - d);
        }
    return sum;
}

/* Scales the light that leaves each texel such that it equals the albedo of the
 * data under uniform irradiance 1. */
static void scale_fit_to_albedo(struct glint_scatter_fit *fit)
{
    const int texels = fit->side * fit->side;

    for (int x = 0; x < texels; x++)
        for (int c = 0; c < 3; c++) {
            const double sum = compute_uniform_response(fit, x, c);
            const double want = fit->albedo[3 * x + c];
            /* A texel that is almost black in the fit stays unscaled, as its
             * factor would be huge. */
            const double scale = sum > 0.1 * want && want > 0 ? want / sum : 1;

            for (int j = 0; fit->f && j < fit->kernels; j++)
                fit->f[(size_t)(j * 3 + c) * (size_t)texels + (size_t)x] *=
                    scale;
            if (fit->out)
                fit->out[3 * x + c] *= scale;
        }
}

static void reverse_array(double *a, int n)
{
    for (int i = 0; i < n / 2; i++) {
        const double x = a[i];

        a[i] = a[n - 1 - i];
        a[n - 1 - i] = x;
    }
}

/* Mirrors all kernels: offsets to the source of light become offsets to its
 * destination. */
static void mirror_kernels(struct glint_scatter_fit *fit)
{
    const int n = fit->kernel;

    for (int i = 0; i < 3 * fit->kernels; i++)
        reverse_array(fit->h + (size_t)i * (size_t)(n * n), n * n);
    for (int i = 0; fit->row && i < 3 * fit->kernels * fit->rank; i++) {
        reverse_array(fit->column + (size_t)i * (size_t)n, n);
        reverse_array(fit->row + (size_t)i * (size_t)n, n);
    }
}

/* Returns the sum of the entries of kernel H, centred at texel X, that lie
 * inside the map. */
static double sum_kernel_inside_map(const struct glint_scatter_fit *fit, int x,
                                    const double *h)
{
    const int n = fit->kernel;
    const struct glint_scatter_inside in =
        glint_scatter_find_offsets_inside(fit->side, n, x);
    double sum = 0;

    for (int v = in.v_from; v < in.v_to; v++)
        for (int u = in.u_from; u < in.u_to; u++)
            sum += h[v * n + u];
    return sum;
}

/* Sets H to the mean of all rows of channel C, weighted by the out factors and
 * scaled to the sum 1. SQUARE: scratch of the same size. */
static void compute_mean_kernel(const struct glint_scatter_rows *rows,
                                const struct glint_scatter_fit *fit, int c,
                                double *h, double *square)
{
    const int side = fit->side, n = fit->kernel, k2 = n * n;
    double sum = 0;

    memset(h, 0, (size_t)k2 * sizeof *h);
    memset(square, 0, (size_t)k2 * sizeof *square);
    for (int x = 0; x < side * side; x++) {
        const struct glint_scatter_inside in =
            glint_scatter_find_offsets_inside(side, n, x);
        const float *row = glint_scatter_get_row(rows, x, c);
        const double a = fit->out[3 * x + c];

        for (int v = in.v_from; v < in.v_to; v++)
            for (int d = v * n + in.u_from; d < v * n + in.u_to; d++) {
                h[d] += a * (double)row[d];
                square[d] += a * a;
            }
    }
    for (int d = 0; d < k2; d++) {
        h[d] = square[d] > 0 ? h[d] / square[d] : 0;
        sum += h[d];
    }
    for (int d = 0; d < k2 && sum > 0; d++)
        h[d] /= sum;
}

/* Fits one kernel, and an albedo per texel. Rows at the rim are incomplete, as
 * they lie partly outside the map. The kernel gives the complete sums of these
 * rows, and the sums give a better kernel, so both are iterated. */
static enum glint_status fit_albedo_model(const struct glint_scatter_rows *rows,
                                          struct glint_scatter_fit *fit)
{
    const int n = 3 * fit->side * fit->side;
    const size_t k2 = (size_t)glint_scatter_count_entries(fit->kernel);
    double *square = malloc(k2 * sizeof *square);

    fit->h = calloc(3 * k2, sizeof *fit->h);
    fit->out = calloc((size_t)n, sizeof *fit->out);
    if (!square || !fit->h || !fit->out) {
        free(square);
        return GLINT_E_MEMORY;
    }
    memcpy(fit->out, fit->albedo, (size_t)n * sizeof *fit->out);
    for (int i = 0; i < RIM_ROUNDS; i++) {
        for (int c = 0; c < 3; c++)
            compute_mean_kernel(rows, fit, c, fit->h + (size_t)c * k2, square);
        for (int x = 0; x < n; x++) {
            const double share = sum_kernel_inside_map(
                fit, x / 3, fit->h + (size_t)(x % 3) * k2);

            fit->out[x] = share > 0 ? fit->albedo[x] / share : 0;
        }
    }
    free(square);
    return GLINT_OK;
}

static double compute_psnr_db(double square, double peak)
{
    return square > 0 && peak > 0 ? 10 * log10(peak * peak / square)
                                  : NO_ERROR_DB;
}

static void measure_entry_errors(const struct glint_scatter_rows *rows,
                                 struct glint_scatter_fit *fit)
{
    const int k2 = glint_scatter_count_entries(fit->kernel);
    double square = 0, peak = 0;

    for (int x = 0; x < fit->side * fit->side; x++)
        for (int c = 0; c < 3; c++) {
            const float *row = glint_scatter_get_row(rows, x, c);
            double sum = 0;

            for (int d = 0; d < k2; d++) {
                const double e =
                    glint_scatter_entry(fit, x, c, d) - (double)row[d];

                square += e * e;
                sum += e;
                peak = fmax(peak, (double)row[d]);
            }
            fit->error.albedo = fmax(fit->error.albedo, fabs(sum));
        }
    square /= 3.0 * fit->side * fit->side * k2;
    fit->error.rmse = peak > 0 ? sqrt(square) / peak : 0;
    fit->error.entry_db = compute_psnr_db(square, peak);
}

static enum glint_status
measure_fit_errors(const struct glint_scatter_rows *rows,
                   struct glint_scatter_fit *fit)
{
    const int n = 3 * fit->side * fit->side;
    double *light = malloc(3 * (size_t)n * sizeof *light);
    double *want, *got, square = 0, peak = 0;

    if (!light)
        return GLINT_E_MEMORY;
    want = light + n;
    got = want + n;
    measure_entry_errors(rows, fit);
    glint_scatter_test_light(fit->side, light);
    glint_scatter_light_rows(rows, light, want);
    glint_scatter_light(fit, light, got);
    for (int i = 0; i < n; i++) {
        square += (got[i] - want[i]) * (got[i] - want[i]) / n;
        peak = fmax(peak, want[i]);
    }
    fit->error.light_db = compute_psnr_db(square, peak);
    free(light);
    return GLINT_OK;
}

static bool are_options_in_range(const struct glint_scatter_options *o)
{
    return o->kernels >= 1 && o->kernels <= GLINT_SCATTER_MAX_TERMS &&
           o->rank >= 1 && o->rank <= GLINT_SCATTER_MAX_RANK &&
           (o->model == GLINT_SCATTER_CLUSTERED ||
            o->model == GLINT_SCATTER_FACTORED ||
            (o->model == GLINT_SCATTER_ALBEDO && o->kernels == 1));
}

static enum glint_status fit_chosen_model(const struct glint_scatter_rows *rows,
                                          const struct glint_watch *watch,
                                          struct glint_scatter_fit *fit)
{
    switch (fit->model) {
    case GLINT_SCATTER_CLUSTERED:
        return glint_scatter_fit_clusters(rows, watch, fit);
    case GLINT_SCATTER_FACTORED:
        return glint_scatter_fit_factors(rows, watch, fit);
    case GLINT_SCATTER_ALBEDO:
    default:
        return fit_albedo_model(rows, fit);
    }
}

enum glint_status glint_scatter_fit(struct glint_scatter_rows *rows,
                                    const struct glint_scatter_options *options,
                                    const struct glint_watch *watch,
                                    struct glint_scatter_fit *fit)
{
    const size_t texels = (size_t)rows->side * (size_t)rows->side;
    enum glint_status status;

    memset(fit, 0, sizeof *fit);
    if (!are_options_in_range(options))
        return GLINT_E_ARGUMENT;
    fit->model = options->model;
    fit->side = rows->side;
    fit->kernel = rows->kernel;
    fit->kernels = options->kernels;
    fit->rank = options->rank;
    fit->albedo = calloc(3 * texels, sizeof *fit->albedo);
    status = fit->albedo ? GLINT_OK : GLINT_E_MEMORY;
    if (status == GLINT_OK) {
        /* The fit minimises errors of transposed rows, each of which has the
         * light that leaves one texel: there errors are visible. */
        glint_scatter_transpose_rows(rows);
        compute_row_albedo(rows, fit->albedo);
        status = fit_chosen_model(rows, watch, fit);
        glint_scatter_transpose_rows(rows);
    }
    if (status == GLINT_OK) {
        mirror_kernels(fit);
        scale_fit_to_albedo(fit);
        status = measure_fit_errors(rows, fit);
    }
    if (status != GLINT_OK)
        glint_scatter_fit_close(fit);
    return status;
}
