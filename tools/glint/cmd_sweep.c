/* SPDX-License-Identifier: MIT
 *
 * glint sweep: measures time and error of frames as functions of the quality
 * parameters, varied one by one and together.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure/sweep.h"
#include "options/command_line.h"
#include "posix/output.h"

static const char help[] =
    "glint sweep [LENS]... -o FILE [options]\n"
    "\n"
    "Draws the same frames with each quality parameter varied separately, "
    "with\n"
    "several varied together, and along --quality, and compares each with the\n"
    "exact picture: time (as in glint bench, in rounds), memory, PSNR, SSIM, "
    "the\n"
    "99th percentile of the differences in codes, and flux. FILE gets all\n"
    "results as CSV, with version and machine; standard output gets a table\n"
    "of the named qualities.\n"
    "Without lenses: one of each type that comes with glint.\n"
    "\n"
    "  -o, --output FILE\n"
    "  --size WxH[,...]    sizes for the parameters (default 1280x720; of the\n"
    "                      first lens also 640x360, with one light and 16)\n"
    "  --lights N[,...]    numbers of lights (default 1)\n"
    "  --angle A[,...]     angles of the first light in degrees (default 12)\n"
    "  --small             one lens, one small picture, fewer values, in "
    "seconds\n"
    "  --repeat N          rounds, 1 to 100 (default 7)\n"
    "  --json              print all points on standard output, too\n";
static const char help_end[] = COMMON_HELP;

static const char *const default_lenses[] = {
    "heliar-tronnier", "double-gauss-angenieux", "itoh-zoom-long",
    "nikon-zoom-mid", "canon-zoom-mid"};

enum { MAX_LIST = 8 };

struct asked {
    struct sweep *sweep;
    const char *output;
    int n_sizes, size[MAX_LIST][2];
    int n_lights, lights[MAX_LIST];
    int n_angles;
    double angle[MAX_LIST];
    /* whether none of --size, --lights, --angle, --small was given */
    bool plain;
};

/* ------------------------------------------------------------------- cases */

static void add_sweep_case(struct sweep *s, struct sweep_case c)
{
    if (s->n_cases < SWEEP_CASES)
        s->scase[s->n_cases++] = c;
}

/* Adds cases with a small image for the first lens: one with a single light,
 * and one with 16 lights that can merge. Exact images of 16 lights at full size
 * would take too long. */
static void add_small_image_cases(struct sweep *s)
{
    const struct sweep_case c = {
        .width = 640, .height = 360, .n_lamps = 1, .angle = 12};
    struct sweep_case many = c;

    many.n_lamps = 16;
    add_sweep_case(s, c);
    add_sweep_case(s, many);
}

static void add_requested_cases(struct sweep *s, const struct asked *a)
{
    for (int lens = 0; lens < s->n_lenses; lens++) {
        for (int i = 0; i < a->n_sizes; i++)
            for (int k = 0; k < a->n_lights; k++)
                for (int m = 0; m < a->n_angles; m++)
                    add_sweep_case(s,
                                   (struct sweep_case){
                                       .lens = lens,
                                       .width = a->size[i][0],
                                       .height = a->size[i][1],
                                       .n_lamps = a->lights[k],
                                       .angle = a->angle[m],
                                       .together = i == 0 && k == 0 && m == 0});
        if (lens == 0 && a->plain)
            add_small_image_cases(s);
    }
}

/* ------------------------------------------------------------------ output */

static int save_sweep(const struct sweep *s, const char *path)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *file = glint_memory_file_open(&text, &bytes);
    int code;

    if (file)
        sweep_write_csv(s, file);
    code = tool_save_text(s->tool, path, file, &text, &bytes);
    if (code == EXIT_OK && s->tool->json)
        sweep_write_json(s, stdout);
    else if (code == EXIT_OK && !s->tool->quiet)
        sweep_write_name_table(s, stdout);
    return code;
}

/* ----------------------------------------------------------------- command */

static void print_sweep_case(const struct sweep *s, int c)
{
    const struct sweep_case *k = &s->scase[c];

    if (!s->tool->quiet)
        fprintf(stderr,
                "glint sweep: %d of %d: %s, %dx%d, %d light%s, %g "
                "degrees: %d points\n",
                c + 1, s->n_cases, s->lens[k->lens], k->width, k->height,
                k->n_lamps, k->n_lamps > 1 ? "s" : "", k->angle, k->n);
}

static int measure_sweep_cases(struct sweep *s)
{
    struct tool_progress progress;
    int code = EXIT_OK;

    for (int c = 0; c < s->n_cases && code == EXIT_OK; c++) {
        print_sweep_case(s, c);
        tool_progress_start(&progress, s->tool, "sweep");
        code = sweep_measure_case(s, c, &progress);
        tool_progress_end(&progress);
    }
    return code;
}

static int run_sweep(struct sweep *s, const struct asked *a)
{
    int code;

    for (int i = 0; i < s->n_lenses; i++)
        if (tool_is_model(s->lens[i]))
            return tool_usage(
                s->tool, "%s is a model: exact pictures need the lens table",
                s->lens[i]);
    code = tool_check_output(s->tool, a->output);
    if (code != EXIT_OK)
        return code;
    add_requested_cases(s, a);
    if (sweep_plan_points(s) != GLINT_OK)
        return tool_fail(s->tool, GLINT_E_MEMORY, NULL);
    code = measure_sweep_cases(s);
    if (code != EXIT_OK)
        return code;
    sweep_mark_fronts(s);
    return save_sweep(s, a->output);
}

