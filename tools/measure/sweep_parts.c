/* SPDX-License-Identifier: MIT
 *
 * Fronts of what is drawn beside ghosts: how far stars reach, how fine the
 * tables of dust are, and whether there is a veil, against what each costs.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/explain.h"
#include "glint/measure.h"
#include "measure/plots/plot.h"
#include "measure/sweep.h"

enum parameter { STAR_CULL, DUST_LOG2, VEIL };
static const char *const parameter_name[] = {"star_cull", "dust_log2", "veil"};

/* What is drawn, and the values of its parameter. The tables of dust have
 * 2^VALUE cells a side. */
static const struct subject {
    const char *words;
    enum parameter parameter;
    const char *option, *text; /* that has it drawn */
    int n_values;
    double value[MAX_VALUES], finest;
    int n_lamps;
    double stops, angle; /* over white, of a star; of the first lamp, degrees */
} subjects[] = {
    {"a lamp of 12 stops",
     STAR_CULL,
     "only",
     "starburst",
     10,
     {0.25, 0.5, 1, 2, 4, 8, 16, 32, 64, 128},
     0,
     1,
     12,
     8},
    {"ten of 2 stops",
     STAR_CULL,
     "only",
     "starburst",
     10,
     {0.25, 0.5, 1, 2, 4, 8, 16, 32, 64, 128},
     0,
     10,
     2,
     8},
    {"one of 16 stops beside the picture",
     STAR_CULL,
     "only",
     "starburst",
     10,
     {0.25, 0.5, 1, 2, 4, 8, 16, 32, 64, 128},
     0,
     1,
     16,
     40},
    {"dust on 0.05 of the stop",
     DUST_LOG2,
     "dust",
     "0.05,1",
     8,
     {3, 4, 5, 6, 7, 8, 9, 10},
     10,
     1,
     0,
     12},
    {"a veil of 0.02", VEIL, "veil", "0.02", 2, {0, 1}, 1, 1, 0, 12}};

/* A frame being measured. */
struct bay {
    struct sweep *s;
    const struct subject *subject;
    struct settings settings;
    struct glint_engine *engine;
    struct glint_dials dials;
    struct glint_lamp lamp[10];
    double exposure;
    int width, height;
    size_t n;       /* samples of a picture */
    uint8_t *codes; /* [n] */
    float *exact;   /* [n], codes with nothing left out, not rounded */
};

static bool is_star(const struct subject *subject)
{
    return subject->parameter == STAR_CULL;
}

/* ---------------------------------------------------------------- measuring */

static void set_parameter(struct glint_dials *d, enum parameter parameter,
                          double value)
{
    if (parameter == STAR_CULL)
        d->star_cull = value;
    else if (parameter == DUST_LOG2)
        d->dust_log2 = (int)value;
    else if (value == 0)
        d->flags |= GLINT_DIAL_NO_VEIL;
    else
        d->flags &= ~(unsigned)GLINT_DIAL_NO_VEIL;
}

/* Returns a black picture of FORMAT in MEM. */
static struct glint_image black(const struct bay *b,
                                enum glint_pixel_format format, void *mem)
{
    struct glint_image image = {.format = format,
                                .width = b->width,
                                .height = b->height,
                                .range = GLINT_RANGE_FULL};

    memset(mem, 0, glint_image_bytes(format, image.width, image.height));
    glint_image_place(&image, mem);
    return image;
}

/* Sets b->exact: all light, with the finest value. */
static enum glint_status draw_exact(struct bay *b)
{
    struct glint_dials dials = b->dials;
    int32_t *linear_q20 = malloc(b->n * sizeof *linear_q20);
    struct glint_engine_report report;
    enum glint_status status = GLINT_E_MEMORY;

    if (!is_star(b->subject)) {
        dials.irradiance_steps = dials.snap_codes_q8 = 0;
        dials.cull_codes = dials.dim_codes = 0;
    }
    set_parameter(&dials, b->subject->parameter, b->subject->finest);
    glint_engine_set_dials(b->engine, dials);
    if (linear_q20) {
        const struct glint_image image = black(b, GLINT_LINEAR_Q20, linear_q20);

        status = glint_engine_draw_at(b->engine, b->lamp, b->subject->n_lamps,
                                      b->exposure, &image, &report);
    }
    for (size_t i = 0; i < b->n && status == GLINT_OK; i++)
        b->exact[i] = (float)glint_measure_code(linear_q20[i] * 0x1p-20);
    free(linear_q20);
    return status;
}

