/* SPDX-License-Identifier: MIT
 *
 * Fronts of what is drawn beside ghosts: how far stars reach, how fine the
 * tables of dust are, and whether there is a veil, against what each costs.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/measure.h"
#include "engine/frame/cost.h"
#include "engine/setup/dirt.h"
#include "lab/plots/plot.h"
#include "lab/sweep.h"
#include "linux/instructions.h"

static const double culls[] = {0.25, 0.5, 1, 2, 4, 8, 16, 32, 64, 128};

/* Lamps whose stars are measured, and their stops over white. */
static const struct lamps {
    const char *words;
    int n;
    double stops, angle; /* of the first one, degrees off the axis */
} lamps[] = {{"a lamp of 12 stops", 1, 12, 8},
             {"ten of 2 stops", 10, 2, 8},
             {"one of 16 stops beside the picture", 1, 16, 40}};

/* Tables of dust of 2^3 to 2^10 cells a side; without the veil and with it. */
static const struct kind {
    const char *words, *dial;
    int first, n; /* values of the dial */
} kinds[] = {{"dust on 0.05 of the stop", "dust_log2", 3, 8},
             {"a veil of 0.02", "veil", 0, 2}};

/* A frame being measured. */
struct bay {
    struct sweep *s;
    struct settings settings;
    struct glint_frame frame;
    struct canvas canvas;
    struct glint_lamp lamp[10];
    int n_lamps;
    double exposure;
    float *exact; /* codes with nothing left out, not rounded */
};

static enum glint_status draw(struct bay *b, enum glint_pixel_format format,
                              void *mem, struct glint_engine_report *report)
{
    struct glint_image image = {.format = format,
                                .width = b->frame.view.width,
                                .height = b->frame.view.height,
                                .range = GLINT_RANGE_FULL};

    memset(mem, 0, glint_image_bytes(format, image.width, image.height));
    glint_image_place(&image, mem);
    return glint_frame_draw(&b->frame, b->lamp, b->n_lamps, b->exposure, &image,
                            report);
}

/* Sets the codes that all of the light has, as the dials are. */
static enum glint_status set_exact(struct bay *b)
{
    const size_t n =
        3 * (size_t)b->frame.view.width * (size_t)b->frame.view.height;
    int32_t *linear_q20 = malloc(n * sizeof *linear_q20);
    struct glint_engine_report report;
    enum glint_status status = GLINT_E_MEMORY;

    b->exact = malloc(n * sizeof *b->exact);
    if (linear_q20 && b->exact)
        status = draw(b, GLINT_LINEAR_Q20, linear_q20, &report);
    for (size_t i = 0; i < n && status == GLINT_OK; i++)
        b->exact[i] = (float)glint_measure_code(linear_q20[i] * 0x1p-20);
    free(linear_q20);
    return status;
}

/* Draws and times a frame as the dials are, and compares it. CODES is room for
 * its picture. */
static enum glint_status measure(struct bay *b, uint8_t *codes,
                                 struct sweep_shot *to)
{
    const size_t n =
        3 * (size_t)b->frame.view.width * (size_t)b->frame.view.height;
    enum glint_status status = GLINT_OK;
    double square = 0;

    to->ms = HUGE_VAL;
    to->instructions = (double)NAN;
    to->most_codes = 0;
    for (int i = 0; i < b->s->rounds && status == GLINT_OK; i++) {
        uint64_t n0 = 0;
        double t0;

        if (b->s->counter >= 0)
            n0 = glint_instructions_read(b->s->counter);
        t0 = tool_seconds();
        status = draw(b, GLINT_RGB24, codes, &to->report);
        to->ms = fmin(to->ms, 1e3 * (tool_seconds() - t0));
        if (b->s->counter >= 0)
            to->instructions =
                (double)(glint_instructions_read(b->s->counter) - n0);
    }
    for (size_t i = 0; i < n; i++) {
        const double off = codes[i] - (double)b->exact[i];

        square += off * off;
        to->most_codes = fmax(to->most_codes, fabs(off));
    }
    to->psnr_db = 10 * log10(255. * 255 * (double)n / square);
    return status;
}

