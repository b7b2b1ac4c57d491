/* SPDX-License-Identifier: MIT
 *
 * steady [--lens LENS] [VIDEO.y4m...] - prints how steady the flare is in
 * synthetic scenes and in videos.
 *
 * The total light of the flare changes from frame to frame for two reasons:
 * lamps move, appear, vanish or are occluded, and the automatic exposure
 * adapts. The change that the lamps alone cause is measured at a constant
 * exposure. A step between 0 and this change is attributed to the lamps; the
 * part of a step outside this interval is attributed to glint ("own step").
 * Frames after a cut are not counted.
 *
 * In synthetic scenes the true lamps are known. There a step is also attributed
 * to them up to the range of their true flare light within the last WINDOW
 * frames, as a tracked lamp fades in and out over six frames. Exit code 1: an
 * own step is larger than MOST, by either attribution.
 */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/engine_parts.h"
#include "overlay/drawing.h"
#include "video/y4m.h"
#include "posix/error.h"
#include "support/night.h"
#include "options/command_line.h"

#define MOST 0.1

enum { WIDTH = 640, HEIGHT = 360, FRAMES = 150, FRAME_US = 40000, WINDOW = 10 };

struct steady {
    struct tool tool;
    struct drawing drawing;
    /* total, own: flare light of the previous frame, with and without the
     * automatic exposure */
    double total, own;
    /* flare light of the true lamps, latest frame first; -1: unknown */
    double truth[WINDOW + 1];
    /* worst: largest own step; largest: largest step of any cause */
    double worst, largest;
    /* largest part of a step that exceeds the change of the true lamps */
    double unmade;
    int worst_frame, unmade_frame, cuts, frames, most_lights;
};

/* ------------------------------------------------------------------- steps */

static double sum_flare_light(struct steady *s)
{
    const struct drawing *const c = &s->drawing;
    struct glint_response_light light;

    if (glint_response_draw_and_measure(
            &c->run.engine->paint.frame,
            glint_engine_copy_ghost_lamps(c->run.engine, c->run.lamp,
                                          c->run.n_lamps),
            c->run.n_lamps, GLINT_RESPONSE_COARSE, NULL, &light,
            NULL) != GLINT_OK)
        exit(EXIT_RUNTIME);
    return glint_largest_channel(light.mean);
}

/* Returns how far STEP lies outside the interval between 0 and OWN. Both are
 * logarithms of the ratio of the light in two frames. */
static double compute_step_outside_interval(double step, double own)
{
    const double low = fmin(own, 0), high = fmax(own, 0);

    return step > high ? step - high : step < low ? low - step : 0;
}

/* Returns ln(max / min) of the true flare light within the last WINDOW
 * frames. */
static double compute_true_light_span(const struct steady *s)
{
    double low = s->truth[0], high = s->truth[0];

    for (int i = 1; i <= WINDOW && i <= s->frames; i++) {
        low = fmin(low, s->truth[i]);
        high = fmax(high, s->truth[i]);
    }
    return low > 0 ? log(high / low) : HUGE_VAL;
}

static void record_light_step(struct steady *s, double total, double own)
{
    const bool is_cut = drawing_has_exposure_restarted(&s->drawing);
    /* a fainter flare is invisible, so that its appearance is not counted as a
     * step */
    const double least = 1e-6;

    s->cuts += is_cut && s->frames > 0;
    if (!is_cut && s->total > least && total > least) {
        const double step = log(total / s->total);
        const double ours =
            exp(compute_step_outside_interval(step, log(own / s->own))) - 1;

        const double alone =
            exp(fmax(fabs(step) - compute_true_light_span(s), 0)) - 1;

        s->largest = fmax(s->largest, exp(fabs(step)) - 1);
        if (alone > s->unmade) {
            s->unmade = alone;
            s->unmade_frame = s->frames;
        }
        if (ours > s->worst) {
            s->worst = ours;
            s->worst_frame = s->frames;
        }
    }
    s->total = total;
    s->own = own;
}

static void draw_and_record_frame(struct steady *s,
                                  const struct glint_image *image,
                                  int32_t elapsed_us)
{
    struct drawing *drawing = &s->drawing;
    double own, drawn, power = 0, held = 0;

    drawing_detect_and_draw_scene(drawing, image, elapsed_us);
    own = drawn = sum_flare_light(s);
    for (int i = 0; i < drawing->run.n_lamps; i++)
        power += drawing->run.lamp[i].lamp.power;
    drawing_set_exposure(drawing, image);
    for (int i = 0; i < drawing->run.n_lamps; i++)
        held += drawing->run.lamp[i].lamp.power;
    /* The exposure has reduced the power of lamps that are too bright. */
    if (held < power)
        drawn = sum_flare_light(s);
    record_light_step(s, drawn * drawing_get_exposure_factor(&drawing->run),
                      own);
    if (drawing->run.n_lamps > s->most_lights)
        s->most_lights = drawing->run.n_lamps;
    s->frames++;
}

