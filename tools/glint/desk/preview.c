/* SPDX-License-Identifier: MIT */
#include "desk/preview.h"

#include <stdio.h>

#include "glint/explain.h"
#include "formats/paint.h"

enum { SMALL = 320, MOST = 24 };

/* Boxes x0, y0, x1, y1 of all labels drawn so far */
struct labels {
    struct paint paint;
    int n, box[MOST][4];
};

/* Sets X and Y to the brightest pixel of the ghost drawn last. Returns false
 * if the ghost has no light. */
static bool find_brightest_ghost_pixel(const struct glint_explain *e, int *x,
                                       int *y)
{
    const int width = e->view->width, height = e->view->height;
    const int32_t *px = e->linear_q20;
    int64_t most = 0;

    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++, px += 3) {
            const int64_t light = (int64_t)px[0] + px[1] + px[2];

            if (light <= most)
                continue;
            most = light;
            *x = i;
            *y = j;
        }
    return most > 0;
}

static bool is_label_space_free(const struct labels *l, const int box[4])
{
    for (int i = 0; i < l->n; i++)
        if (box[0] < l->box[i][2] && box[2] > l->box[i][0] &&
            box[1] < l->box[i][3] && box[3] > l->box[i][1])
            return false;
    return true;
}

/* Draws NUMBER at pixel (X, Y), or at the first free position below. */
static void draw_number_label(struct labels *l, int number, int x, int y)
{
    struct paint *const p = &l->paint;
    const int high = 9 * p->line;
    char text[16];
    int box[4], wide;

    snprintf(text, sizeof text, "%d", number);
    wide = paint_text_width(p, text) + 4 * p->line;
    x = x + wide > p->image->width ? p->image->width - wide : x;
    y = y + high > p->image->height ? p->image->height - high : y;
    for (int i = 0; i < MOST; i++, y += high) {
        box[0] = x;
        box[1] = y;
        box[2] = x + wide;
        box[3] = y + high;
        if (is_label_space_free(l, box))
            break;
    }
    for (int i = 0; i < 4; i++)
        l->box[l->n][i] = box[i];
    l->n++;
    paint_set_colour(p, 0, 0, 0);
    paint_fill_rectangle(p, box[0], box[1], box[2], box[3]);
    paint_set_colour(p, 255, 224, 96);
    paint_text(p, x + 2 * p->line, y + 2 * p->line, text);
}

enum glint_status
preview_draw_ghost_numbers(struct glint_engine *engine,
                           const struct glint_engine_lamp *lamps, int n,
                           double scale, const struct glint_image *image)
{
    const int width = image->width < SMALL ? image->width : SMALL;
    const int height = (int)((int64_t)image->height * width / image->width);
    struct labels l = {
        .paint = {.image = image, .line = 1 + image->height / 540}};
    int ghosts[GLINT_MAX_GHOSTS], x = 0, y = 0;
    struct glint_explain e;
    enum glint_status status;

    if (n == 0 || !(scale > 0))
        return GLINT_OK;
    status = glint_explain_at(&e, engine, lamps, n, scale, width,
                              height > 0 ? height : 1);
    if (status == GLINT_OK)
        glint_explain_sort(&e, ghosts);
    for (int i = 0; status == GLINT_OK && i < e.n_ghosts && l.n < MOST; i++) {
        if (glint_explain_drawn(&e.ghost[ghosts[i]]) == 0)
            continue;
        glint_explain_draw(&e, ghosts[i]);
        if (find_brightest_ghost_pixel(&e, &x, &y))
            draw_number_label(
                &l, ghosts[i], (int)((int64_t)x * image->width / e.view->width),
                (int)((int64_t)y * image->height / e.view->height));
    }
    glint_explain_close(&e);
    return status;
}
