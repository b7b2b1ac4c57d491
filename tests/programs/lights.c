/* SPDX-License-Identifier: MIT
 *
 * lights N MODEL.glint... - prints what frames with many lights cost and how
 * good they are, by quality and by glint_dials.dim_codes, which tells what
 * ghosts take the rays of one wave. Frames are 1920x1080 codes on black, with N
 * lights (1, 4, 16, 64 or 128; 0: each of these) that were found in night
 * photographs. A row has the processor milliseconds of a frame on one thread,
 * the least of three, PSNR against the finest quality, which leaves out only
 * what is below 0.01 codes, and the number of bundles.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "options/tool.h"
#include "support/stage.h"

enum { W = 1920, H = 1080, BYTES = 3 * W * H, MOST = 128, FRAMES = 3 };

/* Places as shares of the picture, powers and colours: what glint finds in
 * bridge_night, lights_water, esplanade_lamps and night_town of the corpus. */
static const struct light {
    double x, y, power, rgb[3];
} found[] = {
    {0.338, 0.173, 34165, {2.18, 0.75, 0.00}},
    {0.418, 0.112, 4377, {1.63, 0.87, 0.45}},
    {0.123, 0.489, 1840, {1.76, 0.81, 0.59}},
    {0.441, 0.507, 1408, {1.72, 0.88, 0.04}},
    {0.375, 0.502, 1911, {1.70, 0.89, 0.03}},
    {0.075, 0.285, 1250, {2.29, 0.70, 0.18}},
    {0.995, 0.592, 536, {1.61, 0.90, 0.25}},
    {0.934, 0.574, 1711, {1.65, 0.88, 0.29}},
    {0.352, 0.485, 756, {1.95, 0.81, 0.06}},
    {0.777, 0.476, 612, {2.00, 0.79, 0.17}},
    {0.863, 0.538, 452, {1.85, 0.83, 0.20}},
    {0.668, 0.385, 518, {2.07, 0.78, 0.03}},
    {0.259, 0.236, 1473, {2.43, 0.68, 0.00}},
    {0.548, 0.270, 475, {2.24, 0.72, 0.08}},
    {0.489, 0.212, 868, {2.39, 0.68, 0.06}},
    {0.603, 0.325, 382, {2.08, 0.78, 0.04}},
    {0.189, 0.255, 549, {2.35, 0.70, 0.00}},
    {0.823, 0.511, 447, {2.05, 0.78, 0.07}},
    {0.754, 0.552, 398, {1.90, 0.81, 0.27}},
    {0.639, 0.538, 304, {1.87, 0.82, 0.21}},
    {0.492, 0.503, 335, {1.94, 0.80, 0.16}},
    {0.279, 0.413, 19419, {1.29, 0.91, 1.03}},
    {0.557, 0.466, 2467, {1.41, 0.87, 1.06}},
    {0.745, 0.386, 960, {1.50, 0.92, 0.34}},
    {0.452, 0.389, 1691, {2.04, 0.79, 0.00}},
    {0.743, 0.468, 1724, {2.00, 0.76, 0.42}},
    {0.685, 0.386, 1204, {1.41, 0.97, 0.10}},
    {0.557, 0.388, 1090, {1.41, 0.97, 0.07}},
    {0.685, 0.463, 1802, {1.86, 0.79, 0.60}},
    {0.499, 0.389, 1167, {1.89, 0.83, 0.00}},
    {0.616, 0.388, 951, {1.54, 0.94, 0.04}},
    {0.616, 0.456, 1440, {1.76, 0.82, 0.59}},
    {0.367, 0.445, 1985, {1.96, 0.78, 0.34}},
    {0.451, 0.449, 1724, {1.87, 0.80, 0.40}},
    {0.499, 0.450, 1144, {1.87, 0.80, 0.39}},
    {0.046, 0.404, 1165, {2.35, 0.70, 0.00}},
    {0.883, 0.347, 631, {2.07, 0.76, 0.27}},
    {0.912, 0.335, 500, {1.41, 0.98, 0.03}},
    {0.083, 0.404, 535, {2.62, 0.62, 0.00}},
    {0.366, 0.389, 1531, {1.99, 0.81, 0.00}},
    {0.143, 0.403, 482, {2.40, 0.68, 0.00}},
    {0.931, 0.336, 339, {1.44, 0.90, 0.70}},
    {0.339, 0.441, 499, {2.16, 0.76, 0.02}},
    {0.177, 0.404, 403, {2.25, 0.73, 0.00}},
    {0.975, 0.322, 236, {2.07, 0.77, 0.13}},
    {0.110, 0.413, 223, {2.31, 0.71, 0.00}},
    {0.309, 0.158, 14991, {0.52, 0.92, 3.18}},
    {0.454, 0.404, 6568, {1.26, 0.92, 1.01}},
    {0.281, 0.339, 1540, {0.26, 0.94, 3.78}},
    {0.944, 0.184, 1832, {1.41, 0.93, 0.47}},
    {0.216, 0.292, 1397, {0.16, 0.77, 5.76}},
    {0.272, 0.266, 642, {0.91, 0.96, 1.66}},
    {0.973, 0.334, 5042, {0.93, 0.93, 1.88}},
    {0.037, 0.335, 2958, {0.30, 0.99, 3.17}},
    {0.641, 0.411, 297, {1.38, 0.94, 0.45}},
    {0.640, 0.523, 238, {1.02, 0.91, 1.88}},
    {0.703, 0.799, 335, {1.29, 1.00, 0.19}},
    {0.077, 0.516, 15701, {1.11, 1.00, 0.73}},
    {0.856, 0.452, 32750, {1.47, 0.91, 0.53}},
    {0.154, 0.580, 1913, {1.74, 0.88, 0.02}},
    {0.737, 0.449, 1738, {1.35, 0.93, 0.63}},
    {0.158, 0.514, 794, {1.19, 0.98, 0.62}},
    {0.935, 0.437, 100, {1.45, 0.91, 0.53}},
};

