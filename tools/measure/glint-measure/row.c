/* SPDX-License-Identifier: MIT */
#include "measure/glint-measure/row.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "glint/measure.h"
#include "measure/canvas.h"
#include "model/model_cache.h"
#include "model/model_summary.h"
#include "model/picture_check.h"
#include "model/table_file.h"

#define ROW_BAKE    "bake_s,model_kib,mean_terms,barrel_rms,f_number,table_ghosts"
#define ROW_CHECK   "told_db,least_db,median_db"
#define ROW_PICTURE "psnr_db,ssim,flux"
#define ROW_FRAME                                                           \
    "edges,refs,bundles,ghosts,arena_kib,arena_mib,plan_ms,bin_ms,draw_ms," \
    "cpu_ms,minsn"

/* Not static and never inlined, because callgrind finds the last frame by the
 * name of this function and counts its instructions. */
enum glint_status measured_frame(struct glint_engine *engine,
                                 const struct glint_lamp *lamps, int n,
                                 double scale, const struct glint_image *image,
                                 struct glint_engine_report *report);
static enum glint_status (*volatile measured_call)(
    struct glint_engine *, const struct glint_lamp *, int, double,
    const struct glint_image *, struct glint_engine_report *) = measured_frame;

enum glint_status measured_frame(struct glint_engine *engine,
                                 const struct glint_lamp *lamps, int n,
                                 double scale, const struct glint_image *image,
                                 struct glint_engine_report *report)
{
    return glint_engine_draw_at(engine, lamps, n, scale, image, report);
}

static bool list_contains_word(const char *words, const char *word,
                               size_t length)
{
    for (const char *at = words; at; at = strchr(at, ',')) {
        at += *at == ',';
        if (strncmp(at, word, length) == 0 &&
            (at[length] == ',' || at[length] == '\0'))
            return true;
    }
    return false;
}

/* Returns whether any of NAMES, separated by commas, is a requested metric. */
static bool is_any_metric_requested(const struct figure_row *row,
                                    const char *names)
{
    for (const char *at = names; at; at = strchr(at, ',')) {
        at += *at == ',';
        if (list_contains_word(row->metrics, at, strcspn(at, ",")))
            return true;
    }
    return false;
}

static double get_process_cpu_s(void)
{
    struct timespec t;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* --------------------------------------------------------------- parameters */

static bool parse_row_parameter(struct figure_row *r, const char *name,
                                const char *value)
{
    const struct {
        const char *name;
        int *to, low, high;
    } integers[] = {{"lights", &r->n_lights, 0, 10000},
                    {"exact-grid", &r->grid, 4, 1024},
                    {"rounds", &r->rounds, 1, 1000},
                    {"dust-log2", &r->dust_log2, 0, 16}};
    const struct {
        const char *name;
        double *to;
    } numbers[] = {{"theta", &r->theta},
                   {"phi", &r->phi},
                   {"stops", &r->stops},
                   {"bake-stop", &r->bake_stop},
                   {"step", &r->step_deg}};
    const struct {
        const char *name, **to;
    } words[] = {{"lens", &r->lens},
                 {"metrics", &r->metrics},
                 {"picture", &r->picture},
                 {"reference", &r->reference}};

    for (size_t i = 0; i < sizeof integers / sizeof *integers; i++)
        if (strcmp(name, integers[i].name) == 0)
            return tool_parse_integer(value, integers[i].low, integers[i].high,
                                      integers[i].to);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (strcmp(name, numbers[i].name) == 0)
            return tool_parse_number(value, numbers[i].to);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcmp(name, words[i].name) == 0) {
            *words[i].to = value;
            return true;
        }
    if (strcmp(name, "size") == 0)
        return tool_parse_size(value, &r->width, &r->height);
    if (strcmp(name, "nm") == 0)
        return (r->n_nm = tool_parse_numbers(value, r->nm,
                                             GLINT_MAX_WAVELENGTHS)) > 0;
    if (strcmp(name, "coating") == 0 &&
        coating_parse_option(r->tool, &r->settings.coating, value) != -1)
        return false;
    return settings_set_text(&r->settings, name, value);
}

