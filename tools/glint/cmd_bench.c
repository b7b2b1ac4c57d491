/* SPDX-License-Identifier: MIT
 *
 * glint bench: draws frames of several lenses alternately, measures the time
 * of each stage, and compares it with the memory floor, the time of adding a
 * constant layer to the same frame.
 */
#include <stdlib.h>
#include <string.h>

#include "measure/canvas.h"
#include "options/command_line.h"
#include "options/json_writer.h"

static const char help[] =
    "glint bench [LENS|MODEL]... [options]\n"
    "\n"
    "Measures the time of 8-bit video frames with flares drawn in place, and "
    "the\n"
    "memory floor: the time of adding a small constant layer, with "
    "saturation,\n"
    "to the same frame. All cases are measured in turns, so that other load "
    "of\n"
    "the machine affects all of them equally. Prints medians and their ratios "
    "to\n"
    "the floor. One light 12 degrees off the axis, exposed so that the\n"
    "99.9th percentile of the flare is display white. Without lenses:\n"
    "heliar-tronnier, double-gauss-angenieux and itoh-zoom-short.\n"
    "\n"
    "  --size WxH      default 1920x1080\n"
    "  --repeat N      rounds (default 15)\n"
    "  --moving        move the first light from 8 to 16 degrees during the "
    "run\n"
    "  --format F      yuyv (default) | i420 | nv12 | rgb24 | xrgb8888 | "
    "rgb565\n";

/* Baking all of these costs 30 s of CPU time; canon-zoom-mid alone costs
 * minutes. */
static const char *const default_lenses[] = {
    "heliar-tronnier", "double-gauss-angenieux", "itoh-zoom-short"};

static const char *const format_words[] = {
    "yuyv", "i420", "nv12", "rgb24", "xrgb8888", "rgb565", NULL};
static const enum glint_pixel_format formats[] = {GLINT_YUYV,     GLINT_I420,
                                                  GLINT_NV12,     GLINT_RGB24,
                                                  GLINT_XRGB8888, GLINT_RGB565};

enum { PLAN, TRANSFER, BIN, DRAW, WHOLE, STAGES, MAX_LENSES = 16 };
static const char *const stages[] = {"plan", "transfer", "bin", "draw"};

/* A timed lens */
struct bench_case {
    struct opened_lens lens;
    struct glint_engine *engine;
    struct glint_lamp lamp;
    double scale;
    struct glint_engine_report report;
    double ms[STAGES][CANVAS_MAX];
};

struct bench {
    struct tool *tool;
    struct settings base; /* settings from the command line */
    /* format: index in format_words */
    int width, height, rounds, format;
    bool moving; /* true: the light is at another angle in each round */
    struct canvas canvas;
    struct bench_case *cases[MAX_LENSES];
    int n_cases;
};

/* ------------------------------------------------------------------- cases */

static int add_bench_case(struct bench *b, const char *name)
{
    struct bench_case *t;

    if (b->n_cases == MAX_LENSES)
        return tool_usage(b->tool, "accepts at most %d lenses", MAX_LENSES);
    t = calloc(1, sizeof *t);
    if (!t)
        return tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    b->cases[b->n_cases++] = t;
    return opened_lens_open(b->tool, &t->lens, &b->base, name);
}

static int create_bench_engine(struct bench *b, struct bench_case *t)
{
    struct glint_engine_config cfg;
    struct glint_error error = {""};
    enum glint_status status;

    canvas_set_lamps(&t->lamp, 1, 12);
    canvas_open_engine(b->tool, &t->lens, &b->base, b->width, b->height, &cfg);
    status = glint_engine_create(&t->engine, &cfg, &error);
    if (status == GLINT_OK)
        status = canvas_compute_exposure(t->engine, &t->lamp, 1, &t->scale);
    return status == GLINT_OK ? EXIT_OK
                              : tool_fail(b->tool, status, error.text);
}