static void begin_video_statistics(struct steady *s, int width, int height)
{
    s->total = s->own = s->worst = s->largest = 0;
    s->unmade = s->unmade_frame = 0;
    s->worst_frame = s->cuts = s->frames = s->most_lights = 0;
    if (drawing_allocate(&s->tool, &s->drawing, width, height) != EXIT_OK)
        exit(EXIT_RUNTIME);
}

static bool print_step_statistics(const struct steady *s, const char *name)
{
    printf("| %s | %d | %d | %d | %.1f | %.1f | %d |", name, s->frames,
           s->most_lights, s->cuts, 100 * s->largest, 100 * s->worst,
           s->worst_frame);
    if (s->truth[0] >= 0)
        printf(" %.1f | %d |", 100 * s->unmade, s->unmade_frame);
    else
        printf(" | |");
    printf("\n");
    fflush(stdout);
    return s->worst <= MOST && (s->truth[0] < 0 || s->unmade <= MOST);
}

/* ------------------------------------------------------------------ scenes */

typedef int lamps_fn(struct night *night, int i, struct night_lamp *lamp);

/* Sets LAMP to the five lamps of a street, all visible, and returns 5. */
static int set_street_lamps(struct night_lamp *lamp)
{
    for (int i = 0; i < 5; i++)
        lamp[i] =
            (struct night_lamp){90 + 120 * i, 120 + 40 * (i % 3), 2 + i % 2, 6};
    return 5;
}

static int set_lamps_in_noise(struct night *night, int i,
                              struct night_lamp *lamp)
{
    (void)i;
    night->sigma = 4;
    return set_street_lamps(lamp);
}

static int set_single_sun(struct night *night, int i, struct night_lamp *lamp)
{
    (void)night;
    lamp[0] = (struct night_lamp){-30 + 3 * i, 90 + 0.5 * i, 14, 2000};
    return 1;
}

static int set_sun_entering_image(struct night *night, int i,
                                  struct night_lamp *lamp)
{
    const int n = set_street_lamps(lamp);

    (void)night;
    lamp[n] = (struct night_lamp){-30 + 3 * i, 250 - 0.5 * i, 14, 2000};
    return n + 1;
}

static int set_sun_leaving_image(struct night *night, int i,
                                 struct night_lamp *lamp)
{
    return set_sun_entering_image(night, FRAMES - i, lamp);
}

static int set_lamps_behind_poles(struct night *night, int i,
                                  struct night_lamp *lamp)
{
    const double at = (4 * i) % 200;

    night->pole_x0 = 60 + at;
    night->pole_x1 = 95 + at;
    for (int k = 0; k < 3; k++)
        lamp[k] = (struct night_lamp){120 + 90 * k, 150 + 30 * k, 4, 40};
    return 3;
}

static int set_lamp_behind_pole(struct night *night, int i,
                                struct night_lamp *lamp)
{
    set_lamps_behind_poles(night, i, lamp);
    lamp[0].x = 210;
    return 1;
}

static int set_lamps_seen_from_train(struct night *night, int i,
                                     struct night_lamp *lamp)
{
    const int n = set_street_lamps(lamp);

    (void)night;
    for (int k = 0; k < n; k++)
        lamp[k].x = fmod(lamp[k].x + 5 * i, WIDTH + 60) - 30;
    return n;
}

static int set_lamps_with_scene_cuts(struct night *night, int i,
                                     struct night_lamp *lamp)
{
    if (i / 40 % 2 == 0)
        return set_street_lamps(lamp);
    (void)night;
    lamp[0] = (struct night_lamp){400, 90, 20, 3000};
    lamp[1] = (struct night_lamp){100, 300, 3, 8};
    return 2;
}

static const struct {
    const char *name;
    lamps_fn *lamps;
} scenes[] = {
    {"noise", set_lamps_in_noise},
    {"a sun enters", set_single_sun},
    {"a sun enters among lamps", set_sun_entering_image},
    {"a sun leaves lamps", set_sun_leaving_image},
    {"lamps behind poles", set_lamps_behind_poles},
    {"a lamp alone behind poles", set_lamp_behind_pole},
    {"lamps from a train", set_lamps_seen_from_train},
    {"hard cuts", set_lamps_with_scene_cuts},
};

/* Returns the sum of the light of LAMP's visible pixels, white x pixels. Sets
 * AT to their centroid, pixels. */