static int parse_assignment(struct figure_row *row, const char *assignment)
{
    const size_t length = strcspn(assignment, "=");
    char name[32];

    if (assignment[length] != '=' || length >= sizeof name)
        return tool_usage(row->tool, "'%s' is not PARAMETER=VALUE", assignment);
    memcpy(name, assignment, length);
    name[length] = '\0';
    return parse_row_parameter(row, name, assignment + length + 1)
               ? EXIT_OK
               : tool_usage(row->tool,
                            "unknown parameter, or invalid value: %s",
                            assignment);
}

int row_parse(struct figure_row *row, struct tool *tool, int n,
              char **assignment)
{
    int code = EXIT_OK;

    *row = (struct figure_row){.tool = tool,
                               .n = n,
                               .assignment = assignment,
                               .json = {.to = stdout},
                               .metrics = "",
                               .width = 1920,
                               .height = 1080,
                               .n_lights = 1,
                               .theta = 12,
                               .phi = 33,
                               .stops = (double)NAN,
                               .grid = 128,
                               .rounds = 1,
                               .picture = "linear",
                               .bake_stop = -1,
                               .nm = {650, 532, 450},
                               .n_nm = 3,
                               .step_deg = 0.7};
    settings_set_defaults(&row->settings);
    /* Unlike the commands, figures measure the coatings of the table. */
    row->settings.coating.kind = COATING_TABLE;
    for (int i = 0; i < n && code == EXIT_OK; i++)
        code = parse_assignment(row, assignment[i]);
    return code == EXIT_OK && !row->lens
               ? tool_usage(tool, "--row needs lens=LENS")
               : code;
}

/* ------------------------------------------------------------------- lenses */

/* Compares pictures by the model with pictures by exact rays, for the lights of
 * 'glint bake' and for 12 random lights. */
static int check_row_model(struct figure_row *r,
                           const struct glint_bake_options *options)
{
    const struct glint_lens *const model = &r->opened.model.lens;
    struct glint_error error = {""};
    struct picture_check check;
    double psnr_db[PICTURE_CHECK_LIGHTS];
    int n = 12;
    enum glint_status status =
        picture_check_run(r->tool, &r->table, model, options, &check, &error);

    if (status == GLINT_OK)
        status = picture_check_run_random(r->tool, &r->table, model, options,
                                          &n, psnr_db, &error);
    if (status != GLINT_OK)
        return tool_fail(r->tool, status, error.text);
    json_write(&r->json, "told_db: %.2f", check.psnr_db);
    if (n)
        json_write(&r->json, "least_db: %.2f, median_db: %.2f", psnr_db[0],
                   0.5 * (psnr_db[(n - 1) / 2] + psnr_db[n / 2]));
    return EXIT_OK;
}

/* Bakes the table like 'glint bake', opens the model, and writes the CPU time
 * of the bake, s. */
static int bake_row_table(struct figure_row *r)
{
    struct glint_bake_options options;
    struct glint_bake_report report;
    struct glint_error error = {""};
    unsigned char *model = NULL;
    size_t bytes = 0;
    enum glint_status status = GLINT_OK;
    const double from = get_process_cpu_s();
    char path[1024];
    FILE *file;
    int code;

    if (r->bake_stop > r->table.f_number)
        status =
            glint_prescription_set_f_number(&r->table, r->bake_stop, &error);
    glint_bake_defaults(&options);
    options.workers = r->tool->workers;
    if (status == GLINT_OK)
        status =
            glint_bake(&r->table, &options, &model, &bytes, &report, &error);
    if (status != GLINT_OK)
        return tool_fail(r->tool, status, error.text);
    json_write(&r->json, "bake_s: %.3f", get_process_cpu_s() - from);
    if (!model_cache_make_path(path, sizeof path, "measured.glint") ||
        !(file = fopen(path, "wb"))) {
        free(model);
        return tool_fail(r->tool, GLINT_E_IO,
                         "cannot create a file in the cache for the model");
    }
    status = fwrite(model, 1, bytes, file) == bytes ? GLINT_OK : GLINT_E_IO;
    free(model);
    if (fclose(file) != 0 || status != GLINT_OK)
        return tool_fail(r->tool, GLINT_E_IO, path);
    code = opened_lens_open(r->tool, &r->opened, &r->settings, path);
    if (code == EXIT_OK && is_any_metric_requested(r, ROW_CHECK))
        code = check_row_model(r, &options);
    return code;
}

