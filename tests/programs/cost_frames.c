/* SPDX-License-Identifier: MIT
 *
 * cost_frames [--from N] FILE - draws the frames to which the cost model is
 * fitted, a third of them through lenses that are held out for validation.
 * Writes a line per frame to FILE: 1 if the frame is held out, its parameters,
 * the numbers of operations that its plan predicts, and the numbers counted
 * while drawing.
 *
 * If FILE exists, only draws the frames from number N on.
 * tools/measure/cost-fit counts their instructions with callgrind.
 *
 * Lights, image sizes, quality settings, f-numbers and enabled effects are
 * pseudo-random, the same in each run.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/frame/cost.h"
#include "glint/measure.h"
#include "measure/canvas.h"
#include "support/settings_frame.h"
#include "support/rng.h"

enum { FIT = 36, HELD = 18, LAMPS = 4 };

static const char *const fit_lens[] = {
    "heliar-tronnier", "double-gauss-angenieux", "itoh-zoom-long"};
static const char *const held_lens[] = {"nikon-zoom-mid", "nikon-zoom-short"};

struct shape {
    bool held;
    const char *lens;
    int width, height, n_lamps;
    double angle, stops, star_stops;
    double quality, dim, dispersion, starburst, veil, haze, dust, soft, round;
};

struct stage {
    struct tool tool;
    struct opened opened;
    struct glint_frame frame;
    struct canvas canvas;
    struct glint_lamp lamp[LAMPS];
    double exposure;
};

static double random_number_between(uint32_t *seed, double low, double high)
{
    return low + (high - low) * rng_unit(seed);
}

/* Returns the parameters of frame I. Frames with dust or soft edges, which draw
 * many edges, have a small image. */
static struct shape make_frame_parameters(int i)
{
    static const int width[] = {320, 480, 640};
    static const int lamps[] = {1, 1, 2, 4};
    uint32_t seed = 2654435761u * (uint32_t)(i + 1);
    struct shape s = {.held = i >= FIT};
    bool dirty;

    for (int k = 0; k < 8; k++)
        rng_bits32(&seed);
    s.lens = s.held ? held_lens[rng_int_below(&seed, 2)]
                    : fit_lens[rng_int_below(&seed, 3)];
    dirty = rng_int_below(&seed, 4) == 0;
    s.width = width[rng_int_below(&seed, dirty ? 1 : 3)];
    s.height = s.width * 9 / 16;
    s.n_lamps = lamps[rng_int_below(&seed, dirty ? 2 : 4)];
    s.angle = random_number_between(&seed, 1, 25);
    s.stops = random_number_between(&seed, -5, 1);
    s.quality = random_number_between(&seed, 0, dirty ? 0.5 : 0.75);
    s.dim =
        rng_int_below(&seed, 3) ? 0 : exp2(random_number_between(&seed, -2, 2));
    s.dispersion = rng_int_below(&seed, 4) ? 0 : 1;
    s.starburst = rng_int_below(&seed, 3) ? 0 : 1;
    s.star_stops = random_number_between(&seed, 3, 14);
    s.veil = rng_int_below(&seed, 4) ? 0 : 0.02;
    s.haze = rng_int_below(&seed, 5) ? 0 : 0.02;
    s.dust = dirty && rng_int_below(&seed, 3)
                 ? exp2(random_number_between(&seed, -9, -5))
                 : 0;
    s.soft = dirty && rng_int_below(&seed, 3) == 0
                 ? random_number_between(&seed, 0.01, 0.1)
                 : 0;
    s.round =
        rng_int_below(&seed, 4) ? 0 : random_number_between(&seed, 0.1, 0.9);
    return s;
}

