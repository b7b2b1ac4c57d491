/* SPDX-License-Identifier: MIT */
#include "show_lights.h"

#include <stdio.h>

#include "paint.h"

static void set_state(struct paint *p, enum glint_track_state state)
{
    switch (state) {
    case GLINT_TRACK_RISING:
        paint_colour(p, 255, 255, 0);
        break;
    case GLINT_TRACK_STEADY:
        paint_colour(p, 0, 255, 0);
        break;
    case GLINT_TRACK_FADING:
        paint_colour(p, 255, 0, 0);
        break;
    case GLINT_TRACK_LEAVING:
        paint_colour(p, 0, 128, 255);
        break;
    }
}

static void draw_cross(const struct paint *p, int x, int y)
{
    const int d = p->line;

    paint_fill(p, x - 2 * d, y, x + 3 * d, y + d);
    paint_fill(p, x, y - 2 * d, x + d, y + 3 * d);
}

static void draw_all(const struct paint *p, int x, int y, int half, uint32_t id)
{
    char number[16];

    snprintf(number, sizeof number, "%lu", (unsigned long)id);
    draw_cross(p, x, y);
    paint_box(p, x, y, half);
    paint_text(p, x + half + 3 * p->line, y - half, number);
}

/* A shadow first, as lamps are as bright as any line. */
void show_light(const struct glint_image *image,
                const struct glint_track *track)
{
    struct paint p = {.image = image, .line = 1 + image->height / 540};
    const int x = track->x_q8 >> 8, y = track->y_q8 >> 8;
    const int half = 4 * p.line + (track->size_q8 >> 7);

    paint_colour(&p, 0, 0, 0);
    draw_all(&p, x + p.line, y + p.line, half, track->id);
    set_state(&p, track->state);
    draw_all(&p, x, y, half, track->id);
}
