/* SPDX-License-Identifier: MIT
 *
 * Converts a fit in doubles to a baked translucent medium: codes, filter taps,
 * shifts and gains.
 *
 * Each kernel is a sum of products of a row r and a column k. A plane is one
 * kernel of one channel. Its factors f, one per texel, are stored as codes: f =
 * F code, where F is the max factor. For each product the run time computes
 *
 *     light -> row taps / 2^shift -> column taps -> code -> gain
 *
 * Row taps are R r, with the scale R as large as fits. Column taps are V w,
 * where w = k F 2^shift / R. All kernels of a channel have the same scale V, as
 * their sums are added. The gain is 1 / V.
 */
#include "glint/scene/stone_bake.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bake/table/draft.h"
#include "bake/translucent/linear.h"

enum { CHANNELS = 3 };

struct writer {
    const struct glint_scatter_fit *fit;
    const struct glint_stone_text *text;
    struct glint_error *error;
    struct glint_stone_report *report;
    struct glint_draft draft;
    struct glint_translucent_header header;
    int rank, texels;
    /* columns and rows of all kernels, [kernels][3][rank][kernel] */
    double *column, *row;
    /* [3][kernels]: max factor of each plane (channel and kernel) */
    double *largest;
    /* max factor for entering light, per channel, of the clustered model; 1 for
     * other models */
    double in[CHANNELS];
};

/* ----------------------------------------------------------------- kernels */

static size_t compute_kernel_index(int p, int c)
{
    return (size_t)p * CHANNELS + (size_t)c;
}

/* Sets the members column and row to the separable products of all kernels.
 * Returns false if there is no memory. */
static bool separate_kernels(struct writer *w)
{
    const struct glint_scatter_fit *fit = w->fit;
    const size_t k = (size_t)fit->kernel, n = (size_t)fit->kernels * CHANNELS;
    const size_t numbers = n * (size_t)w->rank * k;
    double lost = 0, all = 0;

    w->column = malloc(numbers * sizeof *w->column);
    w->row = malloc(numbers * sizeof *w->row);
    if (!w->column || !w->row)
        return false;
    if (fit->column) {
        memcpy(w->column, fit->column, numbers * sizeof *w->column);
        memcpy(w->row, fit->row, numbers * sizeof *w->row);
        return true;
    }
    for (size_t i = 0; i < n; i++) {
        struct glint_separated s = {.column =
                                        w->column + i * (size_t)w->rank * k,
                                    .row = w->row + i * (size_t)w->rank * k};

        glint_separate_kernel(fit->h + i * k * k, fit->kernel, w->rank, &s);
        lost += s.lost;
        all += s.all;
    }
    w->report->kernel_loss = all > 0 ? sqrt(lost / all) : 0;
    return true;
}

/* ------------------------------------------------------------------- codes */

/* Returns the factor of texel X in plane P, channel C. */
static double get_texel_factor(const struct writer *w, int p, int c, int x)
{
    const struct glint_scatter_fit *fit = w->fit;

    if (fit->model == GLINT_SCATTER_FACTORED)
        return fit
            ->f[compute_kernel_index(p, c) * (size_t)w->texels + (size_t)x];
    if (fit->cluster && fit->cluster[x] != p)
        return 0;
    return fit->out[CHANNELS * (size_t)x + (size_t)c];
}

/* Converts VALUE[N] to codes such that MOST becomes 2^BITS - 1, and appends
 * them, negative ones in two's complement. Returns false if there is no
 * memory. */
static bool append_codes(struct writer *w, const double *value, int n,
                         double most, int bits)
{
    const double full = most > 0 ? (double)((1L << bits) - 1) / most : 0;
    uint8_t *code = malloc((size_t)n);

    for (int i = 0; code && i < n; i++)
        code[i] = (uint8_t)lrint(value[i] * full);
    if (code)
        glint_draft_append(&w->draft, code, (size_t)n);
    free(code);
    return code != NULL;
}

