/* SPDX-License-Identifier: MIT
 *
 * Draws boxes, lines and small letters onto 8-bit pictures of any format.
 *
 *     struct paint p = {.image = image, .line = 2};
 *     paint_set_colour(&p, 255, 255, 0);
 *     paint_text(&p, x, y, "tile 7");
 *
 * Drawing is clipped to the picture.
 */
#ifndef GLINT_FORMATS_PAINT_H
#define GLINT_FORMATS_PAINT_H

#include <stdint.h>

#include "glint/image.h"

struct paint {
    const struct glint_image *image;
    int line;       /* thickness of lines and of strokes of letters, pixels */
    uint8_t rgb[3]; /* R, G, B, set by paint_set_colour */
    uint8_t ycc[3]; /* the colour rgb converted to Y, Cb, Cr */
};

void paint_set_colour(struct paint *p, uint8_t r, uint8_t g, uint8_t b);

/* Fills the pixels X0 .. X1 - 1 of the rows Y0 .. Y1 - 1. */
void paint_fill_rectangle(const struct paint *p, int x0, int y0, int x1,
                          int y1);

/* Draws the outline of a square with its middle at (X, Y). Its width is 2 HALF
 * pixels plus the thickness of a line. */
void paint_square_outline(const struct paint *p, int x, int y, int half);

/* paint_text() draws TEXT with its top left corner at (X, Y); letters are five
 * line widths high. Small letters are drawn as capitals. Characters other than
 * letters, digits and % . , - + : / are left blank. paint_text_width() returns
 * the width of TEXT in pixels. */
void paint_text(const struct paint *p, int x, int y, const char *text);
int paint_text_width(const struct paint *p, const char *text);

/* Sets IMAGE to black. */
void paint_set_image_black(const struct glint_image *image);

#endif
