/* SPDX-License-Identifier: MIT
 *
 * glint overlay: adds to an image or video the flare that a lens would produce
 * for the lamps in it.
 */
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "overlay/folder.h"
#include "overlay/overlay_line.h"
#include "overlay/overlay_y4m.h"
#include "options/command_line.h"
#include "options/numbered.h"
#include "formats/picture.h"
#include "posix/error.h"
#include "video/transfer.h"

static const char help[] =
    "glint overlay IN... -o OUT [options]\n"
    "\n"
    "Adds the flare of a lens to IN, in linear light:\n"
    "  a picture         .ppm .png .jpg; with the image plug-in more\n"
    "  a sequence        frames/%04d.ppm -> out/%04d.ppm: all numbers that "
    "exist,\n"
    "                    unless a file has this very name; gaps are reported\n"
    "  a video           .y4m, or - for standard input and output, built in;\n"
    "                    .mp4 .mkv .mov .webm .avi .mpg, animated .gif and\n"
    "                    more through the installed ffmpeg: sound is copied,\n"
    "                    rate and colours are preserved\n"
    "\n"
    "  -o, --output OUT    a file, or FOLDER/ where each IN keeps its name\n"
    "  --range R           auto | full | limited codes of a video\n"
    "  --matrix M          auto | 601 | 709 | 2020\n"
    "  --transfer T        auto | 709 | srgb | linear | gamma22 | gamma28 | "
    "240m | pq |\n"
    "                      hlg | log100 | log316: the curve from codes to "
    "light;\n"
    "                      auto: the file's tag, else 709\n"
    "  --format F          i420 | i422 | i444 | grey: IN, or - , is frames of "
    "8 bits\n"
    "                      without headers, 30 a second, of --size WxH and "
    "rows of\n"
    "                      --stride N bytes (default: no padding)\n"
    "  --encode OPTIONS    encoder options of ffmpeg, which replace those of\n"
    "                      glint (H.264: -crf 18): '-c:v libx265 -crf 20'\n"
    "  --start-number N    first of a sequence (default: 0 or 1, as found)\n"
    "  --frames A-B        only these frames of a video, from 0; those before\n"
    "                      are searched for lamps, not drawn\n"
    "  --warm-up N         with --frames: search only the last N frames before "
    "A\n"
    "                      for lamps; the result is the same if N includes a\n"
    "                      cut, or if tracks and exposure settle within N\n"
    "  --list-shots        print the frames A-B of each shot of a video, "
    "without -o\n"
    "  --layers OUT        write flare, ghosts, starburst and, if enabled, "
    "veil as\n"
    "                      layers of linear light: parts of an .exr, or a "
    "file\n"
    "                      per layer if its name has %s; %04d: frame number.\n"
    "                      Layers have colours even if IN is grey\n"
    "  --layers-type T     half (default) | float\n"
    "  --jpeg-quality N    1 to 100, of JPEG and WebP (default: about the "
    "input's,\n"
    "                      else 95)\n";

/* ------------------------------------------------------------------ options */

static bool parse_keyword(const char *text, const char *const *words,
                          int *value)
{
    *value = tool_find_word_index(text, words);
    return *value >= 0;
}

/* Parses the range of frames TEXT, "A-B". */
static bool parse_frame_range(struct overlay *o, const char *text)
{
    char first[12];
    const size_t n = strcspn(text, "-");

    if (n >= sizeof first || text[n] != '-')
        return false;
    memcpy(first, text, n);
    first[n] = '\0';
    return tool_parse_integer(first, 0, INT_MAX - 1, &o->first) &&
           tool_parse_integer(text + n + 1, o->first, INT_MAX - 1, &o->last);
}

/* Parses the size TEXT, "WxH". */
static bool parse_image_size(struct overlay *o, const char *text)
{
    char width[12];
    const size_t n = strcspn(text, "x");

    if (n >= sizeof width || text[n] != 'x')
        return false;
    memcpy(width, text, n);
    width[n] = '\0';
    return tool_parse_integer(width, 1, GLINT_MAX_SIDE, &o->raw.width) &&
           tool_parse_integer(text + n + 1, 1, GLINT_MAX_SIDE, &o->raw.height);
}

