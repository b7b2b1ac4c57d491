/* SPDX-License-Identifier: MIT
 *
 * glint bench --scene: times frames onto which a scene is drawn, by stage.
 */
#include "lab/scene_bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lab/scene_trial.h"
#include "linux/instructions.h"
#include "linux/sets.h"
#include "options/engine_options.h"
#include "options/command_line.h"
#include "options/json_writer.h"
#include "posix/workers.h"
#include "scenes/baked_scene.h"

static const char help[] =
    "glint bench --scene NAME.scene|BAKED [options]\n"
    "\n"
    "Times frames of 8-bit video onto which a scene is drawn, by stage, and\n"
    "compares them with touching their memory, as glint bench does for\n"
    "flares. All cases take turns; medians are shown, and ratios to the\n"
    "floor. Stages: prepare finds what may be seen and makes lists of\n"
    "shadows, as if a thing had moved; around keeps the picture, small, for\n"
    "mirrors and glass; draw; of that shadows, what the scene without them\n"
    "does not take; lights, what a lens is told of the scene's lights.\n"
    "\n"
    "  --all               also: every value of each dial, all kernels, 2\n"
    "                      threads, 360p to 2160p\n"
    "  --sizes             instead: 360p, 720p, 1080p and 2160p\n"
    "  --size WxH          default 1920x1080\n"
    "  --repeat N          rounds, 1 to 100 (default 15)\n"
    "  --format F          yuyv (default) | i420 | nv12 | rgb24 | xrgb8888 |\n"
    "                      rgb565\n";

enum { MAX_TRIALS = 16, MAX_CANVASES = 4 };

struct bench_size {
    struct canvas canvas;
    double floor_ms[SCENE_ROUNDS];
};

struct scene_bench {
    struct tool *tool;
    const char *file;
    struct baked_scene scene, bare; /* bare: without shadows, if it has any */
    struct scene_dials dials;
    enum glint_pixel_format format;
    const char *format_word;
    int rounds, counter;
    bool all, sizes;
    struct glint_workers *one, *two;
    struct bench_size size[MAX_CANVASES];
    int n_sizes;
    struct scene_trial *trial[MAX_TRIALS];
    struct bench_size *on[MAX_TRIALS]; /* what each trial is drawn on */
    int n_trials;
};

/* ------------------------------------------------------------------- cases */

/* What differs from what was asked for; 0: nothing. */
struct variation {
    int width, height;
    int edge_samples, shadow_points;
    bool half_shading, two_threads;
    const char *kernels;
    unsigned sets; /* instruction sets that KERNELS may use */
};

static const struct variation variations[] = {
    {.edge_samples = 1},
    {.edge_samples = 8},
    {.edge_samples = 16},
    {.shadow_points = 1},
    {.shadow_points = 16},
    {.half_shading = true},
    {.kernels = "c"},
    {.kernels = "sse41", .sets = GLINT_SET_SSE41},
    {.two_threads = true},
    {.width = 640, .height = 360},
    {.width = 1280, .height = 720},
    {.width = 3840, .height = 2160},
};

static struct bench_size *size_of(struct scene_bench *b, int width, int height)
{
    struct bench_size *const next = &b->size[b->n_sizes];

    for (int i = 0; i < b->n_sizes; i++)
        if (b->size[i].canvas.image.width == width &&
            b->size[i].canvas.image.height == height)
            return &b->size[i];
    if (b->n_sizes == MAX_CANVASES ||
        canvas_init(&next->canvas, b->format, width, height) != GLINT_OK)
        return NULL;
    b->n_sizes++;
    return next;
}

static int add(struct scene_bench *b, const struct variation *v)
{
    struct scene_trial *const t = calloc(1, sizeof *t);
    struct scene_dials dials = b->dials;
    struct tool tool = *b->tool;
    struct bench_size *on;

    if (v->width) {
        dials.width = v->width;
        dials.height = v->height;
    }
    if (v->edge_samples)
        dials.edge_samples = v->edge_samples;
    if (v->shadow_points)
        dials.shadow_points = v->shadow_points;
    dials.half_shading = dials.half_shading || v->half_shading;
    tool.workers = v->two_threads   ? b->two
                   : tool.n_threads ? tool.workers
                                    : b->one;
    tool.n_threads = v->two_threads ? 2 : tool.n_threads ? tool.n_threads : 1;
    if (v->kernels) {
        tool.kernels = v->kernels;
        tool.sets_off |= ~v->sets;
    }
    on = size_of(b, dials.width, dials.height);
    if (!t || !on) {
        free(t);
        return tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    }
    b->on[b->n_trials] = on;
    b->trial[b->n_trials++] = t;
    return scene_trial_open(t, &tool, &b->scene.model,
                            b->bare.data ? &b->bare.model : NULL, &dials,
                            &on->canvas);
}

/* Returns whether V is the plain case, or needs what this processor lacks. */
static bool is_left_out(const struct scene_bench *b, const struct variation *v)
{
    return v->edge_samples == b->dials.edge_samples ||
           v->shadow_points == b->dials.shadow_points ||
           (v->half_shading && b->dials.half_shading) ||
           (v->width == b->dials.width && v->height == b->dials.height) ||
           (v->sets & ~glint_system_sets()) != 0;
}

