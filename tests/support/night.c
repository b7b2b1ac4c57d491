/* SPDX-License-Identifier: MIT */
#include "support/night.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/canvas.h"
#include "support/rng.h"

void night_close_tracker(struct night *night)
{
    free(night->image.plane[0]);
    for (int i = 0; i < 3; i++)
        free(night->mem[i]);
    memset(night, 0, sizeof *night);
}

void night_init_parameters(struct night *night, int width, int height)
{
    memset(night, 0, sizeof *night);
    night->seed = 1;
    night->image = (struct glint_image){
        .format = GLINT_GREY, .width = width, .height = height};
    glint_image_place(&night->image, malloc((size_t)width * (size_t)height));
    for (int i = 0; i < NIGHT_NOISE; i++) {
        double sum = -6;

        for (int k = 0; k < 12; k++)
            sum += rng_int_below(&night->seed, 1 << 20) * 0x1p-20;
        night->noise[i] = (int8_t)fmax(-127, fmin(127, floor(16 * sum + 0.5)));
    }
    glint_lamp_finder_defaults(&night->lights, width, height);
    night->lights.keep_faint = 1;
    night->lights.max_share_q15 = 1 << 15;
    glint_lamp_tracker_defaults(&night->cfg, width, height);
}

int night_open_tracker(struct night *n)
{
    const size_t bytes[2] = {glint_lamp_finder_bytes(&n->lights),
                             glint_lamp_tracker_bytes(&n->cfg)};

    return posix_memalign(&n->mem[0], 64, bytes[0]) == 0 &&
           posix_memalign(&n->mem[1], 64, bytes[1]) == 0 &&
           posix_memalign(&n->mem[2], 64, glint_profile_bytes()) == 0 &&
           glint_profile_init(&n->profile, n->mem[2], glint_profile_bytes()) ==
               GLINT_OK &&
           glint_lamp_finder_init(&n->finder, &n->lights, n->mem[0],
                                  bytes[0]) == GLINT_OK &&
           glint_lamp_tracker_init(&n->tracks, &n->cfg, n->mem[1], bytes[1]) ==
               GLINT_OK;
}

static double compute_lamp_light(const struct night *night,
                                 const struct night_lamp *lamp, int n, int x,
                                 int y)
{
    double light = 0.01;

    if (x + 0.5 > night->pole_x0 && x + 0.5 < night->pole_x1)
        return light;
    for (int i = 0; i < n; i++) {
        const double r = hypot(x + 0.5 - lamp[i].x, y + 0.5 - lamp[i].y);

        if (r < lamp[i].radius + 15)
            light += lamp[i].light * exp(-fmax(r - lamp[i].radius, 0) / 1.5);
    }
    return light;
}

static void write_noisy_pixel(struct night *night, int x, int y, double light)
{
    const double code =
        canvas_encode_srgb(light) +
        night->sigma * night->noise[(night->row_noise[y] + x) % NIGHT_NOISE] /
            16.0;

    night->image.plane[0][y * night->image.width + x] =
        (uint8_t)fmax(0, fmin(255, floor(code + 0.5)));
}

void night_draw_lamps(struct night *night, const struct night_lamp *lamp, int n)
{
    const struct glint_image *image = &night->image;

    for (int y = 0; y < image->height; y++) {
        uint8_t *row = image->plane[0] + y * image->width;

        night->row_noise[y] =
            rng_int_below(&night->seed, NIGHT_NOISE - image->width);
        for (int x = 0; x < image->width; x++)
            row[x] =
                (uint8_t)(25 + (night->noise[night->row_noise[y] + x] >> 4));
    }
    for (int i = 0; i < n; i++) {
        const int reach = (int)lamp[i].radius + 14;
        const int cx = (int)lamp[i].x, cy = (int)lamp[i].y;

        for (int y = cy - reach < 0 ? 0 : cy - reach;
             y < image->height && y <= cy + reach; y++)
            for (int x = cx - reach < 0 ? 0 : cx - reach;
                 x < image->width && x <= cx + reach; x++)
                write_noisy_pixel(night, x, y,
                                  compute_lamp_light(night, lamp, n, x, y));
    }
}

void night_track_lamps(struct night *n, int32_t elapsed_us)
{
    glint_lamp_finder_keep_white(
        n->finder, glint_lamp_tracker_white_q15(n->tracks, elapsed_us));
    n->n_spots =
        glint_lamp_finder_find(n->finder, &n->image, n->spot, NIGHT_MAX);
    glint_profile_measure(n->profile, &n->image, n->spot, n->n_spots);
    n->n_tracks = glint_lamp_tracker_step(n->tracks, n->spot, n->n_spots,
                                          elapsed_us, n->track, NIGHT_MAX);
}

void night_draw_and_track(struct night *n, const struct night_lamp *lamp,
                          int n_lamps, int32_t elapsed_us)
{
    night_draw_lamps(n, lamp, n_lamps);
    night_track_lamps(n, elapsed_us);
}

double night_track_power(const struct glint_lamp_track *t)
{
    return t->level_q15 / 32768.0 * (double)t->power_q16 / 65536;
}

double night_sum_track_energies(const struct night *n)
{
    double sum = 0;

    for (int i = 0; i < n->n_tracks; i++)
        sum += night_track_power(&n->track[i]);
    return sum;
}

double night_spot_power(const struct glint_spot *s)
{
    return (double)s->power_q16 / 65536;
}

int night_find_track(const struct night *n, double x, double y)
{
    double best = HUGE_VAL;
    int at = -1;

    for (int i = 0; i < n->n_tracks; i++) {
        const double d =
            hypot(n->track[i].x_q8 / 256.0 - x, n->track[i].y_q8 / 256.0 - y);

        if (d < best) {
            best = d;
            at = i;
        }
    }
    return at;
}

int night_find_spot(const struct night *n, double x, double y)
{
    double best = HUGE_VAL;
    int at = -1;

    for (int i = 0; i < n->n_spots; i++) {
        const double d =
            hypot(n->spot[i].x_q8 / 256.0 - x, n->spot[i].y_q8 / 256.0 - y);

        if (d < best) {
            best = d;
            at = i;
        }
    }
    return at;
}
