/* SPDX-License-Identifier: MIT */
#include "support/power_picture.h"
#include "support/canvas.h"
#include "support/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FINE = 5, SOURCES = 40, KERNEL = 1 << 18 };

static double make_gaussian_noise(uint32_t *seed)
{
    double sum = -6;

    for (int i = 0; i < 12; i++)
        sum += rng_unit(seed);
    return sum;
}

static int is_point_in_shape(const struct power_lamp *l, double x, double y)
{
    const double c = cos(l->angle), s = sin(l->angle);
    const double u = fabs(c * (x - l->x) + s * (y - l->y));
    const double v = fabs(c * (y - l->y) - s * (x - l->x));

    switch (l->shape) {
    case POWER_DISC:
        return u * u + v * v <= l->radius * l->radius;
    case POWER_SQUARE:
        return fmax(u, v) <= l->radius;
    default:
        return u <= l->radius && v <= fmax(0.3, l->radius / 8);
    }
}

/* Sets LIGHT to the fraction of each pixel that the shape covers, divided by
 * the sum of these fractions. */
static void draw_shape(double *light, int width, int height,
                       const struct power_lamp *l)
{
    double sum = 0;
    const int reach = (int)(l->radius * 1.5) + 2;

    memset(light, 0, sizeof *light * (size_t)(width * height));
    for (int y = (int)l->y - reach; y <= (int)l->y + reach; y++)
        for (int x = (int)l->x - reach; x <= (int)l->x + reach; x++) {
            const int fine = l->radius < 2 ? 8 * FINE : FINE;
            int n = 0;

            if (x < 0 || y < 0 || x >= width || y >= height)
                continue;
            for (int i = 0; i < fine * fine; i++)
                n += is_point_in_shape(l, x + (i % fine + 0.5) / fine,
                                       y + (i / fine + 0.5) / fine);
            light[y * width + x] = (double)n / (fine * fine);
            sum += light[y * width + x];
        }
    for (int i = 0; i < width * height; i++)
        light[i] = (light[i] / sum);
}

static void blur_line(double *at, int n, int step, const double *kernel,
                      int reach, double *tmp)
{
    for (int i = 0; i < n; i++) {
        double sum = 0;

        for (int k = -reach; k <= reach; k++)
            if (i + k >= 0 && i + k < n)
                sum += at[(i + k) * step] * kernel[abs(k)];
        tmp[i] = sum;
    }
    for (int i = 0; i < n; i++)
        at[i * step] = tmp[i];
}

static void blur_image(double *light, int width, int height, double sigma)
{
    double kernel[64], sum = 0;
    const int reach = (int)ceil(4.5 * sigma + 1);
    double *tmp = malloc(sizeof *tmp * (size_t)(width + height));

    for (int k = 0; k <= reach; k++) {
        kernel[k] =
            erf((k + 0.5) / sigma / sqrt(2)) - erf((k - 0.5) / sigma / sqrt(2));
        sum += k ? 2 * kernel[k] : kernel[k];
    }
    for (int k = 0; k <= reach; k++)
        kernel[k] /= sum;
    for (int y = 0; y < height; y++)
        blur_line(light + y * width, width, 1, kernel, reach, tmp);
    for (int x = 0; x < width; x++)
        blur_line(light + x, height, width, kernel, reach, tmp);
    free(tmp);
}

/* Adds the glare of the lit pixels of SHAPE to LIGHT. If more than SOURCES
 * pixels are lit, only every k-th pixel is a source, with k times its light. */
static void add_glare(double *light, const double *shape, int width, int height,
                      const struct power_lamp *l)
{
    static double kernel[KERNEL];
    const int n = width * height;
    double total = 0, seen = 0, all = 0;
    int n_lit = 0, skip, at = 0;

    for (int r2 = 0; r2 < width * width + height * height && r2 < KERNEL; r2++)
        kernel[r2] = pow(1 + r2 / (l->reach * l->reach), -l->fall / 2);
    /* TOTAL: the glare of one pixel, integrated to a radius of 2000 pixels */
    for (double r = 0.25; r < 2000; r += 0.5)
        total +=
            3.14159265 * r * pow(1 + r * r / l->reach / l->reach, -l->fall / 2);
    for (int i = 0; i < n; i++) {
        n_lit += shape[i] > 0;
        all += shape[i];
    }
    skip = n_lit / SOURCES + 1;
    for (int i = 0; i < n; i++)
        if (shape[i] > 0 && at++ % skip == 0)
            seen += shape[i];
    at = 0;
    for (int i = 0; i < n; i++) {
        const double part = shape[i] / seen * all * l->glare / total;

        if (!(shape[i] > 0) || at++ % skip)
            continue;
        for (int y = 0; y < height; y++) {
            const int dy = y - i / width, x0 = i % width;

            for (int x = 0; x < width; x++)
                light[y * width + x] +=
                    part * kernel[(x - x0) * (x - x0) + dy * dy];
        }
    }
}

void power_apply_lens(double *light, int width, int height,
                      const struct power_lamp *lens, double over)
{
    const int n = width * height;
    double *shape = malloc(sizeof *shape * (size_t)n);

    for (int i = 0; i < n; i++)
        shape[i] = light[i] > over ? light[i] : 0;
    blur_image(light, width, height, lens->sigma);
    add_glare(light, shape, width, height, lens);
    free(shape);
}

void power_draw_lamp(double *light, int width, int height,
                     const struct power_lamp *lamp)
{
    const size_t bytes = sizeof *light * (size_t)(width * height);
    double *shape = malloc(bytes);

    draw_shape(light, width, height, lamp);
    memcpy(shape, light, bytes);
    blur_image(light, width, height, lamp->sigma);
    for (int i = 0; i < width * height; i++)
        light[i] *= 1 - lamp->glare;
    if (lamp->glare > 0)
        add_glare(light, shape, width, height, lamp);
    free(shape);
}

enum { CODES = 1 << 16, NOISE = 1 << 16 };

static double code[CODES + 1], noise[NOISE];

static void make_srgb_tables(void)
{
    uint32_t seed = 1;

    for (int i = 0; i <= CODES; i++)
        code[i] = canvas_encode_srgb_exactly((double)i / CODES);
    for (int i = 0; i < NOISE; i++)
        noise[i] = make_gaussian_noise(&seed);
}

void power_expose_codes(uint8_t *rgb, const struct power_picture *scene,
                        double gain, double sigma, uint32_t *seed)
{
    if (code[CODES] < 1)
        make_srgb_tables();
    for (int i = 0; i < 3 * scene->width * scene->height; i++) {
        const double light = gain * scene->rgb[i];
        const double v = code[light < 1 ? (int)(light * CODES) : CODES];

        rng_bits32(seed);
        rgb[i] = (uint8_t)fmax(
            0, fmin(255, floor(v + sigma * noise[*seed >> 16] + 0.5)));
    }
}
