/* SPDX-License-Identifier: MIT
 *
 * glint bench: what a frame costs, next to touching its memory.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure.h"
#include "posix/workers.h"
#include "scene.h"

static const char help[] =
    "glint bench [LENS|MODEL]... [options]\n"
    "\n"
    "Times frames of 8-bit video with flares drawn in place, and what it "
    "takes\n"
    "to touch that memory at all: a saturating addition of a small constant\n"
    "layer to the same frame, the floor. All cases take turns, so that what\n"
    "else the machine does falls on all of them; medians are shown, and "
    "ratios\n"
    "to the floor. One light 12 degrees off the axis, exposed so that the\n"
    "99.9th percentile of the flare is display white; further lights lie on a\n"
    "spiral around it. Without lenses: one of each kind that comes with "
    "glint.\n"
    "\n"
    "  --all           also: both rasterisers, all kernels, 2 threads, 2 to "
    "64\n"
    "                  lights, 360p to 2160p, no light, a light far outside\n"
    "  --size WxH      default 1920x1080\n"
    "  --repeat N      rounds (default 15)\n"
    "  --psnr          also draw each lens exactly and compare, which takes\n"
    "                  minutes\n"
    "  --format F      yuyv (default) | i420 | nv12 | rgb24 | xrgb8888 | "
    "rgb565\n";
static const char help_end[] = SCENE_HELP COMMON_HELP;

enum { MAX_CASES = 256, MAX_ROUNDS = 1000, MAX_LENSES = 16, MAX_LIGHTS = 64 };

static const char *const default_lenses[] = {
    "heliar-tronnier", "double-gauss-angenieux", "itoh-zoom-short",
    "itoh-zoom-long",  "nikon-zoom-mid",         "canon-zoom-mid"};

static const char *const format_words[] = {
    "yuyv", "i420", "nv12", "rgb24", "xrgb8888", "rgb565", NULL};
static const enum glint_pixel_format formats[] = {GLINT_YUYV,     GLINT_I420,
                                                  GLINT_NV12,     GLINT_RGB24,
                                                  GLINT_XRGB8888, GLINT_RGB565};

enum stage { PLAN, TRANSFER, BIN, DRAW, WHOLE, STAGES };

static const char *const stage_names[STAGES] = {"plan", "transfer", "bin",
                                                "draw", "whole"};

/* A picture to draw on, and what touching it costs. */
struct canvas {
    struct glint_image image;
    uint8_t *fresh, *mem;
    size_t bytes;
    double floor_ms[MAX_ROUNDS];
};

struct test {
    const struct scene *scene;
    struct canvas *canvas;
    struct frame frame;
    struct glint_lamp lamp[MAX_LIGHTS];
    int n_lamps, threads;
    const char *kernels;
    double scale, psnr_db; /* NAN: not measured */
    struct frame_report report;
    double ms[STAGES][MAX_ROUNDS];
};

struct bench {
    struct tool *tool;
    struct scene base, scene[MAX_LENSES];
    int n_scenes, n_canvases, n_tests, rounds;
    struct canvas canvas[8];
    struct test *test;
    struct glint_workers *one, *two;
    enum glint_pixel_format format;
    const char *format_word;
    int width, height;
    bool all, psnr;
};

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

static double time_floor(struct canvas *c)
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
    unsigned sets_off;
    const char *kernels; /* NULL: as asked */
    double angle;
};

static const struct variation plain = {0, 0, 1, 0, 0, 0, NULL, 12};

static void set_lamps(struct test *t, int n, double angle)
{
    t->n_lamps = n;
    for (int i = 0; i < n; i++)
        t->lamp[i] = (struct glint_lamp){i ? fmod(angle + 2.39 * i, 24) : angle,
                                         fmod(33 + 137.5 * i, 360),
                                         1.0 / n,
                                         {1, 1, 1}};
}

