/* SPDX-License-Identifier: MIT
 *
 * glint bench: times frames, and compares them with touching their memory.
 */
#include <stdlib.h>
#include <string.h>

#include "lab/bench.h"
#include "lab/scene_bench.h"
#include "lab/scene_trial.h"
#include "posix/workers.h"
#include "options/command_line.h"

static const char help[] =
    "glint bench [LENS|MODEL]... [options]\n"
    "glint bench --scene FILE ...    of a scene; --scene x --help has more\n"
    "\n"
    "Times frames of 8-bit video with flares drawn in place, and what it "
    "takes\n"
    "to touch that memory at all: a saturating addition of a small constant\n"
    "layer to the same frame, the floor. All cases take turns, so that what\n"
    "else the machine does falls on all of them; medians are shown, and "
    "ratios\n"
    "to the floor. One light 12 degrees off the axis, exposed so that the\n"
    "99.9th percentile of the flare is display white; further lights lie on a\n"
    "spiral around it. Without lenses: heliar-tronnier, "
    "double-gauss-angenieux\n"
    "and itoh-zoom-short.\n"
    "Of drawing, accumulate is the light of all pixels, timed by itself, and\n"
    "composite the rest: codes read, light added, codes written.\n"
    "\n"
    "  --all           also: all kernels, 2 threads, 2 to 10000\n"
    "                  lights, 360p to 2160p, no light, a light far outside,\n"
    "                  and, alone, the star of one light of 12 stops over "
    "white\n"
    "                  and those of ten of 2 stops\n"
    "  --sizes         instead: 360p, 720p, 1080p and 2160p\n"
    "  --growth        instead: 1 to 64 lights, 360p to 2160p, some of the\n"
    "                  ghosts, other quanta and grids; tools/report/growth "
    "draws "
    "them\n"
    "  --budgets LIST  instead: held to so many milliseconds each, and how far "
    "what\n"
    "                  was predicted is off\n"
    "  --size WxH      default 1920x1080\n"
    "  --repeat N      rounds (default 15)\n"
    "  --moving        the first light goes from 8 to 16 degrees meanwhile\n"
    "  --psnr          also draw each lens exactly and compare, which takes\n"
    "                  minutes\n"
    "  --format F      yuyv (default) | i420 | nv12 | rgb24 | xrgb8888 | "
    "rgb565\n";

/* These bake in 30 s of processor time together; canon-zoom-mid alone takes
 * minutes. */
static const char *const default_lenses[] = {
    "heliar-tronnier", "double-gauss-angenieux", "itoh-zoom-short"};

static const char *const format_words[] = {
    "yuyv", "i420", "nv12", "rgb24", "xrgb8888", "rgb565", NULL};
static const enum glint_pixel_format formats[] = {GLINT_YUYV,     GLINT_I420,
                                                  GLINT_NV12,     GLINT_RGB24,
                                                  GLINT_XRGB8888, GLINT_RGB565};

/* ----------------------------------------------------------------- command */

static int run_rounds(struct bench *b)
{
    const int warm = b->moving ? b->rounds : 1;
    struct tool_progress progress;
    enum glint_status status = GLINT_OK;

    tool_progress_start(&progress, b->tool, "bench");
    /* The first rounds only warm up: one, or one for each place of a moving
     * light. */
    for (int round = -warm; round < b->rounds && status == GLINT_OK; round++) {
        const int at = round < 0 ? round + warm : round;

        for (int i = 0; i < b->n_canvases; i++)
            b->canvas[i].floor_ms[at] = canvas_floor_ms(&b->canvas[i].of);
        for (int i = 0; i < b->n_tests && status == GLINT_OK; i++) {
            if (b->moving)
                bench_move(&b->test[i], at, b->rounds);
            status = bench_run(&b->test[i], at);
        }
        tool_progress_show(&progress,
                           (round + warm + 1.0) / (b->rounds + warm));
    }
    tool_progress_end(&progress);
    return status == GLINT_OK ? EXIT_OK : tool_fail(b->tool, status, NULL);
}

static int open_settings(struct bench *b, const char *name)
{
    struct settings *s = &b->settings[b->n_settings];

    if (b->n_settings == MAX_LENSES)
        return tool_usage(b->tool, "takes %d lenses at most", MAX_LENSES);
    *s = b->base;
    b->n_settings++;
    if (b->psnr && tool_is_model(name))
        return tool_usage(b->tool, "%s is a model: --psnr needs the lens table",
                          name);
    return settings_open(b->tool, s, name);
}

