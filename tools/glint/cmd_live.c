/* SPDX-License-Identifier: MIT
 *
 * glint live: parses its command line and configuration file.
 */
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "overlay/apart.h"
#include "options/config.h"
#include "linux/fourcc.h"
#include "live/live.h"

static const char help[] =
    "glint live [-d CAMERA] [-o OUTPUT] [options]\n"
    "\n"
    "Draws the flare of a lens into the frames of a camera at its rate and "
    "shows\n"
    "them. It draws the newest frame and skips older ones.\n"
    "\n"
    "  -d, --device DEV    /dev/video0 (default), a number; FILE.y4m, -, "
    "test,\n"
    "                      none (black, for --scene)\n"
    "  -o, --output OUT    fb[:/dev/fb0] (default), kms[:HDMI-A-1], window,\n"
    "                      FILE.y4m, y4m:-, v4l2:/dev/videoN (v4l2loopback),\n"
    "                      null\n"
    "  --list-devices      list the cameras\n"
    "  --list-formats      list the formats of the camera\n"
    "Camera\n"
    "  -s, --size WxH      (default: as the camera is set)\n"
    "  -r, --fps N[/D]     (default: as the camera is set)\n"
    "  -f, --format NAME   YUYV, NV12 ...; default: the cheapest\n"
    "  --stride BYTES      of a row of headerless frames (-d - with --format)\n"
    "  -i, --input N       input of a camera with several\n"
    "  -n, --buffers N     2 to 32 (default 4)\n"
    "  --io HOW            auto | mmap | userptr | read\n"
    "  --range R           auto | full | limited: overrides that of the "
    "camera\n"
    "  --matrix M          auto | 601 | 709\n"
    "Run\n"
    "  --count N           frames to show (default: until SIGINT or SIGTERM)\n"
    "  --skip N            frames to skip first\n"
    "  --[no-]adaptive     reduce the quality in steps to keep the frame rate\n"
    "                      (default: of cameras, without --budget)\n"
    "  --reconnect         wait for a camera or panel that went away, instead "
    "of\n"
    "                      leaving with exit code 4\n"
    "  --stats HOW         auto | line | json | none: print statistics each "
    "second;\n"
    "                      json: lines on standard output; auto: a line, or "
    "json\n"
    "                      with --json.\n"
    "                      Keys: t (s), fps, frames, drops, late, corrupt,\n"
    "                      latency_ms_p50, latency_ms_p99, ms (convert, find,\n"
    "                      plan, bin, draw, show), lights, ghosts, bytes,\n"
    "                      quality (0 to 1); the last line has totals.\n"
    "                      drops: frames that the camera lost; late: frames "
    "skipped\n"
    "                      for a newer one; corrupt: damaged frames, not "
    "shown\n"
    "  --fit HOW           scale (default) | centre: if the picture and the "
    "panel\n"
    "                      differ in size\n"
    "  --snapshot NAME     (default glint-%03d.ppm)\n"
    "  --config FILE       read these options, without dashes: lens = "
    "zoom.glint\n"
    "Signals: SIGHUP reads --config and lens again, SIGUSR1 reports, SIGUSR2 "
    "saves.\n";

enum {
    OPT_CONFIG = ENGINE_OPTIONS_END,
    OPT_LIST_DEVICES,
    OPT_LIST_FORMATS,
    OPT_STRIDE,
    OPT_IO,
    OPT_RANGE,
    OPT_MATRIX,
    OPT_COUNT,
    OPT_SKIP,
    OPT_ADAPTIVE,
    OPT_NO_ADAPTIVE,
    OPT_RECONNECT,
    OPT_STATS,
    OPT_FIT,
    OPT_SNAPSHOT
};

#define SHORT "d:o:s:r:f:i:n:" TOOL_COMMON_SHORT

static const struct option own[] = {
    {"device", required_argument, NULL, 'd'},
    {"output", required_argument, NULL, 'o'},
    {"list-devices", no_argument, NULL, OPT_LIST_DEVICES},
    {"list-formats", no_argument, NULL, OPT_LIST_FORMATS},
    {"size", required_argument, NULL, 's'},
    {"fps", required_argument, NULL, 'r'},
    {"format", required_argument, NULL, 'f'},
    {"input", required_argument, NULL, 'i'},
    {"buffers", required_argument, NULL, 'n'},
    {"stride", required_argument, NULL, OPT_STRIDE},
    {"io", required_argument, NULL, OPT_IO},
    {"range", required_argument, NULL, OPT_RANGE},
    {"matrix", required_argument, NULL, OPT_MATRIX},
    {"count", required_argument, NULL, OPT_COUNT},
    {"skip", required_argument, NULL, OPT_SKIP},
    {"adaptive", no_argument, NULL, OPT_ADAPTIVE},
    {"no-adaptive", no_argument, NULL, OPT_NO_ADAPTIVE},
    {"reconnect", no_argument, NULL, OPT_RECONNECT},
    {"stats", required_argument, NULL, OPT_STATS},
    {"fit", required_argument, NULL, OPT_FIT},
    {"snapshot", required_argument, NULL, OPT_SNAPSHOT},
    {"config", required_argument, NULL, OPT_CONFIG},
    {NULL, 0, NULL, 0}};