static double measure_visible_light(const struct night *night,
                                    const struct night_lamp *lamp, double at[2])
{
    const int reach = (int)lamp->radius + 14;
    double sum = 0, sums[2] = {0, 0};

    for (int y = (int)lamp->y - reach; y <= (int)lamp->y + reach; y++)
        for (int x = (int)lamp->x - reach; x <= (int)lamp->x + reach; x++) {
            const double px[2] = {x + 0.5, y + 0.5};
            const double r = hypot(px[0] - lamp->x, px[1] - lamp->y);
            const double light =
                lamp->light * exp(-fmax(r - lamp->radius, 0) / 1.5);

            if (x < 0 || x >= WIDTH || y < 0 || y >= HEIGHT ||
                (px[0] > night->pole_x0 && px[0] < night->pole_x1))
                continue;
            sum += light;
            for (int k = 0; k < 2; k++)
                sums[k] += light * px[k];
        }
    for (int k = 0; k < 2; k++)
        at[k] = sum > 0 ? sums[k] / sum : 0;
    return sum;
}

/* Adds the flare light that the true lamps produce to s->truth. */
static void add_true_lamp_light(struct steady *s, const struct night *night,
                                const struct night_lamp *lamp, int n)
{
    const struct drawing *c = &s->drawing;
    struct glint_engine_lamp all[16];
    const struct glint_strength_lamps lamps = {all, NULL, n,
                                               (double)WIDTH * HEIGHT};
    struct glint_response_light light;

    for (int i = 0; i < n; i++) {
        double at[2];
        struct glint_lamp one = {.rgb = {1, 1, 1}};

        one.power = measure_visible_light(night, &lamp[i], at);
        glint_view_to_angles(&c->run.view, c->files.lens.setup.optics.focal_mm,
                             at[0], at[1], &one);
        all[i] = glint_engine_lamp_of(&one, 1);
    }
    glint_strength_compute_light(&c->run.engine->expose.response, &lamps,
                                 &light);
    memmove(s->truth + 1, s->truth, WINDOW * sizeof *s->truth);
    s->truth[0] = glint_largest_channel(light.mean);
}

static bool measure_generated_scene(struct steady *s, int k)
{
    struct night night;
    struct night_lamp lamp[16];

    night_init_parameters(&night, WIDTH, HEIGHT);
    night.sigma = 1;
    begin_video_statistics(s, WIDTH, HEIGHT);
    for (int i = 0; i < FRAMES; i++) {
        const int n = scenes[k].lamps(&night, i, lamp);

        night_draw_lamps(&night, lamp, n);
        add_true_lamp_light(s, &night, lamp, n);
        draw_and_record_frame(s, &night.image, FRAME_US);
    }
    night_close_tracker(&night);
    return print_step_statistics(s, scenes[k].name);
}

static bool measure_video_file(struct steady *s, const char *path)
{
    struct glint_error error = {""};
    struct glint_y4m_reader in;
    const struct glint_image *image;

    if (glint_y4m_reader_open(&in, path, &error) != GLINT_OK) {
        fprintf(stderr, "steady: %s\n", error.text);
        exit(EXIT_INPUT);
    }
    begin_video_statistics(s, in.header.width, in.header.height);
    s->truth[0] = -1;
    while (glint_y4m_reader_next(&in, &image, &error) == GLINT_OK && image)
        draw_and_record_frame(s, image, FRAME_US);
    glint_y4m_reader_close(&in);
    return print_step_statistics(s, path);
}

int main(int argc, char **argv)
{
    static const struct option options[] = {
        {"lens", required_argument, NULL, 'l'}, {NULL, 0, NULL, 0}};
    static struct steady s = {.tool = {.name = "steady", .quiet = true}};
    bool good = true;
    int c;

    drawing_line_set_defaults(&s.drawing.line);
    while ((c = getopt_long(argc, argv, "", options, NULL)) >= 0) {
        if (c != 'l')
            return EXIT_USAGE;
        s.drawing.line.settings.options.lens = optarg;
    }
    if (tool_start_threads(&s.tool) != EXIT_OK ||
        drawing_open(&s.tool, &s.drawing) != EXIT_OK)
        return EXIT_RUNTIME;
    puts("| scene | frames | lights | cuts | largest step, % | beside the "
         "lamps' own, % | at frame | that no lamp made, % | at frame |\n"
         "|---|---|---|---|---|---|---|---|---|");
    for (int k = 0; k < (int)(sizeof scenes / sizeof *scenes); k++)
        good = measure_generated_scene(&s, k) && good;
    for (int i = optind; i < argc; i++)
        good = measure_video_file(&s, argv[i]) && good;
    drawing_close(&s.drawing);
    tool_stop_threads(&s.tool);
    return good ? 0 : 1;
}
