/* SPDX-License-Identifier: MIT
 *
 * steady [--lens LENS] [--most SHARE] [--log] [--scene NAME] [VIDEO.y4m...] -
 * how steady the flare of a video is: drawn scenes, all or that one (none: a
 * name that no scene has), and videos.
 *
 * From frame to frame the total light of the flare, as it is drawn, changes
 * for what the lamps do (they move, rise, fade, are hidden: the total light at
 * an exposure that stays) and for what the exposure does. A step that lies
 * between none and the lamps' own is theirs; what goes beyond is ours. Frames
 * after a cut begin anew and are not counted. Exit code 1: a step of ours is
 * larger than SHARE (default 0.1). --log prints every frame to stderr.
 */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "overlay/compositor.h"
#include "video/y4m.h"
#include "posix/error.h"
#include "support/night.h"

enum { WIDTH = 640, HEIGHT = 360, FRAMES = 150, FRAME_US = 40000 };

struct steady {
    struct tool tool;
    struct compositor compositor;
    double total, own; /* of the frame before */
    bool log;
    double worst, largest; /* step of ours; of any */
    int worst_frame, cuts, frames, most_lights;
};

/* ------------------------------------------------------------------- steps */

static double light_of(struct steady *s, const struct glint_lamp *lamps)
{
    struct glint_response_light light;

    if (glint_response_draw(&s->compositor.frame, lamps, s->compositor.n_lamps,
                            GLINT_RESPONSE_COARSE, &light) != GLINT_OK)
        exit(EXIT_RUNTIME);
    return glint_strength_largest(light.mean);
}

/* By how much STEP exceeds what lies between none and OWN, both logarithms. */
static double beyond(double step, double own)
{
    const double low = fmin(own, 0), high = fmax(own, 0);

    return step > high ? step - high : step < low ? low - step : 0;
}

static void note(struct steady *s, double total, double own)
{
    const bool is_cut = glint_lamp_tracker_was_cut(s->compositor.finder.tracks);
    /* A flare below this is unseen, so it does not step when it appears. */
    const double least = 1e-6;

    s->cuts += is_cut && s->frames > 0;
    if (!is_cut && s->total > least && total > least) {
        const double step = log(total / s->total);
        const double ours = exp(beyond(step, log(own / s->own))) - 1;

        s->largest = fmax(s->largest, exp(fabs(step)) - 1);
        if (ours > s->worst) {
            s->worst = ours;
            s->worst_frame = s->frames;
        }
    }
    s->total = total;
    s->own = own;
}

/* The light of a frame, and its lamps: what made a step. */
static void log_frame(const struct steady *s, double own, double drawn)
{
    const struct compositor *c = &s->compositor;

    fprintf(stderr, "%d own %.4g drawn %.4g total %.4g%s\n", s->frames, own,
            drawn, drawn * compositor_scale(c),
            glint_lamp_tracker_was_cut(c->finder.tracks) ? " cut" : "");
    for (int i = 0; i < c->n_lamps; i++) {
        const struct glint_lamp_track *t = &c->finder.track[i];

        fprintf(stderr,
                "    %u state %d at %.1f,%.1f size %.1f level %.2f "
                "flux %.4g power %.4g\n",
                (unsigned)t->id, (int)t->state, t->x_q8 / 256.0,
                t->y_q8 / 256.0, t->size_q8 / 256.0, t->level_q15 / 32768.0,
                (double)t->flux_q16 / 65536, (double)t->power_q16 / 65536);
    }
}

static void frame(struct steady *s, const struct glint_image *image,
                  int32_t elapsed_us)
{
    struct compositor *compositor = &s->compositor;
    double own, drawn, power = 0, held = 0;

    compositor_find(compositor, image, elapsed_us);
    own = drawn = light_of(s, compositor->lamp);
    for (int i = 0; i < compositor->n_lamps; i++)
        power += compositor->lamp[i].power;
    compositor_expose(compositor, elapsed_us);
    for (int i = 0; i < compositor->n_lamps; i++)
        held += compositor->lamp[i].power;
    if (held < power) /* some are too bright yet */
        drawn = light_of(s, compositor->lamp);
    if (s->log)
        log_frame(s, own, drawn);
    note(s, drawn * compositor_scale(compositor), own);
    if (compositor->n_lamps > s->most_lights)
        s->most_lights = compositor->n_lamps;
    s->frames++;
}

static void begin(struct steady *s, int width, int height)
{
    s->total = s->own = s->worst = s->largest = 0;
    s->worst_frame = s->cuts = s->frames = s->most_lights = 0;
    if (compositor_size(&s->tool, &s->compositor, width, height) != EXIT_OK)
        exit(EXIT_RUNTIME);
}

static bool end(const struct steady *s, const char *name, double most)
{
    printf("| %s | %d | %d | %d | %.1f | %.1f | %d |\n", name, s->frames,
           s->most_lights, s->cuts, 100 * s->largest, 100 * s->worst,
           s->worst_frame);
    fflush(stdout);
    return s->worst <= most;
}

/* ------------------------------------------------------------------- scenes
 */

typedef int settings_fn(struct night *night, int i, struct night_lamp *lamp);

