/* SPDX-License-Identifier: MIT
 *
 * Plots as SVG, or as pixels: panels with two axes, marks and lines. Pages of
 * HTML, with tables (html.c).
 */
#ifndef GLINT_TOOLS_LAB_PLOTS_PLOT_H
#define GLINT_TOOLS_LAB_PLOTS_PLOT_H

#include <stdbool.h>
#include <stdio.h>

#include "formats/paint.h"
#include "posix/error.h"

enum { PLOT_WIDTH = 380, PLOT_HEIGHT = 320 }; /* size of a panel, px */

struct plot_axis {
    const char *words;
    bool is_log;
    double lo, hi;     /* lo > hi: no points yet, see plot_stretch */
    double least_span; /* least hi - lo; a logarithmic axis ignores it */
};

/* A plot as pixels: RGB24, each unit of a panel PLOT_SCALE pixels a side. */
enum { PLOT_SCALE = 2 };
struct plot_pixels {
    struct glint_image image; /* its plane is owned */
};

struct plot {
    FILE *file;                 /* NULL: pixels */
    struct plot_pixels *pixels; /* NULL: file */
    const char *title;
    struct plot_axis x, y;
    int left, top; /* top left corner of the panel, pixels */
    int n_keys;
};

/* Begins a file of N_PANELS panels in two columns, or of one panel. */
void plot_open(FILE *file, int n_panels);
void plot_close(FILE *file);

/* Does the same for pixels. Returns false if memory is short; nothing is owned
 * then. */
bool plot_pixels_open(struct plot_pixels *pixels, int n_panels);
void plot_pixels_close(struct plot_pixels *pixels);

/* Write the pixels as PNG; return false if memory is short. */
bool plot_png(FILE *file, const struct plot_pixels *pixels);

/* Draw the parts of a plot: a line WIDTH thick, a mark that fills 2 R a side,
 * and words that begin, have their middle or end at X. COLOUR is #RGB or
 * #RRGGBB. */
void plot_pixels_line(const struct plot_pixels *pixels, double x0, double y0,
                      double x1, double y1, const char *colour, double width);
void plot_pixels_mark(const struct plot_pixels *pixels, double x, double y,
                      double r, const char *colour);
void plot_pixels_words(const struct plot_pixels *pixels, double x, double y,
                       const char *anchor, const char *words);

/* Prepares PLOT as panel NUMBER, from 0, with linear axes. */
void plot_init(struct plot *plot, FILE *file, int number, const char *title);

/* Stretches the axes to X, Y, unless one of them is not finite, or not above 0
 * on a logarithmic axis. */
void plot_stretch(struct plot *plot, double x, double y);

/* Draws title, axes and grid, after stretching and before marks. */
void plot_frame(struct plot *plot);

/* Draws a mark of KIND 'o' circle, '.' small circle, 's' square or 'd' diamond;
 * capitals are hollow. Browsers show TIP, unless it is NULL. */
void plot_mark(const struct plot *plot, double x, double y, char kind,
               const char *colour, const char *tip);
void plot_line(const struct plot *plot, double x0, double y0, double x1,
               double y1, const char *colour, bool thick);
void plot_words(const struct plot *plot, double x, double y, const char *words);

/* Adds an entry to the legend below the title. */
void plot_key(struct plot *plot, char kind, const char *colour,
              const char *words);

const char *plot_colour(int i);

/* ------------------------------------------------------------------- pages */

/* Begins a page with the heading TITLE. STYLE extends or replaces the rules
 * that all pages share. */
void html_begin(FILE *file, const char *title, const char *style);

/* Writes TEXT, whose < > & and " are escaped. */
void html_text(FILE *file, const char *text);

/* Writes a row of cells of TAG, th or td, that | divides in the text of FORMAT,
 * up to 1023 bytes. A cell that begins with ! is of the class worse. */
void html_row(FILE *file, const char *tag, const char *format, ...)
    GLINT_PRINTF(3, 4);

/* Writes RGB[HEIGHT][WIDTH][3] as a data: URI of a PNG (png.c). */
void html_png(FILE *file, const uint8_t *rgb, int width, int height);

void html_end(FILE *file);

#endif
