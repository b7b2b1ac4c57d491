/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench.h"
#include "measure.h"

/* -------------------------------------------------------------------- canvas
 */

/* A dim evening: luma rises to the right, colours turn downwards. */
static void paint(struct canvas *c)
{
    for (size_t i = 0; i < c->bytes; i++)
        c->fresh[i] = (uint8_t)(16 + i % 97 / 3 + (i >> 12) % 40);
}

static struct canvas *canvas_of(struct bench *b, int width, int height)
{
    struct canvas *c = &b->canvas[b->n_canvases];

    for (int i = 0; i < b->n_canvases; i++)
        if (b->canvas[i].image.width == width &&
            b->canvas[i].image.height == height)
            return &b->canvas[i];
    if (b->n_canvases == 8)
        return NULL;
    c->image = (struct glint_image){.format = b->format,
                                    .width = width,
                                    .height = height,
                                    .range = GLINT_RANGE_LIMITED,
                                    .matrix = GLINT_MATRIX_BT709,
                                    .transfer = GLINT_TONE_BT709};
    c->bytes = glint_image_bytes(b->format, width, height);
    c->fresh = malloc(c->bytes);
    c->mem = malloc(c->bytes);
    if (!c->fresh || !c->mem)
        return NULL;
    glint_image_place(&c->image, c->mem);
    paint(c);
    b->n_canvases++;
    return c;
}

/* In place, with a layer that stays in the cache; written so that compilers
 * make vectors of it. */
static void add_layer(uint8_t *restrict px, const uint8_t *restrict layer,
                      size_t bytes)
{
    for (size_t i = 0; i + 256 <= bytes; i += 256)
        for (size_t k = 0; k < 256; k++) {
            const uint8_t sum = (uint8_t)(px[i + k] + layer[k]);

            px[i + k] = sum < layer[k] ? 255 : sum;
        }
}

double bench_floor(struct canvas *c)
{
    static uint8_t layer[256];
    double t0;

    layer[1]++;
    memcpy(c->mem, c->fresh, c->bytes);
    t0 = tool_seconds();
    add_layer(c->mem, layer, c->bytes);
    return 1e3 * (tool_seconds() - t0);
}

/* --------------------------------------------------------------------- tests
 */

/* What of a test differs from the plainest one of its lens. */
struct variation {
    int width, height; /* 0: as asked */
    int lights;
    int two_threads, by_cells; /* whatever was asked for */
    const char *kernels;       /* NULL: as asked */
    unsigned sets;             /* which those may use */
    double angle;
};

static const struct variation variations[] = {
    {0, 0, 1, 0, 0, NULL, ~0U, 12}, /* the plain one */
    {0, 0, 1, 0, 1, NULL, ~0U, 12},
    {0, 0, 1, 0, 0, "c", 0, 12},
    {0, 0, 1, 0, 0, "sse41", GLINT_SET_SSE41, 12},
    {0, 0, 1, 1, 0, NULL, ~0U, 12},
    {0, 0, 2, 0, 0, NULL, ~0U, 12},
    {0, 0, 8, 0, 0, NULL, ~0U, 12},
    {0, 0, 64, 0, 0, NULL, ~0U, 12},
    {0, 0, 588, 0, 0, NULL, ~0U, 12},
    {0, 0, 10000, 0, 0, NULL, ~0U, 12},
    {640, 360, 1, 0, 0, NULL, ~0U, 12},
    {1280, 720, 1, 0, 0, NULL, ~0U, 12},
    {3840, 2160, 1, 0, 0, NULL, ~0U, 12},
    {0, 0, 0, 0, 0, NULL, ~0U, 12},
    {0, 0, 1, 0, 0, NULL, ~0U, 75}, /* farther out than models go */
};

/* Equal lights, but of hundreds few are bright: the kth brightest has 1 / k of
 * the power of the first. */
static double power_of(int i, int n)
{
    return 1.0 / (n > 64 ? 1 + i : n);
}

static void set_lamps(struct test *t, int n, double angle)
{
    t->n_lamps = n;
    for (int i = 0; i < n; i++)
        t->lamp[i] = (struct glint_lamp){i ? fmod(angle + 2.39 * i, 24) : angle,
                                         fmod(33 + 137.5 * i, 360),
                                         power_of(i, n),
                                         {1, 1, 1}};
}

