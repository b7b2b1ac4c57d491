/* SPDX-License-Identifier: MIT
 *
 * Pictures to draw on by hand.
 */
#ifndef GLINT_TESTS_CANVAS_H
#define GLINT_TESTS_CANVAS_H

#include "glint/image.h"

/* Formats of codes. */
enum { CANVAS_FORMATS = 12 };
extern const enum glint_pixel_format canvas_format[CANVAS_FORMATS];

/* Returns a black picture of FORMAT in memory of its own, which begins at
 * plane[0] and is the caller's to free. */
struct glint_image canvas_new(enum glint_pixel_format format, int width,
                              int height);

void canvas_set_rgb(const struct glint_image *image, int x, int y, int r, int g,
                    int b);

void canvas_set_grey(const struct glint_image *image, int x, int y, int code);

int canvas_get_grey(const struct glint_image *image, int x, int y);

void canvas_fill_grey(const struct glint_image *image, int x0, int y0, int x1,
                      int y1, int code);

/* canvas_light() returns the light of V, a code divided by 255; canvas_code()
 * is its inverse. White is 1; negative values are mirrored. */
double canvas_light(double v, enum glint_tone tone);
double canvas_code(double light, enum glint_tone tone); /* returns 1 at most */

int canvas_srgb_code(double light); /* 0 .. 255 for light 0 .. 1 */

double canvas_linear(int code);

/* Returns the fraction of pixel (X, Y), 0 .. 1, that the disc covers, counted
 * at 16 x 16 points. */
double canvas_disc_cover(int x, int y, double cx, double cy, double radius);

/* Draws a disc of LIGHT (1 = white) with a smooth edge onto a grey picture. */
void canvas_disc(const struct glint_image *image, double cx, double cy,
                 double radius, double light);

#endif
