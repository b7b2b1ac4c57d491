/* SPDX-License-Identifier: MIT
 *
 * scene [-n FRAMES] [-m DX,DY] [-s SIGMA] YUYV|NV12|y4m WxH OUT [X,Y,R]...
 *
 * A night with lamps at X, Y (pixels) of radius R, that move by DX, DY each
 * frame, under noise of SIGMA codes: frames as a camera would send them, the
 * same on every run. y4m has the samples of YUYV.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_LAMPS = 16 };

struct scene {
    int width, height, n_frames, n_lamps;
    double dx, dy, sigma;
    double lamp[MAX_LAMPS][3];
};

static void die(const char *why)
{
    fprintf(stderr, "scene: %s\n", why);
    exit(2);
}

/* Nearly normal, of deviation 1. */
static double noise(void)
{
    static uint32_t seed = 7;
    double sum = -6;

    for (int i = 0; i < 12; i++) {
        seed = seed * 1664525 + 1013904223;
        sum += (seed >> 8) / 16777216.0;
    }
    return sum;
}

/* White inside, a glow outside, over a sky that is brighter below. */
static uint8_t luma_at(const struct scene *s, int frame, int x, int y)
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
        v += s->sigma * noise();
    return (uint8_t)fmax(16, fmin(235, floor(v + 0.5)));
}

static void put_frame(const struct scene *s, const char *format,
                      const uint8_t *luma, FILE *file)
{
    const size_t n = (size_t)s->width * (size_t)s->height;

    if (strcmp(format, "YUYV") == 0) {
        for (size_t i = 0; i < n; i++) {
            putc(luma[i], file);
            putc(128, file);
        }
        return;
    }
    if (strcmp(format, "y4m") == 0)
        fputs("FRAME\n", file);
    fwrite(luma, 1, n, file);
    for (size_t i = 0; i < (strcmp(format, "y4m") == 0 ? n : n / 2); i++)
        putc(128, file);
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
            die("see the head of scene.c");
    if (argc - optind < 3 ||
        sscanf(argv[optind + 1], "%dx%d", &s.width, &s.height) != 2)
        die("see the head of scene.c");
    format = argv[optind];
    name = argv[optind + 2];
    for (int i = optind + 3; i < argc && s.n_lamps < MAX_LAMPS; i++) {
        double *l = s.lamp[s.n_lamps++];

        if (sscanf(argv[i], "%lf,%lf,%lf", &l[0], &l[1], &l[2]) != 3)
            die("a lamp is X,Y,R");
    }
    luma = malloc((size_t)s.width * (size_t)s.height);
    file = fopen(name, "wb");
    if (!luma || !file)
        die("cannot write");
    if (strcmp(format, "y4m") == 0)
        fprintf(file, "YUV4MPEG2 W%d H%d F30:1 Ip A1:1 C422\n", s.width,
                s.height);
    for (int f = 0; f < s.n_frames; f++) {
        for (int y = 0; y < s.height; y++)
            for (int x = 0; x < s.width; x++)
                luma[y * s.width + x] = luma_at(&s, f, x, y);
        put_frame(&s, format, luma, file);
    }
    free(luma);
    return fclose(file) == 0 ? 0 : 1;
}
