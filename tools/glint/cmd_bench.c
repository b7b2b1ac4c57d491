/* SPDX-License-Identifier: MIT
 *
 * glint bench: measures the time of a frame and compares it with the memory
 * floor, the time of adding a constant layer to the same frame.
 */
#include <stdlib.h>
#include <string.h>

#include "measure/bench.h"
#include "options/command_line.h"

/* Applies option C with the value optarg. Returns 1 on success, 0 if the
 * value is invalid, -2 if C is unknown. */
static int parse_option(struct bench *b, int c)
{
    switch (c) {
    case 's':
        return tool_parse_size(optarg, &b->width, &b->height);
    case 'r':
        return tool_parse_integer(optarg, 1, b->subject->max_rounds,
                                  &b->rounds);
    case 'F':
        c = tool_find_word_index(optarg, bench_format);
        b->word = c < 0 ? b->word : c;
        return c >= 0;
    default:
        return b->subject->take(b, c, optarg);
    }
}

static int parse_options(struct bench *b, int argc, char **argv)
{
    const struct option *const options = engine_build_options(
        b->tool, b->subject->groups, &b->base.options, b->subject->own);
    int c, at = 0, code;

    while ((c = tool_getopt(argc, argv, TOOL_COMMON_SHORT, options, &at)) >=
           0) {
        const int taken = parse_option(b, c);

        if (taken == 0)
            return tool_report_bad_value(b->tool, options[at].name, optarg);
        if (taken != -2)
            continue;
        code = settings_apply_option(b->tool, &b->base, c, optarg);
        if (code == -2)
            code = tool_apply_option(b->tool, c, optarg);
        if (code >= 0)
            return code;
    }
    return -1;
}

/* Returns whether the command line has --scene, which selects the scene
 * benchmark and its options. */
static bool has_scene_option(int argc, char **argv)
{
    for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
        if (strcmp(argv[i], "--scene") == 0 ||
            strncmp(argv[i], "--scene=", 8) == 0)
            return true;
    return false;
}

int cmd_bench(int argc, char **argv)
{
    struct tool tool = {
        .name = "bench", .help_end = COMMON_HELP, .kernels = "auto"};
    struct bench *const b = calloc(1, sizeof *b);
    int code;

    if (!b)
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    b->subject = has_scene_option(argc, argv) ? &bench_scene : &bench_flare;
    tool.help = b->subject->help;
    b->tool = &tool;
    b->rounds = 15;
    b->width = 1920;
    b->height = 1080;
    settings_set_defaults(&b->base);
    code = parse_options(b, argc, argv);
    if (code < 0)
        code = tool_start_threads(&tool);
    if (code == EXIT_OK && tool.workers)
        code =
            bench_run_all(b, argc - optind, (const char *const *)argv + optind);
    bench_close(b);
    tool_stop_threads(&tool);
    return code;
}
