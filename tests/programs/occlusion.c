/* SPDX-License-Identifier: MIT
 *
 * occlusion [--log] - prints how well the measured power of a lamp follows its
 * visible fraction while a pole passes in front of it.
 *
 * A lamp is a disc 6 stops above white; its image has the glare of a lens: a
 * narrow core and a tail that falls with the cube of the distance. The pole
 * hides the disc, but not the glare. The power is divided by its mean before
 * the pole. It is compared with the visible fraction of the disc in the same
 * frame and in earlier frames. The number of frames back to the best match is
 * the lag. --log prints every frame.
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/detector.h"
#include "glint/view.h"

enum {
    WIDTH = 320,
    HEIGHT = 180,
    FRAMES = 100,
    POINTS = 150,
    FRAME_US = 40000,
    REACH = 64,
    SQUARES = 2 * (REACH + 1) * (REACH + 1)
};

struct scene {
    const char *name;
    /* radius of the lamp and width of the pole, px; speed of the pole, px per
     * frame */
    double radius, pole, speed;
};

/* Visible fraction of the lamp and its measured power, per frame of one
 * scene. */
struct passing {
    double share[FRAMES], power[FRAMES];
    int lamps[FRAMES];
};

static struct glint_lamp_detector detector;
static uint8_t rgb[3 * WIDTH * HEIGHT];

/* Returns the glare of a point light at distance R, per unit of its light. The
 * integral over the plane is about 1. */
static double compute_glare(double r)
{
    return 0.14 * exp(-r * r / 2) + 0.02 / pow(1 + r, 3);
}

static uint8_t encode_pixel(double x)
{
    x = x > 1 ? 1 : x;
    x = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
    return (uint8_t)lrint(255 * x);
}

/* Draws the disc behind a pole between columns X0 and X1. Returns the
 * visible fraction of the disc. */
static double draw_occluded_lamp(const struct scene *s, double x0, double x1)
{
    const double cx = WIDTH / 2.0 + 0.3, cy = HEIGHT / 2.0 - 0.2;
    const double each = 64 * 3.14159265 * s->radius * s->radius / POINTS;
    static double point[POINTS][2], table[4 * SQUARES];
    int n = 0;

    for (int i = 0; i < 4 * SQUARES && table[0] == 0; i++)
        table[4 * SQUARES - 1 - i] =
            compute_glare(sqrt((4 * SQUARES - 0.5 - i) / 4));
    /* Samples the disc at points of a sunflower spiral. */
    for (int i = 0; i < POINTS; i++) {
        const double r = s->radius * sqrt((i + 0.5) / POINTS);
        const double x = cx + r * cos(2.399963 * i);

        if (x > x0 && x < x1)
            continue;
        point[n][0] = x;
        point[n++][1] = cy + r * sin(2.399963 * i);
    }
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const bool is_pole = x + 0.5 > x0 && x + 0.5 < x1;
            double light = is_pole ? 0.002 : 0.004;

            for (int i = 0; i < n && abs(x - WIDTH / 2) < REACH - 20 &&
                            abs(y - HEIGHT / 2) < REACH - 20;
                 i++) {
                const double dx = x + 0.5 - point[i][0];
                const double dy = y + 0.5 - point[i][1];

                light += each * table[(int)(4 * (dx * dx + dy * dy))];
            }
            memset(rgb + 3 * (y * WIDTH + x), encode_pixel(light), 3);
        }
    return (double)n / POINTS;
}

static double sum_lamp_powers(const struct glint_lamp *lamp, int n)
{
    double sum = 0;

    for (int i = 0; i < n; i++)
        sum += lamp[i].power;
    return sum;
}

static bool measure_occluded_lamp_power(const struct scene *s,
                                        struct passing *p)
{
    static struct glint_lamp lamp[GLINT_LAMP_DETECTOR_MAX];
    const struct glint_view view = glint_view_fit(WIDTH, HEIGHT, 36, 24);
    struct glint_image image = {
        .format = GLINT_RGB24, .width = WIDTH, .height = HEIGHT};
    struct glint_lamp_finder_config cfg;

    glint_image_place(&image, rgb);
    glint_lamp_finder_defaults(&cfg, WIDTH, HEIGHT);
    detector = (struct glint_lamp_detector){.max = 16, .headroom_ev = -1};
    if (glint_lamp_detector_open(&detector, &cfg) != GLINT_OK)
        return false;
    for (int i = 0; i < FRAMES; i++) {
        const double x =
            WIDTH / 2.0 - s->radius - s->pole - 4 + s->speed * (i - 30);

        p->share[i] = draw_occluded_lamp(s, x, x + s->pole);
        p->lamps[i] = glint_lamp_detector_find_lamps(&detector, &image,
                                                     FRAME_US, &view, 50, lamp);
        p->power[i] = sum_lamp_powers(lamp, p->lamps[i]);
    }
    glint_lamp_detector_close(&detector);
    return true;
}

/* Returns the RMS difference between the power in a frame and the visible
 * fraction LAG frames earlier. */
static double compute_rms_difference_at_lag(const struct passing *p,
                                            double full, int lag)
{
    double sum = 0;

    for (int i = 30; i < FRAMES; i++)
        sum += pow(p->power[i] / full - p->share[i - lag], 2);
    return sqrt(sum / (FRAMES - 30));
}

static void print_scene_errors(const struct scene *s, const struct passing *p,
                               bool log)
{
    double full = 0, least_share = 1, least = 1e30, step = 0, share_step = 0;
    int lag = 0;

    for (int i = 20; i < 30; i++)
        full += p->power[i] / 10;
    for (int i = 1; i < 10; i++)
        lag = compute_rms_difference_at_lag(p, full, i) <
                      compute_rms_difference_at_lag(p, full, lag)
                  ? i
                  : lag;
    for (int i = 30; i < FRAMES; i++) {
        least_share = fmin(least_share, p->share[i]);
        least = fmin(least, p->power[i] / full);
        step = fmax(step, fabs(p->power[i] - p->power[i - 1]) / full);
        share_step = fmax(share_step, fabs(p->share[i] - p->share[i - 1]));
        if (log)
            printf("%s,%d,%.4f,%.4f,%d\n", s->name, i, p->share[i],
                   p->power[i] / full, p->lamps[i]);
    }
    if (!log)
        printf("| %s | %.0f, %.0f | %.2f | %.2f | %.3f | %d: %.3f | %.2f | "
               "%.2f |\n",
               s->name, s->radius, s->pole, least_share, least,
               compute_rms_difference_at_lag(p, full, 0), lag,
               compute_rms_difference_at_lag(p, full, lag), share_step, step);
}

int main(int argc, char **argv)
{
    static const struct scene scenes[] = {
        {"a thin pole", 8, 6, 1},     {"half of the lamp", 8, 8, 1},
        {"as wide", 8, 16, 1},        {"wider", 8, 24, 1},
        {"wider and fast", 8, 24, 3}, {"a large lamp", 16, 16, 1},
        {"a small lamp", 3, 8, 0.5},
    };
    const bool log = argc > 1 && strcmp(argv[1], "--log") == 0;
    static struct passing p;

    puts(log ? "scene,frame,share,power,lamps"
             : "| scene | lamp's radius, pole, px | least share | least power "
               "| RMS | lag: RMS | largest step of the share | of power |\n"
               "|---|---|---|---|---|---|---|---|");
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        if (!measure_occluded_lamp_power(&scenes[i], &p))
            return 1;
        print_scene_errors(&scenes[i], &p, log);
    }
    return 0;
}