static enum glint_status measure_star(struct bay *b, double cull,
                                      uint8_t *codes, struct sweep_star *to)
{
    enum glint_status status;

    to->cull = b->frame.dials.star_cull = cull;
    status = measure(b, codes, &to->shot);
    to->pixels = b->frame.star.pixels;
    to->minsn_told = 1e-3 * glint_cost_weight[GLINT_COST_STAR].planned *
                     b->frame.star.pixels;
    to->bytes = glint_frame_star_bytes(&b->frame);
    return status;
}

static enum glint_status measure_lamps(struct bay *b, int kind)
{
    const struct lamps *k = &lamps[kind];
    const size_t n =
        3 * (size_t)b->frame.view.width * (size_t)b->frame.view.height;
    uint8_t *codes = calloc(n, 1);
    enum glint_status status;

    b->n_lamps = k->n;
    canvas_lamps(b->lamp, k->n, k->angle);
    for (int i = 0; i < k->n; i++)
        b->lamp[i].power = exp2(k->stops);
    b->frame.dials.star_cull = 0;
    status = codes ? set_exact(b) : GLINT_E_MEMORY;
    for (size_t i = 0; i < sizeof culls / sizeof *culls && status == GLINT_OK;
         i++) {
        struct sweep_star *to = &b->s->star[b->s->n_stars++];

        to->words = k->words;
        status = measure_star(b, culls[i], codes, to);
    }
    free(b->exact);
    b->exact = NULL;
    free(codes);
    return status;
}

int sweep_stars(struct sweep *s, const char *lens)
{
    const int width = s->small ? 320 : 1920, height = s->small ? 180 : 1080;
    struct bay *b = calloc(1, sizeof *b);
    enum glint_status status = GLINT_OK;
    int code;

    if (!b)
        return tool_fail(s->tool, GLINT_E_MEMORY, NULL);
    b->s = s;
    b->exposure = 1;
    b->settings = s->base;
    b->settings.options.starburst = 1;
    GLINT_OPTION_GIVEN(&b->settings.options, starburst) = true;
    b->settings.options.only = GLINT_ONLY_STARBURST;
    code = settings_open(s->tool, &b->settings, lens);
    if (code == EXIT_OK)
        code = settings_frame(s->tool, &b->settings,
                              settings_view(&b->settings, width, height),
                              &b->frame);
    if (code == EXIT_OK) {
        b->frame.cfg.workers = s->one;
        b->frame.star.is_bare = true;
        for (int i = 0; i < SWEEP_STAR_LAMPS && status == GLINT_OK; i++)
            status = measure_lamps(b, i);
        glint_frame_finish(&b->frame);
    }
    settings_close(&b->settings);
    free(b);
    return status == GLINT_OK ? code : tool_fail(s->tool, status, NULL);
}

/* Returns the bytes of tables of 2^LOG2 cells a side and coarser. */
static size_t shade_bytes(const struct glint_shade *shade, int log2)
{
    size_t bytes = 0;

    for (int k = 1; k <= log2 && k <= shade->log2; k++)
        bytes += 3 * ((size_t)1 << k | 1) * ((size_t)1 << k | 1);
    return bytes;
}

/* Turns the dial of KIND to VALUE. */
static void turn(struct glint_dials *d, int kind, int value)
{
    if (kind == 0)
        d->dust_log2 = value;
    else if (value == 0)
        d->flags |= GLINT_DIAL_NO_VEIL;
    else
        d->flags &= ~(unsigned)GLINT_DIAL_NO_VEIL;
}

/* Returns D with what may be left out of ghosts drawn. */
static struct glint_dials with_all(struct glint_dials d)
{
    d.irradiance_steps = d.snap_codes_q8 = 0;
    d.cull_codes = d.dim_codes = 0;
    return d;
}

