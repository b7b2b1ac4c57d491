/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "lab/bench.h"
#include "linux/sets.h"
#include "glint/measure.h"

/* ------------------------------------------------------------------ canvas */

static struct bench_canvas *canvas_of(struct bench *b, int width, int height)
{
    struct bench_canvas *c = &b->canvas[b->n_canvases];

    for (int i = 0; i < b->n_canvases; i++)
        if (b->canvas[i].of.image.width == width &&
            b->canvas[i].of.image.height == height)
            return &b->canvas[i];
    if (b->n_canvases == 8 ||
        canvas_init(&c->of, b->format, width, height) != GLINT_OK)
        return NULL;
    b->n_canvases++;
    return c;
}

/* ------------------------------------------------------------------- tests */

/* The differences of a test from the plainest one of its lens. */
struct variation {
    int width, height; /* 0: as asked */
    int lights;
    int two_threads;     /* for this case, whatever was asked for */
    const char *kernels; /* NULL: as asked */
    unsigned sets;       /* instruction sets that the kernels may use */
    double angle;
    double star_stops; /* stars of lamps of so many stops over white, alone; 0:
                          ghosts */
};

static const struct variation variations[] = {
    {0, 0, 1, 0, NULL, ~0U, 12, 0}, /* the plain case */
    {0, 0, 1, 0, "c", 0, 12, 0},
    {0, 0, 1, 0, "sse41", GLINT_SET_SSE41, 12, 0},
    {0, 0, 1, 1, NULL, ~0U, 12, 0},
    {0, 0, 2, 0, NULL, ~0U, 12, 0},
    {0, 0, 8, 0, NULL, ~0U, 12, 0},
    {0, 0, 64, 0, NULL, ~0U, 12, 0},
    {0, 0, 588, 0, NULL, ~0U, 12, 0},
    {0, 0, 10000, 0, NULL, ~0U, 12, 0},
    {640, 360, 1, 0, NULL, ~0U, 12, 0},
    {1280, 720, 1, 0, NULL, ~0U, 12, 0},
    {3840, 2160, 1, 0, NULL, ~0U, 12, 0},
    {0, 0, 0, 0, NULL, ~0U, 12, 0},
    {.lights = 1, .sets = ~0U, .angle = 12, .star_stops = 12},
    {.lights = 10, .sets = ~0U, .angle = 12, .star_stops = 2},
    {0, 0, 1, 0, NULL, ~0U, 75, 0}, /* a light beyond the angles of models */
};

/* Sets t->scale to the exposure at which the 99.9th percentile of the flare's
 * luminance is white. */
static enum glint_status expose(struct test *t)
{
    const int w = t->canvas->of.image.width, h = t->canvas->of.image.height;
    struct glint_float_image flare = {
        w, h, malloc(3 * (size_t)w * (size_t)h * sizeof(float))};
    enum glint_status status = GLINT_E_MEMORY;

    if (flare.rgb)
        status = glint_frame_draw_alone(&t->frame, t->lamp, t->n_lamps, 1,
                                        flare.rgb, &t->report);
    if (status == GLINT_OK)
        t->scale = glint_measure_exposure(&flare);
    free(flare.rgb);
    return status;
}

/* Makes T draw nothing but stars of lamps of STOPS over white. */
static void make_star(struct test *t, double stops)
{
    for (int i = 0; i < t->n_lamps; i++)
        t->lamp[i].power = exp2(stops);
    t->scale = t->frame.star.share = 1;
    t->frame.star.is_alone = t->frame.star.is_bare = true;
}

static int add_test(struct bench *b, const struct settings *settings,
                    const struct variation *v)
{
    struct test *t = &b->test[b->n_tests];
    const int width = v->width ? v->width : b->width;
    const int height = v->height ? v->height : b->height;
    struct glint_lamp *lamp;
    int code;

    if (b->n_tests == MAX_CASES)
        return EXIT_OK;
    t->settings = settings;
    t->n_lamps = v->lights;
    t->canvas = canvas_of(b, width, height);
    lamp = calloc((size_t)v->lights + 1, sizeof *lamp);
    if (!t->canvas || !lamp) {
        free(lamp);
        return tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    }
    code = settings_frame(b->tool, settings,
                          settings_view(settings, width, height), &t->frame);
    if (code != EXIT_OK) {
        free(lamp);
        return code;
    }
    t->lamp = lamp;
    t->threads = v->two_threads       ? 2
                 : b->tool->n_threads ? b->tool->n_threads
                                      : 1;
    t->kernels = v->kernels ? v->kernels : b->tool->kernels;
    t->psnr_db = (double)NAN;
    t->frame.cfg.workers = v->two_threads       ? b->two
                           : b->tool->n_threads ? b->tool->workers
                                                : b->one;
    t->frame.cfg.sets &= v->sets;
    canvas_lamps(t->lamp, v->lights, v->angle);
    b->n_tests++;
    if (expose(t) != GLINT_OK)
        return tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    /* Such a light is exposed as if it were in the picture. */
    if (v->angle != 12) {
        canvas_lamps(t->lamp, v->lights, 12);
        if (expose(t) != GLINT_OK)
            return tool_fail(b->tool, GLINT_E_MEMORY, NULL);
        canvas_lamps(t->lamp, v->lights, v->angle);
    }
    if (v->star_stops > 0)
        make_star(t, v->star_stops);
    return EXIT_OK;
}

