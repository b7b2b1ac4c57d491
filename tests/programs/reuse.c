/* SPDX-License-Identifier: MIT
 *
 * reuse MODEL.glint LIGHTS [SCALE] - measures frames that reuse the rays of
 * stationary lights. Frames have 1920x1080 codes on black, LIGHTS lights of a
 * night street, the default quality and three wavelengths.
 *
 * SCALE is a factor on the powers of the lights. With SCALE, only calls
 * draw_and_time_frame(), for profilers: without reuse, with reuse of the same
 * lights, and with reuse after the lights moved by up to 0.4 pixels and changed
 * their powers by up to a fifth. The first frames without and with reuse do
 * more work than later ones.
 *
 * Without SCALE, prints
 *   - the scale at which all but 1e-4 of the samples are at most a quarter of
 *     white;
 *   - the bytes of a frame without and with memory for reuse;
 *   - for tolerances of 0.25, 0.5 and 1 pixel, the min PSNR of three frames
 *     whose lights have moved by up to that distance, against frames without
 *     reuse.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/models/street.h"

enum { W = 1920, H = 1080, BYTES = 3 * W * H, MOST = 128 };

static struct stage stage;
static struct glint_frame plain, reusing;
static struct glint_lamp lamps[MOST];
static uint8_t want[BYTES], got[BYTES];

static void draw_and_time_frame(struct glint_frame *f, int n, double scale,
                                uint8_t *codes)
{
    struct glint_image image = {.format = GLINT_RGB24,
                                .width = W,
                                .height = H,
                                .range = GLINT_RANGE_FULL};

    glint_image_place(&image, codes);
    if (glint_frame_draw(f, lamps, n, scale, &image, &stage.drawn) != GLINT_OK)
        exit(1);
}

/* The call through a volatile pointer prevents inlining, so that profiles show
 * the function's name. */
static void (*volatile frame)(struct glint_frame *, int, double,
                              uint8_t *) = draw_and_time_frame;

/* Draws a frame on black. PX: tolerance of reuse, pixels; negative: without
 * reuse. */
static void draw_with_reuse(int n, double scale, double px, uint8_t *codes)
{
    struct glint_frame *f = px < 0 ? &plain : &reusing;

    f->dials.still_px = fmax(px, 0);
    memset(codes, 0, BYTES);
    frame(f, n, scale, codes);
}

/* Moves N lamps by up to PX pixels and changes their powers at random. */
static void move_lamps(int n, double px, uint64_t *noise)
{
    const double focal = stage.of_model.optics.focal_mm;

    street_lamps(&stage, lamps, n);
    for (int i = 0; i < n; i++) {
        const double r = px * sqrt(stage_random_uniform(noise, 0, 1));
        const double turn = stage_random_uniform(noise, 0, 2 * GLINT_PI);
        double x, y;

        glint_view_to_pixel(&stage.view, focal, &lamps[i], &x, &y);
        glint_view_to_angles(&stage.view, focal, x + r * cos(turn),
                             y + r * sin(turn), &lamps[i]);
        lamps[i].power *= stage_random_uniform(noise, 0.8, 1.2);
    }
}

static double find_exposure_scale(int n)
{
    const int quarter = 137, most = BYTES / 10000;
    double low = -30, high = 30;

    for (int i = 0; i < 14; i++) {
        const double middle = (low + high) / 2;
        int above = 0;

        draw_with_reuse(n, exp2(middle), -1, got);
        for (int k = 0; k < BYTES; k++)
            above += got[k] > quarter;
        if (above > most)
            high = middle;
        else
            low = middle;
    }
    return exp2(low);
}

/* Returns the min PSNR, dB, of frames with reuse whose lights have moved by up
 * to PX pixels, against frames without reuse. */
static double measure_min_psnr(int n, double scale, double px)
{
    uint64_t noise = 1;
    struct glint_measure m;
    double least = 99;

    for (int i = 0; i < 3; i++) {
        street_lamps(&stage, lamps, n);
        draw_with_reuse(n, scale, px * 1.1, got);
        move_lamps(n, px, &noise);
        draw_with_reuse(n, scale, px * 1.1, got);
        if (!stage.drawn.stats.reused)
            exit(1);
        draw_with_reuse(n, scale, -1, want);
        glint_measure_codes(want, got, W, H, &m);
        least = fmin(least, m.psnr_db);
    }
    return least;
}

static void print_reuse_figures(int n)
{
    const double scale = find_exposure_scale(n);
    size_t bytes;

    draw_with_reuse(n, scale, -1, got);
    bytes = stage.drawn.need_bytes;
    draw_with_reuse(n, scale, 0.5, got);
    printf("%.17g %zu %zu", scale, bytes, stage.drawn.need_bytes);
    for (double px = 0.25; px <= 1; px *= 2)
        printf(" %.1f", measure_min_psnr(n, scale, px));
    puts("");
}

static void measure_reuse_case(int n, double scale)
{
    uint64_t noise = 1;

    for (int i = 0; i < 2; i++)
        draw_with_reuse(n, scale, -1, got);
    for (int i = 0; i < 3; i++)
        draw_with_reuse(n, scale, 0.5, got);
    move_lamps(n, 0.4, &noise);
    draw_with_reuse(n, scale, 0.5, got);
}

static bool open_model(const char *path)
{
    if (!stage_open_model_file(&stage, path, W, H))
        return false;
    stage.frame.dials = glint_dials_at(1 << 14);
    stage.frame.dials.dispersion_q8 = 0;
    stage.frame.asked = stage.frame.dials;
    glint_frame_init_like(&plain, &stage.frame, stage.view);
    glint_frame_init_like(&reusing, &stage.frame, stage.view);
    reusing.cfg.reuse = &glint_reuse;
    return true;
}

int main(int argc, char **argv)
{
    const int n = argc > 2 ? atoi(argv[2]) : 0;

    if (argc < 3 || argc > 4 || n < 1 || n > MOST || !open_model(argv[1]))
        return 2;
    street_lamps(&stage, lamps, n);
    if (argc == 4)
        measure_reuse_case(n, atof(argv[3]));
    else
        print_reuse_figures(n);
    glint_frame_finish(&plain);
    glint_frame_finish(&reusing);
    stage_free(&stage);
    return 0;
}