/* getopt_long() table of glint live and engine options */
static const struct option *options;

/* The command line, which is parsed again when the configuration is
 * reloaded. */
struct line {
    struct tool *tool;
    int argc;
    char **argv;
    /* files read at the start (CONFIG) and by the last reload (AGAIN) */
    struct config config, again;
    struct live_options *into;
};

static void set_live_defaults(struct live_options *o)
{
    *o = (struct live_options){.input = {.camera = {.device = "/dev/video0",
                                                    .input = -1,
                                                    .range = -1,
                                                    .matrix = -1},
                                         .n_buffers = 4},
                               .output = "fb",
                               .snapshot = "glint-%03d.ppm"};
    drawing_line_set_defaults(&o->drawing.line);
    o->drawing.line.reserve_bytes = 32 << 20;
    o->drawing.line.is_live = true;
}

/* Parses TEXT, "30" or "30000/1001", as a frame rate. */
static bool parse_frame_rate(const char *text, int *num, int *den)
{
    char top[16];
    const char *slash = strchr(text, '/');
    const size_t n = slash ? (size_t)(slash - text) : strlen(text);

    if (n >= sizeof top)
        return false;
    memcpy(top, text, n);
    top[n] = '\0';
    *den = 1;
    return tool_parse_integer(top, 1, 1000000, num) &&
           (!slash || tool_parse_integer(slash + 1, 1, 1000000, den));
}

/* Returns whether TEXT has exactly one '%', which begins %d or %0Nd. */
static bool is_numbered_pattern(const char *text)
{
    const char *at = strchr(text, '%');
    const size_t digits = at ? strspn(at + 1, "0123456789") : 0;

    return at && digits < 3 && at[1 + digits] == 'd' && !strchr(at + 1, '%');
}

/* Applies OPTION if it concerns the camera. Returns -1 on success, -2 for
 * another option, -3 if VALUE is invalid. */
static int parse_camera_option(struct live_wish *wish, int option,
                               const char *value)
{
    static const char *const ranges[] = {"auto", "full", "limited", NULL};
    static const char *const matrices[] = {"auto", "601", "709", NULL};
    static const char *const ios[] = {"auto", "mmap", "userptr", "read", NULL};
    struct glint_v4l2_config *const c = &wish->camera;
    bool good = true;
    int word = 0;

    switch (option) {
    case 'd':
        c->device = value;
        good = *value != '\0';
        break;
    case 's':
        good = tool_parse_size(value, &c->width, &c->height);
        break;
    case 'r':
        good = parse_frame_rate(value, &c->fps_num, &c->fps_den);
        break;
    case 'f':
        good = glint_fourcc_parse(value, &c->fourcc);
        break;
    case 'i':
        good = tool_parse_integer(value, 0, 255, &c->input);
        break;
    case 'n':
        good = tool_parse_integer(value, 2, GLINT_V4L2_MAX_BUFFERS,
                                  &wish->n_buffers);
        break;
    case OPT_STRIDE:
        good = tool_parse_integer(value, 1, 131072, &wish->stride_bytes);
        break;
    case OPT_IO:
        wish->io =
            (enum glint_v4l2_io)(word = tool_find_word_index(value, ios));
        break;
    case OPT_RANGE:
        c->range = (word = tool_find_word_index(value, ranges)) - 1;
        break;
    case OPT_MATRIX:
        c->matrix = (word = tool_find_word_index(value, matrices)) - 1;
        break;
    default:
        return -2;
    }
    return good && word >= 0 ? -1 : -3;
}

/* Applies OPTION if only glint live has it. Returns the same values as
 * parse_camera_option(). */
static int parse_live_option(struct live_options *o, int option,
                             const char *value)
{
    static const char *const stats[] = {"auto", "line", "json", "none", NULL};
    static const char *const fits[] = {"scale", "centre", NULL};
    bool good = true;
    int word = 0;

    switch (option) {
    case OPT_LIST_DEVICES:
        o->list_devices = true;
        break;
    case OPT_LIST_FORMATS:
        o->list_formats = true;
        break;
    case OPT_ADAPTIVE:
    case OPT_NO_ADAPTIVE:
        o->adaptive = option == OPT_ADAPTIVE ? LIVE_ADAPTIVE : LIVE_FIXED;
        break;
    case OPT_RECONNECT:
        o->reconnect = true;
        break;
    case OPT_CONFIG: /* the configuration file was read before all other options
                      * */
        break;
    case OPT_STATS:
        o->report =
            (enum live_report)(word = tool_find_word_index(value, stats));
        break;
    case OPT_FIT:
        o->fit =
            (enum glint_panel_fit)(word = tool_find_word_index(value, fits));
        break;
    case OPT_COUNT:
        good = tool_parse_integer(value, 1, 1 << 30, &o->count);
        break;
    case OPT_SKIP:
        good = tool_parse_integer(value, 0, 1 << 30, &o->skip);
        break;
    case OPT_SNAPSHOT:
        o->snapshot = value;
        good = is_numbered_pattern(value) &&
               snprintf(NULL, 0, value, INT_MAX) < LIVE_NAME_BYTES;
        break;
    case 'o':
        o->output = value;
        good = live_output_parse(&(struct live_output){.path = NULL}, value);
        break;
    default:
        return parse_camera_option(&o->input, option, value);
    }
    return good && word >= 0 ? -1 : -3;
}

