/* SPDX-License-Identifier: MIT
 *
 * Plots as pixels, for pictures: what plot.c writes as SVG, drawn.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure/plots/plot.h"

bool plot_pixels_open(struct plot_pixels *p, int n_panels)
{
    const int columns = n_panels > 1 ? 2 : 1;
    const int rows = (n_panels + columns - 1) / columns;
    const int width = columns * PLOT_WIDTH * PLOT_SCALE;
    const int height = rows * PLOT_HEIGHT * PLOT_SCALE;
    uint8_t *plane = malloc(3 * (size_t)width * (size_t)height);

    *p = (struct plot_pixels){.image = {.format = GLINT_RGB24,
                                        .width = width,
                                        .height = height,
                                        .plane = {plane},
                                        .stride_bytes = {3 * width}}};
    if (plane)
        memset(plane, 255, 3 * (size_t)width * (size_t)height);
    return plane != NULL;
}

void plot_pixels_close(struct plot_pixels *p)
{
    free(p->image.plane[0]);
    p->image.plane[0] = NULL;
}

/* Returns a paint of COLOUR with lines LINE pixels wide. */
static struct paint paint_of(const struct plot_pixels *p, const char *colour,
                             int line)
{
    struct paint paint = {.image = &p->image, .line = line};
    unsigned long rgb = strtoul(colour + 1, NULL, 16);

    if (strlen(colour) == 4)
        rgb = (rgb >> 8 & 15) * 0x110000 + (rgb >> 4 & 15) * 0x1100 +
              (rgb & 15) * 0x11;
    paint_colour(&paint, (uint8_t)(rgb >> 16), (uint8_t)(rgb >> 8),
                 (uint8_t)rgb);
    return paint;
}

static void fill_about(const struct paint *paint, double x, double y,
                       double half)
{
    paint_fill(paint, (int)lround(x - half), (int)lround(y - half),
               (int)lround(x + half), (int)lround(y + half));
}

void plot_pixels_line(const struct plot_pixels *p, double x0, double y0,
                      double x1, double y1, const char *colour, double width)
{
    const struct paint paint = paint_of(p, colour, 1);
    const double dx = PLOT_SCALE * (x1 - x0), dy = PLOT_SCALE * (y1 - y0);
    const int n = 1 + (int)fmax(fabs(dx), fabs(dy));

    for (int i = 0; i <= n; i++)
        fill_about(&paint, PLOT_SCALE * x0 + dx * i / n,
                   PLOT_SCALE * y0 + dy * i / n, width * PLOT_SCALE / 2.0);
}

void plot_pixels_mark(const struct plot_pixels *p, double x, double y, double r,
                      const char *colour)
{
    const struct paint paint = paint_of(p, colour, 1);

    fill_about(&paint, PLOT_SCALE * x, PLOT_SCALE * y, PLOT_SCALE * r);
}

void plot_pixels_words(const struct plot_pixels *p, double x, double y,
                       const char *anchor, const char *words)
{
    const struct paint paint = paint_of(p, "#000", PLOT_SCALE / 2 + 1);
    const int width = paint_text_width(&paint, words);
    const int back = strcmp(anchor, "middle") == 0 ? width / 2
                     : strcmp(anchor, "end") == 0  ? width
                                                   : 0;

    /* Y is where letters stand. */
    paint_text(&paint, (int)lround(PLOT_SCALE * x) - back,
               (int)lround(PLOT_SCALE * y) - 5 * paint.line, words);
}