static void set_frame_settings(struct settings *to, const struct shape *s)
{
    settings_set_defaults(to);
    to->coating.kind = COATING_TABLE;
    settings_set_quality(to, s->quality);
    to->dials.dispersion_q8 = (int)(256 * s->dispersion);
    to->camera.waves.kind =
        s->dispersion > 0 ? GLINT_WAVES_AUTO : GLINT_WAVES_LIST;
    to->dials.dim_codes = s->dim;
    to->options.starburst = s->starburst;
    GLINT_OPTION_GIVEN(&to->options, starburst) = true;
    to->options.veil = s->veil;
    to->options.haze = s->haze;
    to->camera.iris.dust = s->dust;
    to->camera.iris.softness = s->soft;
    to->camera.iris.roundness = s->round;
    to->options.work = 0;
    GLINT_OPTION_GIVEN(&to->options, work) = true;
    to->tolerance = 1;
}

static void exit_with_error(const char *what)
{
    fprintf(stderr, "cost_frames: %s\n", what);
    exit(1);
}

static void open_lens_stage(struct stage *s, const struct shape *shape)
{
    set_frame_settings(&s->opened.settings, shape);
    if (opened_lens_open(&s->tool, &s->opened.lens, &s->opened.settings,
                         shape->lens) != EXIT_OK ||
        make_frame_from_settings(&s->tool, &s->opened, shape->width,
                                 shape->height, &s->frame) != EXIT_OK ||
        canvas_init(&s->canvas, GLINT_RGB24, shape->width, shape->height) !=
            GLINT_OK)
        exit_with_error(shape->lens);
    canvas_set_lamps(s->lamp, shape->n_lamps, shape->angle);
}

static void close_lens_stage(struct stage *s)
{
    canvas_free(&s->canvas);
    glint_frame_finish(&s->frame);
    opened_lens_close(&s->opened.lens);
}

/* Calls glint_frame_draw(). A separate function, so that
 * tools/measure/cost-fit can count its instructions. */
static enum glint_status draw_counted_frame(struct glint_frame *frame,
                                            const struct glint_lamp *lamp,
                                            int n,
                                            const struct glint_image *image,
                                            struct glint_engine_report *report)
{
    return glint_frame_draw(frame, lamp, n, 1, image, report);
}

/* The call through a volatile pointer prevents inlining. */
static enum glint_status (*volatile counted_draw)(
    struct glint_frame *, const struct glint_lamp *, int,
    const struct glint_image *,
    struct glint_engine_report *) = draw_counted_frame;

static enum glint_status find_frame_exposure(struct glint_frame *frame,
                                             const struct glint_lamp *lamp,
                                             double *exposure)
{
    const int width = frame->view.width, height = frame->view.height;
    const size_t n = 3 * (size_t)width * (size_t)height;
    struct glint_float_image flare = {width, height, malloc(n * sizeof(float))};
    struct glint_engine_report report;
    enum glint_status status = GLINT_E_MEMORY;

    if (flare.rgb)
        status =
            glint_frame_draw_flare_alone(frame, lamp, 1, 1, flare.rgb, &report);
    if (status == GLINT_OK)
        *exposure = glint_measure_exposure(&flare);
    free(flare.rgb);
    return status;
}

/* Draws the frame twice. The first drawing allocates the memory, so that the
 * second measures drawing alone. */
static void draw_frame_twice(struct stage *s, const struct shape *shape)
{
    struct glint_engine_report report;

    for (int i = 0; i < shape->n_lamps; i++)
        s->lamp[i].power *= s->exposure * exp2(shape->stops);
    /* The exposure scales lamps and stars. The star's fraction is divided by
     * the exposure, so that the star's light does not depend on it. */
    s->frame.star.share *= exp2(shape->star_stops) /
                           (s->exposure * exp2(shape->stops)) * shape->n_lamps;
    canvas_restore_background(&s->canvas);
    if (glint_frame_draw(&s->frame, s->lamp, shape->n_lamps, 1,
                         &s->canvas.image, &report) != GLINT_OK)
        exit_with_error("no memory");
    canvas_restore_background(&s->canvas);
    if (counted_draw(&s->frame, s->lamp, shape->n_lamps, &s->canvas.image,
                     &report) != GLINT_OK)
        exit_with_error("no memory");
}

