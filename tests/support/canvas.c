/* SPDX-License-Identifier: MIT */
#include "support/canvas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const enum glint_pixel_format canvas_format[CANVAS_FORMATS] = {
    GLINT_RGB24, GLINT_GREY,  GLINT_I420,     GLINT_I422,
    GLINT_I444,  GLINT_NV12,  GLINT_NV21,     GLINT_YUYV,
    GLINT_UYVY,  GLINT_BGR24, GLINT_XRGB8888, GLINT_RGB565};

struct glint_image canvas_allocate_image(enum glint_pixel_format format,
                                         int width, int height)
{
    void *mem = calloc(1, glint_image_bytes(format, width, height));

    /* A failed allocation aborts the program: programs without cmocka use this
     * function, too, so cmocka cannot report it. */
    if (!mem)
        abort();
    return glint_image_over(mem, format, width, height);
}

void canvas_set_rgb_pixel(const struct glint_image *image, int x, int y, int r,
                          int g, int b)
{
    uint8_t *px = image->plane[0] + y * image->stride_bytes[0] + 3 * x;

    px[0] = (uint8_t)r;
    px[1] = (uint8_t)g;
    px[2] = (uint8_t)b;
}

void canvas_set_grey_pixel(const struct glint_image *image, int x, int y,
                           int code)
{
    image->plane[0][y * image->stride_bytes[0] + x] = (uint8_t)code;
}

int canvas_read_grey_pixel(const struct glint_image *image, int x, int y)
{
    return image->plane[0][y * image->stride_bytes[0] + x];
}

void canvas_fill_grey_box(const struct glint_image *image, int x0, int y0,
                          int x1, int y1, int code)
{
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            canvas_set_grey_pixel(image, x, y, code);
}

double canvas_decode_value(double v, enum glint_tone tone)
{
    if (v < 0)
        return -canvas_decode_value(-v, tone);
    if (tone == GLINT_TONE_SRGB)
        return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    return v < 0.081 ? v / 4.5 : pow((v + 0.099) / 1.099, 1 / 0.45);
}

double canvas_encode_light(double light, enum glint_tone tone)
{
    if (light < 0)
        return -canvas_encode_light(-light, tone);
    if (light > 1)
        return 1;
    if (tone == GLINT_TONE_SRGB)
        return light <= 0.0031308 ? 12.92 * light
                                  : 1.055 * pow(light, 1 / 2.4) - 0.055;
    return light < 0.018 ? 4.5 * light : 1.099 * pow(light, 0.45) - 0.099;
}

int canvas_encode_srgb(double light)
{
    return (int)(canvas_encode_srgb_exactly(light) + 0.5);
}

double canvas_encode_srgb_exactly(double light)
{
    return 255 * canvas_encode_light(fmax(light, 0), GLINT_TONE_SRGB);
}

double canvas_decode_srgb(int code)
{
    return canvas_decode_value(code / 255.0, GLINT_TONE_SRGB);
}

double canvas_disc_coverage(int x, int y, double cx, double cy, double radius)
{
    int inside = 0;

    for (int i = 0; i < 256; i++)
        inside += hypot(x + (i % 16 + 0.5) / 16 - cx,
                        y + (i / 16 + 0.5) / 16 - cy) < radius;
    return inside / 256.0;
}

void canvas_draw_disc(const struct glint_image *image, double cx, double cy,
                      double radius, double light)
{
    for (int y = (int)(cy - radius - 1); y <= cy + radius + 1; y++)
        for (int x = (int)(cx - radius - 1); x <= cx + radius + 1; x++) {
            const double cover = canvas_disc_coverage(x, y, cx, cy, radius);

            if (cover > 0)
                canvas_set_grey_pixel(image, x, y,
                                      canvas_encode_srgb(cover * light));
        }
}