/* Returns the bytes of tables of 2^LOG2 cells a side and coarser, as far as
 * DIRT has them. */
static size_t shade_bytes(const struct glint_dirt *dirt, int log2)
{
    size_t bytes = 0;

    for (int k = 1; k <= log2 && k <= glint_dirt_log2(dirt); k++)
        bytes += 3 * ((size_t)1 << k | 1) * ((size_t)1 << k | 1);
    return bytes;
}

/* Sets what is known of P but by its picture: bytes and planned cost. */
static void note_plan(const struct bay *b, struct sweep_part *p,
                      const struct glint_engine_report *report)
{
    const bool star = is_star(b->subject);

    p->planned_minsn = glint_explain_planned(
        b->engine, star ? GLINT_COST_STAR : GLINT_COST_KINDS);
    if (star)
        p->pixels =
            1e3 * p->planned_minsn / glint_cost_weight[GLINT_COST_STAR].planned;
    p->bytes = report->star_bytes + (star ? 0 : report->peak_bytes);
    if (b->subject->parameter == DUST_LOG2)
        p->bytes += shade_bytes(b->settings.setup.dirt, (int)p->value);
}

/* Draws and times frames with VALUE, and compares the last one. */
static enum glint_status measure(struct bay *b, double value)
{
    struct sweep_part *const p = &b->s->part[b->s->n_parts++];
    struct glint_dials dials = b->dials;
    struct glint_engine_report report = {.lights = 0};
    enum glint_status status = GLINT_OK;
    double square = 0;

    *p = (struct sweep_part){.subject = (int)(b->subject - subjects),
                             .value = value,
                             .ms = HUGE_VAL,
                             .instructions = (double)NAN};
    set_parameter(&dials, b->subject->parameter, value);
    glint_engine_set_dials(b->engine, dials);
    for (int i = 0; i < b->s->rounds && status == GLINT_OK; i++) {
        const struct glint_image image = black(b, GLINT_RGB24, b->codes);
        double ms;

        status =
            sweep_time(b->s, b->engine, b->lamp, b->subject->n_lamps,
                       b->exposure, &image, &report, &ms, &p->instructions);
        p->ms = fmin(p->ms, ms);
    }
    for (size_t i = 0; i < b->n; i++) {
        const double off = b->codes[i] - (double)b->exact[i];

        square += off * off;
        p->most_codes = fmax(p->most_codes, fabs(off));
    }
    p->psnr_db = 10 * log10(255. * 255 * (double)b->n / square);
    if (status == GLINT_OK)
        note_plan(b, p, &report);
    return status;
}

static enum glint_status measure_all(struct bay *b)
{
    struct sweep_part *const first = b->s->part + b->s->n_parts;
    double cost[MAX_VALUES], db[MAX_VALUES];
    int front[MAX_VALUES], n = 0;
    enum glint_status status = draw_exact(b);

    while (n < b->subject->n_values && status == GLINT_OK) {
        status = measure(b, b->subject->value[n]);
        cost[n] = first[n].ms;
        db[n] = first[n].psnr_db;
        n++;
    }
    n = sweep_front(cost, db, n, front);
    for (int i = 0; i < n; i++)
        first[front[i]].front = true;
    return status;
}

/* Sets lamps and exposure: stars of lamps as bright as they are, or ghosts that
 * reach white, under a veil that is a fraction of white. */
static enum glint_status set_lamps(struct bay *b)
{
    const struct subject *const subject = b->subject;

    canvas_lamps(b->lamp, subject->n_lamps, subject->angle);
    for (int i = 0; i < subject->n_lamps; i++)
        b->lamp[i].power =
            is_star(subject) ? exp2(subject->stops) : (double)b->n / 3;
    b->exposure = 1;
    return is_star(subject)
               ? GLINT_OK
               : canvas_exposure(b->engine, b->lamp, 1, &b->exposure);
}

