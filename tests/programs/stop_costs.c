/* SPDX-License-Identifier: MIT
 *
 * stop_costs MODEL.glint F... - prints what a frame through a model takes at
 * each f-number: a line of f-number, processor milliseconds of one thread (the
 * least of ROUNDS), edges, lit pixels (the sum over the ghosts), and the height
 * of the picture. Frames are 16:9, codes on black, at the default quality with
 * three wavelengths, and show one light 7 degrees off the axis, so bright that
 * the 99.9th percentile of the flare is display white. Pictures are 1080 high
 * for the last f-number, and for the others as high as makes their ghosts light
 * as many pixels as its ghosts do; then 1080 high for all, a line each.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "engine/explain_frame.h"
#include "options/tool.h"
#include "support/stage.h"

enum { TALL = 1080, ROUNDS = 5, TRIES = 4 };

static struct stage stage;
static const struct glint_lamp here = {7, 30, 1, {1, 1, 1}, {0, 0}, 0};

struct costs {
    int height, edges;
    double ms, lit;
};

static double seconds(void)
{
    struct timespec t;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void set_height(int height)
{
    stage_view(&stage, (16 * height + 4) / 9 & ~1, height, 0);
    stage.frame.dials = glint_dials_at(1 << 14);
    stage.frame.dials.dispersion_q8 = 0;
}

/* Returns the sum over ghosts of the pixels that each lights in the frame that
 * was drawn last. */
static double lit_pixels(void)
{
    struct glint_explain explain;
    double lit = 0;

    if (glint_explain_frame(&explain, &stage.frame, 1) != GLINT_OK)
        exit(1);
    for (int k = 0; k < explain.n_ghosts; k++)
        lit += explain.ghost[k].lit;
    glint_explain_close(&explain);
    return lit;
}

/* Measures frames of a height. */
static struct costs measure(int height)
{
    struct costs c = {.height = height, .ms = HUGE_VAL};
    struct glint_lamp lamp = here;
    const size_t bytes = 3 * (size_t)height * (size_t)(2 * height);
    uint8_t *codes = malloc(bytes);

    if (!codes)
        exit(1);
    set_height(height);
    lamp.power = stage_power(&stage, &lamp);
    for (int i = 0; i < ROUNDS; i++) {
        double from;

        memset(codes, 0, bytes);
        from = seconds();
        if (!stage_codes(&stage, &lamp, 1, codes))
            exit(1);
        c.ms = fmin(c.ms, 1e3 * (seconds() - from));
    }
    c.edges = stage.drawn.stats.primitives;
    c.lit = lit_pixels();
    free(codes);
    return c;
}

static bool stop_down(double f_number)
{
    static const double nm[3] = {650, 532, 450};
    struct glint_error error;

    return glint_setup_from_model(&stage.of_model, &stage.file.lens, 8, 0, nm,
                                  3, &error) == GLINT_OK &&
           glint_setup_stop_down(&stage.of_model, &stage.file.lens, f_number,
                                 &error) == GLINT_OK;
}

static void print(double f_number, const struct costs *c)
{
    printf("%g %.2f %d %.0f %d\n", f_number, c->ms, c->edges, c->lit,
           c->height);
    fflush(stdout);
}

/* Returns the costs of a frame whose ghosts light LIT pixels, within a
 * fiftieth if TRIES steps come as near. */
static struct costs of_same_lit(double lit)
{
    struct costs c = measure(TALL);

    for (int i = 0; i < TRIES && fabs(c.lit / lit - 1) > 0.02; i++) {
        const double height = c.height * sqrt(lit / c.lit);

        c = measure((int)fmax(32, fmin(2 * TALL, height)));
    }
    return c;
}

int main(int argc, char **argv)
{
    static const struct tool tool = {.name = "stop_costs", .n_threads = 1};
    struct costs c;

    if (argc < 3 || tool_model(&tool, argv[1], &stage.file) != EXIT_OK)
        return 2;
    stage.lens.film_width_mm =
        glint_real_value(stage.file.lens.header->film_width_mm);
    stage.lens.film_height_mm =
        glint_real_value(stage.file.lens.header->film_height_mm);
    if (!stop_down(atof(argv[argc - 1])))
        return 1;
    c = measure(TALL);
    for (int i = 2; i < argc; i++) {
        struct costs same;

        if (!stop_down(atof(argv[i])))
            return 1;
        same = of_same_lit(c.lit);
        print(atof(argv[i]), &same);
    }
    for (int i = 2; i < argc; i++) {
        if (!stop_down(atof(argv[i])))
            return 1;
        c = measure(TALL);
        print(atof(argv[i]), &c);
    }
    stage_close(&stage);
    return 0;
}
