/* SPDX-License-Identifier: MIT
 *
 * Fits the rows of a scattering matrix by a few kernels. The row of texel x has
 * the light that enters at each texel near x and leaves at x. Its entry for
 * texel y is modelled as out(x) kernel(y - x) in(y), with the kernel of the
 * cluster that contains x.
 *
 * Alternating least squares updates kernels, in factors and out factors in
 * turn. Then each texel is assigned to the kernel with the smallest residual of
 * its row. Initial clusters follow the fraction of material 0 around a texel,
 * or, for measured rows, the amount of light that a row scatters. Random
 * initial clusters would separate the rim from the interior.
 */
#include "bake/translucent/rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    /* number of rounds; further rounds reduce errors by less than 1 % */
    ROUNDS = 8,
    /* radius, texels, of the neighbourhood over which the fraction of material
     * 0 is averaged */
    ABOUT = 2
};

struct clusters {
    const struct glint_scatter_rows *rows;
    struct glint_scatter_fit *fit;
    /* numerators (above) and denominators (below) of the least-squares
     * solutions, one per texel or per kernel entry */
    double *above, *below;
};

/* One line of the row of texel X, which has kernel x kernel entries: those from
 * u_from to u_to - 1, which lie inside the map. */
struct span {
    int x, c, u_from, u_to;
    const float *data;
    /* kernel: entries of the kernel's line. in: in factors, 3 doubles apart, of
     * the texels that correspond to the entries, from u_from on. */
    double *kernel, *in;
};

static double *get_cluster_kernel(const struct glint_scatter_fit *fit, int j,
                                  int c)
{
    return fit->h + (size_t)(j * 3 + c) *
                        (size_t)glint_scatter_count_entries(fit->kernel);
}

/* Returns line V of the row of texel X, with kernel J. */
static struct span get_line_of_row(const struct clusters *p,
                                   const struct glint_scatter_inside *in, int x,
                                   int c, int j, int v)
{
    const int n = p->fit->kernel, side = p->fit->side;

    return (struct span){
        .x = x,
        .c = c,
        .u_from = in->u_from,
        .u_to = in->u_to,
        .data = glint_scatter_get_row(p->rows, x, c) + v * n,
        .kernel = get_cluster_kernel(p->fit, j, c) + v * n,
        /* may point outside the array, but only entries inside the map are
         * accessed */
        .in =
            p->fit->in + c + 3 * (x + (v - n / 2) * side + in->u_from - n / 2),
    };
}

/* Sets PRODUCT to the sum over the row of texel X of data * kernel * in, and
 * SQUARE to the sum of (kernel * in)^2. */
static void compute_row_sums(const struct clusters *p, int x, int c, int j,
                             double *product, double *square)
{
    const struct glint_scatter_inside in =
        glint_scatter_find_offsets_inside(p->fit->side, p->fit->kernel, x);

    *product = *square = 0;
    for (int v = in.v_from; v < in.v_to; v++) {
        const struct span s = get_line_of_row(p, &in, x, c, j, v);

        for (int u = s.u_from; u < s.u_to; u++) {
            const double b = s.kernel[u] * s.in[3 * (u - s.u_from)];

            *product += (double)s.data[u] * b;
            *square += b * b;
        }
    }
}

static double divide_or_zero(double above, double below)
{
    return below > 0 ? above / below : 0;
}

static void fit_leaving_factors(const struct clusters *p)
{
    for (int x = 0; x < p->fit->side * p->fit->side; x++)
        for (int c = 0; c < 3; c++) {
            double product, square;

            compute_row_sums(p, x, c, p->fit->cluster[x], &product, &square);
            p->fit->out[3 * x + c] = divide_or_zero(product, square);
        }
}

/* Fits SCALE[N] by least squares: the in factors if IN_SCALES, else the kernel
 * entries. */
static void fit_least_squares_scales(const struct clusters *p, bool in_scales,
                                     double *scale, size_t n)
{
    const int side = p->fit->side;

    memset(p->above, 0, n * sizeof *p->above);
    memset(p->below, 0, n * sizeof *p->below);
    for (int i = 0; i < 3 * side * side; i++) {
        const int x = i / 3, c = i % 3;
        const struct glint_scatter_inside in =
            glint_scatter_find_offsets_inside(side, p->fit->kernel, x);

        for (int v = in.v_from; v < in.v_to; v++) {
            const struct span s =
                get_line_of_row(p, &in, x, c, p->fit->cluster[x], v);

            for (int u = s.u_from; u < s.u_to; u++) {
                const double *lit = s.in + 3 * (ptrdiff_t)(u - s.u_from);
                const ptrdiff_t at = (in_scales ? lit : s.kernel + u) - scale;
                const double b =
                    p->fit->out[i] * (in_scales ? s.kernel[u] : *lit);

                p->above[at] += (double)s.data[u] * b;
                p->below[at] += b * b;
            }
        }
    }
    for (size_t i = 0; i < n; i++)
        scale[i] = divide_or_zero(p->above[i], p->below[i]);
}

static void fit_entering_factors(const struct clusters *p)
{
    fit_least_squares_scales(p, true, p->fit->in,
                             3 * (size_t)p->fit->side * (size_t)p->fit->side);
}

