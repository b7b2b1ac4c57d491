/* SPDX-License-Identifier: MIT
 *
 * scene_sweep: its options, its points, and its files.
 */
#include "reference/scenes/scene_sweep.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lab/report_file.h"
#include "lab/sweep.h"
#include "linux/instructions.h"
#include "options/command_line.h"
#include "posix/workers.h"
#include "scenes/budget.h"

static const char help[] =
    "scene_sweep --scene NAME.scene -o FOLDER [options]\n"
    "\n"
    "Draws the same frame of a scene with all values of its dials: points of "
    "a\n"
    "pixel at outlines 1, 4, 8, 16; of a light 1, 4, 16; shading full and\n"
    "half; under an environment that lights brushed metal also lookups 1, 4, "
    "8,\n"
    "16, 32, of two levels and of the nearest; of translucent stones that are "
    "texts\n"
    "also models, kernels or terms, ranks, bits, texels, and maps of every "
    "second\n"
    "and fourth frame of a thing that turns a degree a frame (minutes to bake, "
    "kept\n"
    "in the cache); and measures each against the exact picture, drawn by rays "
    "in\n"
    "double precision, light in stones by all of their rows: time (as glint "
    "bench --scene does, all taking turns),\n"
    "instructions where the processor counts them, memory, PSNR, SSIM, the\n"
    "99th percentile of the differences in codes, and flux. FOLDER gets\n"
    "  sweep.csv     all of it\n"
    "  front.svg     error against time, and what nothing else is better than\n"
    "  dials.svg     each dial by itself\n"
    "  table.md      the front, and what --budget comes by\n"
    "  index.html    these, and pictures to judge by; one file\n"
    "\n"
    "  -o, --output FOLDER\n"
    "  --size WxH          default 640x360\n"
    "  --small             160x90, fewer rounds and rays, in seconds\n"
    "  --repeat N          rounds, 1 to 100 (default 7)\n"
    "  --exact-samples N   the exact picture has N x N points of each pixel,\n"
    "                      1 to 64 (default 8)\n"
    "  --count             only say which points there are, drawing each once\n"
    "  --counts FILE       instructions of points from\n"
    "                      tools/report/sweep-insn\n"
    "  --cost WHAT         time (default) | instructions: what fronts go by\n"
    "  --json              prints all points on standard output, too\n";

static const int edge_samples[] = {1, 4, 8, 16}, shadow_points[] = {1, 4, 16};

static const int lookups[] = {1, 4, 8, 16, 32};

/* ------------------------------------------------------------------ points */

/* Returns what dial D of VALUE is where nobody turns it: a model has numbers of
 * kernels or terms of its own. */
static int usual(const struct scene_sweep *s, const int value[SCENE_DIALS],
                 int d)
{
    static const int planes[] = {0, 1, 4, 5};

    return d == SCENE_PLANES && value[SCENE_MODEL] != s->standard[SCENE_MODEL]
               ? planes[value[SCENE_MODEL]]
               : s->standard[d];
}

/* Sets VALUE to the dials of LEVEL of --budget, and returns its quality. */
static double level_of(const struct scene_sweep *s, int level,
                       int value[SCENE_DIALS])
{
    struct scene_budget budget;
    const struct scene_dials most = {
        .edge_samples = 16, .shadow_points = 16, .ward_samples = 32};
    struct scene_dials d;

    scene_budget_init(&budget, &most);
    budget.level = level;
    d = scene_budget_dials(&budget, level);
    memcpy(value, s->standard, sizeof s->standard);
    value[SCENE_EDGES] = d.edge_samples;
    value[SCENE_SHADOWED] = d.shadow_points;
    value[SCENE_SHADING] = d.half_shading ? 2 : 1;
    value[SCENE_LOOKUPS] = d.ward_samples;
    value[SCENE_LEVELS] = d.ward_nearest ? 1 : 2;
    return scene_budget_quality(&budget);
}

static bool has_metal(const struct scene_sweep *s)
{
    const struct glint_scene_header *h = s->scene.model.header;

    return h->n_wards > 0 && h->n_environments > 0;
}

/* Returns the quality that --budget calls these dials, or -1. Without metal its
 * own dials do not count. */
static double quality_of(const struct scene_sweep *s,
                         const int value[SCENE_DIALS])
{
    for (int i = 0; i < SCENE_BUDGET_LEVELS; i++) {
        int of_level[SCENE_DIALS];
        const double quality = level_of(s, i, of_level);

        if (!has_metal(s))
            memcpy(of_level + SCENE_LOOKUPS, value + SCENE_LOOKUPS,
                   2 * sizeof *value);
        if (memcmp(value, of_level, sizeof of_level) == 0)
            return quality;
    }
    return -1;
}

