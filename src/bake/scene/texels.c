/* SPDX-License-Identifier: MIT */
#include "bake/scene/texels.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static double decode_srgb(uint8_t code)
{
    const double x = code / 255.0;

    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

static uint8_t encode_srgb(double light)
{
    const double x = light <= 0.0031308 ? 12.92 * light
                                        : 1.055 * pow(light, 1 / 2.4) - 0.055;

    return (uint8_t)lrint(255 * fmin(fmax(x, 0.0), 1.0));
}

/* Returns the weight of source texel K in the mean over the source range FROM
 * .. TO, which is RATIO texels long. */
static double compute_texel_weight(int k, double from, double to, double ratio)
{
    return (fmin(k + 1, to) - fmax(k, from)) / ratio;
}

/* Sets each of N texels of DST to the mean of the SRC_N texels of SRC that it
 * covers. */
static void resize_texel_row(double *dst, int n, const double *src, int src_n)
{
    const double ratio = (double)src_n / n;

    for (int i = 0; i < n; i++) {
        const double from = i * ratio, to = (i + 1) * ratio;
        double sum[3] = {0, 0, 0};

        for (int k = (int)from; k < src_n && k < to; k++) {
            const double share = compute_texel_weight(k, from, to, ratio);

            for (int c = 0; c < 3; c++)
                sum[c] += share * src[3 * k + c];
        }
        for (int c = 0; c < 3; c++)
            dst[3 * i + c] = sum[c];
    }
}

/* Buffers of resize_picture(). They have three doubles per texel of a single
 * row: buffers for a picture would need 24 bytes per texel. */
struct rows {
    double table[256]; /* linear light of each 8-bit code */
    double *light;     /* a row of the source, linear light */
    /* the source row of index held_row, resized to the width of the result */
    double *across;
    /* the weighted sum of source rows for one row of the result */
    double *sum;
    int held_row; /* index of the source row that across has; -1: none */
};

/* Sets rows->across to row Y of the source, resized from SRC_WIDTH to WIDTH. */
static void load_source_row(struct rows *rows, int y, int width,
                            const uint8_t *src, int src_width)
{
    const size_t n = 3 * (size_t)src_width;

    if (rows->held_row == y)
        return;
    for (size_t i = 0; i < n; i++)
        rows->light[i] = rows->table[src[(size_t)y * n + i]];
    resize_texel_row(rows->across, width, rows->light, src_width);
    rows->held_row = y;
}

/* Resizes as glint_texels_resize_picture() does, using the buffers ROWS. */
static void resize_picture(struct rows *rows, uint8_t *dst, int width,
                           int height, const uint8_t *src, int src_width,
                           int src_height)
{
    const double ratio = (double)src_height / height;
    const size_t n = 3 * (size_t)width;

    for (int y = 0; y < height; y++) {
        const double from = y * ratio, to = (y + 1) * ratio;

        for (size_t i = 0; i < n; i++)
            rows->sum[i] = 0;
        for (int k = (int)from; k < src_height && k < to; k++) {
            const double share = compute_texel_weight(k, from, to, ratio);

            load_source_row(rows, k, width, src, src_width);
            for (size_t i = 0; i < n; i++)
                rows->sum[i] += share * rows->across[i];
        }
        for (size_t i = 0; i < n; i++)
            dst[(size_t)y * n + i] = encode_srgb(rows->sum[i]);
    }
}

enum glint_status glint_texels_resize_picture(uint8_t *dst, int width,
                                              int height, const uint8_t *src,
                                              int src_width, int src_height)
{
    struct rows rows = {.held_row = -1};
    bool good;

    rows.light = malloc(3 * (size_t)src_width * sizeof *rows.light);
    rows.across = malloc(3 * (size_t)width * sizeof *rows.across);
    rows.sum = malloc(3 * (size_t)width * sizeof *rows.sum);
    good = rows.light && rows.across && rows.sum;
    for (int code = 0; code < 256; code++)
        rows.table[code] = decode_srgb((uint8_t)code);
    if (good)
        resize_picture(&rows, dst, width, height, src, src_width, src_height);
    free(rows.light);
    free(rows.across);
    free(rows.sum);
    return good ? GLINT_OK : GLINT_E_MEMORY;
}

/* Returns the power of two, at most MOST, whose ratio to SIDE is nearest to
 * 1. */
static int find_nearest_power_of_two(int side, int most)
{
    int power = 1;

    while (2 * power <= most && (double)side * side > 2.0 * power * power)
        power *= 2;
    return power;
}

enum glint_status
glint_texels_resize_to_powers_of_two(struct glint_image *image, int most)
{
    const int width = find_nearest_power_of_two(image->width, most);
    const int height = find_nearest_power_of_two(image->height, most);
    enum glint_status status;
    uint8_t *mem;

    if (width == image->width && height == image->height)
        return GLINT_OK;
    mem = malloc(3 * (size_t)width * (size_t)height);
    status =
        mem ? glint_texels_resize_picture(mem, width, height, image->plane[0],
                                          image->width, image->height)
            : GLINT_E_MEMORY;
    if (status != GLINT_OK) {
        free(mem);
        return status;
    }
    free(image->plane[0]);
    image->width = width;
    image->height = height;
    glint_image_place(image, mem);
    return GLINT_OK;
}
