/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/measure.h"
#include "measure/sweep.h"

/* max time that is spent on a point, ms; further rounds skip the point */
#define MAX_POINT_MS 4000.0

enum { MAX_OPEN = 12 };

/* A lens opened with certain settings */
struct sweep_lens {
    struct settings settings;
    struct opened_lens lens;
};

/* A point that is being measured. */
struct run {
    struct sweep_point *point;
    const struct sweep_lens *open;
    struct glint_engine *engine;
    struct glint_engine_report report;
    double ms[SWEEP_ROUNDS];
    int n;
    double spent_ms;
};

/* State of measuring one case. */
struct bay {
    struct sweep *s;
    const struct sweep_case *c;
    struct sweep_lens open[MAX_OPEN];
    int n_open;
    struct run *run;
    struct canvas canvas;
    struct glint_lamp *lamp;
    double exposure;
    /* exact image; rgb is NULL until it is drawn */
    struct glint_float_image exact;
};

/* ------------------------------------------------------------------ set-up */

static bool has_same_exact_image(const struct settings *a,
                                 const struct settings *b)
{
    return a->tolerance == b->tolerance && a->n_wavelengths == b->n_wavelengths;
}

/* Returns the lens opened with the options of SET. Settings with the same
 * tolerance and number of wavelengths share an opened lens. On failure prints
 * the error, sets *CODE to the exit code and returns NULL. */
static const struct sweep_lens *
find_lens(struct bay *b, const struct sweep_setting *set, int *code)
{
    struct settings asked = b->s->base;
    struct sweep_lens *open;

    sweep_apply_setting(&asked, set, true);
    for (int i = 0; i < b->n_open; i++)
        if (has_same_exact_image(&b->open[i].settings, &asked))
            return &b->open[i];
    if (b->n_open == MAX_OPEN) {
        *code = tool_usage(
            b->s->tool,
            "a case has more than %d different pairs of tolerance and number "
            "of wavelengths",
            MAX_OPEN);
        return NULL;
    }
    open = &b->open[b->n_open++];
    open->settings = asked;
    *code = opened_lens_open(b->s->tool, &open->lens, &open->settings,
                             b->s->lens[b->c->lens]);
    return *code == EXIT_OK ? open : NULL;
}

static int prepare_run(struct bay *b, struct run *r)
{
    struct glint_engine_config cfg;
    struct glint_error error = {""};
    struct settings asked;
    enum glint_status status;
    int code = EXIT_OK;

    r->open = find_lens(b, &r->point->set, &code);
    if (!r->open)
        return code;
    asked = r->open->settings;
    sweep_apply_setting(&asked, &r->point->set, false);
    canvas_open_engine(b->s->tool, &r->open->lens, &asked, b->c->width,
                       b->c->height, &cfg);
    cfg.workers = b->s->tool->n_threads ? b->s->tool->workers : NULL;
    status = glint_engine_create(&r->engine, &cfg, &error);
    r->point->metric[SWEEP_MODEL_BYTES] = (double)r->open->lens.model.bytes;
    return status == GLINT_OK ? EXIT_OK
                              : tool_fail(b->s->tool, status, error.text);
}

static int open_case_measurement(struct bay *b)
{
    const struct sweep_case *c = b->c;
    int code = EXIT_OK;

    b->run = calloc((size_t)c->n, sizeof *b->run);
    b->lamp = calloc((size_t)c->n_lamps, sizeof *b->lamp);
    b->exact = (struct glint_float_image){c->width, c->height, NULL};
    if (!b->run || !b->lamp ||
        canvas_init(&b->canvas, GLINT_YUYV, c->width, c->height) != GLINT_OK)
        return tool_fail(b->s->tool, GLINT_E_MEMORY, NULL);
    canvas_set_lamps(b->lamp, c->n_lamps, c->angle);
    for (int i = 0; i < c->n && code == EXIT_OK; i++) {
        b->run[i].point = &b->s->point[c->first + i];
        code = prepare_run(b, &b->run[i]);
    }
    if (code == EXIT_OK &&
        canvas_compute_exposure(b->run[0].engine, b->lamp, c->n_lamps,
                                &b->exposure) != GLINT_OK)
        code = tool_fail(b->s->tool, GLINT_E_MEMORY, NULL);
    return code;
}

static void close_case_measurement(struct bay *b)
{
    for (int i = 0; b->run && i < b->c->n; i++)
        glint_engine_destroy(b->run[i].engine);
    for (int i = 0; i < b->n_open; i++)
        opened_lens_close(&b->open[i].lens);
    canvas_free(&b->canvas);
    free(b->run);
    free(b->lamp);
    free(b->exact.rgb);
}

/* ------------------------------------------------------------------ timing */

/* Draws R's frame and records its time. Round -1 warms up the caches and
 * records nothing. */
static enum glint_status draw_and_time_run(struct bay *b, struct run *r,
                                           int round)
{
    enum glint_status status;
    double t0;

    canvas_restore_background(&b->canvas);
    t0 = tool_clock_s();
    status = glint_engine_draw_at(r->engine, b->lamp, b->c->n_lamps,
                                  b->exposure, &b->canvas.image, &r->report);
    if (round < 0)
        return status;
    r->ms[r->n] = 1e3 * (tool_clock_s() - t0);
    r->spent_ms += r->ms[r->n++];
    return status;
}

/* Measures the times of all points and of the memory floor; each round measures
 * every point once. The progress rises from FROM to TO, 0 .. 1. */
