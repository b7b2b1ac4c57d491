/* SPDX-License-Identifier: MIT
 *
 * Writes plots as SVG: panels with two axes, marks and lines. Writes HTML pages
 * with tables (html.c) and pictures (png.c).
 */
#ifndef GLINT_TOOLS_LAB_PLOTS_PLOT_H
#define GLINT_TOOLS_LAB_PLOTS_PLOT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "posix/error.h"

enum { PLOT_WIDTH = 380, PLOT_HEIGHT = 320 }; /* size of a panel, px */

struct plot_axis {
    const char *words;
    bool is_log;
    /* range of the axis; lo > hi: no points yet (plot_extend_axes()) */
    double lo, hi;
    double least_span; /* min of hi - lo; ignored by a logarithmic axis */
};

struct plot {
    FILE *file;
    const char *title;
    struct plot_axis x, y;
    int left, top; /* top left corner of the panel, pixels */
    int n_keys;
};

/* Begins an SVG file of N_PANELS panels in two columns, or of one panel. */
void plot_open(FILE *file, int n_panels);
void plot_close(FILE *file);

/* Prepares PLOT as panel NUMBER, counted from 0, with linear axes. */
void plot_init(struct plot *plot, FILE *file, int number, const char *title);

/* Extends the axes to include (X, Y), unless a value is not finite or, on a
 * logarithmic axis, not above 0. */
void plot_extend_axes(struct plot *plot, double x, double y);

/* Draws title, axes and grid. Call it after plot_extend_axes() for all points
 * and before marks are drawn. */
void plot_draw_frame(struct plot *plot);

/* Draws a mark at (X, Y). KIND: 'o' circle, '.' small circle, 's' square,
 * 'd' diamond; hollow if it is a capital letter. TIP is the tooltip, or
 * NULL. */
void plot_draw_mark(const struct plot *plot, double x, double y, char kind,
                    const char *colour, const char *tip);
void plot_draw_line(const struct plot *plot, double x0, double y0, double x1,
                    double y1, const char *colour, bool thick);
void plot_draw_label(const struct plot *plot, double x, double y,
                     const char *words);

/* Adds an entry to the legend below the title. */
void plot_draw_legend_entry(struct plot *plot, char kind, const char *colour,
                            const char *words);

const char *plot_get_colour_of_series(int i);

/* ------------------------------------------------------------------- pages */

/* Begins an HTML page with the heading TITLE. The CSS rules STYLE extend or
 * replace the rules of all pages. */
void html_write_head(FILE *file, const char *title, const char *style);

/* Writes a table row with cells <TAG> (th or td): the printf text of FORMAT,
 * up to 1023 bytes, split at each |. A cell that begins with ! gets the CSS
 * class "worse". */
void html_write_table_row(FILE *file, const char *tag, const char *format, ...)
    GLINT_PRINTF(3, 4);

/* Returns whether the image plug-in, which html_write_png() needs, is
 * available. */
bool html_can_write_png(void);

/* Writes RGB[HEIGHT][WIDTH][3] as a data: URI of a PNG (png.c); nothing if that
 * fails. */
void html_write_png(FILE *file, const uint8_t *rgb, int width, int height);

void html_write_end(FILE *file);

#endif