/* The exposure at which the flare is as bright as the picture's white. */
static enum glint_status expose(struct test *t)
{
    const int w = t->canvas->image.width, h = t->canvas->image.height;
    struct glint_float_image flare = {
        w, h, malloc(3 * (size_t)w * (size_t)h * sizeof(float))};
    enum glint_status status = GLINT_E_MEMORY;

    if (flare.rgb)
        status = frame_draw_alone(&t->frame, t->lamp, t->n_lamps, 1, flare.rgb,
                                  &t->report);
    if (status == GLINT_OK)
        t->scale = measure_exposure(&flare);
    free(flare.rgb);
    return status;
}

static int add_test(struct bench *b, const struct scene *scene,
                    const struct variation *v)
{
    struct test *t = &b->test[b->n_tests];
    const int width = v->width ? v->width : b->width;
    const int height = v->height ? v->height : b->height;
    struct glint_lamp *lamp;
    int code;

    if (b->n_tests == MAX_CASES)
        return EXIT_OK;
    t->scene = scene;
    t->canvas = canvas_of(b, width, height);
    lamp = calloc((size_t)v->lights + 1, sizeof *lamp);
    if (!t->canvas || !lamp) {
        free(lamp);
        return tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    }
    code = scene_frame(b->tool, scene, scene_view(scene, width, height),
                       &t->frame);
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
    if (v->by_cells)
        t->frame.cfg.raster = GLINT_RASTER_CELLS;
    t->frame.cfg.sets &= v->sets;
    set_lamps(t, v->lights, v->angle);
    b->n_tests++;
    if (expose(t) != GLINT_OK)
        return tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    if (v->angle != 12) { /* exposed as if it were in the picture */
        set_lamps(t, v->lights, 12);
        if (expose(t) != GLINT_OK)
            return tool_fail(b->tool, GLINT_E_MEMORY, NULL);
        set_lamps(t, v->lights, v->angle);
    }
    return EXIT_OK;
}

int bench_add_one(struct bench *b, const struct scene *scene, int width,
                  int height, int lights)
{
    const struct variation v = {width, height, lights, 0, 0, NULL, ~0U, 12};

    return add_test(b, scene, &v);
}

/* Of a frame and its memory. */
static int add_sizes(struct bench *b, const struct scene *scene)
{
    static const int size[][2] = {
        {640, 360}, {1280, 720}, {1920, 1080}, {3840, 2160}};
    int code = EXIT_OK;

    for (size_t i = 0; i < sizeof size / sizeof *size && code == EXIT_OK; i++)
        code = bench_add_one(b, scene, size[i][0], size[i][1], 1);
    return code;
}

int bench_add(struct bench *b, const struct scene *scene)
{
    const int n = b->all ? (int)(sizeof variations / sizeof *variations) : 1;
    int code = EXIT_OK;

    if (b->growth)
        return bench_add_growth(b, scene);
    if (b->sizes)
        return add_sizes(b, scene);
    for (int i = 0; i < n && code == EXIT_OK; i++)
        if (variations[i].sets == ~0U ||
            !(variations[i].sets & ~glint_sets_here()))
            code = add_test(b, scene, &variations[i]);
    return code;
}

/* What of drawing the last frame did not touch the picture. */
static double accumulate_ms(const struct test *t)
{
    const double t0 = tool_seconds();

    if (t->n_lamps > 0)
        glint_flare_draw(t->frame.flare, NULL);
    return 1e3 * (tool_seconds() - t0);
}

enum glint_status bench_run(struct test *t, int round)
{
    struct canvas *c = t->canvas;
    enum glint_status status;
    clock_t cpu0 = 0;
    double t0, cpu_ms;