static bool parse_image_sizes(const char *text, struct asked *a)
{
    char copy[128], *word, *rest = copy;

    if ((size_t)snprintf(copy, sizeof copy, "%s", text) >= sizeof copy)
        return false;
    for (a->n_sizes = 0; (word = strtok_r(rest, ",", &rest)); a->n_sizes++)
        if (a->n_sizes == MAX_LIST ||
            !tool_parse_size(word, &a->size[a->n_sizes][0],
                             &a->size[a->n_sizes][1]))
            return false;
    return a->n_sizes > 0;
}

/* Parses up to MAX_LIST numbers within LOW .. HIGH. Returns their number, or 0
 * if TEXT is malformed. */
static int parse_number_list(const char *text, double low, double high,
                             double *to)
{
    const int n = tool_parse_numbers(text, to, MAX_LIST);

    for (int i = 0; i < n; i++)
        if (to[i] < low || to[i] > high)
            return 0;
    return n;
}

static bool parse_light_counts(const char *text, struct asked *a)
{
    double v[MAX_LIST];

    a->n_lights = parse_number_list(text, 1, 10000, v);
    for (int i = 0; i < a->n_lights; i++) {
        if (v[i] != floor(v[i]))
            return false;
        a->lights[i] = (int)v[i];
    }
    return a->n_lights > 0;
}

enum option_code { OPT_SMALL = 1 };

static const struct option options[] = {
    {"output", required_argument, NULL, 'o'},
    {"size", required_argument, NULL, 's'},
    {"lights", required_argument, NULL, 'l'},
    {"angle", required_argument, NULL, 'a'},
    {"repeat", required_argument, NULL, 'r'},
    {"small", no_argument, NULL, OPT_SMALL},
    TOOL_COMMON_OPTIONS};

static int parse_option(struct tool *tool, void *ctx, int c, const char *value)
{
    struct asked *const a = ctx;
    bool good = true;

    switch (c) {
    case 'o':
        a->output = value;
        break;
    case 's':
        good = parse_image_sizes(value, a);
        break;
    case 'l':
        good = parse_light_counts(value, a);
        break;
    case 'a':
        good = (a->n_angles = parse_number_list(value, 0, 60, a->angle)) > 0;
        break;
    case 'r':
        good = tool_parse_integer(value, 1, SWEEP_ROUNDS, &a->sweep->rounds);
        break;
    case OPT_SMALL:
        a->sweep->small = true;
        break;
    default:
        return tool_apply_option(tool, c, value);
    }
    return good ? -1 : -2;
}

static int parse_options(struct tool *tool, int argc, char **argv,
                         struct asked *a)
{
    const int code = tool_parse_options(
        tool, argc, argv, "o:" TOOL_COMMON_SHORT, options, parse_option, a);

    if (code >= 0)
        return code;
    if (!a->output)
        return tool_usage(tool, "needs -o FILE");
    if (argc - optind > SWEEP_LENSES)
        return tool_usage(tool, "accepts at most %d lenses", SWEEP_LENSES);
    for (; optind < argc; optind++)
        a->sweep->lens[a->sweep->n_lenses++] = argv[optind];
    return -1;
}

/* Sets the lenses, sizes, numbers of lights, angles, rounds and grid that
 * the command line does not set. */
static void set_sweep_defaults(struct sweep *s, struct asked *a)
{
    const int n =
        s->small ? 1 : (int)(sizeof default_lenses / sizeof *default_lenses);

    for (int i = 0; s->lens[0] == NULL || (i > 0 && i < n); i++)
        s->lens[s->n_lenses++] = default_lenses[i];
    a->plain = !s->small && a->n_sizes + a->n_lights + a->n_angles == 0;
    if (a->n_sizes == 0) {
        a->size[0][0] = s->small ? 160 : 1280;
        a->size[0][1] = s->small ? 90 : 720;
        a->n_sizes = 1;
    }
    if (a->n_lights == 0)
        a->lights[a->n_lights++] = 1;
    if (a->n_angles == 0)
        a->angle[a->n_angles++] = 12;
    s->rounds = s->rounds ? s->rounds : s->small ? 1 : 7;
    s->grid = s->small ? 64 : 128;
}

static void close_sweep(struct sweep *s)
{
    free(s->point);
    free(s);
}

int cmd_sweep(int argc, char **argv)
{
    struct tool tool = {.name = "sweep", .help = help, .help_end = help_end};
    struct asked asked = {.output = NULL};
    struct sweep *const s = calloc(1, sizeof *s);
    int code;

    if (!s)
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    asked.sweep = s;
    s->tool = &tool;
    settings_set_defaults(&s->base);
    code = parse_options(&tool, argc, argv, &asked);
    if (code < 0)
        code = tool_start_threads(&tool);
    if (code == EXIT_OK && tool.workers && asked.output) {
        set_sweep_defaults(s, &asked);
        code = run_sweep(s, &asked);
    }
    close_sweep(s);
    tool_stop_threads(&tool);
    return code;
}
