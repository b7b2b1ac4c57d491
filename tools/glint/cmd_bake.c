/* SPDX-License-Identifier: MIT
 *
 * glint bake: bakes a lens table into a model. Scenes, environments and motions
 * have their own bake commands, which this one calls.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "overlay/apart.h"
#include "model/coating.h"
#include "options/json_writer.h"
#include "zooms/zoom_bake.h"
#include "model/zoom_option.h"
#include "model/model_report.h"
#include "model/picture_check.h"
#include "model/table_file.h"
#include "posix/output.h"
#include "scenes/baked_scene.h"
#include "scenes/environment_file.h"
#include "motions/motion_file.h"
#include "stones/stone_file.h"
#include "render/render_scene.h"
#include "options/tool.h"
#include "options/command_line.h"

static const char help[] =
    "glint bake LENS -o MODEL [options]\n"
    "\n"
    "Fits polynomials to the rays of every ghost of LENS, converts them to\n"
    "integers, proves that these cannot overflow, measures the errors with "
    "the\n"
    "run-time arithmetic, and writes one file for render, overlay and trace. "
    "The\n"
    "same lens and options give the same bytes. NAME.scene, NAME.translucent,\n"
    "panoramas (.exr .hdr .dds .pfm .environment) and recordings (.json) have\n"
    "other options:\n"
    "glint bake NAME.scene --help. glint info --help explains the report.\n"
    "\n"
    "  -o, --output MODEL\n"
    "                    -: standard output, without a report\n"
    "  --f-number N      stop the lens down to f/N first\n" ZOOM_HELP
        COATING_HELP "  --band LO,HI      wavelengths in nm (default 400,700)\n"
    "  --max-angle DEG   max angle of a light in degrees (default 60)\n"
    "  --positions N     zoom lenses: bake N positions of the zoom range, 2 .. "
    "64,\n"
    "                    into one file, which can then zoom without a bake\n"
    "  --halfway DB      with --positions: min PSNR between positions (default "
    "45);\n"
    "                    ghosts with less are baked there, too; 0: no check\n"
    "  --field MM        radius on the sensor within which light counts\n"
    "                    (default: 1.1 times that of the film's corners)\n"
    "  --tolerance T     scale of the tolerances (default 1)\n"
    "  --strict          write nothing and exit with 5 if a picture of the "
    "model has\n"
    "                    less than 50 dB against exact rays; with "
    "--positions,\n"
    "                    less than --halfway between positions\n"
    "  -j, --threads N   default: all processors; never changes the model\n"
    "  --json   -q   -v   --help   --help-all   --version\n";

enum { MOST_POSITIONS = 64 };

struct bake {
    const char *output;
    struct coating coating;
    struct zoom_option zoom;
    double f_number;
    int positions; /* --positions: number of baked zoom positions; 0: a single
                      model */
    /* --halfway: min PSNR halfway between positions, dB; below 0: not given */
    double halfway_db;
    bool is_strict;
    struct glint_bake_options options;
    struct tool_progress progress;
};

static int parse_option(struct tool *tool, struct bake *b, int c,
                        const char *name)
{
    struct glint_bake_options *o = &b->options;
    bool ok = true;

    switch (c) {
    case 'o':
        b->output = tool->written = optarg;
        break;
    case 'c':
        return coating_parse_option(tool, &b->coating, optarg);
    case 'n':
        ok = tool_parse_integer(optarg, 2, MOST_POSITIONS, &b->positions);
        break;
    case 'H':
        ok = tool_parse_number(optarg, &b->halfway_db) &&
             (b->halfway_db == 0.0 ||
              (b->halfway_db >= 20 && b->halfway_db <= 60));
        break;
    case 'z':
        ok = zoom_option_parse(&b->zoom, optarg);
        break;
    case 'F':
        ok = zoom_option_parse_focus(&b->zoom, optarg);
        break;
    case 'f':
        ok = tool_parse_number(optarg, &b->f_number) && b->f_number > 0;
        break;
    case 'w':
        ok = tool_parse_numbers(optarg, o->band_nm, 2) == 2;
        break;
    case 'a':
        ok = tool_parse_number(optarg, &o->max_deg);
        break;
    case 'm':
        ok = tool_parse_number(optarg, &o->field_mm) && o->field_mm > 0;
        break;
    case 's':
        b->is_strict = true;
        break;
    case 't':
        ok = tool_parse_number(optarg, &o->tolerance);
        break;
    default:
        return tool_apply_option(tool, c, optarg);
    }
    return ok ? -1 : tool_report_bad_value(tool, name, optarg);
}