void scene_sweep_add(struct scene_sweep *s, const int value[SCENE_DIALS])
{
    struct scene_point p = {.dial = -1, .psnr_db = (double)NAN};
    int turned = 0;

    memcpy(p.value, value, sizeof p.value);
    for (int d = 0; d < SCENE_DIALS; d++)
        if (p.value[d] != usual(s, value, d)) {
            turned++;
            p.dial = d;
        }
    p.kind = turned == 0   ? SCENE_STANDARD
             : turned == 1 ? SCENE_ALONE
                           : SCENE_TOGETHER;
    p.dial = turned == 1 ? p.dial : -1;
    p.quality = quality_of(s, p.value);
    p.scene = &s->scene;
    if (s->n_points < SCENE_POINTS)
        s->point[s->n_points++] = p;
}

/* Adds what --budget comes by and the rest has not. */
static void add_levels(struct scene_sweep *s)
{
    for (int i = 0; i < SCENE_BUDGET_LEVELS; i++) {
        int value[SCENE_DIALS];
        bool is_there = false;

        level_of(s, i, value);
        for (int k = 0; k < s->n_points; k++)
            is_there |= memcmp(value, s->point[k].value, sizeof value) == 0;
        if (!is_there)
            scene_sweep_add(s, value);
    }
}

/* Adds all values of the dials that metal does not have, with lookups as usual,
 * or of metal's with points of outlines as usual. */
static void add_points(struct scene_sweep *s)
{
    int value[SCENE_DIALS];

    memcpy(value, s->standard, sizeof value);
    for (int e = 0; e < 4; e++)
        for (int p = 0; p < 3; p++)
            for (int shading = 1; shading <= 2; shading++) {
                value[SCENE_EDGES] = edge_samples[e];
                value[SCENE_SHADOWED] = shadow_points[p];
                value[SCENE_SHADING] = shading;
                scene_sweep_add(s, value);
            }
    if (!has_metal(s))
        return;
    value[SCENE_EDGES] = s->standard[SCENE_EDGES];
    for (int n = 0; n < 5; n++)
        for (int levels = 1; levels <= 2; levels++)
            for (int p = 0; p < 3; p++)
                for (int shading = 1; shading <= 2; shading++) {
                    value[SCENE_SHADOWED] = shadow_points[p];
                    value[SCENE_SHADING] = shading;
                    value[SCENE_LOOKUPS] = lookups[n];
                    value[SCENE_LEVELS] = levels;
                    if (lookups[n] != s->standard[SCENE_LOOKUPS] ||
                        levels != s->standard[SCENE_LEVELS])
                        scene_sweep_add(s, value);
                }
    add_levels(s);
}

static void mark_front(struct scene_sweep *s)
{
    double cost[SCENE_POINTS], quality[SCENE_POINTS];
    int front[SCENE_POINTS], n;

    for (int i = 0; i < s->n_points; i++) {
        cost[i] = scene_sweep_cost(s, &s->point[i]);
        quality[i] = s->point[i].psnr_db;
    }
    n = sweep_front(cost, quality, s->n_points, front);
    for (int i = 0; i < n; i++)
        s->point[front[i]].front = true;
}

/* ------------------------------------------------------------------ output */

typedef void write_fn(const struct scene_sweep *s, FILE *file);

static int save(const struct scene_sweep *s, const char *name, write_fn *write)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *const file = open_memstream(&text, &bytes);

    if (!file)
        return tool_fail(s->tool, GLINT_E_MEMORY, NULL);
    write(s, file);
    return report_file_save(s->tool, s->folder, name, file, &text, &bytes);
}

static int save_all(const struct scene_sweep *s)
{
    static const struct {
        const char *name;
        write_fn *write;
    } files[] = {{"sweep.csv", scene_sweep_csv},
                 {"front.svg", scene_sweep_front},
                 {"dials.svg", scene_sweep_dials},
                 {"table.md", scene_sweep_table},
                 {"index.html", scene_sweep_page}};
    int code = EXIT_OK;

    for (size_t i = 0; i < sizeof files / sizeof *files && code == EXIT_OK; i++)
        code = save(s, files[i].name, files[i].write);
    if (code == EXIT_OK && s->tool->json)
        scene_sweep_json(s, stdout);
    else if (code == EXIT_OK && !s->tool->quiet)
        scene_sweep_table(s, stdout);
    return code;
}

/* ----------------------------------------------------------------- command */

static int read_counts(struct scene_sweep *s)
{
    double instructions[SCENE_POINTS];
    int code;

    for (int i = 0; i < s->n_points; i++)
        instructions[i] = s->point[i].instructions;
    code = sweep_read_counts(s->counts, s->n_points, instructions);
    for (int i = 0; i < s->n_points; i++)
        s->point[i].instructions = instructions[i];
    return code;
}

