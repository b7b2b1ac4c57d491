/* SPDX-License-Identifier: MIT */
#include "desk/occlusion.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "glint/area.h"
#include "options/numbered.h"
#include "posix/error.h"

enum { POINTS = 61, LEAST_PX = 2 };

/* Min level of a hidden lamp. Lists of lamps, which store the level, do not
 * accept 0. */
static const double least_level = 1e-6;

/* ----------------------------------------------------------------- reading */

static bool does_file_exist(const char *name)
{
    return access(name, F_OK) == 0;
}

/* Loads the image of frame FRAME of a numbered sequence, whose first number
 * is 0 or 1. */
static enum glint_status load_numbered_mask(struct occlusion *o, int frame,
                                            struct glint_error *error)
{
    struct glint_image image = {.plane = {NULL}};
    char name[NUMBERED_BYTES];
    enum glint_status status;

    if (!numbered_make_name(name, o->file, 0))
        return glint_error_report(error, GLINT_E_FORMAT, o->file,
                                  "the file name is too long");
    numbered_make_name(name, o->file, frame + !does_file_exist(name));
    if (o->frame >= 0 && !does_file_exist(name)) {
        o->is_over = true;
        return GLINT_OK;
    }
    status = glint_picture_load(name, &image, error);
    if (status != GLINT_OK)
        return status;
    glint_picture_free(&o->image);
    o->image = image;
    o->frame = frame;
    return GLINT_OK;
}

static enum glint_status read_mask_video_up_to_frame(struct occlusion *o,
                                                     long frame,
                                                     struct glint_error *error)
{
    enum glint_status status = GLINT_OK;

    while (o->frame < frame && !o->is_over && status == GLINT_OK) {
        const struct glint_image *next;

        status = glint_y4m_reader_next(&o->video, &next, error);
        if (status != GLINT_OK || !next) {
            o->is_over = true;
            break;
        }
        o->image = *next;
        o->frame++;
    }
    return status;
}

static enum glint_status open_mask_video(struct occlusion *o,
                                         struct glint_error *error)
{
    const enum glint_status status =
        glint_y4m_reader_open(&o->video, o->file, error);

    o->is_video = status == GLINT_OK;
    if (o->is_video && o->video.header.range == GLINT_RANGE_LIMITED) {
        o->black = 16;
        o->white = 235;
    }
    return status == GLINT_OK ? read_mask_video_up_to_frame(o, 0, error)
                              : status;
}

enum glint_status occlusion_open(struct occlusion *o, struct glint_error *error)
{
    o->frame = -1;
    o->black = 0;
    o->white = 255;
    if (!o->file)
        return GLINT_OK;
    if (glint_y4m_has_extension(o->file))
        return open_mask_video(o, error);
    o->is_numbered = numbered_is_pattern(o->file);
    return o->is_numbered ? load_numbered_mask(o, 0, error)
                          : glint_picture_load(o->file, &o->image, error);
}

void occlusion_close(struct occlusion *o)
{
    if (o->is_video)
        glint_y4m_reader_close(&o->video);
    else
        glint_picture_free(&o->image);
    o->image.plane[0] = NULL;
    o->is_video = false;
}

/* Loads the mask of FRAME. After a read error prints a warning and uses the
 * previous mask for all later frames. */
static void load_frame_mask(struct occlusion *o, int frame)
{
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;

    if (o->is_over || o->frame >= frame)
        return;
    if (o->is_video)
        status = read_mask_video_up_to_frame(o, frame, &error);
    else if (o->is_numbered)
        status = load_numbered_mask(o, frame, &error);
    if (status == GLINT_OK)
        return;
    fprintf(stderr, "glint: %s; the mask of the previous frame is used\n",
            error.text);
    o->is_over = true;
}

/* ------------------------------------------------------- visible fractions */

/* Returns the mask's value, 0 .. 1, at pixel (X, Y), clamped to the mask's
 * borders. */
