/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lab/bench.h"
#include "options/json_writer.h"

static const char *const stage_names[STAGES] = {
    "plan", "transfer", "bin", "draw", "accumulate", "composite", "whole"};

static const char *raster_of(const struct test *t)
{
    return t->frame.star.is_alone ? "star" : "edges";
}

static double quality_of(const struct test *t)
{
    return t->report.quality >= 0 ? t->report.quality
                                  : t->settings->options.quality;
}

/* Returns the width of the column of STAGE in characters. */
static int column(int stage)
{
    const int n = (int)strlen(stage_names[stage]);

    return n > 7 ? n : 7;
}

/* Returns the median size of the relative errors of T's predictions. */
static double off_by(const struct bench *b, const struct test *t)
{
    double size[MAX_ROUNDS];

    for (int i = 0; i < b->rounds; i++)
        size[i] = fabs(t->wrong[i]);
    return canvas_median(size, b->rounds);
}

static void print_test(const struct bench *b, const struct test *t)
{
    const double floor_ms = canvas_median(t->canvas->floor_ms, b->rounds);
    const double ms = canvas_median(t->ms[WHOLE], b->rounds);

    printf("%-22s %4dx%-4d %5d %2d %-5s %-5s %8.3f %7.1f ",
           t->settings->lens.name, t->canvas->of.image.width,
           t->canvas->of.image.height, t->n_lamps, t->threads, raster_of(t),
           t->kernels, ms, ms / floor_ms);
    for (int s = 0; s < WHOLE; s++)
        printf(" %*.2f", column(s),
               canvas_median(t->ms[s], b->rounds) / floor_ms);
    printf("  %7d %6.2f", t->report.stats.primitives,
           (double)(t->report.peak_bytes + t->report.star_bytes) / (1 << 20));
    if (!isnan(t->psnr_db))
        printf("  %.1f", t->psnr_db);
    if (t->frame.budget.ms > 0)
        printf(
            "  budget %g: %.2f of it, quality %.2f, predicted within %.0f %%",
            t->frame.budget.ms, ms / t->frame.budget.ms, t->report.quality,
            100 * off_by(b, t));
    printf("%s%s\n", t->series ? "  " : "", t->series ? t->series : "");
}

void bench_print(const struct bench *b)
{
    printf("floor %.3f ms (%dx%d %s, %d rounds); stages are ratios to it\n",
           canvas_median(b->canvas[0].floor_ms, b->rounds),
           b->canvas[0].of.image.width, b->canvas[0].of.image.height,
           b->format_word, b->rounds);
    printf("%-22s %9s %5s %2s %-5s %-5s %8s %7s ", "lens", "size", "light",
           "th", "by", "sets", "ms", "ratio");
    for (int s = 0; s < WHOLE; s++)
        printf(" %*s", column(s), stage_names[s]);
    printf("  %7s %6s%s\n", "prims", "MiB", b->psnr ? "  dB" : "");
    for (int i = 0; i < b->n_tests; i++)
        print_test(b, &b->test[i]);
}

static void json_test(struct json_writer *json, const struct bench *b,
                      const struct test *t)
{
    const double floor_ms = canvas_median(t->canvas->floor_ms, b->rounds);
    const double ms = canvas_median(t->ms[WHOLE], b->rounds);

    json_write(json, "\n{lens: %s", t->settings->lens.name);
    if (t->series)
        json_write(json, "series: %s, cpu_ms: %.3f", t->series, t->cpu_ms);
    json_write(json,
               "width: %d, height: %d, format: %s, lights: %d, threads: %d, "
               "raster: %s, kernels: %s, quality: %.3f, ms: %.4f, ratio: %.3f",
               t->canvas->of.image.width, t->canvas->of.image.height,
               b->format_word, t->n_lamps, t->threads, raster_of(t), t->kernels,
               quality_of(t), ms, ms / floor_ms);
    for (int s = 0; s < WHOLE; s++)
        json_write(json, "%s_ms: %.4f", stage_names[s],
                   canvas_median(t->ms[s], b->rounds));
    json_write(json, "psnr_db: %.2f", t->psnr_db);
    if (t->frame.budget.ms > 0)
        json_write(json,
                   "budget_ms: %g, achieved: %.4f, prediction_error: %.4f",
                   t->frame.budget.ms, ms / t->frame.budget.ms, off_by(b, t));
    json_write(json,
               "drawn_lights: %d, ghosts: %d, bundles: %d, primitives: %d, "
               "tiles: %d, arena_bytes: %zu, star_bytes: %zu}",
               t->report.drawn_lights, t->report.ghosts,
               t->report.stats.bundles, t->report.stats.primitives,
               t->report.tiles, t->report.peak_bytes, t->report.star_bytes);
}

void bench_print_json(const struct bench *b)
{
    struct json_writer json = {.to = stdout};

    json_write(&json, "{floor_ms: %.5f, rounds: %d, cases: [",
               canvas_median(b->canvas[0].floor_ms, b->rounds), b->rounds);
    for (int i = 0; i < b->n_tests; i++)
        json_test(&json, b, &b->test[i]);
    json_write(&json, "\n]}\n");
}