static bool parse_option(struct overlay *o, int option, const char *value)
{
    static const char *const ranges[] = {"auto", "full", "limited", NULL};
    static const char *const matrices[] = {"auto", "601", "709", "2020", NULL};
    static const char *const formats[] = {"i420", "i422", "i444", "grey", NULL};
    static const char *const types[] = {"half", "float", NULL};
    int word;

    switch (option) {
    case 'r':
        return parse_keyword(value, ranges, &o->range);
    case 'x':
        return parse_keyword(value, matrices, &o->matrix);
    case '4':
        o->transfer = tool_find_word_index(value, glint_transfer_words);
        return o->transfer >= 0 || strcmp(value, "auto") == 0;
    case '1':
        o->raw.format = tool_find_word_index(value, formats);
        o->has_raw = true;
        return o->raw.format >= 0;
    case '2':
        return parse_image_size(o, value);
    case '3':
        return tool_parse_integer(value, 1, 4 * GLINT_MAX_SIDE, &o->raw.stride);
    case 'Q':
        return tool_parse_integer(value, 1, 100, &o->quality);
    case 'L':
        o->layers.path = value;
        return *value != '\0';
    case 'T':
        word = tool_find_word_index(value, types);
        o->layers.is_float = word == 1;
        o->has_layers_type = true;
        return word >= 0;
    case 'F':
        return parse_frame_range(o, value);
    case 'W':
        return tool_parse_integer(value, 0, INT_MAX, &o->warm_up);
    case 'B':
        return o->lists_shots = true;
    default: /* 'n' */
        return tool_parse_integer(value, 0, 1000000000, &o->start_number);
    }
}

static const struct option own[] = {
    {"output", required_argument, NULL, 'o'},
    {"range", required_argument, NULL, 'r'},
    {"matrix", required_argument, NULL, 'x'},
    {"transfer", required_argument, NULL, '4'},
    {"format", required_argument, NULL, '1'},
    {"size", required_argument, NULL, '2'},
    {"stride", required_argument, NULL, '3'},
    {"start-number", required_argument, NULL, 'n'},
    {"jpeg-quality", required_argument, NULL, 'Q'},
    {"frames", required_argument, NULL, 'F'},
    {"warm-up", required_argument, NULL, 'W'},
    {"list-shots", no_argument, NULL, 'B'},
    {"encode", required_argument, NULL, 'e'},
    {"layers", required_argument, NULL, 'L'},
    {"layers-type", required_argument, NULL, 'T'},
    {NULL, 0, NULL, 0}};

static int check_raw_video_options(const struct tool *tool,
                                   const struct overlay *o)
{
    if (o->has_raw != (o->raw.width > 0) || (o->raw.stride && !o->has_raw))
        return tool_usage(tool, "frames without headers need --format F and "
                                "--size WxH");
    if (o->raw.stride && o->raw.stride < o->raw.width)
        return tool_usage(tool, "--stride %d is less than the width in --size",
                          o->raw.stride);
    return EXIT_OK;
}

/* Rejects options that exclude an output folder: --format, --list-shots, and,
 * with N > 1 inputs, --layers and --save-lights, which write a single file.
 * Returns an exit code. */
static int reject_options_without_folder(const struct tool *tool,
                                         const struct overlay *o, int n)
{
    if (o->has_raw)
        return tool_usage(tool, "--format excludes an output folder: raw "
                                "frames do not determine the type of the "
                                "output; name a file by -o");
    if (o->lists_shots)
        return tool_usage(tool, "--list-shots writes no file: leave out -o");
    if (n > 1 &&
        (o->layers.path || o->drawing.line.settings.options.save_lights))
        return tool_usage(tool, "--%s accepts one input, not %d",
                          o->layers.path ? "layers" : "save-lights", n);
    return EXIT_OK;
}

/* Checks that the options fit a single input. Returns -1 or an exit code. */
static int check_input_options(const struct tool *tool, int argc, char **argv,
                               struct overlay *o)
{
    int code;

    if (optind + 1 != argc)
        return tool_usage(
            tool,
            o->output || access(argv[argc - 1], F_OK) == 0
                ? "accepts one input per output file, so '%s' is too many; for "
                  "several inputs use -o FOLDER/"
                : "accepts one input; name the output by -o: -o '%s'",
            argv[argc - 1]);
    if (!o->output && !o->lists_shots)
        return tool_usage(tool, "needs -o OUT");
    if (o->lists_shots && (o->output || o->last < INT_MAX))
        return tool_usage(tool, "--list-shots analyses the whole video and "
                                "writes no file: leave out -o and --frames");
    if (o->lists_shots)
        o->output = "-";
    if ((code = check_raw_video_options(tool, o)) != EXIT_OK)
        return code;
    if (o->has_layers_type && !o->layers.path)
        return tool_usage(tool, "--layers-type needs --layers OUT");
    if (o->layers.path &&
        strcmp(o->drawing.line.settings.options.lens, "none") == 0)
        return tool_usage(tool,
                          "--layers needs a lens: --lens none draws no flare");
    o->input = argv[optind];
    if (o->drawing.line.reserve_bytes &&
        o->drawing.line.settings.options.rays == GLINT_RAYS_EXACT)
        return tool_usage(tool,
                          "--memory applies to models, not to exact rays");
    return -1;
}