static double read_mask_pixel(const struct occlusion *o, int x, int y)
{
    const struct glint_image *m = &o->image;
    const int i = x < 0 ? 0 : x < m->width ? x : m->width - 1;
    const int j = y < 0 ? 0 : y < m->height ? y : m->height - 1;
    const uint8_t *row = m->plane[0] + j * m->stride_bytes[0];
    const double code =
        m->format == GLINT_RGB24
            ? (row[3 * i] + row[3 * i + 1] + row[3 * i + 2]) / 3.0
            : row[i];

    return fmin(fmax((code - o->black) / (o->white - o->black), 0), 1);
}

/* Returns the mask at (X, Y) of an image of VIEW's size, interpolated
 * bilinearly. Off-screen returns 1. */
static double interpolate_mask(const struct occlusion *o,
                               const struct glint_view *view, double x,
                               double y)
{
    const double u = x * o->image.width / view->width - 0.5;
    const double v = y * o->image.height / view->height - 0.5;
    const int i = (int)floor(fmin(fmax(u, -1), 1e6));
    const int j = (int)floor(fmin(fmax(v, -1), 1e6));
    double above, below;

    if (!(x >= 0 && y >= 0 && x < view->width && y < view->height))
        return 1;
    above = read_mask_pixel(o, i, j) * (i + 1 - u) +
            read_mask_pixel(o, i + 1, j) * (u - i);
    below = read_mask_pixel(o, i, j + 1) * (i + 1 - u) +
            read_mask_pixel(o, i + 1, j + 1) * (u - i);
    return above * (j + 1 - v) + below * (v - j);
}

static double compute_mean_mask_over_lamp(const struct occlusion *o,
                                          const struct glint_view *view,
                                          double focal_mm,
                                          const struct glint_lamp *lamp)
{
    const double pixel = glint_view_pixel_tangent(view, focal_mm);
    /* The resolution in this rule is so high that every lamp gets all POINTS
     * sample points. */
    const struct glint_area_rule rule = {1e6 / pixel, POINTS, 1, 1};
    struct glint_lamp disc = *lamp;
    struct glint_area area;
    double sum = 0;
    int n;

    disc.power = 1;
    for (int k = 0; k < 2; k++)
        disc.axis[k] = fmax(disc.axis[k], 0.5 * LEAST_PX * pixel);
    n = glint_area_plan(&area, &disc, &rule);
    for (int i = 0; i < n; i++) {
        const struct glint_lamp point = glint_area_point(&area, i);
        double x, y;

        glint_view_to_pixel(view, focal_mm, &point, &x, &y);
        sum += point.power * interpolate_mask(o, view, x, y);
    }
    return fmin(sum, 1);
}

/* Returns the factor on the light of a lamp at (X, Y), pixels, in an image of
 * WIDTH x HEIGHT. The factor falls from 1 at the image border to 0 at a
 * distance of FADE_PX. */
static double compute_off_screen_fade(double x, double y, int width, int height,
                                      double fade_px)
{
    const double dx = fmax(fmax(-x, x - width), 0);
    const double dy = fmax(fmax(-y, y - height), 0);
    const double t = fade_px > 0 ? fmin(hypot(dx, dy) / fade_px, 1) : 0;

    return 1 - t * t * (3 - 2 * t);
}

void occlusion_dim_lamps(struct occlusion *o, int frame,
                         const struct glint_view *view, double focal_mm,
                         struct glint_engine_lamp *lamps, int n)
{
    if (!o->file && !(o->fade_px > 0))
        return;
    if (o->file)
        load_frame_mask(o, frame);
    for (int i = 0; i < n; i++) {
        struct glint_lamp *const lamp = &lamps[i].lamp;
        double x, y, share = 1;

        glint_view_to_pixel(view, focal_mm, lamp, &x, &y);
        if (o->image.plane[0])
            share = compute_mean_mask_over_lamp(o, view, focal_mm, lamp);
        share *= compute_off_screen_fade(x, y, view->width, view->height,
                                         o->fade_px);
        lamp->power *= share;
        lamps[i].level = fmax(lamps[i].level * share, least_level);
    }
}