static int add_all(struct scene_bench *b)
{
    const struct variation plain = {.width = 0}, full = {1920, 1080, .sets = 0};
    int code = b->sizes ? EXIT_OK : add(b, &plain);

    for (size_t i = 0; i < sizeof variations / sizeof *variations; i++) {
        const struct variation *const v = &variations[i];

        if (code != EXIT_OK || !(b->sizes ? v->width > 0 : b->all))
            continue;
        if (b->sizes && v->width > full.width)
            code = add(b, &full);
        if (code == EXIT_OK && (b->sizes || !is_left_out(b, v)))
            code = add(b, v);
    }
    return code;
}

/* ------------------------------------------------------------------ rounds */

static enum glint_status run_rounds(struct scene_bench *b)
{
    struct tool_progress progress;
    enum glint_status status = GLINT_OK;

    tool_progress_start(&progress, b->tool, "bench");
    for (int i = 0; i < b->n_trials && status == GLINT_OK; i++)
        status = scene_trial_warm(b->trial[i]);
    for (int round = 0; round < b->rounds && status == GLINT_OK; round++) {
        for (int i = 0; i < b->n_sizes; i++)
            b->size[i].floor_ms[round] = canvas_floor_ms(&b->size[i].canvas);
        for (int i = 0; i < b->n_trials; i++)
            scene_trial_run(b->trial[i], b->counter, round);
        tool_progress_show(&progress, (round + 1.0) / b->rounds);
    }
    tool_progress_end(&progress);
    return status;
}

/* ------------------------------------------------------------------ output */

static const char *const stage_names[SCENE_STAGES] = {
    "prepare", "around", "draw", "shadows", "lights", "whole"};

static const char *shading_of(const struct scene_trial *t)
{
    return t->frame.cfg.half_shading ? "half" : "full";
}

static double stage_ms(const struct scene_bench *b, int i, int stage)
{
    return canvas_median(b->trial[i]->ms[stage], b->rounds);
}

static void print_trial(const struct scene_bench *b, int i)
{
    const struct scene_trial *const t = b->trial[i];
    const struct glint_scene_config *const cfg = &t->frame.cfg;
    const double floor_ms = canvas_median(b->on[i]->floor_ms, b->rounds);

    printf("%-16.16s %4dx%-4d %5d %6d %-7s %2d %-5s %8.3f %7.1f ",
           b->scene.model.header->name, cfg->width, cfg->height,
           cfg->edge_samples, cfg->shadow_points, shading_of(t),
           t->tool.n_threads, t->tool.kernels, stage_ms(b, i, SCENE_WHOLE),
           stage_ms(b, i, SCENE_WHOLE) / floor_ms);
    for (int s = 0; s < SCENE_WHOLE; s++)
        printf(" %7.2f", stage_ms(b, i, s) / floor_ms);
    printf("  %7d %7.2f\n", t->covered_px,
           (double)(t->frame.bytes + b->scene.bytes) / (1 << 20));
}

static void print(const struct scene_bench *b)
{
    printf("floor %.3f ms (%dx%d %s, %d rounds); stages are ratios to it\n",
           canvas_median(b->on[0]->floor_ms, b->rounds),
           b->trial[0]->frame.cfg.width, b->trial[0]->frame.cfg.height,
           b->format_word, b->rounds);
    printf("%-16s %9s %5s %6s %-7s %2s %-5s %8s %7s ", "scene", "size", "edges",
           "points", "shading", "th", "sets", "ms", "ratio");
    for (int s = 0; s < SCENE_WHOLE; s++)
        printf(" %7s", stage_names[s]);
    printf("  %7s %7s\n", "covers", "MiB");
    for (int i = 0; i < b->n_trials; i++)
        print_trial(b, i);
}

static void json_trial(struct json_writer *json, const struct scene_bench *b,
                       int i)
{
    const struct scene_trial *const t = b->trial[i];
    const struct glint_scene_config *const cfg = &t->frame.cfg;
    const double ms = stage_ms(b, i, SCENE_WHOLE);

    json_write(json,
               "\n{scene: %s, width: %d, height: %d, format: %s, "
               "edge_samples: %d, shadow_points: %d, shading: %s, threads: %d, "
               "kernels: %s, ms: %.4f, ratio: %.3f",
               b->scene.model.header->name, cfg->width, cfg->height,
               b->format_word, cfg->edge_samples, cfg->shadow_points,
               shading_of(t), t->tool.n_threads, t->tool.kernels, ms,
               ms / canvas_median(b->on[i]->floor_ms, b->rounds));
    for (int s = 0; s < SCENE_STAGES; s++)
        json_write(json, "%s_ms: %.4f", stage_names[s], stage_ms(b, i, s));
    json_write(json,
               "instructions: %.0f, covered_px: %d, "
               "triangles: %d, arena_bytes: %zu, model_bytes: %zu}",
               t->instructions, t->covered_px, t->frame.stats.triangles,
               t->frame.bytes, b->scene.bytes);
}