static const char *find_option_name(int option)
{
    const struct option *o = options;

    while (o->val != option)
        o++;
    return o->name;
}

static int parse_option(struct line *line, int option, const char *value)
{
    int code = drawing_line_set_option(line->tool, &line->into->drawing.line,
                                       option, value);

    if (code == -2)
        code = parse_live_option(line->into, option, value);
    if (code == -3)
        return tool_report_bad_value(line->tool, find_option_name(option),
                                     value);
    return code == -2 ? tool_apply_option(line->tool, option, value) : code;
}

static int parse_config_option(void *ctx, const struct option *option,
                               const char *value)
{
    return parse_option(ctx, option->val, value);
}

static int parse_command_line(struct line *line)
{
    int c, code;

    optind = 1;
    while ((c = tool_getopt(line->argc, line->argv, SHORT, options, NULL)) >= 0)
        if ((code = parse_option(line, c, optarg)) >= 0)
            return code;
    return optind == line->argc
               ? -1
               : tool_usage(line->tool, "'%s' is not an option",
                            line->argv[optind]);
}

/* Rejects options O if an output would overwrite an input, the configuration
 * file CONFIG (may be NULL) or another output. Returns -1 or an exit code. */
static int check_outputs_differ_from_inputs(const struct tool *tool,
                                            const struct live_options *o,
                                            const char *config)
{
    struct apart files = {.n_read = 0};
    struct live_output output = {.path = NULL};
    int code;

    file_conflicts_add_input(&files, "--device", o->input.camera.device);
    file_conflicts_add_input(&files, "--config", config);
    if (live_output_parse(&output, o->output) && output.kind == LIVE_OUTPUT_Y4M)
        file_conflicts_add_output(&files, "-o", output.path);
    file_conflicts_add_output(&files, "--snapshot", o->snapshot);
    file_conflicts_add_drawing_files(&files, &o->drawing.line);
    code = file_conflicts_check_outputs(tool, &files);
    return code == EXIT_OK ? -1 : code;
}

/* Reads options into INTO: first from the file of --config, then from the
 * command line, which overrides the file. CONFIG owns the strings of the
 * file. Returns -1 or an exit code. */
static int parse_options(struct line *line, struct config *config,
                         struct live_options *into)
{
    const char *path;
    int code;

    set_live_defaults(into);
    line->into = into;
    path = tool_find_option_value(line->argc, line->argv, SHORT, options,
                                  OPT_CONFIG);
    if (path) {
        code = config_read(config, path);
        if (code != EXIT_OK)
            return code;
        drawing_line_end_file(&into->drawing.line);
    }
    code = drawing_line_apply_command_style(line->tool, &into->drawing.line,
                                            line->argc, line->argv, SHORT,
                                            options);
    if (code < 0)
        code = parse_command_line(line);
    return code < 0 ? check_outputs_differ_from_inputs(line->tool, into, path)
                    : code;
}

static int reread_options(void *ctx, struct tool *tool,
                          struct live_options *into)
{
    struct line *line = ctx;

    (void)tool;
    /* The drawings that used the strings of AGAIN are closed already. */
    config_free(&line->again);
    return parse_options(line, &line->again, into);
}

static int list_cameras(struct tool *tool, const struct live_options *o)
{
    struct glint_error error = {""};
    const enum glint_status status =
        o->list_devices
            ? glint_v4l2_list_devices(stdout, tool->json)
            : glint_v4l2_list_formats(stdout, o->input.camera.device,
                                      tool->json, &error);

    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

int cmd_live(int argc, char **argv)
{
    struct tool tool = {.name = "live", .help = help, .help_end = COMMON_HELP};
    struct live_options *o = calloc(1, sizeof *o);
    struct line line = {
        .tool = &tool,
        .argc = argc,
        .argv = argv,
        .config = {.tool = &tool, .take = parse_config_option, .ctx = &line},
        .into = o};
    int code;

    if (!o)
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    set_live_defaults(o);
    options = engine_build_options(&tool, ENGINE_ALL,
                                   &o->drawing.line.settings.options, own);
    line.config.options = options;
    line.again = line.config;
    code = parse_options(&line, &line.config, o);
    if (code < 0 && (o->list_devices || o->list_formats))
        code = list_cameras(&tool, o);
    else if (code < 0) {
        code = tool_start_threads(&tool);
        if (code == EXIT_OK)
            code = live_run(&tool, o, reread_options, &line);
        tool_stop_threads(&tool);
    }
    drawing_close(&o->drawing);
    config_free(&line.config);
    config_free(&line.again);
    free(o);
    return code;
}
