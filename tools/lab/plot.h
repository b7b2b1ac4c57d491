/* SPDX-License-Identifier: MIT
 *
 * Plots as SVG: panels with two axes, marks and lines.
 */
#ifndef GLINT_TOOLS_LAB_PLOT_H
#define GLINT_TOOLS_LAB_PLOT_H

#include <stdbool.h>
#include <stdio.h>

enum { PLOT_WIDTH = 380, PLOT_HEIGHT = 320 }; /* size of a panel, px */

struct plot_axis {
    const char *words;
    bool is_log;
    double lo, hi;     /* lo > hi: nothing yet, see plot_stretch */
    double least_span; /* hi - lo at least; a logarithmic axis ignores it */
};

struct plot {
    FILE *file;
    const char *title;
    struct plot_axis x, y;
    int left, top; /* corner of the panel, pixels */
    int n_keys;
};

/* N panels in two columns, or one. */
void plot_open(FILE *file, int n_panels);
void plot_close(FILE *file);

/* Prepares panel NUMBER. */
void plot_init(struct plot *plot, FILE *file, int number, const char *title);

/* Makes room for a point; what is not finite, or by a logarithm not above 0,
 * takes none. */
void plot_stretch(struct plot *plot, double x, double y);

/* Title, axes, grid. After stretching, before marks. */
void plot_frame(struct plot *plot);

/* KIND: 'o' circle, '.' small one, 's' square, 'd' diamond, hollow in capitals.
 * TIP: shown by browsers, or NULL. */
void plot_mark(const struct plot *plot, double x, double y, char kind,
               const char *colour, const char *tip);
void plot_line(const struct plot *plot, double x0, double y0, double x1,
               double y1, const char *colour, bool thick);
void plot_words(const struct plot *plot, double x, double y, const char *words);

/* An entry of the legend, below the title. */
void plot_key(struct plot *plot, char kind, const char *colour,
              const char *words);

const char *plot_colour(int i);

#endif