/* With clusters each texel has only the factor of its cluster. */
static bool append_factor_codes(struct writer *w, int c, double *value)
{
    const bool is_factored = w->fit->model == GLINT_SCATTER_FACTORED;
    const int bits = GLINT_TRANSLUCENT_CODE_BITS - is_factored;
    double most[GLINT_SCATTER_MAX_TERMS] = {0};

    for (int p = 0; p < w->fit->kernels; p++) {
        for (int x = 0; x < w->texels; x++) {
            value[x] = get_texel_factor(w, p, c, x);
            most[p] = fmax(most[p], fabs(value[x]));
        }
        w->largest[c * w->fit->kernels + p] = most[p];
        if (is_factored && !append_codes(w, value, w->texels, most[p], bits))
            return false;
    }
    if (is_factored)
        return true;
    for (int x = 0; x < w->texels; x++) {
        const int p = w->fit->cluster ? w->fit->cluster[x] : 0;

        value[x] = most[p] > 0 ? get_texel_factor(w, p, c, x) / most[p] : 0;
    }
    return append_codes(w, value, w->texels, 1, bits);
}

static bool append_in_factor_codes(struct writer *w, int c, double *value)
{
    double most = 0;

    for (int x = 0; x < w->texels; x++) {
        value[x] = w->fit->in[CHANNELS * (size_t)x + (size_t)c];
        most = fmax(most, value[x]);
    }
    w->in[c] = most * ldexp(1, GLINT_TRANSLUCENT_CODE_BITS) /
               ((1 << GLINT_TRANSLUCENT_CODE_BITS) - 1);
    return append_codes(w, value, w->texels, most, GLINT_TRANSLUCENT_CODE_BITS);
}

static bool write_all_codes(struct writer *w)
{
    double *value = malloc((size_t)w->texels * sizeof *value);
    bool good = value != NULL;

    w->header.code_at = (uint32_t)w->draft.bytes;
    for (int c = 0; good && c < CHANNELS; c++)
        good = append_factor_codes(w, c, value);
    for (int c = 0; good && c < CHANNELS; c++) {
        w->in[c] = 1;
        if (w->fit->model == GLINT_SCATTER_CLUSTERED)
            good = append_in_factor_codes(w, c, value);
    }
    free(value);
    if (w->fit->model == GLINT_SCATTER_CLUSTERED)
        w->header.cluster_at =
            glint_draft_append(&w->draft, w->fit->cluster, (size_t)w->texels);
    return good;
}

/* -------------------------------------------------------------------- taps */

static double find_max_magnitude(const double *x, int n)
{
    double most = 0;

    for (int k = 0; k < n; k++)
        most = fmax(most, fabs(x[k]));
    return most;
}

static double sum_tap_magnitudes(const double *x, int n)
{
    double all = 0;

    for (int k = 0; k < n; k++)
        all += fabs(x[k]);
    return all;
}

/* Returns the max scale for N taps such that the magnitudes of the rounded taps
 * sum to at most GLINT_TRANSLUCENT_MOST_TAPS. MOST and ALL are the max and the
 * sum of the taps' magnitudes. Returns 0 if all taps are 0. */
static double choose_tap_scale(double most, double all, int n)
{
    const double tap = (1 << (GLINT_TRANSLUCENT_TAP_BITS - 1)) - 1;

    return most > 0 ? fmin(tap / most,
                           (GLINT_TRANSLUCENT_MOST_TAPS - n / 2. - 1) / all)
                    : 0;
}

/* Rounds TAP[N] times SCALE to integers. Returns the sum of their
 * magnitudes. */
static long round_filter_taps(const double *tap, int n, double scale,
                              int16_t *to)
{
    long all = 0;

    for (int k = 0; k < n; k++) {
        to[k] = (int16_t)lrint(tap[k] * scale);
        all += labs(to[k]);
    }
    return all;
}

/* Sets the taps TO[kernels][rank][2][kernel] and the shifts of channel C.
 * Returns false if the material would emit more light than it receives. */
