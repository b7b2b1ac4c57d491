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

/* Sets each of N texels of DST to the mean of the texels of SRC that it
 * covers. STEP and SRC_STEP are the distances between texels, in doubles. */
static void resize_row(double *dst, int n, ptrdiff_t step, const double *src,
                       int src_n, ptrdiff_t src_step)
{
    const double ratio = (double)src_n / n;

    for (int i = 0; i < n; i++) {
        const double from = i * ratio, to = (i + 1) * ratio;
        double sum[3] = {0, 0, 0};

        for (int k = (int)from; k < src_n && k < to; k++) {
            const double share = (fmin(k + 1, to) - fmax(k, from)) / ratio;

            for (int c = 0; c < 3; c++)
                sum[c] += share * src[k * src_step + c];
        }
        for (int c = 0; c < 3; c++)
            dst[i * step + c] = sum[c];
    }
}

enum glint_status glint_texels_resize(uint8_t *dst, int width, int height,
                                      const uint8_t *src, int src_width,
                                      int src_height)
{
    const size_t n_src = 3 * (size_t)src_width * (size_t)src_height;
    const size_t n_half = 3 * (size_t)width * (size_t)src_height;
    const size_t n_dst = 3 * (size_t)width * (size_t)height;
    double *light = malloc(n_src * sizeof *light);
    double *half = malloc(n_half * sizeof *half);
    double *out = malloc(n_dst * sizeof *out);
    const bool good = light && half && out;
    double table[256];

    for (int code = 0; code < 256; code++)
        table[code] = decode_srgb((uint8_t)code);
    for (size_t i = 0; good && i < n_src; i++)
        light[i] = table[src[i]];
    for (ptrdiff_t y = 0; good && y < src_height; y++)
        resize_row(half + 3 * y * width, width, 3, light + 3 * y * src_width,
                   src_width, 3);
    for (ptrdiff_t x = 0; good && x < width; x++)
        resize_row(out + 3 * x, height, 3 * (ptrdiff_t)width, half + 3 * x,
                   src_height, 3 * (ptrdiff_t)width);
    for (size_t i = 0; good && i < n_dst; i++)
        dst[i] = encode_srgb(out[i]);
    free(light);
    free(half);
    free(out);
    return good ? GLINT_OK : GLINT_E_MEMORY;
}

/* Returns the power of two with the smallest ratio to SIDE, at most MOST. */
static int find_nearest_power(int side, int most)
{
    int power = 1;

    while (2 * power <= most && (double)side * side > 2.0 * power * power)
        power *= 2;
    return power;
}

enum glint_status glint_texels_fit(struct glint_image *image, int most)
{
    const int width = find_nearest_power(image->width, most);
    const int height = find_nearest_power(image->height, most);
    enum glint_status status;
    uint8_t *mem;

    if (width == image->width && height == image->height)
        return GLINT_OK;
    mem = malloc(3 * (size_t)width * (size_t)height);
    status = mem ? glint_texels_resize(mem, width, height, image->plane[0],
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