/* Parses the command line and moves the inputs to ARGV[optind] on. OUTPUT
 * replaces the value of -o unless it is NULL. If -o is a folder, sets *FOLDER
 * to the folder. */
static int parse_options_and_inputs(struct tool *tool, int argc, char **argv,
                                    struct overlay *o, const char *output,
                                    const char **folder)
{
    const struct option *const options = engine_build_options(
        tool, ENGINE_ALL, &o->drawing.line.settings.options, own);
    int c, index = 0;
    int code = drawing_line_apply_command_style(
        tool, &o->drawing.line, argc, argv, "o:" TOOL_COMMON_SHORT, options);

    if (code >= 0)
        return code;
    while ((c = tool_getopt(argc, argv, "o:" TOOL_COMMON_SHORT, options,
                            &index)) >= 0) {
        code = drawing_line_set_option(tool, &o->drawing.line, c, optarg);
        if (code >= 0)
            return code;
        if (code == -1)
            continue;
        if (c == 'o')
            o->output = optarg;
        else if (c == 'e')
            o->encode = optarg;
        else if (strchr("rx4123nQLTFWB", c)) {
            if (!parse_option(o, c, optarg))
                return tool_report_bad_value(tool, options[index].name, optarg);
        } else if ((code = tool_apply_option(tool, c, optarg)) >= 0)
            return code;
    }
    if (optind == argc)
        return tool_check_inputs(
            tool, argc, argv, 1,
            "needs an input: a picture, a sequence or a video");
    if (!output && o->output && folder_is_path_a_folder(o->output)) {
        *folder = o->output;
        code = reject_options_without_folder(tool, o, argc - optind);
        return code == EXIT_OK ? -1 : code;
    }
    if (output)
        o->output = output;
    return check_input_options(tool, argc, argv, o);
}

/* ------------------------------------------------------------------- result */

static void print_overlay_statistics(const struct overlay *o)
{
    const int drawn = overlay_count_frames(o), n = drawn ? drawn : 1;

    fprintf(stderr,
            "%dx%d (find %.1f ms, flare %.1f ms), %d ghosts; flare memory %zu "
            "bytes, peak %zu\n",
            o->drawing.run.view.width, o->drawing.run.view.height,
            o->figures.find_ms / n, o->figures.flare_ms / n,
            o->drawing.run.report.ghosts,
            o->drawing.run.report.arena_bytes +
                o->drawing.run.report.star_bytes,
            o->figures.peak_bytes);
}

static void print_overlay_json(const struct overlay *o,
                               const struct overlay_light *light)
{
    const double seconds = tool_clock_s() - o->figures.started;
    const int drawn = overlay_count_frames(o), n = drawn ? drawn : 1;
    struct json_writer json = {.to = stdout};

    json_write(&json,
               "{input: %s, output: %s, frames: %d, ms: %.3f, fps: %.2f, "
               "find_ms: %.3f, "
               "flare_ms: %.3f, most_lights: %d, reused: %d",
               o->input, o->output, drawn, 1e3 * seconds, drawn / seconds,
               o->figures.find_ms / n, o->figures.flare_ms / n,
               o->figures.most_lights, o->figures.n_reused);
    overlay_write_json(&json, o, light);
    settings_write_json(&json, &o->drawing.run.report);
    json_write(&json, "}\n");
}

static void print_overlay_result(const struct tool *tool, struct overlay *o)
{
    const bool json = tool->json && strcmp(o->output, "-") != 0;
    struct overlay_light light;

    if (!tool->quiet && !tool->verbose && isatty(STDERR_FILENO))
        fputs("\r\033[K", stderr);
    settings_print_light_warnings(tool, &o->figures.worst);
    if (tool->quiet && !json)
        return;
    light = overlay_measure_light(o);
    if (json)
        print_overlay_json(o, &light);
    else
        overlay_print_summary(o, &light, stderr);
    if (tool->verbose && !tool->quiet)
        print_overlay_statistics(o);
}

/* Rejects an input that is missing, unreadable or empty, before a lens is
 * baked. Returns an exit code. */