/* The exposure at which the flare is as bright as the picture's white. */
static enum glint_status expose(struct test *t)
{
    const int w = t->canvas->image.width, h = t->canvas->image.height;
    const size_t n = 3 * (size_t)w * (size_t)h;
    struct glint_image layer = {
        .format = GLINT_LINEAR_Q20, .width = w, .height = h};
    int32_t *linear_q20 = calloc(n, sizeof *linear_q20);
    struct glint_float_image flare = {w, h, malloc(n * sizeof(float))};
    enum glint_status status = GLINT_E_MEMORY;

    if (linear_q20 && flare.rgb && t->n_lamps > 0) {
        const double scale = frame_auto_scale(&t->frame, t->lamp, t->n_lamps);

        glint_image_place(&layer, linear_q20);
        status = frame_draw(&t->frame, t->lamp, t->n_lamps, scale, &layer,
                            &t->report);
        for (size_t i = 0; i < n; i++)
            flare.rgb[i] = (float)(linear_q20[i] * 0x1p-20);
        t->scale = scale * measure_exposure(&flare);
    } else if (t->n_lamps == 0)
        status = GLINT_OK;
    free(linear_q20);
    free(flare.rgb);
    return status;
}

static int add_test(struct bench *b, const struct scene *scene,
                    const struct variation *v)
{
    struct test *t = &b->test[b->n_tests];
    const int width = v->width ? v->width : b->width;
    const int height = v->height ? v->height : b->height;
    int code;

    if (b->n_tests == MAX_CASES)
        return EXIT_OK;
    t->scene = scene;
    t->canvas = canvas_of(b, width, height);
    if (!t->canvas)
        return tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    code = scene_frame(b->tool, scene, scene_view(scene, width, height),
                       &t->frame);
    if (code != EXIT_OK)
        return code;
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
    t->frame.cfg.sets &= ~v->sets_off;
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

static int add_tests(struct bench *b, const struct scene *scene)
{
    static const int sizes[][2] = {{640, 360}, {1280, 720}, {3840, 2160}};
    static const int lights[] = {2, 8, 64};
    static const struct {
        unsigned set;
        const char *name;
    } sets[] = {{0, "c"}, {GLINT_SET_SSE41, "sse41"}};
    struct variation v = plain;
    int code = add_test(b, scene, &v);

    if (!b->all || code != EXIT_OK)
        return code;
    v.by_cells = 1;
    code = add_test(b, scene, &v);
    for (int i = 0; i < 2 && code == EXIT_OK; i++) {
        v = plain;
        v.kernels = sets[i].name;
        v.sets_off = ~sets[i].set;
        if (!(sets[i].set & ~glint_sets_here()))
            code = add_test(b, scene, &v);
    }
    v = plain;
    v.two_threads = 1;
    if (code == EXIT_OK)
        code = add_test(b, scene, &v);
    v = plain;
    for (int i = 0; i < 3 && code == EXIT_OK; i++) {
        v.lights = lights[i];
        code = add_test(b, scene, &v);
    }
    v = plain;
    for (int i = 0; i < 3 && code == EXIT_OK; i++) {
        v.width = sizes[i][0];
        v.height = sizes[i][1];
        code = add_test(b, scene, &v);
    }
    v = plain;
    v.lights = 0;
    if (code == EXIT_OK)
        code = add_test(b, scene, &v);
    v = plain;
    v.angle = 75; /* farther out than models go: nothing to draw */
    return code == EXIT_OK ? add_test(b, scene, &v) : code;
}

static enum glint_status run_test(struct test *t, int round)
{
    struct canvas *c = t->canvas;
    enum glint_status status;
    double t0;

    memcpy(c->mem, c->fresh, c->bytes);
    t0 = tool_seconds();
    status = frame_draw(&t->frame, t->lamp, t->n_lamps, t->scale, &c->image,
                        &t->report);
    t->ms[WHOLE][round] = 1e3 * (tool_seconds() - t0);
    t->ms[PLAN][round] = t->report.plan_ms;
    t->ms[TRANSFER][round] = t->report.trace_ms;
    t->ms[BIN][round] = t->report.bin_ms;
    t->ms[DRAW][round] = t->report.draw_ms;
    return status;
}

/* --------------------------------------------------------------------- exact
 */

/* The flare alone as T draws it, at scale 1. */
static enum glint_status draw_flare(struct test *t,
                                    struct glint_float_image *to)
{
    const size_t n = 3 * (size_t)to->width * (size_t)to->height;
    struct glint_image layer = {
        .format = GLINT_LINEAR_Q20, .width = to->width, .height = to->height};
    const double scale = frame_auto_scale(&t->frame, t->lamp, t->n_lamps);
    int32_t *linear_q20 = calloc(n, sizeof *linear_q20);
    enum glint_status status = GLINT_E_MEMORY;

    if (linear_q20) {
        glint_image_place(&layer, linear_q20);
        status = frame_draw(&t->frame, t->lamp, t->n_lamps, scale, &layer,
                            &t->report);
    }
    for (size_t i = 0; i < n && status == GLINT_OK; i++)
        to->rgb[i] = (float)(linear_q20[i] * 0x1p-20 / scale);
    free(linear_q20);
    return status;
}

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

/* PSNR of the flare alone against exact rays. */
static int measure_psnr(struct bench *b, struct test *t)
{
    const int w = t->canvas->image.width, h = t->canvas->image.height;
    const size_t n = 3 * (size_t)w * (size_t)h;
    struct glint_float_image want = {w, h, malloc(n * sizeof(float))};
    struct glint_float_image got = {w, h, malloc(n * sizeof(float))};
    enum glint_status status = GLINT_E_MEMORY;
    struct measure m;

    if (want.rgb && got.rgb)
        status = draw_flare(t, &got);
    if (status == GLINT_OK)
        status = draw_exact(b, t, &want);
    if (status == GLINT_OK && measure_compare(&want, &got, false, &m))
        t->psnr_db = m.psnr_db;
    free(want.rgb);
    free(got.rgb);
    return status == GLINT_OK ? EXIT_OK : tool_fail(b->tool, status, NULL);
}

/* -------------------------------------------------------------------- report
 */

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static double median(const double *values, int n)
{
    double sorted[MAX_ROUNDS];

    memcpy(sorted, values, (size_t)n * sizeof *values);
    qsort(sorted, (size_t)n, sizeof *sorted, by_size);
    return 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]);
}

