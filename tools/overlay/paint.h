/* SPDX-License-Identifier: MIT
 *
 * Boxes, lines and small letters, over pictures of 8 bits in any format.
 *
 *     struct paint p = {.image = image, .line = 2};
 *     paint_colour(&p, 255, 255, 0);
 *     paint_text(&p, x, y, "tile 7");
 *
 * What lies beside the picture is left out.
 */
#ifndef GLINT_TOOLS_OVERLAY_PAINT_H
#define GLINT_TOOLS_OVERLAY_PAINT_H

#include <stdint.h>

#include "glint/image.h"

struct paint {
    const struct glint_image *image;
    int line;       /* pixels: how thick lines and the strokes of letters are */
    uint8_t rgb[3]; /* set by paint_colour, for the formats of pictures: */
    uint8_t ycc[3]; /* Y, Cb, Cr */
};

void paint_colour(struct paint *p, uint8_t r, uint8_t g, uint8_t b);

/* The pixels X0 .. X1 - 1 of the rows Y0 .. Y1 - 1. */
void paint_fill(const struct paint *p, int x0, int y0, int x1, int y1);

/* A square of lines, 2 HALF + 1 pixels and a line wide. */
void paint_box(const struct paint *p, int x, int y, int half);

/* TEXT, its top left corner at (X, Y), five lines high. Letters are all
 * capitals; of signs there are % . , - + : and /, the rest is blank. */
void paint_text(const struct paint *p, int x, int y, const char *text);
int paint_text_width(const struct paint *p, const char *text);

#endif
