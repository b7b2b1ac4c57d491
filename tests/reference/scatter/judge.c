/* SPDX-License-Identifier: MIT
 *
 * Measures the errors of models of subsurface scattering against the rows of
 * the scattering matrix that they were fitted to.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "reference/scatter/rebuild.h"

#define NO_ERROR_DB 999.0

void glint_scatter_set_default_candidate(
    struct glint_scatter_candidate *candidate,
    enum glint_scatter_candidate_kind kind)
{
    *candidate = (struct glint_scatter_candidate){
        .kind = kind,
        .terms = kind == GLINT_CANDIDATE_CLUSTERED ? 4
                 : kind == GLINT_CANDIDATE_ALBEDO  ? 1
                                                   : 5,
        .rank = kind == GLINT_CANDIDATE_FACTORED ? 3 : 1,
        .degree = 4,
        .clusters = 1,
        .b = 1,
    };
}

static bool
are_candidate_parameters_in_range(const struct glint_scatter_candidate *o)
{
    return o->kind >= 0 && o->kind < GLINT_CANDIDATES && o->terms >= 1 &&
           o->terms <= GLINT_SCATTER_MAX_TERMS && o->rank >= 1 &&
           o->rank <= GLINT_SCATTER_MAX_RANK && o->degree >= 0 &&
           o->degree <= 5 && o->clusters >= 1 &&
           o->clusters <= GLINT_SCATTER_MAX_TERMS && o->a >= 0 && o->b > 0;
}

double
glint_scatter_candidate_bytes(const struct glint_scatter_candidate *candidate,
                              double texels, double entries)
{
    const double line = sqrt(entries);

    switch (candidate->kind) {
    /* `texels` bytes: one cluster index per texel */
    case GLINT_CANDIDATE_CLUSTERED:
        return 8 * 3 * (2 * texels + candidate->terms * entries) + texels;
    case GLINT_CANDIDATE_FACTORED:
        return 8 * 3 * candidate->terms * (texels + 2 * candidate->rank * line);
    case GLINT_CANDIDATE_ALBEDO:
        return 8 * 3 * (texels + entries);
    case GLINT_CANDIDATE_TUCKER:
        return 8 * ((candidate->terms + 2 * candidate->turned +
                     3 * (candidate->degree + 1)) *
                        texels +
                    candidate->terms * entries);
    case GLINT_CANDIDATE_PEERS:
        return 8 * 3 *
                   (candidate->terms * (texels + entries) +
                    candidate->clusters * entries) +
               (candidate->clusters > 1 ? 3 * texels : 0);
    case GLINT_CANDIDATE_SUBEDIT:
        return 8 * 36 * texels;
    case GLINT_CANDIDATE_SVD:
    case GLINT_CANDIDATE_LOG_SVD:
    case GLINT_CANDIDATE_ALS:
    default:
        return 8 * 3 * candidate->terms * (texels + entries);
    }
}

double
glint_scatter_candidate_sums(const struct glint_scatter_candidate *candidate,
                             double texels, double entries, bool kept)
{
    const double terms = 3.0 * candidate->terms;

    switch (candidate->kind) {
    case GLINT_CANDIDATE_SVD:
    case GLINT_CANDIDATE_ALS:
    case GLINT_CANDIDATE_FACTORED:
        return kept ? terms * (texels + entries) : terms * texels * entries;
    case GLINT_CANDIDATE_ALBEDO:
        return kept ? 3 * (texels + entries) : 3 * texels * entries;
    case GLINT_CANDIDATE_CLUSTERED:
        return 3 * texels * entries;
    /* KEPT: uses, per cluster, the stored sum of mean row G times each
     * kernel */
    case GLINT_CANDIDATE_PEERS:
        return kept ? terms * (texels + candidate->clusters * entries)
                    : (terms + 3) * texels * entries;
    case GLINT_CANDIDATE_TUCKER:
        return (candidate->terms + 3.0 * candidate->degree) * texels * entries;
    /* two profile interpolations and a square root per entry */
    case GLINT_CANDIDATE_SUBEDIT:
        return 3 * 4 * texels * entries;
    case GLINT_CANDIDATE_LOG_SVD: /* plus an exponential */
    default:
        return (terms + 3) * texels * entries;
    }
}