static enum glint_status time_all_points(struct bay *b,
                                         struct tool_progress *progress,
                                         double from, double to)
{
    const int n = b->s->rounds;
    enum glint_status status = GLINT_OK;

    for (int round = -1; round < n && status == GLINT_OK; round++) {
        canvas_time_memory_floor(&b->canvas, round < 0 ? 0 : round);
        for (int i = 0; i < b->c->n && status == GLINT_OK; i++)
            if (round < 1 || b->run[i].spent_ms < MAX_POINT_MS)
                status = draw_and_time_run(b, &b->run[i], round);
        tool_progress_show(progress,
                           from + (to - from) * (round + 2) / (n + 1));
    }
    for (int i = 0; i < b->c->n && status == GLINT_OK; i++) {
        const struct run *const r = &b->run[i];
        double *const m = b->s->point[b->c->first + i].metric;

        m[SWEEP_MS] = canvas_find_median(r->ms, r->n);
        m[SWEEP_FLOOR_MS] = canvas_find_median(b->canvas.floor_ms, n);
        m[SWEEP_RATIO] = m[SWEEP_MS] / m[SWEEP_FLOOR_MS];
        m[SWEEP_ARENA_BYTES] = (double)r->report.peak_bytes;
        m[SWEEP_GHOSTS] = r->report.ghosts;
        m[SWEEP_BUNDLES] = r->report.stats.bundles;
        m[SWEEP_EDGES] = r->report.stats.primitives;
        m[SWEEP_TILES] = r->report.tiles;
    }
    return status;
}

/* ---------------------------------------------------------------- pictures */

static double sum_pixel_light(const struct glint_float_image *image)
{
    double sum = 0;

    for (size_t i = 0; i < 3 * (size_t)image->width * (size_t)image->height;
         i++)
        sum += (double)image->rgb[i];
    return sum;
}

/* Sets the metric SWEEP_FLUX_ERROR of R to (total light of its flare / total
 * light of the exact image) - 1. The flare is planned for 8-bit codes, like the
 * timed frames, but drawn in linear light. */
static enum glint_status measure_flux_error(struct bay *b, struct run *r)
{
    const size_t n = 3 * (size_t)b->c->width * (size_t)b->c->height;
    struct glint_float_image layer = {b->c->width, b->c->height,
                                      malloc(n * sizeof(float))};
    struct glint_engine_report report;
    enum glint_status status = GLINT_E_MEMORY;

    if (layer.rgb)
        status = glint_engine_render(
            r->engine, b->lamp, b->c->n_lamps, b->exposure,
            GLINT_ENGINE_ALL | GLINT_ENGINE_CODES, layer.rgb, &report);
    if (status == GLINT_OK)
        r->point->metric[SWEEP_FLUX_ERROR] =
            sum_pixel_light(&layer) /
                (b->exposure * sum_pixel_light(&b->exact)) -
            1;
    free(layer.rgb);
    return status;
}

/* Measures the error of R's frame against EXACT_CODES. CODES is scratch memory
 * for R's codes. */
static enum glint_status measure_error_of_run(struct bay *b, struct run *r,
                                              const uint8_t *exact_codes,
                                              double exposure, uint8_t *codes)
{
    struct glint_engine_report report;
    struct glint_measure m;
    const enum glint_status status = canvas_draw_flare_codes(
        r->engine, b->lamp, b->c->n_lamps, exposure, codes, &report);

    if (status != GLINT_OK)
        return status;
    glint_measure_codes(exact_codes, codes, b->c->width, b->c->height, &m);
    r->point->metric[SWEEP_PSNR_DB] = m.psnr_db;
    r->point->metric[SWEEP_SSIM] = m.ssim;
    r->point->metric[SWEEP_P99] = m.p99;
    return measure_flux_error(b, r);
}

static enum glint_status measure_all_points(struct bay *b,
                                            struct tool_progress *progress,
                                            double from, double to)
{
    const size_t n = 3 * (size_t)b->c->width * (size_t)b->c->height;
    enum glint_status status = GLINT_E_MEMORY;
    uint8_t *exact_codes = NULL, *codes = malloc(n);

    b->exact.rgb = malloc(n * sizeof(float));
    if (b->exact.rgb && codes)
        status = canvas_draw_exact(b->s->tool, &b->open[0].lens,
                                   &b->open[0].settings, b->lamp, b->c->n_lamps,
                                   b->s->grid, &b->exact);
    if (status == GLINT_OK) {
        const double exposure = glint_measure_exposure(&b->exact);

        exact_codes = glint_measure_encode(&b->exact, exposure);
        if (!exact_codes)
            status = GLINT_E_MEMORY;
        for (int i = 0; i < b->c->n && status == GLINT_OK; i++) {
            status = measure_error_of_run(b, &b->run[i], exact_codes, exposure,
                                          codes);
            tool_progress_show(progress,
                               from + (to - from) * (i + 1) / b->c->n);
        }
    }
    free(exact_codes);
    free(codes);
    return status;
}

int sweep_measure_case(struct sweep *s, int c, struct tool_progress *progress)
{
    const double from = (double)s->scase[c].first / s->n_points;
    const double to = from + (double)s->scase[c].n / s->n_points;
    struct bay *b = calloc(1, sizeof *b);
    enum glint_status status = GLINT_OK;
    int code;

    if (!b)
        return tool_fail(s->tool, GLINT_E_MEMORY, NULL);
    b->s = s;
    b->c = &s->scase[c];
    code = open_case_measurement(b);
    if (code == EXIT_OK)
        status = time_all_points(b, progress, from, (from + to) / 2);
    if (code == EXIT_OK && status == GLINT_OK)
        status = measure_all_points(b, progress, (from + to) / 2, to);
    if (code == EXIT_OK && status != GLINT_OK)
        code = tool_fail(s->tool, status, NULL);
    close_case_measurement(b);
    free(b);
    return code;
}
