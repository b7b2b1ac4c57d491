/* SPDX-License-Identifier: MIT
 *
 * glint bench of flares: lenses, image sizes and options to time.
 */
#include <stdlib.h>
#include <string.h>

#include "measure/bench.h"
#include "options/command_line.h"
#include "options/json_writer.h"

static const char help[] =
    "glint bench [LENS|MODEL]... [options]\n"
    "glint bench --scene FILE ...    of a scene; see glint bench --scene x "
    "--help\n"
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

enum { PLAN, TRANSFER, BIN, DRAW, WHOLE };

struct lenses {
    struct opened_lens lens[BENCH_LENSES];
    int n;
};

struct flare_case {
    struct bench_case base;
    struct glint_engine *engine;
    struct glint_lamp lamp;
    double scale;
    struct glint_engine_report report;
};

/* ------------------------------------------------------------------- cases */

static int add_bench_case(struct bench *b, const struct opened_lens *lens)
{
    struct flare_case *const t =
        (struct flare_case *)bench_add_case(b, lens->table.name);
    struct glint_engine_config cfg;
    struct glint_error error = {""};
    enum glint_status status;

    if (!t)
        return tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    canvas_set_lamps(&t->lamp, 1, 12);
    canvas_open_engine(b->tool, lens, &b->base, b->width, b->height, &cfg);
    status = glint_engine_create(&t->engine, &cfg, &error);
    if (status == GLINT_OK)
        status = canvas_compute_exposure(t->engine, &t->lamp, 1, &t->scale);
    return status == GLINT_OK ? EXIT_OK
                              : tool_fail(b->tool, status, error.text);
}

/* ------------------------------------------------------------------ rounds */

/* tools/measure/budget finds the timed frames by the name of this function. */
static enum glint_status bench_run(struct bench *b, struct bench_case *c,
                                   int round)
{
    struct flare_case *const t = (struct flare_case *)c;
    const struct glint_engine_report *const r = &t->report;
    enum glint_status status;
    double t0;

    if (b->moving)
        t->lamp.theta_deg = 8 + 8 * (round + 0.5) / b->rounds;
    t0 = tool_clock_s();
    status = glint_engine_draw_at(t->engine, &t->lamp, 1, t->scale,
                                  &b->canvas.image, &t->report);
    c->ms[WHOLE][round] = 1e3 * (tool_clock_s() - t0);
    c->ms[PLAN][round] = r->plan_ms;
    c->ms[TRANSFER][round] = r->trace_ms;
    c->ms[BIN][round] = r->bin_ms;
    c->ms[DRAW][round] = r->draw_ms;
    return status;
}

/* ----------------------------------------------------------------- opening */

static int open_bench_lens(struct bench *b, struct lenses *lenses,
                           const char *name)
{
    if (lenses->n == BENCH_LENSES)
        return tool_usage(b->tool, "accepts at most %d lenses", BENCH_LENSES);
    return opened_lens_open(b->tool, &lenses->lens[lenses->n++], &b->base,
                            name);
}

static int open_bench_lenses(struct bench *b, int n, const char *const *name)
{
    struct lenses *const lenses = b->opened = calloc(1, sizeof *lenses);
    int code = EXIT_OK;

    if (!lenses)
        return tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    if (b->base.options.memory)
        return tool_usage(b->tool, "bench does not limit memory: --memory is "
                                   "for the other commands that draw");
    if (n == 0) {
        name = default_lenses;
        n = sizeof default_lenses / sizeof *default_lenses;
    }
    for (int i = 0; i < n && code == EXIT_OK; i++)
        code = open_bench_lens(b, lenses, name[i]);
    for (int i = 0; i < n && code == EXIT_OK; i++)
        code = add_bench_case(b, &lenses->lens[i]);
    return code;
}

static void close_bench_case(struct bench_case *c)
{
    struct flare_case *const t = (struct flare_case *)c;

    glint_engine_destroy(t->engine);
}

static void close_bench_lenses(struct bench *b)
{
    struct lenses *const lenses = b->opened;

    for (int i = 0; lenses && i < lenses->n; i++)
        opened_lens_close(&lenses->lens[i]);
    free(lenses);
}

/* ------------------------------------------------------------------ output */

static void print_bench_case(const struct bench *b, const struct bench_case *c)
{
    printf("%-22s %4dx%-4d %5d %2d %-5s %-5s", c->name, b->width, b->height, 1,
           bench_get_threads(b), "edges", b->tool->kernels);
}

static void print_bench_result(const struct bench *b,
                               const struct bench_case *c)
{
    const struct flare_case *const t = (const struct flare_case *)c;
    const struct glint_engine_report *const r = &t->report;

    (void)b;
    printf("%7d %6.2f", r->stats.primitives,
           (double)(r->peak_bytes + r->star_bytes) / (1 << 20));
}

static void write_bench_json(struct json_writer *to, const struct bench *b,
                             const struct bench_case *c)
{
    const struct flare_case *const t = (const struct flare_case *)c;
    const struct glint_engine_report *const r = &t->report;

    bench_write_json_format(to, b);
    json_write(to,
               "lights: %d, threads: %d, raster: %s, kernels: %s, "
               "quality: %.3f",
               1, bench_get_threads(b), "edges", b->tool->kernels,
               r->quality >= 0 ? r->quality : b->base.options.quality);
    bench_write_json_times(to, b, c);
    json_write(to,
               "drawn_lights: %d, ghosts: %d, bundles: %d, primitives: %d, "
               "tiles: %d, arena_bytes: %zu, star_bytes: %zu",
               r->drawn_lights, r->ghosts, r->stats.bundles,
               r->stats.primitives, r->tiles, r->peak_bytes, r->star_bytes);
}

/* ----------------------------------------------------------------- options */

enum { OPT_MOVING = BENCH_OWN };

static const struct option own[] = {{"moving", no_argument, NULL, OPT_MOVING},
                                    BENCH_OPTIONS};

static int parse_bench_option(struct bench *b, int c, const char *value)
{
    (void)value;
    if (c != OPT_MOVING)
        return -2;
    return b->moving = true;
}

const struct bench_subject bench_flare = {
    .word = "lens",
    .help = help,
    .own = own,
    .groups = ENGINE_DRAWING,
    .max_rounds = BENCH_ROUNDS,
    .n_stages = WHOLE + 1,
    .stage = {"plan", "transfer", "bin", "draw", "whole"},
    .heads = "lens                        size light th by    sets ",
    .tail = "  prims    MiB",
    .case_bytes = sizeof(struct flare_case),
    .take = parse_bench_option,
    .open = open_bench_lenses,
    .draw = bench_run,
    .print_case = print_bench_case,
    .print_result = print_bench_result,
    .json = write_bench_json,
    .close_case = close_bench_case,
    .close = close_bench_lenses};