static int open_bench_lenses(struct bench *b, int n, const char *const *name)
{
    int code = EXIT_OK;

    if (b->base.options.memory)
        return tool_usage(b->tool, "bench does not limit memory: --memory is "
                                   "for the other commands that draw");
    if (n == 0) {
        name = default_lenses;
        n = sizeof default_lenses / sizeof *default_lenses;
    }
    for (int i = 0; i < n && code == EXIT_OK; i++)
        code = add_bench_case(b, name[i]);
    for (int i = 0; i < n && code == EXIT_OK; i++)
        code = create_bench_engine(b, b->cases[i]);
    return code;
}

static void close_bench(struct bench *b)
{
    for (int i = 0; i < b->n_cases; i++) {
        glint_engine_destroy(b->cases[i]->engine);
        opened_lens_close(&b->cases[i]->lens);
        free(b->cases[i]);
    }
    canvas_free(&b->canvas);
    free(b);
}

/* ------------------------------------------------------------------ rounds */

/* tools/measure/budget finds the timed frames by the name of this function. */
__attribute__((noinline)) static enum glint_status
bench_run(struct bench *b, struct bench_case *t, int round)
{
    const struct glint_engine_report *const r = &t->report;
    enum glint_status status;
    double t0;

    canvas_restore_background(&b->canvas);
    if (b->moving)
        t->lamp.theta_deg = 8 + 8 * (round + 0.5) / b->rounds;
    t0 = tool_clock_s();
    status = glint_engine_draw_at(t->engine, &t->lamp, 1, t->scale,
                                  &b->canvas.image, &t->report);
    t->ms[WHOLE][round] = 1e3 * (tool_clock_s() - t0);
    t->ms[PLAN][round] = r->plan_ms;
    t->ms[TRANSFER][round] = r->trace_ms;
    t->ms[BIN][round] = r->bin_ms;
    t->ms[DRAW][round] = r->draw_ms;
    return status;
}

static int run_timed_rounds(struct bench *b)
{
    const int warm = b->moving ? b->rounds : 1;
    struct tool_progress progress;
    enum glint_status status = GLINT_OK;

    tool_progress_start(&progress, b->tool, "bench");
    /* Rounds with a negative number warm up the caches and are not recorded. A
     * moving light needs one such round per position, else one is
     * sufficient. */
    for (int round = -warm; round < b->rounds && status == GLINT_OK; round++) {
        const int at = round < 0 ? round + warm : round;

        canvas_time_memory_floor(&b->canvas, at);
        for (int i = 0; i < b->n_cases && status == GLINT_OK; i++)
            status = bench_run(b, b->cases[i], at);
        tool_progress_show(&progress,
                           (round + warm + 1.0) / (b->rounds + warm));
    }
    tool_progress_end(&progress);
    return status == GLINT_OK ? EXIT_OK : tool_fail(b->tool, status, NULL);
}

/* ------------------------------------------------------------------ output */

static int get_thread_count(const struct bench *b)
{
    return b->tool->n_threads ? b->tool->n_threads : 1;
}

static void print_bench_table(const struct bench *b, double floor_ms)
{
    printf("memory floor %.3f ms (%dx%d %s, %d rounds); stages are multiples "
           "of it\n",
           floor_ms, b->width, b->height, format_words[b->format], b->rounds);
    printf("lens                        size th sets        ms   "
           "ratio     plan transfer     bin    draw    prims    MiB\n");
    for (int i = 0; i < b->n_cases; i++) {
        const struct bench_case *const t = b->cases[i];
        const struct glint_engine_report *const r = &t->report;
        const double ms = canvas_find_median(t->ms[WHOLE], b->rounds);

        printf("%-22s %4dx%-4d %2d %-5s %8.3f %7.1f ", t->lens.table.name,
               b->width, b->height, get_thread_count(b), b->tool->kernels, ms,
               ms / floor_ms);
        for (int k = PLAN; k < WHOLE; k++)
            printf(" %*.2f", k == TRANSFER ? 8 : 7,
                   canvas_find_median(t->ms[k], b->rounds) / floor_ms);
        printf("  %7d %6.2f\n", r->stats.primitives,
               (double)(r->peak_bytes + r->star_bytes) / (1 << 20));
    }
}