static const char *raster_of(const struct test *t)
{
    return t->frame.cfg.raster == GLINT_RASTER_CELLS || t->frame.mask ? "cells"
                                                                      : "edges";
}

static double quality_of(const struct test *t)
{
    return log2((t->scene->grid ? t->scene->grid : 64) / 16.0) / 4;
}

static void print_test(const struct bench *b, const struct test *t)
{
    const double floor_ms = median(t->canvas->floor_ms, b->rounds);
    const double ms = median(t->ms[WHOLE], b->rounds);

    printf("%-22s %4dx%-4d %2d %2d %-5s %-5s %8.3f %7.1f ", t->scene->lens.name,
           t->canvas->image.width, t->canvas->image.height, t->n_lamps,
           t->threads, raster_of(t), t->kernels, ms, ms / floor_ms);
    for (int s = 0; s < WHOLE; s++)
        printf(" %7.2f", median(t->ms[s], b->rounds) / floor_ms);
    printf("  %7d %6.2f", t->report.stats.primitives,
           (double)t->report.peak_bytes / (1 << 20));
    if (isnan(t->psnr_db))
        printf("\n");
    else
        printf("  %.1f\n", t->psnr_db);
}

static void print_table(const struct bench *b)
{
    printf("floor %.3f ms (%dx%d %s, %d rounds); stages are ratios to it\n",
           median(b->canvas[0].floor_ms, b->rounds), b->canvas[0].image.width,
           b->canvas[0].image.height, b->format_word, b->rounds);
    printf("%-22s %9s %2s %2s %-5s %-5s %8s %7s ", "lens", "size", "li", "th",
           "by", "sets", "ms", "ratio");
    for (int s = 0; s < WHOLE; s++)
        printf(" %7.7s", stage_names[s]);
    printf("  %7s %6s%s\n", "prims", "MiB", b->psnr ? "  dB" : "");
    for (int i = 0; i < b->n_tests; i++)
        print_test(b, &b->test[i]);
}

