/* SPDX-License-Identifier: MIT
 *
 * Images for tests, drawn pixel by pixel.
 */
#ifndef GLINT_TESTS_CANVAS_H
#define GLINT_TESTS_CANVAS_H

#include "glint/image.h"

/* number of pixel formats except linear light */
enum { CANVAS_FORMATS = 12 };
extern const enum glint_pixel_format canvas_format[CANVAS_FORMATS];

/* Returns a black image of FORMAT. The caller frees its memory, which starts
 * at plane[0]. */
struct glint_image canvas_allocate_image(enum glint_pixel_format format,
                                         int width, int height);

void canvas_set_rgb_pixel(const struct glint_image *image, int x, int y, int r,
                          int g, int b);

void canvas_set_grey_pixel(const struct glint_image *image, int x, int y,
                           int code);

int canvas_read_grey_pixel(const struct glint_image *image, int x, int y);

void canvas_fill_grey_box(const struct glint_image *image, int x0, int y0,
                          int x1, int y1, int code);

/* canvas_decode_value() returns the linear light (1 = white) of the encoded
 * value V = code / 255. canvas_encode_light() is its inverse. Both accept
 * negative values: f(-x) = -f(x). */
double canvas_decode_value(double v, enum glint_tone tone);
double canvas_encode_light(double light,
                           enum glint_tone tone); /* clamped to 1 */

/* canvas_encode_srgb() returns the sRGB code 0 .. 255 of linear light, which is
 * clamped to 0 .. 1, canvas_encode_srgb_exactly() the unrounded code. */
int canvas_encode_srgb(double light);
double canvas_encode_srgb_exactly(double light);

double canvas_decode_srgb(int code);

/* Returns the fraction of pixel (X, Y), 0 .. 1, that the disc covers, measured
 * by 16 x 16 samples. */
double canvas_disc_coverage(int x, int y, double cx, double cy, double radius);

/* Draws an antialiased disc of RADIUS pixels and linear light LIGHT (1 =
 * white), centred at (CX, CY), onto a grey image. */
void canvas_draw_disc(const struct glint_image *image, double cx, double cy,
                      double radius, double light);

#endif