static void write_case_json(struct json_writer *json, const struct bench *b,
                            const struct bench_case *t, double floor_ms)
{
    const struct glint_engine_report *const r = &t->report;
    const double ms = canvas_find_median(t->ms[WHOLE], b->rounds);

    json_write(json,
               "\n{lens: %s, width: %d, height: %d, format: %s, "
               "threads: %d, kernels: %s, quality: %.3f, "
               "ms: %.4f, ratio: %.3f",
               t->lens.table.name, b->width, b->height, format_words[b->format],
               get_thread_count(b), b->tool->kernels,
               r->quality >= 0 ? r->quality : b->base.options.quality, ms,
               ms / floor_ms);
    for (int k = PLAN; k < WHOLE; k++)
        json_write(json, "%s_ms: %.4f", stages[k],
                   canvas_find_median(t->ms[k], b->rounds));
    json_write(json,
               "drawn_lights: %d, ghosts: %d, bundles: %d, primitives: %d, "
               "tiles: %d, arena_bytes: %zu, star_bytes: %zu}",
               r->drawn_lights, r->ghosts, r->stats.bundles,
               r->stats.primitives, r->tiles, r->peak_bytes, r->star_bytes);
}

static void print_bench_json(const struct bench *b, double floor_ms)
{
    struct json_writer json = {.to = stdout};

    json_write(&json,
               "{floor_ms: %.5f, rounds: %d, version: %s, machine: %s, "
               "cases: [",
               floor_ms, b->rounds, GLINT_VERSION, canvas_describe_machine());
    for (int i = 0; i < b->n_cases; i++)
        write_case_json(&json, b, b->cases[i], floor_ms);
    json_write(&json, "\n]}\n");
}

/* ----------------------------------------------------------------- command */

enum { OPT_MOVING = 'A' };

static const struct option own[] = {{"moving", no_argument, NULL, OPT_MOVING},
                                    {"size", required_argument, NULL, 's'},
                                    {"repeat", required_argument, NULL, 'r'},
                                    {"format", required_argument, NULL, 'F'},
                                    {NULL, 0, NULL, 0}};

static int parse_option(struct tool *tool, void *ctx, int c, const char *value)
{
    struct bench *const b = ctx;
    bool good = true;
    int code;

    switch (c) {
    case 's':
        good = tool_parse_size(value, &b->width, &b->height);
        break;
    case 'r':
        good = tool_parse_integer(value, 1, CANVAS_MAX, &b->rounds);
        break;
    case 'F':
        b->format = tool_find_word_index(value, format_words);
        good = b->format >= 0;
        break;
    case OPT_MOVING:
        b->moving = true;
        break;
    default:
        code = settings_apply_option(tool, &b->base, c, value);
        return code == -2 ? tool_apply_option(tool, c, value) : code;
    }
    return good ? -1 : -2;
}

static int run_bench(struct bench *b, int n_names, const char *const *names)
{
    int code;
    double floor_ms;

    if (canvas_init(&b->canvas, formats[b->format], b->width, b->height) !=
        GLINT_OK)
        return tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    code = open_bench_lenses(b, n_names, names);
    if (code == EXIT_OK)
        code = run_timed_rounds(b);
    if (code != EXIT_OK)
        return code;
    floor_ms = canvas_find_median(b->canvas.floor_ms, b->rounds);
    (b->tool->json ? print_bench_json : print_bench_table)(b, floor_ms);
    return EXIT_OK;
}

int cmd_bench(int argc, char **argv)
{
    struct tool tool = {.name = "bench",
                        .help = help,
                        .help_end = COMMON_HELP,
                        .kernels = "auto"};
    struct bench *const b = calloc(1, sizeof *b);
    int code;

    if (!b)
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    b->tool = &tool;
    b->rounds = 15;
    b->width = 1920;
    b->height = 1080;
    settings_set_defaults(&b->base);
    code = tool_parse_options(
        &tool, argc, argv, TOOL_COMMON_SHORT,
        engine_build_options(&tool, ENGINE_DRAWING, &b->base.options, own),
        parse_option, b);
    if (code < 0)
        code = tool_start_threads(&tool);
    if (code == EXIT_OK && tool.workers)
        code = run_bench(b, argc - optind, (const char *const *)argv + optind);
    close_bench(b);
    tool_stop_threads(&tool);
    return code;
}