double glint_scatter_largest_entry(const struct glint_scatter_rows *rows)
{
    const size_t n = (size_t)rows->side * (size_t)rows->side * 3 *
                     (size_t)glint_scatter_count_entries(rows->kernel);
    float most = 0;

    for (size_t i = 0; i < n; i++)
        most = rows->r[i] > most ? rows->r[i] : most;
    return (double)most;
}

void glint_store_rebuilt_row(const struct glint_scatter_rows *rebuilt, int x,
                             int c, const double *row)
{
    float *to = glint_scatter_get_row(rebuilt, x, c);

    for (int d = 0; d < glint_scatter_count_entries(rebuilt->kernel); d++)
        to[d] = glint_scatter_get_target_texel(rebuilt->side, rebuilt->kernel,
                                               x, d) < 0
                    ? 0
                    : (float)row[d];
}

/* Fits to ROWS a model that the run time can draw, and sets REBUILT to the rows
 * of that fit. */
static enum glint_status rebuild_rows_by_runtime_fit(
    struct glint_scatter_rows *rows, const struct glint_scatter_candidate *o,
    const struct glint_watch *watch, struct glint_scatter_rows *rebuilt)
{
    static const enum glint_scatter_model model[] = {
        GLINT_SCATTER_CLUSTERED, GLINT_SCATTER_FACTORED, GLINT_SCATTER_ALBEDO};
    const struct glint_scatter_options options = {model[o->kind], o->terms,
                                                  o->rank};
    const int k2 = glint_scatter_count_entries(rows->kernel);
    struct glint_scatter_fit fit;
    const enum glint_status status =
        glint_scatter_fit(rows, &options, watch, &fit);

    if (status != GLINT_OK)
        return status;
    for (int x = 0; x < rows->side * rows->side; x++)
        for (int c = 0; c < 3; c++)
            for (int d = 0; d < k2; d++)
                glint_scatter_get_row(rebuilt, x, c)[d] =
                    (float)glint_scatter_entry(&fit, x, c, d);
    glint_scatter_fit_close(&fit);
    return GLINT_OK;
}