static void json_test(const struct bench *b, const struct test *t, bool last)
{
    const double floor_ms = median(t->canvas->floor_ms, b->rounds);
    const double ms = median(t->ms[WHOLE], b->rounds);

    printf("{\"lens\": ");
    tool_json_string(stdout, t->scene->lens.name);
    printf(", \"width\": %d, \"height\": %d, \"format\": \"%s\", \"lights\": "
           "%d, \"threads\": %d, \"raster\": \"%s\", \"kernels\": \"%s\", "
           "\"quality\": %.3f, \"ms\": %.4f, \"ratio\": %.3f, ",
           t->canvas->image.width, t->canvas->image.height, b->format_word,
           t->n_lamps, t->threads, raster_of(t), t->kernels, quality_of(t), ms,
           ms / floor_ms);
    for (int s = 0; s < WHOLE; s++)
        printf("\"%s_ms\": %.4f, ", stage_names[s],
               median(t->ms[s], b->rounds));
    if (isnan(t->psnr_db))
        printf("\"psnr_db\": null, ");
    else
        printf("\"psnr_db\": %.2f, ", t->psnr_db);
    printf("\"ghosts\": %d, \"bundles\": %d, \"primitives\": %d, \"tiles\": "
           "%d, \"arena_bytes\": %zu}%s\n",
           t->report.ghosts, t->report.stats.bundles,
           t->report.stats.primitives, t->report.tiles, t->report.peak_bytes,
           last ? "" : ",");
}

static void print_json(const struct bench *b)
{
    printf("{\"floor_ms\": %.5f, \"rounds\": %d, \"cases\": [\n",
           median(b->canvas[0].floor_ms, b->rounds), b->rounds);
    for (int i = 0; i < b->n_tests; i++)
        json_test(b, &b->test[i], i + 1 == b->n_tests);
    printf("]}\n");
}

/* ------------------------------------------------------------------- command
 */

static int run_rounds(struct bench *b)
{
    struct tool_progress progress;
    enum glint_status status = GLINT_OK;

    tool_progress_start(&progress, b->tool, "bench");
    /* the first round only warms up */
    for (int round = -1; round < b->rounds && status == GLINT_OK; round++) {
        const int at = round < 0 ? 0 : round;

        for (int i = 0; i < b->n_canvases; i++)
            b->canvas[i].floor_ms[at] = time_floor(&b->canvas[i]);
        for (int i = 0; i < b->n_tests && status == GLINT_OK; i++)
            status = run_test(&b->test[i], at);
        tool_progress_show(&progress, (round + 2.0) / (b->rounds + 1));
    }
    tool_progress_end(&progress);
    return status == GLINT_OK ? EXIT_OK : tool_fail(b->tool, status, NULL);
}

static int open_scene(struct bench *b, const char *name)
{
    struct scene *s = &b->scene[b->n_scenes];

    if (b->n_scenes == MAX_LENSES)
        return tool_usage(b->tool, "takes %d lenses at most", MAX_LENSES);
    *s = b->base;
    b->n_scenes++;
    if (b->psnr && tool_is_model(name))
        return tool_usage(b->tool, "%s is a model: --psnr needs the lens table",
                          name);
    return scene_open(b->tool, s, name);
}