static int parse_options(struct tool *tool, int argc, char **argv,
                         struct bake *b)
{
    static const struct option options[] = {
        {"output", required_argument, NULL, 'o'},
        {"coating", required_argument, NULL, 'c'},
        {"f-number", required_argument, NULL, 'f'},
        ZOOM_OPTIONS('z', 'F'),
        {"positions", required_argument, NULL, 'n'},
        {"halfway", required_argument, NULL, 'H'},
        {"band", required_argument, NULL, 'w'},
        {"max-angle", required_argument, NULL, 'a'},
        {"field", required_argument, NULL, 'm'},
        {"tolerance", required_argument, NULL, 't'},
        {"strict", no_argument, NULL, 's'},
        TOOL_COMMON_OPTIONS};
    int c, code, index = 0;

    while ((c = tool_getopt(argc, argv, "o:" TOOL_COMMON_SHORT, options,
                            &index)) >= 0)
        if ((code = parse_option(tool, b, c, options[index].name)) >= 0)
            return code;
    code = tool_check_inputs(tool, argc, argv, 1, "expects one lens");
    if (code >= 0)
        return code;
    if (!b->output)
        return tool_usage(tool, "needs -o MODEL");
    if (b->positions && b->zoom.is_zoomed)
        return tool_usage(
            tool, "--positions bakes the whole zoom range and excludes --zoom");
    if (!b->positions && b->halfway_db >= 0)
        return tool_usage(tool, "--halfway needs --positions");
    if (b->is_strict && b->halfway_db == 0)
        return tool_usage(tool, "--strict needs the check between positions, "
                                "which --halfway 0 turns off");
    if (b->halfway_db < 0)
        b->halfway_db = ZOOM_BAKE_DB;
    return -1;
}

/* Prints an error: --strict rejects the model, because its images WHERE have a
 * PSNR of PSNR_DB against exact ray tracing, below LEAST_DB. Returns an exit
 * code. */
static int reject_inaccurate_model(const struct tool *tool, double psnr_db,
                                   double least_db, const char *where,
                                   const char *remedy)
{
    char text[200];

    snprintf(text, sizeof text,
             "--strict: the model is not written, since its PSNR against exact "
             "rays is %.1f dB %s, below %g dB; %s",
             psnr_db, where, least_db, remedy);
    return tool_fail(tool, GLINT_E_LENS, text);
}

/* Returns EXIT_OK if CHECK has a PSNR of at least PICTURE_CHECK_DB, else an
 * exit code after printing the reason. */
static int check_accuracy_for_strict(const struct tool *tool,
                                     const struct picture_check *check)
{
    char where[64];

    if (check->psnr_db >= PICTURE_CHECK_DB)
        return EXIT_OK;
    snprintf(where, sizeof where, "with the light %.1f degrees off the axis",
             check->angle_deg);
    return reject_inaccurate_model(tool, check->psnr_db, PICTURE_CHECK_DB,
                                   where, "try a smaller --tolerance");
}

/* Compares images by the model *DATA[*BYTES] with images by exact rays, and
 * stores the result and the coating in the model. Prints an error if there is
 * no memory or --strict needs the result; another failure is a warning, and
 * CHECK->n is 0. Returns an exit code. */
static int measure_accuracy(const struct tool *tool, const struct bake *b,
                            const struct glint_prescription *lens,
                            unsigned char **data, size_t *bytes,
                            struct picture_check *check)
{
    struct glint_error error = {""};
    enum glint_status status = GLINT_E_LENS;
    struct glint_lens opened;
    const char *reason;

    if (glint_lens_open(&opened, *data, *bytes, &reason) != GLINT_OK)
        return tool_fail(tool, status, reason);
    status = picture_check_run(tool, lens, &opened, &b->options, check, &error);
    if (status == GLINT_OK &&
        picture_check_store(check, &b->coating, data, bytes) == GLINT_OK)
        return b->is_strict ? check_accuracy_for_strict(tool, check) : EXIT_OK;
    check->n = 0;
    if (status == GLINT_OK ||
        picture_check_store(NULL, &b->coating, data, bytes) != GLINT_OK)
        status = GLINT_E_MEMORY;
    if (b->is_strict || status == GLINT_E_MEMORY)
        return tool_fail(tool, status, error.text[0] ? error.text : NULL);
    fprintf(stderr,
            "glint bake: the pictures of %s could not be compared with exact "
            "rays: %s\n",
            b->output, error.text[0] ? error.text : glint_status_text(status));
    return EXIT_OK;
}