static int check_input_file(struct tool *tool, struct overlay *o)
{
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;
    char pattern[NUMBERED_BYTES];
    struct stat file;

    if (strcmp(o->input, "-") == 0 &&
        o->drawing.line.settings.options.control &&
        strcmp(o->drawing.line.settings.options.control, "-") == 0)
        return tool_usage(tool, "pictures and --control cannot both come from "
                                "standard input");
    if (strcmp(o->input, "-") == 0 || overlay_is_sequence(o))
        return EXIT_OK;
    if (access(o->input, F_OK) != 0 &&
        numbered_convert_hashes(pattern, o->input))
        status = glint_error_report(
            &error, GLINT_E_IO, o->input,
            "does not exist; a sequence has a name like %s", pattern);
    else if (stat(o->input, &file) != 0 ||
             (S_ISREG(file.st_mode) && access(o->input, R_OK) != 0))
        status = glint_error_report(&error, GLINT_E_IO, o->input, "%s",
                                    strerror(errno));
    else if (S_ISREG(file.st_mode) && file.st_size == 0)
        status =
            glint_error_report(&error, GLINT_E_FORMAT, o->input, "is empty");
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

/* Checks, before the work begins, that the output can be written and that its
 * type fits the input. Returns an exit code. */
static int check_output_file(struct tool *tool, struct overlay *o)
{
    struct glint_error error = {""};
    bool frames;
    const int code = overlay_check_gif(tool, o, &frames);

    o->is_video = frames || o->has_raw || overlay_is_video(o->input);
    if (code != EXIT_OK)
        return code;
    if (!frames && !o->lists_shots &&
        o->is_video != overlay_is_video(o->output))
        return tool_usage(tool, "the output of a video must be a video (.y4m, "
                                "- or a type of ffmpeg), and that of a "
                                "picture must be a picture");
    if (!o->is_video && (o->last < INT_MAX || o->lists_shots))
        return tool_usage(tool,
                          "--%s applies to videos only; %s is not a video",
                          o->lists_shots ? "list-shots" : "frames", o->input);
    if (o->lists_shots)
        return EXIT_OK;
    if (o->is_video &&
        o->drawing.line.settings.options.layer == GLINT_LAYER_FLARE_ALPHA)
        return tool_usage(tool, "--layer flare-alpha applies to pictures only; "
                                "for a video use --layers NAME.%%04d.exr");
    if (o->last < INT_MAX && (o->drawing.line.settings.options.budget > 0 ||
                              o->drawing.line.settings.dials.still_px > 0))
        return tool_usage(tool,
                          "--frames excludes --budget and --still, since with "
                          "these a frame depends on the frames before");
    if (tool_check_output(tool, o->output) != EXIT_OK)
        return EXIT_OUTPUT;
    if (o->is_video || glint_kept_check(o->output, &error) == GLINT_OK)
        return EXIT_OK;
    tool_fail(tool, GLINT_E_OUTPUT, error.text);
    return EXIT_OUTPUT;
}

/* Disables the bake and the brightness measurement in S, because --list-shots
 * and --show lights draw no flare. Does nothing if key frames or control lines
 * may change the lens. */
static void disable_bake_and_metering(struct settings *s)
{
    struct glint_options *const o = &s->options;

    if (o->keys || o->control)
        return;
    if (!tool_is_model(o->lens))
        o->rays = GLINT_RAYS_EXACT;
    s->dials.flags &= ~(unsigned)GLINT_DIAL_ALWAYS_HALF;
    GLINT_OPTION_GIVEN(o, exposure) = true;
}

/* Returns how to draw with a lens table. A picture is drawn by
 * exact rays unless an option needs a model. A video or sequence needs a model,
 * which is baked when a lamp is detected, unless an option needs it before. */
static enum settings_unbaked
choose_rendering_without_model(const struct overlay *o)
{
    const struct settings *const s = &o->drawing.line.settings;
    const struct glint_options *const of = &s->options;

    if (!o->is_video && !overlay_is_sequence(o) &&
        settings_choose_method_without_model(s) == SETTINGS_TRACE)
        return SETTINGS_TRACE;
    return of->keys || of->control || of->scene || of->budget > 0 ||
                   settings_has_veil(s) || o->drawing.line.reserve_bytes
               ? SETTINGS_BAKE
               : SETTINGS_SEARCH;
}

/* Opens the lens and draws the input. Returns an exit code. */
static int draw_single_input(struct tool *tool, struct overlay *o)
{
    const bool is_sequence = overlay_is_sequence(o);
    int code;

    o->figures.started = tool_clock_s();
    if (!o->is_video && !is_sequence)
        return overlay_draw_single_picture(tool, o);
    code = drawing_open(tool, &o->drawing);
    o->figures.started = tool_clock_s();
    if (code != EXIT_OK)
        return code;
    return o->is_video ? overlay_draw_video(tool, o)
                       : overlay_draw_sequence(tool, o);
}

static int add_flare_to_single_input(struct tool *tool, struct overlay *o)
{
    int code = check_input_file(tool, o);

    if (code == EXIT_OK)
        code = check_output_file(tool, o);
    if (o->lists_shots || o->drawing.line.show_lights)
        disable_bake_and_metering(&o->drawing.line.settings);
    if (code == EXIT_OK && o->is_video)
        code = overlay_check_ffmpeg(tool, o);
    if (code == EXIT_OK)
        code = layers_check_file_names(tool, &o->layers,
                                       o->is_video || overlay_is_sequence(o));
    if (code == EXIT_OK)
        code = overlay_check_outputs(tool, o, o->input, o->output);
    o->drawing.line.settings.unbaked = choose_rendering_without_model(o);
    if (code == EXIT_OK)
        code = draw_single_input(tool, o);
    if (code == EXIT_OK)
        code = drawing_finish_lamp_file(tool, &o->drawing);
    if (code == EXIT_OK && !o->lists_shots)
        print_overlay_result(tool, o);
    return code;
}

/* ------------------------------------------------------------------ folders */

/* Parses a command line and adds the flare to its input.
 * add_flare_to_inputs_of_folder() calls it for each input. OUTPUT: see
 * parse_options_and_inputs(). */
static int run_overlay_command_line(int argc, char **argv, const char *output);

/* Adds flares to the N inputs ARGV[FIRST] on and writes each to FOLDER under
 * its own name. A failed input does not stop the others, unless the command
 * line or the lens is wrong. Returns the largest exit code. */
static int add_flare_to_inputs_of_folder(const struct tool *tool, char **argv,
                                         int first, int n, const char *folder,
                                         const struct glint_options *options)
{
    char **const line = calloc((size_t)first + 2, sizeof *line);
    bool is_new = false, is_wrong = false;
    int code, done = 0, failed = 0;
    char path[FOLDER_PATH];

    if (!line)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    code = folder_create(tool, folder, argv + first, n, options, &is_new);
    is_wrong = code != EXIT_OK;
    for (int i = 0; i < n && !is_wrong; i++) {
        int one = EXIT_OUTPUT;

        memcpy(line, argv, (size_t)first * sizeof *line);
        line[first] = argv[first + i];
        optind = 0;
        if (folder_make_output_path(path, folder, argv[first + i]))
            one = run_overlay_command_line(first + 1, line, path);
        else
            tool_error(tool, "%s: the name is too long", argv[first + i]);
        done += one == EXIT_OK;
        failed += one != EXIT_OK;
        code = one > code ? one : code;
        is_wrong = one == EXIT_USAGE || one == EXIT_LENS;
    }
    free(line);
    if (done > 0 && failed > 0 && !tool->quiet)
        fprintf(stderr,
                "glint overlay: %d of %d inputs failed; the others were "
                "written to %s\n",
                n - done, n, folder);
    if (done == 0 && is_new)
        rmdir(folder); /* has no effect if the folder is not empty */
    return code;
}

static int run_overlay_command_line(int argc, char **argv, const char *output)
{
    struct tool tool = {
        .name = "overlay", .help = help, .help_end = COMMON_HELP};
    struct overlay *o = calloc(1, sizeof *o);
    const char *folder = NULL;
    int code;

    if (!o)
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    drawing_line_set_defaults(&o->drawing.line);
    o->start_number = o->transfer = -1;
    o->last = o->warm_up = INT_MAX;
    code = parse_options_and_inputs(&tool, argc, argv, o, output, &folder);
    if (code < 0 && folder)
        code = add_flare_to_inputs_of_folder(&tool, argv, optind, argc - optind,
                                             folder,
                                             &o->drawing.line.settings.options);
    else if (code < 0) {
        code = tool_start_threads(&tool);
        if (code == EXIT_OK)
            code = add_flare_to_single_input(&tool, o);
        tool_stop_threads(&tool);
    }
    overlay_y4m_close(o);
    drawing_close(&o->drawing);
    free(o);
    return code;
}

int cmd_overlay(int argc, char **argv)
{
    return run_overlay_command_line(argc, argv, NULL);
}