enum { FOUND = sizeof found / sizeof *found };

static const struct setting {
    int quality_q15;
    double dim;
} settings[] = {{1 << 14, 0}, {1 << 13, 0}, {1 << 13, 1}, {1 << 12, 0},
                {1 << 12, 4}, {1 << 11, 0}, {1 << 11, 8}};

enum { SETTINGS = sizeof settings / sizeof *settings };

static struct stage stage;
static struct glint_lamp lamps[MOST];
static uint8_t want[BYTES], got[BYTES];

/* Sets lamps[] to what was found, then to the same mirrored across, and then
 * down. */
static void set_lamps(void)
{
    for (int i = 0; i < MOST; i++) {
        const struct light *l = &found[i % FOUND];
        const int turn = i / FOUND;

        lamps[i] = (struct glint_lamp){.power = l->power};
        memcpy(lamps[i].rgb, l->rgb, sizeof l->rgb);
        glint_view_to_angles(&stage.view, stage.of_model.optics.focal_mm,
                             W * (turn & 1 ? 1 - l->x : l->x),
                             H * (turn & 2 ? 1 - l->y : l->y), &lamps[i]);
    }
}

static double seconds(void)
{
    struct timespec t;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Draws the first N lamps, times SCALE, on black. Returns processor seconds. */
static double draw(int n, double scale, uint8_t *codes)
{
    struct glint_image image = {.format = GLINT_RGB24,
                                .width = W,
                                .height = H,
                                .range = GLINT_RANGE_FULL};
    double from;

    memset(codes, 0, BYTES);
    glint_image_place(&image, codes);
    from = seconds();
    if (glint_frame_draw(&stage.frame, lamps, n, scale, &image, &stage.drawn) !=
        GLINT_OK)
        exit(1);
    return seconds() - from;
}

/* Returns the scale at which all but a ten-thousandth of the samples are at
 * most a quarter of white, about as --strength 0.5 has it. */
static double scale_for(int n)
{
    const int quarter = 137, most = BYTES / 10000;
    double low = -30, high = 30;

    for (int i = 0; i < 14; i++) {
        const double middle = (low + high) / 2;
        int above = 0;

        draw(n, exp2(middle), got);
        for (int k = 0; k < BYTES; k++)
            above += got[k] > quarter;
        if (above > most)
            high = middle;
        else
            low = middle;
    }
    return exp2(low);
}

static double psnr(void)
{
    double sum = 0;

    for (int i = 0; i < BYTES; i++) {
        const double d = (double)want[i] - got[i];

        sum += d * d;
    }
    return sum > 0 ? 10 * log10(255. * 255 * BYTES / sum) : 99;
}

static void run(const char *lens, int n)
{
    struct glint_frame *f = &stage.frame;
    double scale;

    f->dials = glint_dials_at(1 << 12);
    scale = scale_for(n);
    f->dials = glint_dials_at(1 << 15);
    f->dials.cull_codes = 0.01;
    f->dials.dispersion_q8 = 0;
    f->dials.max_lights = MOST;
    f->most_minsn = 0;
    draw(n, scale, want);
    for (int i = 0; i < SETTINGS; i++) {
        double least = 1e9;

        f->dials = glint_dials_at(settings[i].quality_q15);
        f->dials.dispersion_q8 = 0;
        f->dials.dim_codes = settings[i].dim;
        for (int k = 0; k < FRAMES; k++)
            least = fmin(least, draw(n, scale, got));
        printf("| %s | %d | %.3g | %.3g | %.1f | %.1f | %d |\n", lens, n,
               settings[i].quality_q15 / 32768., settings[i].dim, 1e3 * least,
               psnr(), stage.drawn.stats.bundles);
        fflush(stdout);
    }
}

/* Sets up the stage for the model at PATH. Returns false if it is refused. */
static bool open_model(const char *path)
{
    static const double nm[3] = {650, 532, 450};
    static const struct tool tool = {.name = "lights", .n_threads = 1};
    struct glint_error error;

    if (tool_model(&tool, path, &stage.file) != EXIT_OK ||
        glint_setup_from_model(&stage.of_model, &stage.file.lens, 8, 0, nm, 3,
                               &error) != GLINT_OK)
        return false;
    stage.lens.film_width_mm =
        glint_real_value(stage.file.lens.header->film_width_mm);
    stage.lens.film_height_mm =
        glint_real_value(stage.file.lens.header->film_height_mm);
    stage_view(&stage, W, H, 0);
    return true;
}

int main(int argc, char **argv)
{
    static const int lights[] = {1, 4, 16, 64, 128};
    const int n = argc > 1 ? atoi(argv[1]) : 0;

    puts("| lens | lights | quality | dim, codes | ms | dB | bundles |\n"
         "|---|---|---|---|---|---|---|");
    fflush(stdout);
    for (int i = 2; i < argc; i++) {
        if (!open_model(argv[i]))
            return 1;
        set_lamps();
        for (size_t k = 0; k < sizeof lights / sizeof *lights; k++)
            if (n == 0 || n == lights[k])
                run(stage.file.lens.header->name, lights[k]);
        stage_close(&stage);
    }
    return 0;
}