static int open_row_lens(struct figure_row *r)
{
    int code = EXIT_OK;

    if (!tool_is_model(r->lens))
        code = tool_read_lens(r->tool, r->lens, &r->table);
    if (code != EXIT_OK)
        return code;
    r->settings.max_deg = fmax(r->settings.max_deg, r->theta);
    if (r->bake_stop >= 0 && r->table.n_surfaces)
        return bake_row_table(r);
    if (!is_any_metric_requested(r, ROW_BAKE "," ROW_PICTURE "," ROW_FRAME
                                             "," ROW_RAYS))
        return EXIT_OK;
    return opened_lens_open(r->tool, &r->opened, &r->settings, r->lens);
}

static void write_model_metrics(struct figure_row *r)
{
    const struct model_file *const model = &r->opened.model;
    struct model_summary sum;

    json_write(&r->json, "f_number: %g", r->table.f_number);
    if (!model->data)
        return;
    sum =
        model_compute_summary(&model->lens, model_get_full_span(&model->lens));
    json_write(&r->json, "model_kib: %.4f, mean_terms: %.4f, table_ghosts: %u",
               (double)model->bytes / 1024, model_compute_mean_terms(&sum),
               model_count_ghosts(&model->lens));
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        if (strcmp(model_output_names[kind], "barrel_0") == 0)
            json_write(&r->json, "barrel_rms: %.6g", sqrt(sum.of[kind].mean2));
}

/* ------------------------------------------------------------------- frames */

struct frame {
    struct glint_engine *engine;
    struct glint_lamp *lamp;
    struct canvas canvas;
    struct glint_float_image exact, got; /* linear light */
    uint8_t *exact_codes, *codes;
    double exposure;
    struct glint_engine_report report, least;
    double cpu_ms;
    struct glint_measure measure;
};

static bool is_image_linear(const struct figure_row *r)
{
    return strcmp(r->picture, "linear") == 0;
}

static bool is_drawn_on_canvas(const struct figure_row *r)
{
    return strcmp(r->picture, "frame") == 0;
}

static enum glint_status create_row_engine(struct figure_row *r,
                                           struct frame *f,
                                           struct glint_error *error)
{
    struct glint_engine_config cfg;

    canvas_open_engine(r->tool, &r->opened, &r->settings, r->width, r->height,
                       &cfg);
    cfg.workers = NULL; /* without a pool the engine uses one thread */
    if (r->settings.options.starburst > 0)
        cfg.drawing.parts |= GLINT_ENGINE_CORES;
    if (r->dust_log2)
        cfg.drawing.dials.dust_log2 = r->dust_log2;
    if (is_image_linear(r)) {
        cfg.search.more_lamps = r->n_lights;
        cfg.search.max_drawn = cfg.drawing.dials.max_lights;
    }
    return glint_engine_create(&f->engine, &cfg, error);
}

static enum glint_status draw_row_frame(struct figure_row *r, struct frame *f,
                                        bool is_last)
{
    struct glint_image layer = {
        .format = GLINT_RGB24, .width = r->width, .height = r->height};
    const struct glint_image *to = &layer;

    if (is_image_linear(r))
        return glint_engine_render(
            f->engine, f->lamp, r->n_lights,
            settings_compute_brightness_scale(&r->settings),
            GLINT_ENGINE_ALL | GLINT_ENGINE_CORES, f->got.rgb, &f->report);
    if (is_drawn_on_canvas(r)) {
        canvas_restore_background(&f->canvas);
        to = &f->canvas.image;
    } else {
        memset(f->codes, 0, 3 * (size_t)r->width * (size_t)r->height);
        glint_image_place(&layer, f->codes);
    }
    return (is_last ? measured_call : glint_engine_draw_at)(
        f->engine, f->lamp, r->n_lights, f->exposure, to, &f->report);
}