/* Sets b->exposure to that at which the ghosts reach white. */
static enum glint_status expose(struct bay *b)
{
    const int width = b->frame.view.width, height = b->frame.view.height;
    struct glint_float_image got = {
        width, height,
        malloc(3 * (size_t)width * (size_t)height * sizeof(float))};
    struct glint_engine_report report;
    enum glint_status status = GLINT_E_MEMORY;

    if (got.rgb)
        status =
            glint_frame_draw_alone(&b->frame, b->lamp, 1, 1, got.rgb, &report);
    if (status == GLINT_OK)
        b->exposure = glint_measure_exposure(&got);
    free(got.rgb);
    return status;
}

/* Measures the values of KIND's dial, and marks those that no other one is both
 * cheaper and nearer than. */
static enum glint_status measure_values(struct bay *b, int kind, uint8_t *codes)
{
    const struct kind *k = &kinds[kind];
    const struct glint_dials asked = b->frame.dials;
    const struct glint_shade *shade =
        b->frame.setup->dirt ? &b->frame.setup->dirt->shade : NULL;
    double cost[SWEEP_PARTS], db[SWEEP_PARTS];
    struct sweep_part *first = b->s->part + b->s->n_parts;
    int front[SWEEP_PARTS], n_front;
    enum glint_status status;

    b->frame.dials = with_all(asked);
    turn(&b->frame.dials, kind, k->first + k->n - 1);
    status = set_exact(b);
    b->frame.dials = asked;
    for (int i = 0; i < k->n && status == GLINT_OK; i++) {
        struct sweep_part *to = &b->s->part[b->s->n_parts++];
        struct glint_cost_plan plan;
        struct glint_cost told;

        *to = (struct sweep_part){
            .words = k->words, .dial = k->dial, .value = k->first + i};
        turn(&b->frame.dials, kind, to->value);
        status = measure(b, codes, &to->shot);
        plan = glint_frame_plan(&b->frame);
        told = glint_cost_of(&plan, &plan.dials);
        to->minsn_told = glint_cost_minsn(&told);
        to->bytes = to->shot.report.peak_bytes + to->shot.report.star_bytes +
                    (shade ? shade_bytes(shade, b->frame.dials.dust_log2) : 0);
        cost[i] = b->s->by_instructions ? to->shot.instructions : to->shot.ms;
        db[i] = to->shot.psnr_db;
    }
    n_front = status == GLINT_OK ? sweep_front(cost, db, k->n, front) : 0;
    for (int i = 0; i < n_front; i++)
        first[front[i]].front = true;
    free(b->exact);
    b->exact = NULL;
    return status;
}

/* Measures the part KIND through LENS. Returns an exit code. */
static int sweep_kind_of(struct sweep *s, struct bay *b, const char *lens,
                         int kind)
{
    const int width = s->small ? 320 : 1280, height = s->small ? 180 : 720;
    uint8_t *codes = calloc(3 * (size_t)width * (size_t)height, 1);
    enum glint_status status = codes ? GLINT_OK : GLINT_E_MEMORY;
    int code = EXIT_OK;

    *b = (struct bay){.s = s, .settings = s->base, .n_lamps = 1};
    if (kind == 0)
        glint_option_dust("0.05,1", &b->settings.stop.iris.dust,
                          &b->settings.stop.iris.dust_seed);
    else
        b->settings.options.veil = 0.02;
    b->settings.options.starburst = 0; /* stars have a front of their own */
    GLINT_OPTION_GIVEN(&b->settings.options, starburst) = true;
    canvas_lamps(b->lamp, 1, 12);
    b->lamp[0].power = width * height; /* a veil as its share of white */
    code = settings_open(s->tool, &b->settings, lens);
    if (code == EXIT_OK)
        code = settings_frame(s->tool, &b->settings,
                              settings_view(&b->settings, width, height),
                              &b->frame);
    if (code == EXIT_OK) {
        b->frame.cfg.workers = s->one;
        status = status == GLINT_OK ? expose(b) : status;
        status = status == GLINT_OK ? measure_values(b, kind, codes) : status;
        glint_frame_finish(&b->frame);
    }
    settings_close(&b->settings);
    free(codes);
    return status == GLINT_OK ? code : tool_fail(s->tool, status, NULL);
}