static bool set_channel_taps(struct writer *w, int c, int16_t *to,
                             uint32_t *shift)
{
    const struct glint_scatter_fit *fit = w->fit;
    const int k = fit->kernel, n = fit->kernels * w->rank;
    const int bits =
        GLINT_TRANSLUCENT_CODE_BITS - (fit->model == GLINT_SCATTER_FACTORED);
    double most = 0, all = 0, scale;

    for (int i = 0; i < n; i++) {
        const size_t at =
            (compute_kernel_index(i / w->rank, c) * (size_t)w->rank +
             (size_t)(i % w->rank)) *
            (size_t)k;
        const double *row = w->row + at;
        double *column = w->column + at;
        const double factor = w->largest[c * fit->kernels + i / w->rank] *
                              ldexp(1, bits) / (double)((1L << bits) - 1);
        const double rows = choose_tap_scale(find_max_magnitude(row, k),
                                             sum_tap_magnitudes(row, k), k);
        const long taps =
            round_filter_taps(row, k, rows, to + 2 * (ptrdiff_t)i * k);

        while (1L << shift[i] < taps)
            shift[i]++;
        for (int j = 0; j < k; j++)
            column[j] *= rows > 0 ? factor * ldexp(1, (int)shift[i]) / rows : 0;
        most = fmax(most, find_max_magnitude(column, k));
        all += sum_tap_magnitudes(column, k);
    }
    scale = choose_tap_scale(most, all, n * k);
    for (int i = 0; i < n; i++)
        round_filter_taps(w->column + (compute_kernel_index(i / w->rank, c) *
                                           (size_t)w->rank +
                                       (size_t)(i % w->rank)) *
                                          (size_t)k,
                          k, scale, to + (2 * (ptrdiff_t)i + 1) * k);
    if (scale > 0)
        w->header.gain[c] = glint_real_of(w->in[c] / scale);
    w->report->tap_bits = (int)fmin(
        w->report->tap_bits, scale > 0 ? floor(log2(most * scale)) + 2 : 16);
    return scale == 0 || w->in[c] < scale;
}

static bool write_filter_taps(struct writer *w)
{
    const size_t n = (size_t)w->fit->kernels * (size_t)w->rank;
    const size_t k = 2 * (size_t)w->fit->kernel;
    int16_t *tap = calloc(CHANNELS * n, k * sizeof *tap);
    uint32_t *shift = calloc(CHANNELS * n, sizeof *shift);
    bool good = tap && shift;

    for (int c = 0; good && c < CHANNELS; c++)
        if (!set_channel_taps(w, c, tap + (size_t)c * n * k,
                              shift + (size_t)c * n)) {
            snprintf(w->error->text, sizeof w->error->text,
                     "the material would emit more light than it receives");
            good = false;
        }
    if (good) {
        w->header.tap_at =
            glint_draft_append(&w->draft, tap, CHANNELS * n * k * sizeof *tap);
        w->header.shift_at =
            glint_draft_append(&w->draft, shift, CHANNELS * n * sizeof *shift);
    }
    free(tap);
    free(shift);
    return good;
}

/* ----------------------------------------------------------------- surface */

/* Returns the fraction of unpolarised light at COSINE that a surface of INDEX
 * transmits (Fresnel). */
static double compute_fresnel_transmittance(double index, double cosine)
{
    const double g = sqrt(index * index - 1 + cosine * cosine);
    const double across = (cosine - g) / (cosine + g);
    const double along =
        (index * index * cosine - g) / (index * index * cosine + g);

    if (!(cosine > 0))
        return 0;
    return 1 - (across * across + along * along) / 2;
}

static void write_surface_table(struct writer *w)
{
    enum { N = GLINT_TRANSLUCENT_COSINES, FINE = 4096 };
    uint16_t table_q15[N + 1];
    double mean = 0;

    for (int i = 0; i <= N; i++)
        table_q15[i] =
            (uint16_t)lrint(0x1p15 * compute_fresnel_transmittance(
                                         w->text->stone.index, (double)i / N));
    for (int i = 0; i < FINE; i++)
        mean += 2 * (i + .5) / FINE *
                compute_fresnel_transmittance(w->text->stone.index,
                                              (i + .5) / FINE) /
                FINE;
    w->header.transmit_at =
        glint_draft_append(&w->draft, table_q15, sizeof table_q15);
    w->header.mean_transmit_q15 = (int32_t)lrint(0x1p15 * mean);
}