static void count_lit_pixels_of_row(const struct stage *s, double *counted)
{
    struct glint_planned b;

    for (int k = 0; k < GLINT_COST_KINDS; k++)
        counted[k] = 0;
    for (int i = 0; glint_flare_planned(s->frame.memory.flare, i, &b); i++) {
        struct glint_account a;

        glint_flare_account(s->frame.memory.flare, b.ghost, b.light, b.wave,
                            &a);
        counted[GLINT_COST_LOOKED_AT] += a.probed;
        counted[GLINT_COST_BUNDLES]++;
        counted[GLINT_COST_VERTICES] += a.vertices;
        counted[GLINT_COST_EDGES] += a.edges;
        counted[GLINT_COST_ROWS] += (double)a.rows;
    }
}

/* Returns the number of pixels to which the flare adds light. */
static double count_lit_pixels(const struct stage *s)
{
    const size_t n =
        3 * (size_t)s->frame.view.width * (size_t)s->frame.view.height;
    struct glint_image image = {.format = GLINT_LINEAR_Q20,
                                .width = s->frame.view.width,
                                .height = s->frame.view.height};
    int32_t *px = calloc(n, sizeof *px);
    double lit = 0;

    if (!px)
        exit_with_error("no memory");
    glint_image_place(&image, px);
    glint_flare_draw(s->frame.memory.flare, &image);
    for (size_t i = 0; i < n; i += 3)
        lit += (px[i] | px[i + 1] | px[i + 2]) != 0;
    free(px);
    return lit;
}

static void print_frame_costs(struct stage *s, const struct shape *shape,
                              FILE *file)
{
    const struct glint_cost_plan plan = glint_frame_make_cost_plan(&s->frame);
    const struct glint_cost planned = glint_cost_of(&plan, &plan.dials);
    double counted[GLINT_COST_KINDS];

    fprintf(file, "%d %s,%d,%d,%g,%g,%g,%g,%d,%d,%d %.17g", shape->held,
            shape->lens, shape->width, shape->n_lamps, shape->quality,
            shape->dust, shape->soft, shape->dispersion,
            s->frame.dials.irradiance_steps, (int)s->frame.dials.flags,
            s->frame.dials.fineness, s->exposure);
    for (int k = 0; k < GLINT_COST_KINDS; k++)
        fprintf(file, " %g", planned.count[k]);
    fprintf(file, " |");
    count_lit_pixels_of_row(s, counted);
    for (int k = GLINT_COST_PARTS; k < GLINT_COST_KINDS; k++)
        counted[k] = planned.count[k];
    counted[GLINT_COST_LIT] = count_lit_pixels(s);
    for (int k = 0; k < GLINT_COST_KINDS; k++)
        fprintf(file, " %g", counted[k]);
    fprintf(file, "\n");
}

int main(int argc, char **argv)
{
    const int first =
        argc > 3 && strcmp(argv[1], "--from") == 0 ? atoi(argv[2]) : 0;
    const char *const path = argv[argc - 1];
    FILE *const from = argc > 1 ? fopen(path, "r") : NULL;
    FILE *const to = !from && argc > 1 ? fopen(path, "w") : NULL;
    struct stage *s = calloc(1, sizeof *s);

    if ((!from && !to) || !s)
        exit_with_error("needs a FILE");
    s->tool.name = "cost_frames";
    s->tool.quiet = true;
    for (int i = 0; i < FIT + HELD; i++) {
        const struct shape shape = make_frame_parameters(i);
        double exposure = 1;

        s->tool.name = "cost_frames";
        if (from && fscanf(from, "%*d %*s %lf%*[^\n]", &exposure) != 1)
            exit_with_error(path);
        if (i < first)
            continue;
        open_lens_stage(s, &shape);
        s->exposure = exposure;
        if (!from &&
            find_frame_exposure(&s->frame, s->lamp, &s->exposure) != GLINT_OK)
            exit_with_error("no memory");
        draw_frame_twice(s, &shape);
        if (to) {
            print_frame_costs(s, &shape, to);
            fflush(to);
        }
        close_lens_stage(s);
        memset(s, 0, sizeof *s);
    }
    free(s);
    return 0;
}
