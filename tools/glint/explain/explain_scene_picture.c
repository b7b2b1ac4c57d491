/* SPDX-License-Identifier: MIT
 *
 * Draws the scene picture of glint explain: objects outlined, numbered and
 * coloured by their cost per pixel, and a legend below. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "explain/explain_scene.h"
#include "formats/paint.h"

enum { COLUMN = 170, ROW = 8, MOST_ENTRIES = 64 };

struct heat {
    const struct explained_scene *scene;
    const struct glint_image *image;
    int width, height, scale;
    double most; /* max steps per pixel over all objects */
};

static int count_scene_objects(const struct heat *h)
{
    return (int)h->scene->drawing->files.scene.baked.model.header->n_objects;
}

/* Returns the mean steps per pixel of OBJECT: points shaded, shadows, texels,
 * lookups and rays that continue. */
static double compute_heat_steps(const struct heat *h, int object)
{
    const int64_t *const n = h->scene->account.objects[object].count;

    return n[GLINT_SCENE_COVERING] > 0
               ? (double)(n[GLINT_SCENE_SHADED] + n[GLINT_SCENE_SHADOWS] +
                          n[GLINT_SCENE_TEXELS] + n[GLINT_SCENE_LOOKUPS] +
                          n[GLINT_SCENE_BOUNCED]) /
                     (double)n[GLINT_SCENE_COVERING]
               : 0;
}

/* Sets RGB to the heat colour of OBJECT, from blue over red to yellow by the
 * square root of its steps. */
static void compute_heat_colour(const struct heat *h, int object,
                                uint8_t rgb[3])
{
    const double x =
        h->most > 0 ? sqrt(compute_heat_steps(h, object) / h->most) : 0;

    rgb[0] = (uint8_t)(255 * fmin(1, 2 * x));
    rgb[1] = (uint8_t)(255 * fmax(0, 2 * x - 1));
    rgb[2] = (uint8_t)(255 * fmax(0, 1 - 1.5 * x));
}

static int find_object_at_pixel(const struct heat *h, int x, int y)
{
    return x < 0 || y < 0 ? -1
                          : h->scene->account.seen[(ptrdiff_t)y * h->width + x];
}

/* Returns whether OBJECT (-1: none) only receives shadows, so that the picture
 * behind it stays visible. */
static bool is_shadow_catcher(const struct heat *h, int object)
{
    return object >= 0 &&
           h->scene->drawing->files.scene.baked.model.object[object]
               .catcher_q15;
}

static void shade_objects_by_cost(const struct heat *h)
{
    for (int y = 0; y < h->height; y++) {
        uint8_t *px = h->image->plane[0] + y * h->image->stride_bytes[0];

        for (int x = 0; x < h->width; x++, px += 3) {
            const int object = find_object_at_pixel(h, x, y);
            const bool rim =
                (x > 0 && object != find_object_at_pixel(h, x - 1, y)) ||
                (y > 0 && object != find_object_at_pixel(h, x, y - 1));
            uint8_t rgb[3] = {0, 0, 0};

            if (object >= 0)
                compute_heat_colour(h, object, rgb);
            for (int c = 0; c < 3; c++)
                px[c] = rim ? 255
                        : is_shadow_catcher(h, object)
                            ? (uint8_t)(px[c] / 2 + rgb[c] / 6)
                            : (uint8_t)(px[c] / 3 + rgb[c] / 2);
        }
    }
}

/* Sets X and Y to the pixel nearest to AT that shows OBJECT; at least one pixel
 * must show it. */
static void find_nearest_object_pixel(const struct heat *h, int object,
                                      const double at[2], int *x, int *y)
{
    double best = HUGE_VAL;

    for (int j = 0; j < h->height; j++)
        for (int i = 0; i < h->width; i++) {
            const double away = hypot(i - at[0], j - at[1]);

            if (find_object_at_pixel(h, i, j) == object && away < best) {
                best = away;
                *x = i;
                *y = j;
            }
        }
}

/* Draws the number of each object with at least 64 visible pixels at that
 * visible pixel which is nearest to their mean position. */
static void draw_object_numbers(const struct heat *h)
{
    struct paint p = {.image = h->image, .line = h->scale};

    for (int i = 0; i < count_scene_objects(h); i++) {
        double sum[2] = {0, 0}, n = 0;
        char text[16];
        int x0 = 0, y0 = 0, wide;

        for (int y = 0; y < h->height; y++)
            for (int x = 0; x < h->width; x++)
                if (find_object_at_pixel(h, x, y) == i) {
                    sum[0] += x;
                    sum[1] += y;
                    n++;
                }
        if (n < 64)
            continue;
        snprintf(text, sizeof text, "%d", i);
        wide = paint_text_width(&p, text);
        sum[0] /= n;
        sum[1] /= n;
        find_nearest_object_pixel(h, i, sum, &x0, &y0);
        x0 -= wide / 2;
        y0 -= 2 * p.line;
        paint_set_colour(&p, 0, 0, 0);
        paint_fill_rectangle(&p, x0 - 2 * p.line, y0 - 2 * p.line,
                             x0 + wide + 2 * p.line, y0 + 7 * p.line);
        paint_set_colour(&p, 255, 255, 255);
        paint_text(&p, x0, y0, text);
    }
}

/* ------------------------------------------------------------------- legend */

static int count_legend_columns(const struct heat *h)
{
    const int n = h->width / (COLUMN * h->scale);

    return n > 0 ? n : 1;
}

static int count_legend_entries(const struct heat *h)
{
    return count_scene_objects(h) < MOST_ENTRIES ? count_scene_objects(h)
                                                 : MOST_ENTRIES;
}

static void draw_legend_entry(const struct heat *h, int i)
{
    const struct glint_scene_object *const object =
        &h->scene->drawing->files.scene.baked.model.object[i];
    struct paint p = {.image = h->image, .line = h->scale};
    const int x = i % count_legend_columns(h) * COLUMN * p.line + 4 * p.line;
    const int y =
        h->height + (3 + ROW * (i / count_legend_columns(h))) * p.line;
    char text[96];
    uint8_t rgb[3];

    compute_heat_colour(h, i, rgb);
    paint_set_colour(&p, rgb[0], rgb[1], rgb[2]);
    paint_fill_rectangle(&p, x, y, x + 5 * p.line, y + 5 * p.line);
    paint_set_colour(&p, 208, 208, 208);
    snprintf(text, sizeof text, "%d %.16s  %.1f steps a px", i, object->name,
             compute_heat_steps(h, i));
    paint_text(&p, x + 8 * p.line, y, text);
}

enum glint_status explain_scene_draw_marks(const struct explained_scene *scene,
                                           const struct glint_image *picture,
                                           struct glint_image *marked)
{
    struct heat h = {.scene = scene,
                     .image = marked,
                     .width = picture->width,
                     .height = picture->height,
                     .scale = 1 + picture->height / 540};
    const int legend =
        ((count_legend_entries(&h) + count_legend_columns(&h) - 1) /
             count_legend_columns(&h) * ROW +
         4) *
        h.scale;
    const enum glint_status status =
        explain_copy_picture(picture, legend, marked);

    if (status != GLINT_OK)
        return status;
    for (int i = 0; i < count_scene_objects(&h); i++)
        h.most = fmax(h.most, compute_heat_steps(&h, i));
    shade_objects_by_cost(&h);
    draw_object_numbers(&h);
    for (int i = 0; i < count_legend_entries(&h); i++)
        draw_legend_entry(&h, i);
    return GLINT_OK;
}
