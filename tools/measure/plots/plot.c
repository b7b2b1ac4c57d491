/* SPDX-License-Identifier: MIT */
#include "measure/plots/plot.h"

#include <ctype.h>
#include <math.h>

enum { LEFT = 48, RIGHT = 14, TOP = 78, BOTTOM = 40, KEYS = 3 };

void plot_open(FILE *file, int n_panels)
{
    const int columns = n_panels > 1 ? 2 : 1;
    const int width = columns * PLOT_WIDTH;
    const int height = (n_panels + columns - 1) / columns * PLOT_HEIGHT;

    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" "
            "width=\"%d\" height=\"%d\" font-family=\"sans-serif\" "
            "font-size=\"11\">\n<rect width=\"%d\" height=\"%d\" "
            "fill=\"#fff\"/>\n",
            width, height, width, height, width, height);
}

void plot_close(FILE *file)
{
    fputs("</svg>\n", file);
}

void plot_init(struct plot *p, FILE *file, int number, const char *title)
{
    *p = (struct plot){.file = file,
                       .title = title,
                       .x = {"", false, 1, 0, 1},
                       .y = {"", false, 1, 0, 1},
                       .left = number % 2 * PLOT_WIDTH,
                       .top = number / 2 * PLOT_HEIGHT};
}

static bool is_on_axis(const struct plot_axis *a, double v)
{
    return isfinite(v) && (!a->is_log || v > 0);
}

static void extend_axis_to_value(struct plot_axis *a, double v)
{
    if (a->lo > a->hi)
        a->lo = a->hi = v;
    a->lo = fmin(a->lo, v);
    a->hi = fmax(a->hi, v);
}

void plot_extend_axes(struct plot *p, double x, double y)
{
    if (is_on_axis(&p->x, x) && is_on_axis(&p->y, y)) {
        extend_axis_to_value(&p->x, x);
        extend_axis_to_value(&p->y, y);
    }
}

/* Returns the position of V along axis A, 0 to 1. */
static double compute_axis_fraction(const struct plot_axis *a, double v)
{
    return a->is_log ? log(v / a->lo) / log(a->hi / a->lo)
                     : (v - a->lo) / (a->hi - a->lo);
}

static double convert_data_x_to_px(const struct plot *p, double x)
{
    return p->left + LEFT +
           compute_axis_fraction(&p->x, x) * (PLOT_WIDTH - LEFT - RIGHT);
}

static double convert_data_y_to_px(const struct plot *p, double y)
{
    return p->top + PLOT_HEIGHT - BOTTOM -
           compute_axis_fraction(&p->y, y) * (PLOT_HEIGHT - TOP - BOTTOM);
}

static void draw_svg_text(const struct plot *p, double x, double y,
                          const char *anchor, const char *more,
                          const char *words)
{
    fprintf(p->file,
            "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"%s>%s</text>\n", x,
            y, anchor, more, words);
}

static void draw_svg_stroke(const struct plot *p, double x0, double y0,
                            double x1, double y1, const char *colour,
                            double width)
{
    fprintf(p->file,
            "<path d=\"M%.1f %.1fL%.1f %.1f\" fill=\"none\" stroke=\"%s\" "
            "stroke-width=\"%.1f\"/>\n",
            x0, y0, x1, y1, colour, width);
}

/* Widens the range of an axis slightly beyond its outermost points. */
static void widen_axis_range(struct plot_axis *a)
{
    if (a->lo > a->hi)
        a->lo = a->is_log ? 1 : 0, a->hi = 1;
    if (a->is_log) {
        const double room = fmax(0.05 * log(a->hi / a->lo), 0.05);

        a->lo *= exp(-room);
        a->hi *= exp(room);
    } else {
        const double room =
            fmax(0.05 * (a->hi - a->lo), (a->least_span - (a->hi - a->lo)) / 2);

        a->lo -= room;
        a->hi += room;
    }
}

static void draw_axis_tick(const struct plot *p, bool is_x, double v)
{
    const double bottom = p->top + PLOT_HEIGHT - BOTTOM;
    const double left = p->left + LEFT;
    char words[32];

    snprintf(words, sizeof words, "%.6g", v);
    if (is_x) {
        draw_svg_stroke(p, convert_data_x_to_px(p, v), p->top + TOP,
                        convert_data_x_to_px(p, v), bottom, "#ddd", 1);
        draw_svg_text(p, convert_data_x_to_px(p, v), bottom + 14, "middle", "",
                      words);
    } else {
        draw_svg_stroke(p, left, convert_data_y_to_px(p, v),
                        p->left + PLOT_WIDTH - RIGHT,
                        convert_data_y_to_px(p, v), "#ddd", 1);
        draw_svg_text(p, left - 5, convert_data_y_to_px(p, v) + 4, "end", "",
                      words);
    }
}

/* Draws the ticks of axis A. Linear: every 1, 2 or 5 times a power of ten.
 * Logarithmic: at 1, 2 and 5 times powers of ten; at more values if the axis
 * spans less than a factor of 12; only at powers of ten if it spans four
 * decades or more, and at every second one from eight decades on. */