static int run(struct bench *b, int n_names, const char *const *names)
{
    int code = EXIT_OK;

    if (glint_pool_create(&b->one, 1) != GLINT_OK ||
        glint_pool_create(&b->two, 2) != GLINT_OK)
        return tool_fail(b->tool, GLINT_E_MEMORY, "no threads to be had");
    for (int i = 0; i < n_names && code == EXIT_OK; i++)
        code = open_scene(b, names[i]);
    for (int i = 0; i < b->n_scenes && code == EXIT_OK; i++)
        code = add_tests(b, &b->scene[i]);
    for (int i = 0; i < b->n_tests && b->psnr && code == EXIT_OK; i++)
        if (b->test[i].n_lamps == 1 && b->test[i].kernels == b->tool->kernels)
            code = measure_psnr(b, &b->test[i]);
    if (code == EXIT_OK)
        code = run_rounds(b);
    if (code == EXIT_OK && b->tool->json)
        print_json(b);
    else if (code == EXIT_OK)
        print_table(b);
    return code;
}

static void close_bench(struct bench *b)
{
    for (int i = 0; i < b->n_tests; i++)
        frame_finish(&b->test[i].frame);
    for (int i = 0; i < b->n_canvases; i++) {
        free(b->canvas[i].fresh);
        free(b->canvas[i].mem);
    }
    for (int i = 0; i < b->n_scenes; i++)
        scene_close(&b->scene[i]);
    glint_pool_destroy(b->one);
    glint_pool_destroy(b->two);
    free(b->test);
    free(b);
}

static int take(struct tool *tool, struct bench *b, int c)
{
    int word;

    switch (c) {
    case 'a':
        b->all = true;
        return -1;
    case 'p':
        b->psnr = true;
        return -1;
    case 's':
        if (tool_size(optarg, &b->width, &b->height))
            return -1;
        return tool_usage(tool, "--size takes WxH of 1 to %d pixels, not '%s'",
                          GLINT_MAX_SIDE, optarg);
    case 'r':
        if (tool_integer(optarg, 1, MAX_ROUNDS, &b->rounds))
            return -1;
        return tool_usage(tool, "--repeat takes 1 to %d, not '%s'", MAX_ROUNDS,
                          optarg);
    case 'F':
        word = tool_word(optarg, format_words);
        if (word < 0)
            return tool_usage(tool, "no format '%s'", optarg);
        b->format = formats[word];
        b->format_word = format_words[word];
        return -1;
    default:
        return tool_option(tool, c, optarg);
    }
}

static int parse(struct tool *tool, int argc, char **argv, struct bench *b)
{
    static const struct option options[] = {
        {"all", no_argument, NULL, 'a'},
        {"psnr", no_argument, NULL, 'p'},
        {"size", required_argument, NULL, 's'},
        {"repeat", required_argument, NULL, 'r'},
        {"format", required_argument, NULL, 'F'},
        SCENE_OPTIONS,
        TOOL_COMMON_OPTIONS};
    int c, code;

    while ((c = getopt_long(argc, argv, TOOL_COMMON_SHORT, options, NULL)) >=
           0) {
        code = scene_option(tool, &b->base, c, optarg);
        if (code == -2)
            code = take(tool, b, c);
        if (code >= 0)
            return code;
    }
    return -1;
}

int cmd_bench(int argc, char **argv)
{
    struct tool tool = {.name = "bench", .help = help, .help_end = help_end};
    struct bench *b = calloc(1, sizeof *b);
    int code;

    if (!b || !(b->test = calloc(MAX_CASES, sizeof *b->test))) {
        free(b);
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    }
    b->tool = &tool;
    b->rounds = 15;
    b->width = 1920;
    b->height = 1080;
    b->format = GLINT_YUYV;
    b->format_word = "yuyv";
    scene_defaults(&b->base);
    tool.kernels = "auto";
    code = parse(&tool, argc, argv, b);
    if (code < 0)
        code = tool_start(&tool);
    if (code == EXIT_OK && tool.workers)
        code =
            optind < argc
                ? run(b, argc - optind, (const char *const *)argv + optind)
                : run(b, (int)(sizeof default_lenses / sizeof *default_lenses),
                      default_lenses);
    close_bench(b);
    tool_finish(&tool);
    return code;
}