static int run(struct bench *b, int n_names, const char *const *names)
{
    int code = EXIT_OK;

    if (glint_pool_create(&b->one, 1) != GLINT_OK ||
        glint_pool_create(&b->two, 2) != GLINT_OK || b->two->n != 2)
        return tool_fail(b->tool, GLINT_E_MEMORY, "no threads to be had");
    for (int i = 0; i < n_names && code == EXIT_OK; i++)
        code = open_settings(b, names[i]);
    for (int i = 0; i < b->n_settings && code == EXIT_OK; i++)
        code = b->growth ? bench_add_growth(b, &b->settings[i])
                         : bench_add(b, &b->settings[i]);
    for (int i = 0; i < b->n_tests && b->psnr && code == EXIT_OK; i++)
        if (b->test[i].n_lamps == 1 && b->test[i].kernels == b->tool->kernels)
            code = bench_psnr(b, &b->test[i]);
    if (code == EXIT_OK)
        code = run_rounds(b);
    if (code == EXIT_OK && b->tool->json)
        bench_print_json(b);
    else if (code == EXIT_OK)
        bench_print(b);
    return code;
}

static void close_bench(struct bench *b)
{
    for (int i = 0; i < MAX_CASES; i++)
        free(b->test[i].lamp);
    for (int i = 0; i < b->n_tests; i++) {
        glint_frame_finish(&b->test[i].frame);
        free(b->test[i].some_ghosts);
    }
    for (int i = 0; i < b->n_canvases; i++)
        canvas_finish(&b->canvas[i].of);
    for (int i = 0; i < b->n_settings; i++)
        settings_close(&b->settings[i]);
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
    case 'g':
        b->growth = true;
        return -1;
    case 'm':
        b->sizes = true;
        return -1;
    case 'M':
        b->moving = true;
        return -1;
    case 'p':
        b->psnr = true;
        return -1;
    case 'b':
        b->n_budgets = tool_numbers(optarg, b->budget_ms, MAX_BUDGETS);
        for (int i = 0; i < b->n_budgets; i++)
            if (b->budget_ms[i] <= 0)
                b->n_budgets = 0;
        return b->n_budgets > 0
                   ? -1
                   : tool_usage(tool,
                                "--budgets takes up to %d numbers of "
                                "milliseconds, not '%s'",
                                MAX_BUDGETS, optarg);
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
            return tool_refuse(tool, "format", optarg);
        b->format = formats[word];
        b->format_word = format_words[word];
        return -1;
    default:
        return tool_option(tool, c, optarg);
    }
}

static int parse(struct tool *tool, int argc, char **argv, struct bench *b)
{
    static const struct option own[] = {
        {"all", no_argument, NULL, 'a'},
        {"growth", no_argument, NULL, 'g'},
        {"sizes", no_argument, NULL, 'm'},
        {"moving", no_argument, NULL, 'M'},
        {"psnr", no_argument, NULL, 'p'},
        {"budgets", required_argument, NULL, 'b'},
        {"size", required_argument, NULL, 's'},
        {"repeat", required_argument, NULL, 'r'},
        {"format", required_argument, NULL, 'F'},
        {NULL, 0, NULL, 0}};
    const struct option *const options =
        engine_getopt(tool, ENGINE_DRAWING, &b->base.options, own);
    int c, code;

    while ((c = tool_getopt(argc, argv, TOOL_COMMON_SHORT, options, NULL)) >=
           0) {
        code = settings_option(tool, &b->base, c, optarg);
        if (code == -2)
            code = take(tool, b, c);
        if (code >= 0)
            return code;
    }
    return b->base.options.memory
               ? tool_usage(tool,
                            "bench does not limit memory: --memory is for the "
                            "other commands that draw")
               : -1;
}

int cmd_bench(int argc, char **argv)
{
    struct tool tool = {.name = "bench", .help = help, .help_end = COMMON_HELP};
    struct bench *b;
    int code;

    if (scene_trial_is_asked(argc, argv))
        return cmd_bench_scene(argc, argv);
    b = calloc(1, sizeof *b);
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
    settings_defaults(&b->base);
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