    memcpy(c->mem, c->fresh, c->bytes);
    if (t->series) /* a system call would cool the caches of small frames */
        cpu0 = clock();
    t0 = tool_seconds();
    status = frame_draw(&t->frame, t->lamp, t->n_lamps, t->scale, &c->image,
                        &t->report);
    t->ms[WHOLE][round] = 1e3 * (tool_seconds() - t0);
    cpu_ms = t->series ? 1e3 * (double)(clock() - cpu0) / CLOCKS_PER_SEC : 0;
    if (t->cpu_ms == 0 || cpu_ms < t->cpu_ms)
        t->cpu_ms = cpu_ms;
    t->ms[PLAN][round] = t->report.plan_ms;
    t->ms[TRANSFER][round] = t->report.trace_ms;
    t->ms[BIN][round] = t->report.bin_ms;
    t->ms[DRAW][round] = t->report.draw_ms;
    t->ms[ACCUMULATE][round] = accumulate_ms(t);
    t->ms[COMPOSITE][round] = t->ms[DRAW][round] - t->ms[ACCUMULATE][round];
    return status;
}

/* --------------------------------------------------------------------- exact
 */

/* The same by exact rays of the lens's table. */
static enum glint_status draw_exact(const struct bench *b, const struct test *t,
                                    struct glint_float_image *to)
{
    const struct scene *s = t->scene;
    const size_t n = 3 * (size_t)to->width * (size_t)to->height;
    struct glint_setup *setup = malloc(sizeof *setup);
    double *rgb = malloc(n * sizeof *rgb);
    struct tool_progress progress;
    struct glint_exact_config cfg = {.setup = setup,
                                     .view = t->frame.view,
                                     .lamps = t->lamp,
                                     .n_lamps = t->n_lamps,
                                     .grid = 128,
                                     .only_ghost = s->only_ghost,
                                     .workers = b->tool->workers,
                                     .progress = tool_progress_show,
                                     .progress_ctx = &progress};
    struct glint_error error = {""};
    enum glint_status status = GLINT_E_MEMORY;

    tool_progress_start(&progress, b->tool, "exact");
    if (setup && rgb)
        status = glint_setup_init(setup, &s->lens, s->n_blades,
                                  s->blade_rotation_deg, s->wavelength_nm,
                                  s->n_wavelengths, &error);
    if (status == GLINT_OK && s->balance)
        glint_setup_balance(setup);
    if (status == GLINT_OK)
        status = glint_exact_render(&cfg, rgb);
    for (size_t i = 0; i < n && status == GLINT_OK; i++)
        to->rgb[i] = (float)rgb[i];
    tool_progress_end(&progress);
    free(setup);
    free(rgb);
    return status;
}

/* The flare alone as codes on black, exposed as WANT is: what a frame draws for
 * codes is not what it draws in linear light. */
static enum glint_status draw_codes(struct test *t,
                                    const struct glint_float_image *want,
                                    struct glint_float_image *to)
{
    struct glint_image layer = {
        .format = GLINT_RGB24, .width = to->width, .height = to->height};
    uint8_t *codes = calloc(3 * (size_t)to->width, (size_t)to->height);
    const double exposure = measure_exposure(want);
    enum glint_status status = GLINT_E_MEMORY;

    if (codes) {
        glint_image_place(&layer, codes);
        status = frame_draw(&t->frame, t->lamp, t->n_lamps, exposure, &layer,
                            &t->report);
        measure_decode(codes, exposure, to);
    }
    free(codes);
    return status;
}

/* PSNR of the flare alone against exact rays. */
int bench_psnr(struct bench *b, struct test *t)
{
    const int w = t->canvas->image.width, h = t->canvas->image.height;
    const size_t n = 3 * (size_t)w * (size_t)h;
    struct glint_float_image want = {w, h, malloc(n * sizeof(float))};
    struct glint_float_image got = {w, h, malloc(n * sizeof(float))};
    enum glint_status status = GLINT_E_MEMORY;
    struct measure m;

    if (want.rgb && got.rgb)
        status = draw_exact(b, t, &want);
    if (status == GLINT_OK)
        status = draw_codes(t, &want, &got);
    if (status == GLINT_OK && measure_compare(&want, &got, false, &m))
        t->psnr_db = m.psnr_db;
    free(want.rgb);
    free(got.rgb);
    return status == GLINT_OK ? EXIT_OK : tool_fail(b->tool, status, NULL);
}