/* Checks the model *DATA[BYTES], which may move, commits it to OUT and prints a
 * report. Aborts OUT if a check fails. SECONDS is the time of the bake. Returns
 * an exit code. */
static int write_model(struct glint_output *out, const struct tool *tool,
                       const struct bake *b,
                       const struct glint_prescription *lens,
                       unsigned char **data, size_t bytes, double seconds,
                       const struct glint_bake_report *report)
{
    struct picture_check check = {.n = 0};
    struct glint_error error = {""};
    struct glint_lens opened;
    enum glint_status status;
    const char *reason;
    const int code = measure_accuracy(tool, b, lens, data, &bytes, &check);

    if (code != EXIT_OK) {
        glint_output_abort(out);
        return code;
    }
    status = glint_output_write_and_commit(out, *data, bytes, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    if (strcmp(b->output, "-") != 0 && (tool->json || !tool->quiet) &&
        glint_lens_open(&opened, *data, bytes, &reason) == GLINT_OK)
        model_report_print_bake(tool, &opened, seconds, report, &check);
    return EXIT_OK;
}

/* Bakes LENS, writes the model to OUT, and commits or aborts OUT. Returns an
 * exit code. */
static int bake_lens_to_output(struct glint_output *out, struct tool *tool,
                               struct bake *b,
                               const struct glint_prescription *lens)
{
    struct glint_error error = {""};
    struct glint_bake_report r;
    unsigned char *model = NULL;
    const double start = tool_clock_s();
    size_t bytes = 0;
    enum glint_status status;
    int code;

    b->options.workers = tool->workers;
    b->options.progress = tool_progress_show;
    b->options.progress_ctx = &b->progress;
    tool_progress_start(&b->progress, tool, "bake");
    b->progress.less = "a smaller --max-angle or a larger --tolerance";
    status = glint_bake(lens, &b->options, &model, &bytes, &r, &error);
    tool_progress_end(&b->progress);
    if (status == GLINT_OK) {
        code = write_model(out, tool, b, lens, &model, bytes,
                           tool_clock_s() - start, &r);
    } else {
        glint_output_abort(out);
        code = tool_fail(tool, status, error.text[0] ? error.text : NULL);
    }
    free(model);
    return code;
}

/* Prints a summary of a zoom bake, unless standard output receives the
 * model. */
static void print_zoom_report(const struct tool *tool, const struct bake *b,
                              const struct zoom_baked *baked, double seconds)
{
    struct json_writer json = {.to = stdout};

    if (strcmp(b->output, "-") == 0)
        return;
    if (tool->json) {
        json_write(&json, "{positions: %d, models: %d, ghosts: %d",
                   b->positions, baked->n_models, baked->n_bakes);
        if (baked->least_db > 0)
            json_write(&json, "halfway_db: %.1f, halfway_mm: %.3f",
                       baked->least_db, baked->least_mm);
        json_write(&json, "bytes: %zu, seconds: %.1f}\n", baked->bytes,
                   seconds);
        return;
    }
    if (tool->quiet)
        return;
    printf("%d zoom positions with all ghosts, %d between them with some of "
           "the ghosts, %zu bytes, %.0f s\n",
           b->positions, baked->n_models - b->positions, baked->bytes, seconds);
    if (baked->least_db > 0)
        printf("min PSNR halfway between positions, against exact pictures: "
               "%.1f dB, at %.2f mm\n",
               baked->least_db, baked->least_mm);
    if (baked->least_db > 0 && baked->least_db < b->halfway_db)
        printf("this is below --halfway %g: increase --positions\n",
               b->halfway_db);
}

/* Bakes LENS at all zoom positions into OUT. LENS must be at the table's
 * default position. Returns an exit code. */
static int bake_zoom_positions(struct glint_output *out, struct tool *tool,
                               struct bake *b,
                               const struct glint_prescription *lens)
{
    const struct zoom_bake zoom = {.lens = lens,
                                   .options = &b->options,
                                   .focus_m = b->zoom.focus_m,
                                   .f_number = b->f_number,
                                   .positions = b->positions,
                                   .coating = &b->coating,
                                   .halfway_db = b->halfway_db};
    const double start = tool_clock_s();
    struct glint_error error = {""};
    struct zoom_baked baked;
    enum glint_status status = zoom_bake_positions(tool, &zoom, &baked, &error);
    char where[64];

    if (status == GLINT_OK && b->is_strict && baked.least_db > 0 &&
        baked.least_db < b->halfway_db) {
        glint_output_abort(out);
        free(baked.data);
        snprintf(where, sizeof where, "at %.2f mm, halfway between positions",
                 baked.least_mm);
        return reject_inaccurate_model(tool, baked.least_db, b->halfway_db,
                                       where, "try more --positions");
    }
    if (status == GLINT_OK)
        status =
            glint_output_write_and_commit(out, baked.data, baked.bytes, &error);
    else
        glint_output_abort(out);
    free(baked.data);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text[0] ? error.text : NULL);
    print_zoom_report(tool, b, &baked, tool_clock_s() - start);
    return EXIT_OK;
}