static int measure(struct scene_sweep *s)
{
    int code = tool_scene_stones(s->tool, s->file, s->text, NULL, s->stones);

    if (code != EXIT_OK)
        return code;
    code = scene_trial_scene(s->tool, s->file, &s->scene);
    if (code == EXIT_OK)
        code = stone_sweep_open(s);
    if (code == EXIT_OK) {
        add_points(s);
        stone_sweep_points(s);
        code = stone_sweep_bake(s);
    }
    if (code == EXIT_OK) {
        s->counter = glint_instructions_open();
        code = scene_sweep_measure(s);
        glint_instructions_close(s->counter);
    }
    glint_description_free(s->text);
    if (code == EXIT_OK && s->counts)
        code = read_counts(s);
    if (code != EXIT_OK || s->count_only)
        return code;
    if (s->by_instructions && isnan(s->point[0].instructions))
        return tool_usage(s->tool, "this processor counts no instructions: "
                                   "take --counts of tools/report/sweep-insn");
    mark_front(s);
    return save_all(s);
}

static int run(struct scene_sweep *s)
{
    int code;

    if (!tool_is_scene(s->file))
        return tool_usage(s->tool, "%s: exact pictures need the scene's text",
                          s->file);
    if (!s->count_only && !report_file_folder(s->folder)) {
        fprintf(stderr, "scene_sweep: %s: %s\n", s->folder, strerror(errno));
        return EXIT_OUTPUT;
    }
    s->text = calloc(1, sizeof *s->text);
    s->stones = calloc(1, sizeof *s->stones);
    s->set = calloc(SCENE_SETS, sizeof *s->set);
    if (!s->text || !s->stones || !s->set ||
        glint_pool_create(&s->one, 1) != GLINT_OK)
        return tool_fail(s->tool, GLINT_E_MEMORY, NULL);
    code = measure(s);
    scene_sweep_free(s);
    return code;
}

static const struct option options[] = {
    {"scene", required_argument, NULL, 'x'},
    {"output", required_argument, NULL, 'o'},
    {"size", required_argument, NULL, 's'},
    {"repeat", required_argument, NULL, 'r'},
    {"exact-samples", required_argument, NULL, 'g'},
    {"cost", required_argument, NULL, 'c'},
    {"small", no_argument, NULL, 'm'},
    {"count", no_argument, NULL, 'n'},
    {"counts", required_argument, NULL, 'C'},
    TOOL_COMMON_OPTIONS};

static bool take_cost(struct scene_sweep *s, const char *text)
{
    static const char *const words[] = {"time", "instructions", NULL};
    const int word = tool_word(text, words);

    s->by_instructions = word == 1;
    return word >= 0;
}

static bool be_small(struct scene_sweep *s)
{
    s->width = 160;
    s->height = 90;
    s->rounds = 1;
    s->samples = 4;
    return true;
}

/* Takes option C. Returns 1, or 0 if it does not take that value, or -2 if C is
 * another option. */
static int take(struct scene_sweep *s, int c)
{
    switch (c) {
    case 'x':
        s->file = optarg;
        return *optarg != '\0';
    case 'o':
        s->folder = optarg;
        return 1;
    case 's':
        return tool_size(optarg, &s->width, &s->height);
    case 'r':
        return tool_integer(optarg, 1, SCENE_ROUNDS, &s->rounds);
    case 'g':
        return tool_integer(optarg, 1, 64, &s->samples);
    case 'c':
        return take_cost(s, optarg);
    case 'm':
        return be_small(s);
    case 'n':
        return s->count_only = true;
    case 'C':
        s->counts = optarg;
        return 1;
    default:
        return -2;
    }
}

static int parse(struct tool *tool, int argc, char **argv,
                 struct scene_sweep *s)
{
    int c, at = 0, code;

    while ((c = tool_getopt(argc, argv, "o:" TOOL_COMMON_SHORT, options,
                            &at)) >= 0) {
        const int taken = take(s, c);

        if (taken == 0)
            return tool_refuse(tool, options[at].name, optarg);
        if (taken == -2 && (code = tool_option(tool, c, optarg)) >= 0)
            return code;
    }
    if (!s->folder && !s->count_only)
        return tool_usage(tool, "needs -o FOLDER");
    return optind == argc
               ? -1
               : tool_usage(tool, "--scene takes no lens; '%s' is too much",
                            argv[optind]);
}

int cmd_sweep_scene(int argc, char **argv)
{
    struct tool tool = {
        .name = "scene_sweep", .help = help, .help_end = COMMON_HELP};
    struct scene_sweep *const s = calloc(1, sizeof *s);
    int code;

    if (!s)
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    s->tool = &tool;
    s->width = 640;
    s->height = 360;
    s->rounds = 7;
    s->samples = 8;
    code = parse(&tool, argc, argv, s);
    if (code < 0)
        code = tool_start(&tool);
    if (code == EXIT_OK && tool.workers)
        code = run(s);
    baked_scene_close(&s->scene);
    stone_sweep_free(s);
    glint_pool_destroy(s->one);
    free(s->text);
    free(s);
    tool_finish(&tool);
    return code;
}