/* Draws all rounds, after a warm-up frame if there are several. */
static enum glint_status draw_all_rounds(struct figure_row *r, struct frame *f)
{
    enum glint_status status = GLINT_OK;

    f->cpu_ms = HUGE_VAL;
    f->least.bin_ms = f->least.draw_ms = f->least.plan_ms = HUGE_VAL;
    for (int i = r->rounds > 1 ? -1 : 0; i < r->rounds && status == GLINT_OK;
         i++) {
        const double from = get_process_cpu_s();

        status = draw_row_frame(r, f, i + 1 == r->rounds);
        if (i < 0)
            continue;
        f->cpu_ms = fmin(f->cpu_ms, 1e3 * (get_process_cpu_s() - from));
        f->least.plan_ms = fmin(f->least.plan_ms, f->report.plan_ms);
        f->least.bin_ms = fmin(f->least.bin_ms, f->report.bin_ms);
        f->least.draw_ms = fmin(f->least.draw_ms, f->report.draw_ms);
    }
    return status;
}

static enum glint_status allocate_row_frame(struct figure_row *r,
                                            struct frame *f)
{
    const size_t n = 3 * (size_t)r->width * (size_t)r->height;

    f->lamp = calloc((size_t)r->n_lights + 1, sizeof *f->lamp);
    f->exact = f->got = (struct glint_float_image){r->width, r->height, NULL};
    f->exact.rgb = malloc(n * sizeof(float));
    f->got.rgb = malloc(n * sizeof(float));
    f->codes = malloc(n);
    if (!f->lamp || !f->exact.rgb || !f->got.rgb || !f->codes)
        return GLINT_E_MEMORY;
    canvas_set_lamps(f->lamp, r->n_lights, r->theta);
    f->lamp[0].phi_deg = r->phi;
    for (int i = 0; i < r->n_lights && !isnan(r->stops); i++)
        f->lamp[i].power = exp2(r->stops);
    return canvas_init(&f->canvas, GLINT_YUYV, r->width, r->height);
}

static void free_row_frame(struct frame *f)
{
    glint_engine_destroy(f->engine);
    canvas_free(&f->canvas);
    free(f->lamp);
    free(f->exact.rgb);
    free(f->got.rgb);
    free(f->exact_codes);
    free(f->codes);
}

/* Draws the reference image: the image of the same row after the parameters in
 * r->reference are set. */
static enum glint_status draw_reference_image(struct figure_row *r,
                                              struct frame *f)
{
    struct figure_row *const other = malloc(sizeof *other);
    struct frame g = {.exposure = f->exposure};
    struct glint_error error = {""};
    char *const copy = strdup(r->reference);
    char *rest = copy, *word;
    enum glint_status status = GLINT_E_ARGUMENT;
    int code = EXIT_RUNTIME;

    if (other && copy)
        code = row_parse(other, r->tool, r->n, r->assignment);
    while (code == EXIT_OK && (word = strtok_r(rest, ";", &rest)))
        code = parse_assignment(other, word);
    if (code == EXIT_OK)
        code = open_row_lens(other);
    if (code == EXIT_OK)
        status = allocate_row_frame(other, &g);
    if (code == EXIT_OK && status == GLINT_OK)
        status = create_row_engine(other, &g, &error);
    if (code == EXIT_OK && status == GLINT_OK)
        status = draw_row_frame(other, &g, false);
    if (code == EXIT_OK && status == GLINT_OK) {
        f->exact_codes = g.codes;
        g.codes = NULL;
    }
    free_row_frame(&g);
    if (other)
        opened_lens_close(&other->opened);
    free(other);
    free(copy);
    return status;
}

/* Sets the exposure. If a metric of ROW_PICTURE is requested, also draws the
 * reference image: that of the reference row, if there is one, else an image by
 * exact rays. */