/* Lamps of a street, all seen. */
static int street(struct night_lamp *lamp)
{
    for (int i = 0; i < 5; i++)
        lamp[i] =
            (struct night_lamp){90 + 120 * i, 120 + 40 * (i % 3), 2 + i % 2, 6};
    return 5;
}

static int noise(struct night *night, int i, struct night_lamp *lamp)
{
    (void)i;
    night->sigma = 4;
    return street(lamp);
}

static int sun_alone(struct night *night, int i, struct night_lamp *lamp)
{
    (void)night;
    lamp[0] = (struct night_lamp){-30 + 3 * i, 90 + 0.5 * i, 14, 2000};
    return 1;
}

static int sun_enters(struct night *night, int i, struct night_lamp *lamp)
{
    const int n = street(lamp);

    (void)night;
    lamp[n] = (struct night_lamp){-30 + 3 * i, 250 - 0.5 * i, 14, 2000};
    return n + 1;
}

static int sun_leaves(struct night *night, int i, struct night_lamp *lamp)
{
    return sun_enters(night, FRAMES - i, lamp);
}

static int poles(struct night *night, int i, struct night_lamp *lamp)
{
    const double at = (4 * i) % 200;

    night->pole_x0 = 60 + at;
    night->pole_x1 = 95 + at;
    for (int k = 0; k < 3; k++)
        lamp[k] = (struct night_lamp){120 + 90 * k, 150 + 30 * k, 4, 40};
    return 3;
}

static int train(struct night *night, int i, struct night_lamp *lamp)
{
    const int n = street(lamp);

    (void)night;
    for (int k = 0; k < n; k++)
        lamp[k].x = fmod(lamp[k].x + 5 * i, WIDTH + 60) - 30;
    return n;
}

static int cuts(struct night *night, int i, struct night_lamp *lamp)
{
    if (i / 40 % 2 == 0)
        return street(lamp);
    (void)night;
    lamp[0] = (struct night_lamp){400, 90, 20, 3000};
    lamp[1] = (struct night_lamp){100, 300, 3, 8};
    return 2;
}

static const struct {
    const char *name;
    settings_fn *settings;
} scenes[] = {
    {"noise", noise},
    {"a sun enters", sun_alone},
    {"a sun enters among lamps", sun_enters},
    {"a sun leaves lamps", sun_leaves},
    {"lamps behind poles", poles},
    {"lamps from a train", train},
    {"hard cuts", cuts},
};

static bool run_settings(struct steady *s, int k, double most)
{
    struct night night;
    struct night_lamp lamp[16];

    night_init(&night, WIDTH, HEIGHT);
    night.sigma = 1;
    begin(s, WIDTH, HEIGHT);
    for (int i = 0; i < FRAMES; i++) {
        const int n = scenes[k].settings(&night, i, lamp);

        night_draw(&night, lamp, n);
        frame(s, &night.image, FRAME_US);
    }
    night_close(&night);
    return end(s, scenes[k].name, most);
}

static bool run_video(struct steady *s, const char *path, double most)
{
    struct glint_error error = {""};
    struct glint_y4m_reader in;
    const struct glint_image *image;

    if (glint_y4m_reader_open(&in, path, &error) != GLINT_OK) {
        fprintf(stderr, "steady: %s\n", error.text);
        exit(EXIT_INPUT);
    }
    begin(s, in.header.width, in.header.height);
    while (glint_y4m_reader_next(&in, &image, &error) == GLINT_OK && image)
        frame(s, image, FRAME_US);
    glint_y4m_reader_close(&in);
    return end(s, path, most);
}

int main(int argc, char **argv)
{
    static const struct option options[] = {
        {"lens", required_argument, NULL, 'l'},
        {"most", required_argument, NULL, 'm'},
        {"log", no_argument, NULL, 'v'},
        {"scene", required_argument, NULL, 's'},
        {NULL, 0, NULL, 0}};
    static struct steady s = {.tool = {.name = "steady", .quiet = true}};
    bool good = true;
    const char *only = NULL;
    double most = 0.1;
    int c;

    compositor_defaults(&s.compositor);
    while ((c = getopt_long(argc, argv, "", options, NULL)) >= 0) {
        if (c == 'l')
            s.compositor.lens = optarg;
        else if (c == 'v')
            s.log = true;
        else if (c == 's')
            only = optarg;
        else if (c != 'm' || !tool_number(optarg, &most))
            return EXIT_USAGE;
    }
    if (tool_start(&s.tool) != EXIT_OK ||
        compositor_open(&s.tool, &s.compositor) != EXIT_OK)
        return EXIT_RUNTIME;
    puts("| scene | frames | lights | cuts | largest step, % | beside the "
         "lamps' own, % | at frame |\n|---|---|---|---|---|---|---|");
    for (int k = 0; k < (int)(sizeof scenes / sizeof *scenes); k++)
        if (!only || strcmp(only, scenes[k].name) == 0)
            good = run_settings(&s, k, most) && good;
    for (int i = optind; i < argc; i++)
        good = run_video(&s, argv[i], most) && good;
    compositor_close(&s.compositor);
    tool_finish(&s.tool);
    return good ? 0 : 1;
}