static enum glint_status rebuild_rows_by_candidate(
    struct glint_scatter_rows *rows, struct glint_scatter_candidate *o,
    const struct glint_watch *watch, struct glint_scatter_rows *rebuilt)
{
    static glint_rebuild_fn *const published[] = {
        [GLINT_CANDIDATE_SVD] = glint_rebuild_svd,
        [GLINT_CANDIDATE_LOG_SVD] = glint_rebuild_svd_of_logarithms,
        [GLINT_CANDIDATE_TUCKER] = glint_rebuild_tucker_terms,
        [GLINT_CANDIDATE_ALS] = glint_rebuild_nonnegative_factors,
        [GLINT_CANDIDATE_PEERS] = glint_rebuild_cluster_factors,
        [GLINT_CANDIDATE_SUBEDIT] = glint_rebuild_radial_profiles,
    };

    return published[o->kind]
               ? published[o->kind](rows, o, watch, rebuilt)
               : rebuild_rows_by_runtime_fit(rows, o, watch, rebuilt);
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* Returns the squared error of the row of texel X. Counts the row's negative
 * entries and updates the max row sum in J. Adds the squared asymmetry of the
 * row's entries to ONE_WAY. */
static double measure_row_errors(const struct glint_scatter_rows *rows,
                                 const struct glint_scatter_rows *rebuilt,
                                 int x, struct glint_scatter_judgement *j,
                                 double *one_way)
{
    const int k2 = glint_scatter_count_entries(rows->kernel);
    double square = 0;

    for (int c = 0; c < 3; c++) {
        const float *want = glint_scatter_get_row(rows, x, c);
        const float *got = glint_scatter_get_row(rebuilt, x, c);
        double sum = 0;

        for (int d = 0; d < k2; d++) {
            const int to =
                glint_scatter_get_target_texel(rows->side, rows->kernel, x, d);
            const double g = (double)got[d];

            if (to < 0)
                continue;
            square += pow(g - (double)want[d], 2);
            sum += g;
            j->negative += g < 0;
            *one_way += pow(
                g - (double)glint_scatter_get_row(rebuilt, to, c)[k2 - 1 - d],
                2);
        }
        j->energy = fmax(j->energy, sum);
    }
    return square;
}

/* Returns the total number of row entries, three channels, whose texels lie
 * inside the square of the medium. */
static double
count_row_entries_inside_medium(const struct glint_scatter_rows *rows)
{
    double n = 0;

    for (int x = 0; x < rows->side * rows->side; x++) {
        const struct glint_scatter_inside in =
            glint_scatter_find_offsets_inside(rows->side, rows->kernel, x);

        n += (in.u_to - in.u_from) * (in.v_to - in.v_from);
    }
    return 3 * n;
}

static double compute_psnr_db(double square, double peak)
{
    return square > 0 && peak > 0 ? 10 * log10(peak * peak / square)
                                  : NO_ERROR_DB;
}

/* Sets the fields of J that measure the errors of rows. SORTED[texels] is
 * scratch memory. */
static void measure_entry_errors(const struct glint_scatter_rows *rows,
                                 const struct glint_scatter_rows *rebuilt,
                                 double *sorted,
                                 struct glint_scatter_judgement *j)
{
    const int texels = rows->side * rows->side;
    const double peak = glint_scatter_largest_entry(rows),
                 all = count_row_entries_inside_medium(rows);
    const double unit = peak > 0 ? peak : 1;
    double square = 0, one_way = 0;

    for (int x = 0; x < texels; x++) {
        const double row = measure_row_errors(rows, rebuilt, x, j, &one_way);

        square += row;
        j->error[x] = sqrt(row / (all / texels)) / unit;
        sorted[x] = j->error[x];
    }
    qsort(sorted, (size_t)texels, sizeof *sorted, compare_doubles);
    j->p50 = sorted[texels / 2];
    j->p95 = sorted[(int)(0.95 * (texels - 1))];
    j->largest = sorted[texels - 1];
    j->rmse = sqrt(square / all) / unit;
    j->entry_db = compute_psnr_db(square / all, peak);
    j->negative /= all;
    j->one_way = sqrt(one_way / all) / unit;
}

static enum glint_status
measure_errors(const struct glint_scatter_rows *rows,
               const struct glint_scatter_rows *rebuilt,
               struct glint_scatter_judgement *j)
{
    const size_t texels = (size_t)rows->side * (size_t)rows->side;
    double *light = malloc(7 * texels * sizeof *light);
    double *want, *sorted, square = 0, peak = 0;

    j->error = malloc(texels * sizeof *j->error);
    j->light = malloc(3 * texels * sizeof *j->light);
    if (!light || !j->error || !j->light) {
        free(light);
        return GLINT_E_MEMORY;
    }
    want = light + 3 * texels;
    sorted = want + 3 * texels;
    measure_entry_errors(rows, rebuilt, sorted, j);
    glint_scatter_test_light(rows->side, light);
    glint_scatter_light_rows(rows, light, want);
    glint_scatter_light_rows(rebuilt, light, j->light);
    for (size_t i = 0; i < 3 * texels; i++) {
        square += pow(j->light[i] - want[i], 2) / (3.0 * (double)texels);
        peak = fmax(peak, want[i]);
    }
    j->light_db = compute_psnr_db(square, peak);
    free(light);
    return GLINT_OK;
}

enum glint_status
glint_scatter_judge(struct glint_scatter_rows *rows,
                    const struct glint_scatter_candidate *candidate,
                    const struct glint_watch *watch,
                    struct glint_scatter_judgement *judgement)
{
    const double texels = (double)rows->side * rows->side;
    const double entries = glint_scatter_count_entries(rows->kernel);
    struct glint_scatter_rows rebuilt;
    const clock_t start = clock();
    enum glint_status status;

    *judgement = (struct glint_scatter_judgement){.candidate = *candidate};
    if (!are_candidate_parameters_in_range(candidate))
        return GLINT_E_ARGUMENT;
    if (!glint_scatter_allocate_rows(&rebuilt, rows->side, rows->kernel, false))
        return GLINT_E_MEMORY;
    status =
        rebuild_rows_by_candidate(rows, &judgement->candidate, watch, &rebuilt);
    judgement->seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    judgement->bytes =
        glint_scatter_candidate_bytes(candidate, texels, entries);
    judgement->compression = 24 * texels * entries / judgement->bytes;
    if (status == GLINT_OK)
        status = measure_errors(rows, &rebuilt, judgement);
    glint_scatter_close(&rebuilt);
    if (status != GLINT_OK)
        glint_scatter_free_judgement(judgement);
    return status;
}

void glint_scatter_free_judgement(struct glint_scatter_judgement *judgement)
{
    free(judgement->error);
    free(judgement->light);
    memset(judgement, 0, sizeof *judgement);
}