static enum glint_status set_exposure(struct figure_row *r, struct frame *f)
{
    enum glint_status status = GLINT_OK;

    if (!isnan(r->stops) ||
        (is_image_linear(r) && !is_any_metric_requested(r, ROW_PICTURE)))
        f->exposure = 1;
    else if (!is_any_metric_requested(r, ROW_PICTURE) || r->reference)
        status = canvas_compute_exposure(f->engine, f->lamp, r->n_lights,
                                         &f->exposure);
    if (status != GLINT_OK || !is_any_metric_requested(r, ROW_PICTURE))
        return status;
    if (r->reference)
        return draw_reference_image(r, f);
    status = canvas_draw_exact(r->tool, &r->opened, &r->settings, f->lamp,
                               r->n_lights, r->grid, &f->exact);
    if (status != GLINT_OK || is_image_linear(r))
        return status;
    f->exposure = glint_measure_exposure(&f->exact);
    f->exact_codes = glint_measure_encode(&f->exact, f->exposure);
    return f->exact_codes ? GLINT_OK : GLINT_E_MEMORY;
}

static enum glint_status compare_frames(struct figure_row *r, struct frame *f)
{
    if (!is_any_metric_requested(r, ROW_PICTURE))
        return GLINT_OK;
    if (is_image_linear(r))
        return glint_measure_compare(&f->exact, &f->got, false, &f->measure)
                   ? GLINT_OK
                   : GLINT_E_MEMORY;
    glint_measure_codes(f->exact_codes, f->codes, r->width, r->height,
                        &f->measure);
    return GLINT_OK;
}

static void write_frame_metrics(struct figure_row *r, const struct frame *f)
{
    const struct glint_engine_report *const p = &f->report;

    if (is_any_metric_requested(r, ROW_PICTURE))
        json_write(&r->json, "psnr_db: %.4f, ssim: %.6f, flux: %.6f",
                   f->measure.psnr_db, f->measure.ssim, f->measure.flux);
    json_write(&r->json,
               "edges: %d, refs: %d, bundles: %d, ghosts: %d, "
               "arena_kib: %.4f, arena_mib: %.6f, plan_ms: %.4f, "
               "bin_ms: %.4f, draw_ms: %.4f, cpu_ms: %.4f",
               p->stats.primitives, p->stats.refs, p->stats.bundles, p->ghosts,
               (double)p->peak_bytes / 1024, (double)p->peak_bytes / (1 << 20),
               f->least.plan_ms, f->least.bin_ms, f->least.draw_ms, f->cpu_ms);
}

static int measure_frame(struct figure_row *r)
{
    struct frame f = {.exposure = 1};
    struct glint_error error = {""};
    enum glint_status status = allocate_row_frame(r, &f);

    if (status == GLINT_OK)
        status = create_row_engine(r, &f, &error);
    if (status == GLINT_OK)
        status = set_exposure(r, &f);
    if (status == GLINT_OK)
        status = draw_all_rounds(r, &f);
    if (status == GLINT_OK)
        status = compare_frames(r, &f);
    if (status == GLINT_OK)
        write_frame_metrics(r, &f);
    free_row_frame(&f);
    return status == GLINT_OK ? EXIT_OK
                              : tool_fail(r->tool, status, error.text);
}

int row_measure(struct figure_row *row)
{
    int code;

    json_write(&row->json, "{");
    code = open_row_lens(row);
    if (code == EXIT_OK && is_any_metric_requested(row, ROW_BAKE))
        write_model_metrics(row);
    if (code == EXIT_OK &&
        is_any_metric_requested(row, ROW_PICTURE "," ROW_FRAME))
        code = measure_frame(row);
    if (code == EXIT_OK && is_any_metric_requested(row, ROW_RAYS))
        code = row_measure_ray_errors(row);
    if (code == EXIT_OK && is_any_metric_requested(row, ROW_PLACES))
        code = row_measure_ghost_positions(row);
    json_write(&row->json, "}\n");
    return code;
}
