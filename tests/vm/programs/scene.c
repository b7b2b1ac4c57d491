/* SPDX-License-Identifier: MIT
 *
 * scene [-n FRAMES] [-m DX,DY] [-s SIGMA] YUYV|NV12|y4m WxH OUT [X,Y,R]...
 *
 * Writes frames of a night scene in the format of a camera: lamps at X, Y
 * (pixels) of radius R, which move by (DX, DY) pixels per frame, with noise of
 * SIGMA codes, above a strip of colour bars. The frames are the same in every
 * run. y4m has the samples of YUYV.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../../support/rng.h"

enum { MAX_LAMPS = 16 };

struct scene {
    int width, height, n_frames, n_lamps;
    double dx, dy, sigma;
    double lamp[MAX_LAMPS][3];
};

static void exit_with_error(const char *why)
{
    fprintf(stderr, "scene: %s\n", why);
    exit(2);
}

/* Returns nearly Gaussian noise of standard deviation 1. */
static double random_noise(void)
{
    static uint32_t seed = 7;
    double sum = -6;

    for (int i = 0; i < 12; i++)
        sum += rng_unit(&seed);
    return sum;
}

/* Returns the luma of pixel (X, Y), 16 .. 235: white lamps with a glow, on a
 * sky that is brighter at the bottom. */
static uint8_t compute_luma(const struct scene *s, int frame, int x, int y)
{
    double v = 24 + 24.0 * y / s->height;

    for (int i = 0; i < s->n_lamps; i++) {
        const double r = s->lamp[i][2];
        const double d = hypot(x + 0.5 - s->lamp[i][0] - frame * s->dx,
                               y + 0.5 - s->lamp[i][1] - frame * s->dy);

        v +=
            230 * fmax(0, fmin(1, r + 0.5 - d)) + 60 * exp(-fmax(0, d - r) / r);
    }
    if (s->sigma > 0)
        v += s->sigma * random_noise();
    return (uint8_t)fmax(16, fmin(235, floor(v + 0.5)));
}

/* Returns Y, Cb, Cr of the colour bar at column X: BT.709, 75 %, from white to
 * black. */
static const uint8_t *find_bar_colour(const struct scene *s, int x)
{
    static const uint8_t bar[8][3] = {
        {180, 128, 128}, {168, 44, 136}, {145, 147, 44}, {133, 63, 52},
        {63, 193, 204},  {51, 109, 212}, {28, 212, 120}, {16, 128, 128}};

    return bar[8 * x / s->width];
}

/* Returns whether row Y is in the lowest sixth of the image, which contains the
 * colour bars. */
static int is_row_of_bars(const struct scene *s, int y)
{
    return y >= s->height - s->height / 6;
}

static uint8_t compute_chroma(const struct scene *s, int x, int y, int which)
{
    return is_row_of_bars(s, y) ? find_bar_colour(s, x)[which] : 128;
}

static void write_yuyv_frame(const struct scene *s, const uint8_t *luma,
                             FILE *file)
{
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            putc(luma[y * s->width + x], file);
            putc(compute_chroma(s, x & ~1, y, 1 + (x & 1)), file);
        }
}

/* Writes the luma plane, then chroma: for NV12 one interleaved plane at half
 * resolution in both directions, otherwise two planes of half the width. */
static void write_planar_frame(const struct scene *s, const uint8_t *luma,
                               int nv12, FILE *file)
{
    fwrite(luma, 1, (size_t)s->width * (size_t)s->height, file);
    if (nv12)
        for (int y = 0; y < s->height; y += 2)
            for (int x = 0; x < s->width; x++)
                putc(compute_chroma(s, x & ~1, y, 1 + (x & 1)), file);
    else
        for (int which = 1; which <= 2; which++)
            for (int y = 0; y < s->height; y++)
                for (int x = 0; x < s->width; x += 2)
                    putc(compute_chroma(s, x, y, which), file);
}

static void write_frame(const struct scene *s, const char *format,
                        const uint8_t *luma, FILE *file)
{
    if (strcmp(format, "YUYV") == 0) {
        write_yuyv_frame(s, luma, file);
        return;
    }
    if (strcmp(format, "y4m") == 0)
        fputs("FRAME\n", file);
    write_planar_frame(s, luma, strcmp(format, "NV12") == 0, file);
}

int main(int argc, char **argv)
{
    struct scene s = {.n_frames = 1};
    const char *format, *name;
    uint8_t *luma;
    FILE *file;
    int c;

    while ((c = getopt(argc, argv, "n:m:s:")) != -1)
        if (c == 'n')
            s.n_frames = atoi(optarg);
        else if (c == 's')
            s.sigma = atof(optarg);
        else if (c != 'm' || sscanf(optarg, "%lf,%lf", &s.dx, &s.dy) != 2)
            exit_with_error("see the head of scene.c");
    if (argc - optind < 3 ||
        sscanf(argv[optind + 1], "%dx%d", &s.width, &s.height) != 2)
        exit_with_error("see the head of scene.c");
    format = argv[optind];
    name = argv[optind + 2];
    for (int i = optind + 3; i < argc && s.n_lamps < MAX_LAMPS; i++) {
        double *l = s.lamp[s.n_lamps++];

        if (sscanf(argv[i], "%lf,%lf,%lf", &l[0], &l[1], &l[2]) != 3)
            exit_with_error("a lamp is X,Y,R");
    }
    luma = malloc((size_t)s.width * (size_t)s.height);
    file = fopen(name, "wb");
    if (!luma || !file)
        exit_with_error("cannot write the output");
    if (strcmp(format, "y4m") == 0)
        fprintf(file, "YUV4MPEG2 W%d H%d F30:1 Ip A1:1 C422\n", s.width,
                s.height);
    for (int f = 0; f < s.n_frames; f++) {
        for (int y = 0; y < s.height; y++)
            for (int x = 0; x < s.width; x++)
                luma[y * s.width + x] = is_row_of_bars(&s, y)
                                            ? find_bar_colour(&s, x)[0]
                                            : compute_luma(&s, f, x, y);
        write_frame(&s, format, luma, file);
    }
    free(luma);
    return fclose(file) == 0 ? 0 : 1;
}