static int measure_subject(struct bay *b, const char *lens)
{
    const struct tool *const tool = b->s->tool;
    const int height = b->s->small ? 180 : is_star(b->subject) ? 1080 : 720;
    const int width = height * 16 / 9;
    struct glint_engine_config cfg;
    struct glint_error error = {""};
    enum glint_status status = GLINT_E_MEMORY;
    int code;

    settings_set_number(&b->settings, "starburst", is_star(b->subject));
    settings_set(&b->settings, b->subject->option, b->subject->text);
    b->n = 3 * (size_t)width * (size_t)height;
    b->codes = calloc(b->n, 1);
    b->exact = malloc(b->n * sizeof *b->exact);
    code = settings_open(tool, &b->settings, lens);
    b->width = width;
    b->height = height;
    if (code == EXIT_OK) {
        canvas_engine(tool, &b->settings, &b->settings, width, height, &cfg);
        cfg.workers = b->s->one;
        if (is_star(b->subject))
            cfg.drawing.parts |= GLINT_ENGINE_CORES;
        b->dials = cfg.drawing.dials;
        if (b->codes && b->exact)
            status = glint_engine_create(&b->engine, &cfg, &error);
        if (status == GLINT_OK)
            status = set_lamps(b);
        if (status == GLINT_OK)
            status = measure_all(b);
        glint_engine_destroy(b->engine);
        if (status != GLINT_OK)
            code = tool_fail(tool, status, error.text);
    }
    settings_close(&b->settings);
    free(b->codes);
    free(b->exact);
    return code;
}

int sweep_parts(struct sweep *s, const char *lens)
{
    struct bay *const b = malloc(sizeof *b);
    int code = EXIT_OK;

    if (!b)
        return tool_fail(s->tool, GLINT_E_MEMORY, NULL);
    for (size_t i = 0; i < sizeof subjects / sizeof *subjects; i++)
        if (code == EXIT_OK) {
            *b = (struct bay){
                .s = s, .subject = &subjects[i], .settings = s->base};
            code = measure_subject(b, lens);
        }
    free(b);
    return code;
}

/* ------------------------------------------------------------------- output */

static void print_csv(const struct sweep *s, bool stars, FILE *file)
{
    for (int i = 0; i < s->n_parts; i++) {
        const struct sweep_part *const p = &s->part[i];
        const struct subject *const subject = &subjects[p->subject];

        if (is_star(subject) != stars)
            continue;
        fprintf(file, "%s,", subject->words);
        if (!stars)
            fprintf(file, "%s,", parameter_name[subject->parameter]);
        fprintf(file, "%g,%.2f,%.2f,", p->value, p->psnr_db, p->most_codes);
        if (stars)
            fprintf(file, "%.0f,", p->pixels);
        fprintf(file, "%.3f,", p->planned_minsn);
        if (isfinite(p->instructions))
            fprintf(file, "%.0f", p->instructions);
        fprintf(file, ",%.3f,%zu", p->ms, p->bytes);
        if (!stars)
            fprintf(file, ",%d", p->front);
        sweep_csv_end(s, file);
    }
}

void sweep_parts_csv(const struct sweep *s, FILE *file)
{
    fputs("part,dial,value,psnr_db,most_codes,minsn_told,instructions,ms,"
          "bytes,front" SWEEP_CSV_END,
          file);
    print_csv(s, false, file);
}

void sweep_star_csv(const struct sweep *s, FILE *file)
{
    fputs("lamps,star_cull,psnr_db,most_codes,pixels,minsn_told,instructions,"
          "ms,star_bytes" SWEEP_CSV_END,
          file);
    print_csv(s, true, file);
}

void sweep_star_svg(const struct sweep *s, FILE *file)
{
    struct plot plot;

    plot_open(file, 1);
    plot_init(&plot, file, 0, "Stars: what is left out of them");
    plot.x.words = "million instructions, as planned";
    plot.x.is_log = true;
    plot.y.words = "PSNR, dB (58.9: rounding to codes)";
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < s->n_parts; i++) {
            const struct sweep_part *const p = &s->part[i];
            const char *const colour = plot_colour(p->subject);
            char tip[64];

            if (!is_star(&subjects[p->subject]))
                continue;
            if (pass == 0) {
                plot_stretch(&plot, p->planned_minsn, p->psnr_db);
                continue;
            }
            snprintf(tip, sizeof tip, "--star-cull %g", p->value);
            plot_mark(&plot, p->planned_minsn, p->psnr_db,
                      p->value == 2 ? 'd' : 'o', colour, tip);
            if (i > 0 && p[-1].subject == p->subject)
                plot_line(&plot, p[-1].planned_minsn, p[-1].psnr_db,
                          p->planned_minsn, p->psnr_db, colour, false);
            else
                plot_key(&plot, 'o', colour, subjects[p->subject].words);
        }
        if (pass == 0)
            plot_frame(&plot);
    }
    plot_close(file);
}