static void draw_axis_ticks(const struct plot *p, const struct plot_axis *a,
                            bool is_x)
{
    static const double mantissa[] = {1, 2, 5, 0.7, 1.5, 3};
    const int every = a->is_log ? 1 + (int)log10(a->hi / a->lo) / 8 : 1;
    const int n = a->hi / a->lo < 12 ? 6 : a->hi / a->lo < 1e4 ? 3 : 1;
    double step = pow(10, floor(log10((a->hi - a->lo) / 4)));

    if (a->is_log) {
        for (int e = -24; e <= 9; e += every)
            for (int k = 0; k < n; k++) {
                const double v = mantissa[k] * pow(10, e);

                if (v >= a->lo && v <= a->hi)
                    draw_axis_tick(p, is_x, v);
            }
        return;
    }
    step *= (a->hi - a->lo) / step > 15  ? 5
            : (a->hi - a->lo) / step > 7 ? 2
                                         : 1;
    for (int k = (int)ceil(a->lo / step); k * step <= a->hi; k++)
        draw_axis_tick(p, is_x, k * step);
}

void plot_draw_frame(struct plot *p)
{
    const double middle = p->top + (TOP + PLOT_HEIGHT - BOTTOM) / 2.0;
    char turn[64];

    widen_axis_range(&p->x);
    widen_axis_range(&p->y);
    draw_axis_ticks(p, &p->x, true);
    draw_axis_ticks(p, &p->y, false);
    draw_svg_text(p, p->left + LEFT, p->top + 15, "start",
                  " font-weight=\"bold\"", p->title);
    draw_svg_text(p, p->left + (LEFT + PLOT_WIDTH - RIGHT) / 2.0,
                  p->top + PLOT_HEIGHT - 8, "middle", "", p->x.words);
    snprintf(turn, sizeof turn, " transform=\"rotate(-90 %d %.1f)\"",
             p->left + 13, middle);
    draw_svg_text(p, p->left + 13, middle, "middle", turn, p->y.words);
}

static void draw_data_mark(const struct plot *p, double x, double y, char kind,
                           const char *colour, const char *tip)
{
    const bool hollow = isupper((unsigned char)kind);
    const double r = kind == '.' ? 1.6 : 3.3;
    char ink[64];

    snprintf(ink, sizeof ink,
             hollow ? "fill=\"#fff\" stroke=\"%s\"" : "fill=\"%s\"", colour);
    kind = (char)tolower((unsigned char)kind);
    if (kind == 's')
        fprintf(p->file,
                "<rect x=\"%.1f\" y=\"%.1f\" width=\"6\" height=\"6\" %s>",
                x - 3, y - 3, ink);
    else if (kind == 'd')
        fprintf(p->file,
                "<path d=\"M%.1f %.1fl4.5 4.5l-4.5 4.5l-4.5 -4.5z\" %s>", x,
                y - 4.5, ink);
    else
        fprintf(p->file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" %s>", x, y,
                r, ink);
    if (tip)
        fprintf(p->file, "<title>%s</title>", tip);
    fputs(kind == 's'   ? "</rect>\n"
          : kind == 'd' ? "</path>\n"
                        : "</circle>\n",
          p->file);
}

void plot_draw_mark(const struct plot *p, double x, double y, char kind,
                    const char *colour, const char *tip)
{
    if (is_on_axis(&p->x, x) && is_on_axis(&p->y, y))
        draw_data_mark(p, convert_data_x_to_px(p, x),
                       convert_data_y_to_px(p, y), kind, colour, tip);
}

void plot_draw_line(const struct plot *p, double x0, double y0, double x1,
                    double y1, const char *colour, bool thick)
{
    if (is_on_axis(&p->x, x0) && is_on_axis(&p->x, x1) &&
        is_on_axis(&p->y, y0) && is_on_axis(&p->y, y1))
        draw_svg_stroke(p, convert_data_x_to_px(p, x0),
                        convert_data_y_to_px(p, y0),
                        convert_data_x_to_px(p, x1),
                        convert_data_y_to_px(p, y1), colour, thick ? 2 : 1);
}

void plot_draw_label(const struct plot *p, double x, double y,
                     const char *words)
{
    if (is_on_axis(&p->x, x) && is_on_axis(&p->y, y))
        draw_svg_text(p, convert_data_x_to_px(p, x) + 5,
                      convert_data_y_to_px(p, y) + 11, "start",
                      " font-size=\"9\" fill=\"#555\"", words);
}

void plot_draw_legend_entry(struct plot *p, char kind, const char *colour,
                            const char *words)
{
    const int column = p->n_keys % KEYS, row = p->n_keys / KEYS;
    const double x =
        p->left + LEFT + 6 + column * (PLOT_WIDTH - LEFT) / (double)KEYS;
    const double y = p->top + 29 + 14 * row;

    draw_data_mark(p, x, y, kind, colour, NULL);
    draw_svg_text(p, x + 8, y + 4, "start", "", words);
    p->n_keys++;
}

const char *plot_get_colour_of_series(int i)
{
    static const char *const colours[] = {
        "#1f6fb2", "#c2571a", "#3a8f3a", "#7a4fa3", "#b01e5a",
        "#8a6d00", "#008a8a", "#555555", "#d07aa8", "#6a8f1f"};

    return colours[i % 10];
}