/* Bakes the lens NAME. Opens the output before the bake, which can take
 * minutes, so that an error shows at once. Returns an exit code. */
static int bake_lens_by_name(struct tool *tool, struct bake *b,
                             const char *name)
{
    struct glint_prescription *lens = malloc(sizeof *lens);
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;
    struct apart files = {.n_read = 0};
    struct glint_output out;
    int code;

    if (!lens)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    file_conflicts_add_input(&files, NULL, name);
    file_conflicts_add_output(&files, "-o", b->output);
    code = file_conflicts_check_outputs(tool, &files);
    if (code == EXIT_OK)
        code = tool_read_lens(tool, name, lens);
    if (code == EXIT_OK)
        code = b->positions ? EXIT_OK : zoom_option_apply(tool, &b->zoom, lens);
    if (code == EXIT_OK)
        coating_apply(&b->coating, lens);
    if (code == EXIT_OK && b->f_number > 0 && !b->positions)
        status = glint_prescription_set_f_number(lens, b->f_number, &error);
    if (code == EXIT_OK && status == GLINT_OK)
        status =
            glint_output_open(&out, b->output, GLINT_OUTPUT_BINARY, &error);
    if (status != GLINT_OK)
        code = tool_fail(tool, status, error.text);
    if (code == EXIT_OK)
        code = b->positions ? bake_zoom_positions(&out, tool, b, lens)
                            : bake_lens_to_output(&out, tool, b, lens);
    free(lens);
    return code;
}

static int bake_lens(struct tool *tool, int argc, char **argv)
{
    struct bake b = {.halfway_db = -1};
    int code;

    tool->help = help;
    glint_bake_defaults(&b.options);
    code = parse_options(tool, argc, argv, &b);
    if (code >= 0)
        return code;
    code = tool_start_threads(tool);
    if (code == EXIT_OK)
        code = bake_lens_by_name(tool, &b, argv[optind]);
    tool_stop_threads(tool);
    return code;
}

/* Runs the bake command of scenes, environments, motions or translucent media
 * if an input has that type, else that of lenses. */
static int bake_by_file_type(struct tool *tool, int argc, char **argv)
{
    static const struct {
        bool (*is_one)(const char *name);
        int (*bake)(struct tool *tool, int argc, char **argv);
    } others[] = {{environment_file_is_source, cmd_bake_environment},
                  {motion_file_is_source, cmd_bake_motion},
                  {stone_file_is_text, cmd_bake_stone}};

    if (render_has_scene(argc, argv))
        return cmd_bake_scene(tool, argc, argv);
    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        for (int i = 1; i < argc; i++)
            if (argv[i][0] != '-' && others[k].is_one(argv[i]))
                return others[k].bake(tool, argc, argv);
    return bake_lens(tool, argc, argv);
}

int cmd_bake(int argc, char **argv)
{
    struct glint_error cause = {""};
    struct tool tool = {.name = "bake", .cause = &cause};
    const int code = bake_by_file_type(&tool, argc, argv);

    if (code != EXIT_OK && tool.json &&
        !(tool.written && strcmp(tool.written, "-") == 0))
        /* Options after an invalid one were not parsed, so --json is searched
         * for here. */
        json_write(&(struct json_writer){.to = stdout},
                   "{error: %s, file: %s, exit: %d}\n", cause.text,
                   optind < argc && *argv[optind] != '-' ? argv[optind] : NULL,
                   code);
    return code;
}