/* ------------------------------------------------------------------- whole */

static bool is_fit_in_range(const struct glint_scatter_fit *fit,
                            const struct glint_stone_text *text)
{
    return text->stone.texel_mm >= .001 && text->stone.texel_mm <= 1000 &&
           text->stone.index >= 1 && text->stone.index <= 3 &&
           text->fit.rank >= 1 &&
           text->fit.rank <= GLINT_TRANSLUCENT_MOST_RANK && fit->kernels >= 1 &&
           fit->kernels <= GLINT_TRANSLUCENT_MOST_PLANES;
}

static bool set_translucent_header(struct writer *w, const char *name,
                                   uint64_t key)
{
    static const struct glint_blob_kind kind = {
        .magic = GLINT_TRANSLUCENT_MAGIC, .version = GLINT_TRANSLUCENT_VERSION};
    struct glint_translucent_header *h = &w->header;
    int log2 = 0;

    while (1 << log2 < w->fit->side)
        log2++;
    if (1 << log2 != w->fit->side || log2 < GLINT_TRANSLUCENT_LEAST_LOG2 ||
        log2 > GLINT_TRANSLUCENT_MOST_LOG2) {
        snprintf(w->error->text, sizeof w->error->text,
                 "a baked translucent material must have 32, 64, 128 or 256 "
                 "texels per side, not %d",
                 w->fit->side);
        return false;
    }
    glint_draft_begin_header(
        h, &kind,
        w->fit->model == GLINT_SCATTER_FACTORED    ? GLINT_TRANSLUCENT_FACTORED
        : w->fit->model == GLINT_SCATTER_CLUSTERED ? GLINT_TRANSLUCENT_CLUSTERED
                                                   : GLINT_TRANSLUCENT_ALBEDO,
        key, name, "stone");
    h->side_log2 = (uint32_t)log2;
    h->kernel = (uint32_t)w->fit->kernel;
    h->n_planes = (uint32_t)w->fit->kernels;
    h->rank = (uint32_t)w->rank;
    h->texel_um = (uint32_t)lrint(1000 * w->text->stone.texel_mm);
    h->index_q16 = (uint32_t)lrint(0x1p16 * w->text->stone.index);
    h->code_bits = GLINT_TRANSLUCENT_CODE_BITS;
    h->tap_bits = GLINT_TRANSLUCENT_TAP_BITS;
    return true;
}

enum glint_status glint_stone_bake(const struct glint_scatter_fit *fit,
                                   const struct glint_stone_text *text,
                                   const char *name, uint64_t key,
                                   unsigned char **data, size_t *bytes,
                                   struct glint_stone_report *report,
                                   struct glint_error *error)
{
    struct writer w = {.fit = fit,
                       .text = text,
                       .error = error,
                       .report = report,
                       .rank = fit->column ? fit->rank : text->fit.rank,
                       .texels = fit->side * fit->side};
    bool good;

    *report = (struct glint_stone_report){0, 16};
    error->text[0] = '\0';
    if (!is_fit_in_range(fit, text))
        return GLINT_E_ARGUMENT;
    w.largest = malloc(CHANNELS * (size_t)fit->kernels * sizeof *w.largest);
    glint_draft_append(&w.draft, NULL, sizeof w.header);
    good = w.largest && set_translucent_header(&w, name, key) &&
           separate_kernels(&w) && write_all_codes(&w) && write_filter_taps(&w);
    write_surface_table(&w);
    free(w.column);
    free(w.row);
    free(w.largest);
    if (glint_draft_finish_file(&w.draft, &w.header, sizeof w.header, good,
                                data, bytes))
        return GLINT_OK;
    return error->text[0] ? GLINT_E_UNSUPPORTED : GLINT_E_MEMORY;
}