static void fit_cluster_kernels(const struct clusters *p)
{
    fit_least_squares_scales(
        p, false, p->fit->h,
        3 * (size_t)p->fit->kernels *
            (size_t)glint_scatter_count_entries(p->fit->kernel));
}

/* Assigns each texel to the kernel with the smallest residual of the texel's
 * row. */
static void assign_texels_to_kernels(const struct clusters *p)
{
    for (int x = 0; x < p->fit->side * p->fit->side; x++) {
        double best = -1;
        int kernel = p->fit->cluster[x];

        for (int j = 0; j < p->fit->kernels; j++) {
            double explained = 0;

            for (int c = 0; c < 3; c++) {
                double product, square;

                compute_row_sums(p, x, c, j, &product, &square);
                explained += divide_or_zero(product * product, square);
            }
            if (explained > best) {
                best = explained;
                kernel = j;
            }
        }
        p->fit->cluster[x] = (uint8_t)kernel;
    }
}

/* Returns the value, 0 .. 1, by which texel X is assigned to an initial
 * cluster. MOST: max sum of a texel's albedos over the channels. */
static double compute_initial_cluster_value(const struct clusters *p, int x,
                                            double most)
{
    const int side = p->fit->side, window = 2 * ABOUT + 1;
    const double *a = p->fit->albedo + 3 * (size_t)x;
    double sum = 0;
    int n = 0;

    if (!p->rows->share)
        return most > 0 ? (a[0] + a[1] + a[2]) / most : 0;
    for (int d = 0; d < window * window; d++) {
        const int to = glint_scatter_get_target_texel(side, window, x, d);

        if (to >= 0) {
            sum += p->rows->share[to];
            n++;
        }
    }
    return sum / n;
}

static void set_initial_clusters(const struct clusters *p)
{
    const int texels = p->fit->side * p->fit->side, k = p->fit->kernels;
    double most = 0;

    for (int x = 0; x < texels; x++) {
        const double *a = p->fit->albedo + 3 * (size_t)x;

        most = fmax(most, a[0] + a[1] + a[2]);
    }
    for (int x = 0; x < texels; x++) {
        const int j = (int)(compute_initial_cluster_value(p, x, most) * k);

        p->fit->cluster[x] = (uint8_t)(j < k ? j : k - 1);
        for (int c = 0; c < 3; c++) {
            p->fit->out[3 * x + c] = p->fit->albedo[3 * x + c];
            p->fit->in[3 * x + c] = 1;
        }
    }
}

/* Scales each kernel to the sum 1 and the in factors to the mean 1. Then out
 * factors are near the albedo. */
static void normalise_kernels(const struct clusters *p)
{
    const int texels = p->fit->side * p->fit->side;
    const int k2 = glint_scatter_count_entries(p->fit->kernel);

    for (int c = 0; c < 3; c++) {
        double mean = 0;

        for (int x = 0; x < texels; x++)
            mean += p->fit->in[3 * x + c] / texels;
        for (int x = 0; x < texels && mean > 0; x++)
            p->fit->in[3 * x + c] /= mean;
        for (int j = 0; j < p->fit->kernels; j++) {
            double *h = get_cluster_kernel(p->fit, j, c), sum = 0;

            for (int d = 0; d < k2; d++)
                sum += h[d];
            for (int d = 0; d < k2 && sum > 0; d++)
                h[d] /= sum;
        }
    }
}

static enum glint_status fit_clusters(struct clusters *p,
                                      const struct glint_watch *watch)
{
    set_initial_clusters(p);
    fit_cluster_kernels(p);
    for (int i = 0; i < ROUNDS; i++) {
        if (glint_watch_report_progress(watch, (double)i / ROUNDS))
            return GLINT_E_CLOSED;
        if (i > 0)
            assign_texels_to_kernels(p);
        fit_leaving_factors(p);
        fit_entering_factors(p);
        fit_cluster_kernels(p);
    }
    normalise_kernels(p);
    fit_leaving_factors(p);
    return GLINT_OK;
}

enum glint_status
glint_scatter_fit_clusters(const struct glint_scatter_rows *rows,
                           const struct glint_watch *watch,
                           struct glint_scatter_fit *fit)
{
    const size_t texels = (size_t)fit->side * (size_t)fit->side;
    const size_t entries = (size_t)fit->kernels * 3 *
                           (size_t)glint_scatter_count_entries(fit->kernel);
    const size_t sums = entries > 3 * texels ? entries : 3 * texels;
    struct clusters p = {.rows = rows, .fit = fit};
    enum glint_status status = GLINT_E_MEMORY;

    fit->h = calloc(entries, sizeof *fit->h);
    fit->out = calloc(3 * texels, sizeof *fit->out);
    fit->in = calloc(3 * texels, sizeof *fit->in);
    fit->cluster = calloc(texels, sizeof *fit->cluster);
    p.above = malloc(2 * sums * sizeof *p.above);
    p.below = p.above + sums;
    if (fit->h && fit->out && fit->in && fit->cluster && p.above)
        status = fit_clusters(&p, watch);
    free(p.above);
    return status;
}
