/* SPDX-License-Identifier: MIT */
#include "overlay/show_lights.h"

#include <math.h>
#include <stdio.h>

#include "formats/paint.h"

static void set_colour_of_state(struct paint *p, enum glint_lamp_state state)
{
    switch (state) {
    case GLINT_LAMP_RISING:
        paint_set_colour(p, 255, 255, 0);
        break;
    case GLINT_LAMP_STEADY:
        paint_set_colour(p, 0, 255, 0);
        break;
    case GLINT_LAMP_FADING:
        paint_set_colour(p, 255, 0, 0);
        break;
    case GLINT_LAMP_LEAVING:
        paint_set_colour(p, 0, 128, 255);
        break;
    }
}

static void draw_lamp_cross(const struct paint *p, int x, int y)
{
    const int d = p->line;

    paint_fill_rectangle(p, x - 2 * d, y, x + 3 * d, y + d);
    paint_fill_rectangle(p, x, y - 2 * d, x + d, y + 3 * d);
}

/* Returns the line width, pixels, at which text on IMAGE is readable. */
static int compute_line_width(const struct glint_image *image)
{
    const int side =
        image->width < image->height ? image->width : image->height;

    return 1 + side / 540;
}

/* Draws NUMBER, with STOPS below it, to the right of the box around (X, Y).
 * Near the right edge of the picture it is drawn to the left. */
static void draw_lamp_number(const struct paint *p, int x, int y, int half,
                             const char *number, const char *stops)
{
    const int gap = 3 * p->line, top = y < half ? 0 : y - half;
    const int a = paint_text_width(p, number), b = paint_text_width(p, stops);
    const int width = a > b ? a : b;
    const int left = x + half + gap + width < p->image->width
                         ? x + half + gap
                         : x - half - gap - width;

    paint_text(p, left, top, number);
    paint_text(p, left, top + 7 * p->line, stops);
}

static void draw_lamp_strokes(const struct paint *p, int x, int y, int half,
                              uint32_t id, const char *stops)
{
    char number[16];

    snprintf(number, sizeof number, "%lu", (unsigned long)id);
    draw_lamp_cross(p, x, y);
    paint_square_outline(p, x, y, half);
    draw_lamp_number(p, x, y, half, number, stops);
}

/* Returns half the width of the box of a lamp with the RMS radius SIZE_Q8. */
static int compute_half_box(const struct paint *p, int32_t size_q8)
{
    return 4 * p->line + (size_q8 >> 7);
}

/* Draws a mark with a black shadow, by which it is visible on bright lamps. */
static void draw_shadowed_mark(const struct glint_image *image,
                               const struct glint_lamp_track *track,
                               const char *stops)
{
    struct paint p = {.image = image, .line = compute_line_width(image)};
    const int x = track->x_q8 >> 8, y = track->y_q8 >> 8;
    const int half = compute_half_box(&p, track->size_q8);

    paint_set_colour(&p, 0, 0, 0);
    draw_lamp_strokes(&p, x + p.line, y + p.line, half, track->id, stops);
    set_colour_of_state(&p, track->state);
    draw_lamp_strokes(&p, x, y, half, track->id, stops);
}

void show_lamp_mark(const struct glint_image *image,
                    const struct glint_lamp_track *track)
{
    draw_shadowed_mark(image, track, "");
}

void show_lamp_mark_with_power(const struct glint_image *image,
                               const struct glint_lamp_track *track,
                               double power)
{
    char stops[32] = "";

    if (power > 0)
        snprintf(stops, sizeof stops, "%+.1f EV", log2(power));
    draw_shadowed_mark(image, track, stops);
}

void show_candidate_mark(const struct glint_image *image,
                         const struct glint_spot *spot)
{
    struct paint p = {.image = image, .line = compute_line_width(image)};
    const int x = spot->x_q8 >> 8, y = spot->y_q8 >> 8;
    const int half = compute_half_box(&p, spot->size_q8);
    char place[32];

    snprintf(place, sizeof place, "%.0f,%.0f", spot->x_q8 / 256.0,
             spot->y_q8 / 256.0);
    for (int shift = p.line; shift >= 0; shift -= p.line) {
        const uint8_t code = shift ? 0 : 255;

        paint_set_colour(&p, code, code, code);
        paint_square_outline(&p, x + shift, y + shift, half);
        draw_lamp_number(&p, x + shift, y + shift, half, place, "");
    }
}

/* ------------------------------------------------------------------ legend */

static const struct {
    const char *word;
    enum glint_lamp_state state;
} states[] = {{"STEADY", GLINT_LAMP_STEADY},
              {"RISING", GLINT_LAMP_RISING},
              {"FADING", GLINT_LAMP_FADING},
              {"LEFT THE PICTURE", GLINT_LAMP_LEAVING}};

static const char words[] = "NUMBER, EV: STOPS OVER A WHITE PIXEL";
static const char candidate[] = "NO CROSS: CANDIDATE, LIGHT-AT";

void show_mark_legend(const struct glint_image *image, bool followed,
                      bool has_candidates)
{
    struct paint p = {.image = image, .line = compute_line_width(image)};
    const int margin = 3 * p.line, row = 8 * p.line;
    const int width = paint_text_width(&p, words) + 2 * margin;
    const int height = (1 + 2 * followed + has_candidates) * row + margin;
    int x = margin, y = image->height - height + margin;

    if (width > image->width || 3 * height > image->height)
        return;
    paint_set_colour(&p, 0, 0, 0);
    paint_fill_rectangle(&p, 0, image->height - height, width, image->height);
    paint_set_colour(&p, 255, 255, 255);
    paint_text(&p, x, y, words);
    if (has_candidates)
        paint_text(&p, x, y += row, candidate);
    for (int i = 0; followed && i < 4; i++) {
        if (i % 3 == 0) {
            x = margin;
            y += row;
        }
        set_colour_of_state(&p, states[i].state);
        paint_text(&p, x, y, states[i].word);
        x += paint_text_width(&p, states[i].word) + 2 * margin;
    }
}