int sweep_parts(struct sweep *s, const char *lens)
{
    struct bay *b = calloc(1, sizeof *b);
    int code = EXIT_OK;

    if (!b)
        return tool_fail(s->tool, GLINT_E_MEMORY, NULL);
    for (int kind = 0;
         kind < (int)(sizeof kinds / sizeof *kinds) && code == EXIT_OK; kind++)
        code = sweep_kind_of(s, b, lens, kind);
    free(b);
    return code;
}

void sweep_parts_csv(const struct sweep *s, FILE *file)
{
    fputs("part,dial,value,psnr_db,most_codes,minsn_told,instructions,ms,"
          "bytes,front\n",
          file);
    for (int i = 0; i < s->n_parts; i++) {
        const struct sweep_part *p = &s->part[i];

        fprintf(file, "%s,%s,%d,%.2f,%.2f,%.3f,", p->words, p->dial, p->value,
                p->shot.psnr_db, p->shot.most_codes, p->minsn_told);
        if (isfinite(p->shot.instructions))
            fprintf(file, "%.0f", p->shot.instructions);
        fprintf(file, ",%.3f,%zu,%d\n", p->shot.ms, p->bytes, p->front);
    }
}

typedef char
    lamps_fit[sizeof lamps / sizeof *lamps == SWEEP_STAR_LAMPS ? 1 : -1];
typedef char
    culls_fit[sizeof culls / sizeof *culls == SWEEP_STAR_CULLS ? 1 : -1];

void sweep_star_csv(const struct sweep *s, FILE *file)
{
    fputs("lamps,star_cull,psnr_db,most_codes,pixels,minsn_told,instructions,"
          "ms,star_bytes\n",
          file);
    for (int i = 0; i < s->n_stars; i++) {
        const struct sweep_star *p = &s->star[i];

        fprintf(file, "%s,%g,%.2f,%.2f,%.0f,%.3f,", p->words, p->cull,
                p->shot.psnr_db, p->shot.most_codes, p->pixels, p->minsn_told);
        if (isfinite(p->shot.instructions))
            fprintf(file, "%.0f", p->shot.instructions);
        fprintf(file, ",%.3f,%zu\n", p->shot.ms, p->bytes);
    }
}

void sweep_star_svg(const struct sweep *s, FILE *file)
{
    struct plot plot;

    plot_open(file, 1);
    plot_init(&plot, file, 0, "Stars: what is left out of them");
    plot.x.words = "million instructions, as planned";
    plot.x.is_log = true;
    plot.y.words = "PSNR, dB (58.9: rounding to codes)";
    plot.x.lo = plot.y.lo = 1;
    plot.x.hi = plot.y.hi = 0;
    for (int i = 0; i < s->n_stars; i++)
        plot_stretch(&plot, s->star[i].minsn_told, s->star[i].shot.psnr_db);
    plot_frame(&plot);
    for (int i = 0; i < s->n_stars; i++) {
        const struct sweep_star *p = &s->star[i];
        const char *const colour = plot_colour(i / SWEEP_STAR_CULLS);
        char tip[64];

        snprintf(tip, sizeof tip, "--star-cull %g", p->cull);
        plot_mark(&plot, p->minsn_told, p->shot.psnr_db,
                  p->cull == 2 ? 'd' : 'o', colour, tip);
        if (i % SWEEP_STAR_CULLS)
            plot_line(&plot, p[-1].minsn_told, p[-1].shot.psnr_db,
                      p->minsn_told, p->shot.psnr_db, colour, false);
        else
            plot_key(&plot, 'o', colour, p->words);
    }
    plot_close(file);
}