int bench_add_one(struct bench *b, const struct settings *settings, int width,
                  int height, int lights)
{
    const struct variation v = {width, height, lights, 0, NULL, ~0U, 12, 0};

    return add_test(b, settings, &v);
}

/* Adds the cases of --sizes. */
static int add_sizes(struct bench *b, const struct settings *settings)
{
    static const int size[][2] = {
        {640, 360}, {1280, 720}, {1920, 1080}, {3840, 2160}};
    int code = EXIT_OK;

    for (size_t i = 0; i < sizeof size / sizeof *size && code == EXIT_OK; i++)
        code = bench_add_one(b, settings, size[i][0], size[i][1], 1);
    return code;
}

/* Frames in which a budget may settle before it is timed. */
enum { SETTLING = 12 };

/* Adds the plain case for each budget, held to that budget. */
static int add_budgets(struct bench *b, const struct settings *settings)
{
    int code = EXIT_OK;

    for (int i = 0; i < b->n_budgets && code == EXIT_OK; i++) {
        struct test *t = &b->test[b->n_tests];
        const int n = b->n_tests;

        code = bench_add_one(b, settings, 0, 0, 1);
        if (b->n_tests == n || code != EXIT_OK)
            break;
        glint_budget_init(&t->frame.budget, b->budget_ms[i]);
        if (glint_frame_calibrate(&t->frame) != GLINT_OK)
            code = tool_fail(b->tool, GLINT_E_MEMORY, NULL);
        for (int k = 0; k < SETTLING && code == EXIT_OK; k++)
            if (bench_run(t, 0) != GLINT_OK)
                code = tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    }
    return code;
}

int bench_add(struct bench *b, const struct settings *settings)
{
    const int n = b->all ? (int)(sizeof variations / sizeof *variations) : 1;
    int code = EXIT_OK;

    if (b->n_budgets)
        return add_budgets(b, settings);
    if (b->sizes)
        return add_sizes(b, settings);
    for (int i = 0; i < n && code == EXIT_OK; i++)
        if (variations[i].sets == ~0U ||
            !(variations[i].sets & ~glint_system_sets()))
            code = add_test(b, settings, &variations[i]);
    return code;
}

void bench_move(struct test *t, int round, int n)
{
    if (t->n_lamps > 0)
        t->lamp[0].theta_deg = 8 + 8 * (round + 0.5) / n;
}

/* Returns the ms of drawing the last frame once more without a picture. */
static double accumulate_ms(const struct test *t)
{
    const double t0 = tool_seconds();

    if (t->n_lamps > 0)
        glint_flare_draw(t->frame.flare, NULL);
    return 1e3 * (tool_seconds() - t0);
}

enum glint_status bench_run(struct test *t, int round)
{
    struct canvas *c = &t->canvas->of;
    enum glint_status status;
    clock_t cpu0 = 0;
    double t0, cpu_ms;

    canvas_fresh(c);
    if (t->series) /* only for a series: the system call cools the caches of
                      small frames */
        cpu0 = clock();
    t0 = tool_seconds();
    status = glint_frame_draw(&t->frame, t->lamp, t->n_lamps, t->scale,
                              &c->image, &t->report);
    t->ms[WHOLE][round] = 1e3 * (tool_seconds() - t0);
    cpu_ms = t->series ? 1e3 * (double)(clock() - cpu0) / CLOCKS_PER_SEC : 0;
    if (t->cpu_ms == 0 || cpu_ms < t->cpu_ms)
        t->cpu_ms = cpu_ms;
    t->wrong[round] =
        t->report.predicted_ms /
            (t->report.plan_ms + t->report.bin_ms + t->report.draw_ms) -
        1;
    t->ms[PLAN][round] = t->report.plan_ms;
    t->ms[TRANSFER][round] = t->report.trace_ms;
    t->ms[BIN][round] = t->report.bin_ms;
    t->ms[DRAW][round] = t->report.draw_ms;
    t->ms[ACCUMULATE][round] = accumulate_ms(t);
    t->ms[COMPOSITE][round] = t->ms[DRAW][round] - t->ms[ACCUMULATE][round];
    return status;
}

int bench_psnr(struct bench *b, struct test *t)
{
    const int w = t->canvas->of.image.width, h = t->canvas->of.image.height;
    const size_t n = 3 * (size_t)w * (size_t)h;
    struct glint_float_image want = {w, h, malloc(n * sizeof(float))};
    uint8_t *want_codes = NULL, *got = malloc(n);
    enum glint_status status = GLINT_E_MEMORY;
    double exposure;
    struct glint_measure m;

    if (want.rgb && got)
        status =
            canvas_exact(b->tool, t->settings, t->lamp, t->n_lamps, 128, &want);
    if (status == GLINT_OK) {
        exposure = glint_measure_exposure(&want);
        want_codes = glint_measure_encode(&want, exposure);
        status = want_codes ? canvas_codes(&t->frame, t->lamp, t->n_lamps,
                                           exposure, got, &t->report)
                            : GLINT_E_MEMORY;
    }
    if (status == GLINT_OK) {
        glint_measure_codes(want_codes, got, w, h, &m);
        t->psnr_db = m.psnr_db;
    }
    free(want.rgb);
    free(want_codes);
    free(got);
    return status == GLINT_OK ? EXIT_OK : tool_fail(b->tool, status, NULL);
}
