/* SPDX-License-Identifier: MIT */
#include "motions/time_line.h"

#include <stdio.h>

#include "formats/paint.h"

/* If there are fewer events (new landmarks) than this, a tick marks each of
 * them, else each block of poses with events. */
enum { MOST_EVENTS = 4096 };

struct bar {
    struct paint paint;
    int x0, x1, y0, y1;
    uint32_t last; /* number of the last frame, at least 1 */
};

static int compute_frame_position_px(const struct bar *b, uint32_t frame)
{
    return b->x0 + (int)((int64_t)(b->x1 - b->x0) * frame / b->last);
}

static void draw_frame_tick(const struct bar *b, uint32_t frame)
{
    const int x = compute_frame_position_px(b, frame), high = b->y1 - b->y0;

    paint_fill_rectangle(&b->paint, x, b->y0 - high, x + b->paint.line, b->y0);
}

/* Marks the frames in which a new landmark ("food") replaces another. */
static void draw_landmark_changes(const struct bar *b,
                                  struct glint_motion *motion)
{
    const struct glint_motion_header *const h = &motion->header;
    const uint32_t each =
        glint_motion_per_block(sizeof(struct glint_motion_pose));
    struct glint_motion_event event;
    struct glint_motion_index index, before = {.event = h->n_foods};

    for (uint32_t i = h->n_foods; i < h->n_events && h->n_events < MOST_EVENTS;
         i++)
        if (glint_motion_event(motion, i, &event) == GLINT_OK)
            draw_frame_tick(b, event.frame);
    for (uint32_t i = 0; h->n_events >= MOST_EVENTS && i * each < h->n_frames;
         i++) {
        if (glint_motion_index(motion, i, &index) != GLINT_OK)
            return;
        if (index.event > before.event)
            draw_frame_tick(b, i * each);
        before = index;
    }
}

void draw_time_line(const struct glint_image *image,
                    struct glint_motion *motion, int frame)
{
    const int high = image->height < 240 ? 2 : image->height / 100;
    const uint32_t n = motion->header.n_frames;
    const uint32_t now = frame < (int)n ? (uint32_t)frame : n - 1;
    struct bar b = {.paint = {.image = image, .line = high > 5 ? 2 : 1},
                    .x0 = image->width / 32,
                    .x1 = image->width - image->width / 32,
                    .y0 = image->height - 4 * high,
                    .y1 = image->height - 3 * high,
                    .last = n > 1 ? n - 1 : 1};
    char text[32];

    paint_set_colour(&b.paint, 70, 75, 80);
    paint_fill_rectangle(&b.paint, b.x0, b.y0, b.x1, b.y1);
    paint_set_colour(&b.paint, 255, 150, 40);
    draw_landmark_changes(&b, motion);
    paint_set_colour(&b.paint, 240, 240, 240);
    paint_fill_rectangle(&b.paint, b.x0, b.y0,
                         compute_frame_position_px(&b, now), b.y1);
    paint_fill_rectangle(
        &b.paint, compute_frame_position_px(&b, now) - high / 2, b.y0 - high,
        compute_frame_position_px(&b, now) + high / 2 + 1, b.y1 + high);
    snprintf(text, sizeof text, "%u/%u", now, n - 1);
    paint_text(&b.paint, b.x1 - paint_text_width(&b.paint, text),
               b.y0 - 2 * high - 6 * b.paint.line, text);
}
