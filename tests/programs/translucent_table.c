/* SPDX-License-Identifier: MIT
 *
 * translucent_table - compares scattering models on four translucent media of
 * 48 x 48 texels with kernels of 21 x 21. Prints the tables of [Kurt14] as
 * Markdown, with the published values next to ours. C1 to C13 are the claims of
 * tests/figures/scenes/translucent.md.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "glint/scene/stone_bake.h"
#include "reference/scatter/translucent_report.h"
#include "support/rng.h"

enum { STONES = 4, GRID_TERMS = 5, GRID_DEGREES = 5 };

static const char *const stone_name[STONES] = {"chess 4 x 4", "chess 8 x 8",
                                               "veins", "pale veins"};

/* Models that are fitted once per medium and appear in several tables. */
enum run {
    CLUSTERED,
    FACTORED,
    ALBEDO,
    SVD5,
    SVD10,
    SVD20,
    LOG5,
    LOG10,
    TUCKER5,
    TUCKER15,
    ALS5,
    PEERS5,
    PEERS10,
    PEERS20,
    SUBEDIT,
    RUNS
};

static const struct {
    const char *name;
    enum glint_scatter_candidate_kind kind;
    int terms, clusters;
} run_of[RUNS] = {
    {"clustered, 4 kernels", GLINT_CANDIDATE_CLUSTERED, 4, 1},
    {"factored, S = 5, rank 3", GLINT_CANDIDATE_FACTORED, 5, 1},
    {"albedo x one kernel", GLINT_CANDIDATE_ALBEDO, 1, 1},
    {"SVD, S = 5", GLINT_CANDIDATE_SVD, 5, 1},
    {"SVD, S = 10", GLINT_CANDIDATE_SVD, 10, 1},
    {"SVD, S = 20", GLINT_CANDIDATE_SVD, 20, 1},
    {"log-SVD, S = 5, searched", GLINT_CANDIDATE_LOG_SVD, 5, 1},
    {"log-SVD, S = 10, searched", GLINT_CANDIDATE_LOG_SVD, 10, 1},
    {"Tucker, T = 5, P = 4", GLINT_CANDIDATE_TUCKER, 5, 1},
    {"Tucker, T = 15, P = 4", GLINT_CANDIDATE_TUCKER, 15, 1},
    {"non-negative ALS, S = 5", GLINT_CANDIDATE_ALS, 5, 1},
    {"Peers, 5 clusters, 5 terms", GLINT_CANDIDATE_PEERS, 5, 5},
    {"Peers, 5 clusters, 10 terms", GLINT_CANDIDATE_PEERS, 10, 5},
    {"Peers, 5 clusters, 20 terms", GLINT_CANDIDATE_PEERS, 20, 5},
    {"SubEdit", GLINT_CANDIDATE_SUBEDIT, 1, 1},
};

struct table {
    int side, kernel;
    double seconds[STONES]; /* CPU time for computing the scattering rows */
    struct glint_scatter_rows rows[STONES];
    struct glint_scatter_judgement j[STONES][RUNS];
};