static void print_json(const struct scene_bench *b)
{
    struct json_writer json = {.to = stdout};

    json_write(&json, "{floor_ms: %.5f, rounds: %d, cases: [",
               canvas_median(b->on[0]->floor_ms, b->rounds), b->rounds);
    for (int i = 0; i < b->n_trials; i++)
        json_trial(&json, b, i);
    json_write(&json, "\n]}\n");
}

/* ----------------------------------------------------------------- command */

static int run(struct scene_bench *b)
{
    int code;

    if (glint_pool_create(&b->one, 1) != GLINT_OK ||
        glint_pool_create(&b->two, 2) != GLINT_OK || b->two->n != 2)
        return tool_fail(b->tool, GLINT_E_MEMORY, "no threads to be had");
    code = scene_trial_scene(b->tool, b->file, &b->scene);
    if (code == EXIT_OK && b->scene.model.header->shadow &&
        scene_trial_bare(&b->scene, &b->bare) != GLINT_OK)
        code = tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    if (code == EXIT_OK)
        code = add_all(b);
    if (code != EXIT_OK)
        return code;
    b->counter = glint_instructions_open();
    if (run_rounds(b) != GLINT_OK)
        code = tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    glint_instructions_close(b->counter);
    if (code == EXIT_OK)
        (b->tool->json ? print_json : print)(b);
    return code;
}

static void close_bench(struct scene_bench *b)
{
    for (int i = 0; i < b->n_trials; i++) {
        scene_trial_close(b->trial[i]);
        free(b->trial[i]);
    }
    for (int i = 0; i < b->n_sizes; i++)
        canvas_finish(&b->size[i].canvas);
    baked_scene_close(&b->scene);
    baked_scene_close(&b->bare);
    glint_pool_destroy(b->one);
    glint_pool_destroy(b->two);
    free(b);
}

static bool take_format(struct scene_bench *b, const char *text)
{
    static const char *const words[] = {"yuyv",     "i420",   "nv12", "rgb24",
                                        "xrgb8888", "rgb565", NULL};
    static const enum glint_pixel_format formats[] = {
        GLINT_YUYV,  GLINT_I420,     GLINT_NV12,
        GLINT_RGB24, GLINT_XRGB8888, GLINT_RGB565};
    const int word = tool_word(text, words);

    if (word < 0)
        return false;
    b->format = formats[word];
    b->format_word = words[word];
    return true;
}

static const struct option own[] = {{"scene", required_argument, NULL, 'x'},
                                    {"all", no_argument, NULL, 'a'},
                                    {"sizes", no_argument, NULL, 'm'},
                                    {"size", required_argument, NULL, 's'},
                                    {"repeat", required_argument, NULL, 'r'},
                                    {"format", required_argument, NULL, 'F'},
                                    {NULL, 0, NULL, 0}};

/* Takes option C. Returns 1, or 0 if it does not take that value, or -2 if C is
 * another option. */
static int take(struct scene_bench *b, int c)
{
    switch (c) {
    case 'x':
        b->file = optarg;
        return *optarg != '\0';
    case 'a':
        return b->all = true;
    case 'm':
        return b->sizes = true;
    case 's':
        return tool_size(optarg, &b->dials.width, &b->dials.height);
    case 'r':
        return tool_integer(optarg, 1, SCENE_ROUNDS, &b->rounds);
    case 'F':
        return take_format(b, optarg);
    default:
        return -2;
    }
}

static int parse(struct tool *tool, int argc, char **argv,
                 struct scene_bench *b)
{
    const struct option *options;
    struct glint_options shading;
    int c, at = 0, code;

    glint_options_defaults(&shading);
    options = engine_getopt(tool, ENGINE_GROUP(SHADING), &shading, own);
    while ((c = tool_getopt(argc, argv, TOOL_COMMON_SHORT, options, &at)) >=
           0) {
        const int taken = take(b, c);

        if (taken == 0)
            return tool_refuse(tool, options[at].name, optarg);
        code = taken == -2 ? engine_option(tool, &shading, c, optarg) : -1;
        if (code == -2)
            code = tool_option(tool, c, optarg);
        if (code >= 0)
            return code;
    }
    scene_dials_choose(&b->dials, &shading);
    return optind == argc
               ? -1
               : tool_usage(tool, "--scene takes no lens; '%s' is too much",
                            argv[optind]);
}

int cmd_bench_scene(int argc, char **argv)
{
    struct tool tool = {.name = "bench", .help = help, .help_end = COMMON_HELP};
    struct scene_bench *const b = calloc(1, sizeof *b);
    int code;

    if (!b)
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    b->tool = &tool;
    b->rounds = 15;
    b->format = GLINT_YUYV;
    b->format_word = "yuyv";
    b->dials = (struct scene_dials){
        .width = 1920, .height = 1080, .edge_samples = 4, .shadow_points = 4};
    tool.kernels = "auto";
    code = parse(&tool, argc, argv, b);
    if (code < 0)
        code = tool_start(&tool);
    if (code == EXIT_OK && tool.workers)
        code = run(b);
    close_bench(b);
    tool_finish(&tool);
    return code;
}