static double cpu_seconds(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

static void exit_with_error(const char *what)
{
    fprintf(stderr, "translucent_table: %s\n", what);
    exit(1);
}

/* Returns the errors of candidate O on ROWS; frees the error map and light
 * map. */
static struct glint_scatter_judgement
judge_candidate(struct glint_scatter_rows *rows,
                const struct glint_scatter_candidate *o)
{
    struct glint_scatter_judgement j, kept;

    if (glint_scatter_judge(rows, o, NULL, &j) != GLINT_OK)
        exit_with_error("out of memory");
    kept = j;
    glint_scatter_free_judgement(&j);
    return kept;
}

static struct glint_scatter_candidate make_fit_candidate(enum run run)
{
    struct glint_scatter_candidate o;

    glint_scatter_set_default_candidate(&o, run_of[run].kind);
    o.terms = run_of[run].terms;
    o.clusters = run_of[run].clusters;
    return o;
}

static void open_medium_rows(struct table *t, int i)
{
    struct glint_stone stone;
    struct glint_error error;
    const double start = cpu_seconds();

    glint_stone_defaults(&stone);
    stone.side = t->side;
    stone.kernel = t->kernel;
    stone.pattern = i < 2 ? GLINT_STONE_CHESS : GLINT_STONE_VEINS;
    stone.fields = i ? 8 : 4;
    stone.seed = (uint32_t)i;
    if (i == 3) /* similar materials */
        stone.material[1] =
            (struct glint_stone_material){{1.6, 1.8, 2}, {0.004, 0.007, 0.012}};
    if (glint_scatter_compute(&stone, NULL, &t->rows[i], &error) != GLINT_OK)
        exit_with_error(error.text);
    t->seconds[i] = cpu_seconds() - start;
    for (int run = 0; run < RUNS; run++) {
        const struct glint_scatter_candidate o =
            make_fit_candidate((enum run)run);

        t->j[i][run] = judge_candidate(&t->rows[i], &o);
        fprintf(stderr, "%s, %s: %.0f s\n", stone_name[i], run_of[run].name,
                t->j[i][run].seconds);
    }
}

static void print_table_headings(const char *first, const char *const *column,
                                 int n)
{
    printf("\n| %s |", first);
    for (int i = 0; i < n; i++)
        printf(" %s |", column[i]);
    printf("\n|---|");
    for (int i = 0; i < n; i++)
        printf("---:|");
    printf("\n");
}

static void print_model_errors(const struct table *t)
{
    static const char *const columns[] = {
        "RMSE", "kB",  "smaller by", "entries, dB", "light, dB", "p50",
        "p95",  "max", "below 0",    "one way",     "energy",    "s"};

    printf("\n### All models\n\nRMSE, percentiles of texels and one-way (rms "
           "of R'(x, y) - R'(y, x)) are of the largest entry; light is the "
           "radiosity under lamps, shadows and a ramp; energy the largest sum "
           "of a row; kB as the source counts, 8 bytes a number; s processor "
           "seconds.\n");
    for (int i = 0; i < STONES; i++) {
        printf("\n%s", stone_name[i]);
        printf(", %d x %d texels, kernels of %d: rows in %.1f processor "
               "seconds\n",
               t->side, t->side, t->kernel, t->seconds[i]);
        print_table_headings("model", columns, 12);
        for (int run = 0; run < RUNS; run++) {
            const struct glint_scatter_judgement *j = &t->j[i][run];

            printf("| %s | %.5f | %.0f | %.0f x | %.1f | %.1f | %.5f | %.5f | "
                   "%.5f | %.2f %% | %.5f | %.3f | %.1f |\n",
                   run_of[run].name, j->rmse, j->bytes / 1e3, j->compression,
                   j->entry_db, j->light_db, j->p50, j->p95, j->largest,
                   100 * j->negative, j->one_way, j->energy, j->seconds);
        }
    }
}

/* Prints the RMSE of the candidates RUNS, per medium, next to the published
 * values. */
static void print_published_comparison(const struct table *t, const char *title,
                                       const enum run *runs, int n,
                                       const char *theirs)
{
    printf("\n### %s\n", title);
    print_table_headings("model", stone_name, STONES);
    for (int k = 0; k < n; k++) {
        printf("| %s |", run_of[runs[k]].name);
        for (int i = 0; i < STONES; i++)
            printf(" %.4f, %.0f kB |", t->j[i][runs[k]].rmse,
                   t->j[i][runs[k]].bytes / 1e3);
        printf("\n");
    }
    printf("\nSource, its own four or eight stones: %s\n", theirs);
}

static void print_published_tables(const struct table *t)
{
    static const enum run in_72[] = {TUCKER15, TUCKER5, PEERS10, PEERS20};
    static const enum run in_74[] = {LOG5, SVD5};
    static const enum run in_75[] = {LOG10, SVD10, SUBEDIT};
    static const enum run in_76[] = {SVD20,   PEERS20, SVD10,
                                     PEERS10, SVD5,    PEERS5};

    print_published_comparison(
        t, "Tucker and Peers (table 7.2; C9, C10)", in_72, 4,
        "Tucker .0102 .0242 .0072 .0152, 24.1 10.2 4.19 11.0 MiB; Peers at "
        "equal size .0134 beside .007, .0384 beside .0212.");
    print_published_comparison(
        t, "Logarithms (table 7.4; C6, C9)", in_74, 2,
        "S = 5 .0340 .0312 .0398 .0225 .0228 .0422 .0268 .0574, 1.48 2.48 "
        "7.88 1.56 8.96 5.82 2.05 5.32 MiB.");
    print_published_comparison(
        t, "Profiles (table 7.5; C9)", in_75, 3,
        "S = 10 .017 .028 .016 .013; SubEdit .05 .049 .029 .158.");
    print_published_comparison(
        t, "SVD and Peers at equal terms (table 7.6; C10)", in_76, 6,
        "S = 20 and 10: .0066 beside .0138, .0197 beside .0492.");
}

/* Copies ROWS to OFF and shifts a random 30 % of them by one texel. */
static void shift_random_rows(const struct glint_scatter_rows *rows,
                              struct glint_scatter_rows *off)
{
    const size_t texels = (size_t)rows->side * (size_t)rows->side;
    const size_t k2 = (size_t)rows->kernel * (size_t)rows->kernel;
    const size_t n = texels * 3 * k2;
    uint32_t seed = 1;

    *off = *rows;
    off->share = NULL;
    off->r = malloc(n * sizeof *off->r);
    if (!off->r)
        exit_with_error("out of memory");
    memcpy(off->r, rows->r, n * sizeof *off->r);
    for (size_t x = 0; x < texels; x++)
        if (rng_unit(&seed) < 0.3)
            for (size_t c = 0; c < 3; c++)
                memcpy(off->r + (x * 3 + c) * k2 + 1,
                       rows->r + (x * 3 + c) * k2, (k2 - 1) * sizeof *off->r);
}

/* Prints table C3. */
static void print_shifted_row_errors(struct table *t)
{
    static const int terms[] = {1, 2, 5, 15};
    static const char *const columns[] = {"T = 1", "T = 2", "T = 5", "T = 15"};
    struct glint_scatter_rows off;

    shift_random_rows(&t->rows[0], &off);
    printf("\n### Turned rows (C3): RMSE, P = 4, chess 4 x 4\n");
    print_table_headings("rows", columns, 4);
    for (int way = 0; way < 4; way++) {
        printf("| %s, %s |",
               way & 2 ? "30 % of them a texel off" : "as they are",
               way & 1 ? "turned" : "plain");
        for (int k = 0; k < 4; k++) {
            struct glint_scatter_candidate o = make_fit_candidate(TUCKER5);

            o.terms = terms[k];
            o.turned = way & 1;
            printf(" %.5f |",
                   judge_candidate(way & 2 ? &off : &t->rows[0], &o).rmse);
        }
        printf("\n");
    }
    printf("\nSource's prototype: T = 5 .00449, turned .00102.\n");
    free(off.r);
}

/* Prints table C5. */
static void print_polynomial_errors(struct table *t)
{
    static const int terms[GRID_TERMS] = {1, 2, 5, 10, 15};
    static const char *const columns[] = {"P = 1", "P = 2", "P = 3", "P = 4",
                                          "P = 5"};

    printf("\n### Terms and degrees (C5, figure 4.6): RMSE, and how much "
           "smaller than 8-byte rows, veins\n");
    print_table_headings("Tucker", columns, GRID_DEGREES);
    for (int k = 0; k < GRID_TERMS; k++) {
        printf("| T = %d |", terms[k]);
        for (int p = 1; p <= GRID_DEGREES; p++) {
            struct glint_scatter_candidate o = make_fit_candidate(TUCKER5);
            struct glint_scatter_judgement j;

            o.terms = terms[k];
            o.degree = p;
            j = judge_candidate(&t->rows[2], &o);
            printf(" %.5f, %.0f x |", j.rmse, j.compression);
        }
        printf("\n");
    }
}

/* Prints table C6. */
static void print_logarithm_errors(struct table *t)
{
    static const double as[] = {0.01, 0.1, 1, 10, 100, 1000};
    static const char *const columns[] = {
        "a = .01", ".1", "1", "10", "100", "1000", "searched: a, b"};
    const int n = t->kernel * t->kernel;

    printf("\n### ln(R' / a + b), b = 1, S = 5 (C6): RMSE, share of entries "
           "below 0 (%d entries a row)\n",
           n);
    print_table_headings("stone", columns, 7);
    for (int i = 0; i < STONES; i++) {
        const struct glint_scatter_judgement *found = &t->j[i][LOG5];

        printf("| %s |", stone_name[i]);
        for (int k = 0; k < 6; k++) {
            struct glint_scatter_candidate o = make_fit_candidate(LOG5);
            struct glint_scatter_judgement j;

            o.a = as[k];
            j = judge_candidate(&t->rows[i], &o);
            printf(" %.5f, %.2f %% |", j.rmse, 100 * j.negative);
        }
        printf(" %.5f: %g, %g |\n", found->rmse, found->candidate.a,
               found->candidate.b);
    }
    printf("\nSource: \"never negative\"; its prototype: .4 to 7 %%.\n");
}

/* Prints table C11: CPU seconds for the sums of all rows of a fit of five
 * terms, computed from all entries and from stored sums of the kernels. */
static void print_row_sum_times(struct table *t)
{
    const struct glint_scatter_options options = {GLINT_SCATTER_FACTORED, 5, 3};
    const int texels = t->side * t->side, k2 = t->kernel * t->kernel;
    const struct glint_scatter_candidate svd = make_fit_candidate(SVD5);
    volatile double plain = 0, kept = 0;
    struct glint_scatter_fit fit;
    double start, first, second;

    if (glint_scatter_fit(&t->rows[0], &options, NULL, &fit) != GLINT_OK)
        exit_with_error("out of memory");
    start = cpu_seconds();
    for (int x = 0; x < texels; x++)
        for (int d = 0; d < k2; d++) {
            double entry = 0;

            for (int j = 0; j < 5; j++)
                entry += fit.f[3 * j * texels + x] * fit.h[3 * j * k2 + d];
            plain = plain + entry;
        }
    first = cpu_seconds() - start;
    start = cpu_seconds();
    for (int again = 0; again < 100; again++) {
        double sum[5] = {0};

        for (int d = 0; d < 5 * k2; d++)
            sum[d / k2] += fit.h[3 * (d / k2) * k2 + d % k2];
        for (int x = 0; x < texels; x++) {
            double row = 0;

            for (int j = 0; j < 5; j++)
                row += fit.f[3 * j * texels + x] * sum[j];
            kept = kept + row;
        }
    }
    second = (cpu_seconds() - start) / 100;
    glint_scatter_fit_close(&fit);
    printf("\n### Sums of all rows (C11)\n\nOne channel, five terms: %.4f s "
           "entry by entry, %.6f s by kept sums of h, %.0f times less; %.0f "
           "times less multiplications (128 texels, kernels of 29: 800). "
           "Source: 3.756 s and .0427 s, 1.135 and .0314 by its model.\n",
           first, second, first / second,
           glint_scatter_candidate_sums(&svd, texels, k2, false) /
               glint_scatter_candidate_sums(&svd, texels, k2, true));
}

/* Returns the CPU seconds of scattering an image by FIT, entry by entry. */
static double time_scattering_by_entries(const struct glint_scatter_fit *fit,
                                         const double *light, double *out)
{
    const int n = fit->side * fit->side, k2 = fit->kernel * fit->kernel;
    const double start = cpu_seconds();

    for (int x = 0; x < n; x++)
        for (int c = 0; c < 3; c++)
            for (int d = 0; d < k2; d++) {
                double entry = 0;

                for (int j = 0; j < fit->kernels; j++)
                    entry += fit->f[(3 * j + c) * n + x] *
                             fit->h[(3 * j + c) * k2 + d];
                out[3 * x + c] += light[3 * x + c] * entry;
            }
    return cpu_seconds() - start;
}

/* Returns the CPU seconds of scattering an image by the baked integers of the
 * fit to ROWS. */
static double time_scattering_by_integers(struct glint_scatter_rows *rows,
                                          const double *light, double *out)
{
    struct glint_scatter_fit fit;
    struct glint_stone_report report;
    struct glint_translucent stone;
    struct glint_stone_text text;
    struct glint_error error;
    unsigned char *data = NULL;
    const char *reason;
    double start, took;
    size_t bytes;

    glint_stone_text_defaults(&text);
    if (glint_scatter_fit(rows, &text.fit, NULL, &fit) != GLINT_OK ||
        glint_stone_bake(&fit, &text, "x", 0, &data, &bytes, &report, &error) !=
            GLINT_OK ||
        glint_translucent_open(&stone, data, bytes, &reason) != GLINT_OK)
        exit_with_error("no stone");
    start = cpu_seconds();
    for (int i = 0; i < 10; i++)
        glint_stone_light(&stone, light, out);
    took = (cpu_seconds() - start) / 10;
    glint_scatter_fit_close(&fit);
    free(data);
    return took;
}

/* Prints table C12: CPU seconds of scattering an image of 64 x 64 texels. */
static void print_scattering_times(void)
{
    enum { SIDE = 64, N = 3 * SIDE * SIDE };
    static double light[N], out[N];
    const struct glint_scatter_options svd = {GLINT_SCATTER_FACTORED, 5, 3};
    struct glint_scatter_rows rows;
    struct glint_scatter_fit fit;
    struct glint_error error;
    struct glint_stone stone;
    double start, by_rows_s, by_terms_s, by_integers_s;

    glint_stone_defaults(&stone);
    stone.side = SIDE;
    stone.kernel = 21;
    if (glint_scatter_compute(&stone, NULL, &rows, &error) != GLINT_OK ||
        glint_scatter_fit(&rows, &svd, NULL, &fit) != GLINT_OK)
        exit_with_error("no rows");
    glint_scatter_test_light(SIDE, light);
    start = cpu_seconds();
    for (int i = 0; i < 5; i++)
        glint_scatter_light_rows(&rows, light, out);
    by_rows_s = (cpu_seconds() - start) / 5;
    by_terms_s = time_scattering_by_entries(&fit, light, out);
    by_integers_s = time_scattering_by_integers(&rows, light, out);
    printf("\n### One picture (C12)\n\n64 x 64 texels, RGB, kernels of 21, "
           "one thread: %.1f ms by all rows, %.1f ms by five terms entry by "
           "entry, %.2f ms by the integers of four kernels of rank 3, in plain "
           "C. Source: 12.7 to 14.0 minutes raw, 14.3 to 17.5 by SubEdit, 14.5 "
           "to 21.7 by SVD.\n",
           1e3 * by_rows_s, 1e3 * by_terms_s, 1e3 * by_integers_s);
    glint_scatter_fit_close(&fit);
    glint_scatter_close(&rows);
}

int main(void)
{
    static struct table t = {.side = 48, .kernel = 21};

    for (int i = 0; i < STONES; i++)
        open_medium_rows(&t, i);
    print_published_tables(&t);
    print_shifted_row_errors(&t);
    print_polynomial_errors(&t);
    print_logarithm_errors(&t);
    print_row_sum_times(&t);
    print_scattering_times();
    print_model_errors(&t);
    for (int i = 0; i < STONES; i++)
        glint_scatter_close(&t.rows[i]);
    return 0;
}
