/* SPDX-License-Identifier: MIT */
#include "overlay/lamp_excess.h"

#include <math.h>
#include <stdlib.h>

/* Region around a lamp in which light above white may belong to the lamp: a
 * disc, and the rectangle around the disc */
struct reach {
    double x, y, radius;
    int left, top, right, bottom;
};

static int clamp_coordinate(double v, int most)
{
    return (int)fmin(fmax(v, 0), most);
}

static struct reach compute_lamp_region(const struct glint_lamp_track *track,
                                        int width, int height)
{
    struct reach r = {.x = track->x_q8 / 256.0, .y = track->y_q8 / 256.0};

    r.radius = 3 * track->size_q8 / 256.0 + 4;
    r.left = clamp_coordinate(floor(r.x - r.radius), width);
    r.right = clamp_coordinate(ceil(r.x + r.radius), width);
    r.top = clamp_coordinate(floor(r.y - r.radius), height);
    r.bottom = clamp_coordinate(ceil(r.y + r.radius), height);
    return r;
}

static double compute_distance_to_lamp(const struct reach *r, int x, int y)
{
    return hypot(x + 0.5 - r->x, y + 0.5 - r->y);
}

/* Returns whether pixel (X, Y) belongs to lamp OWN: it is within the lamp's
 * radius, and no other of the N lamps is nearer. */
static bool is_lamp_nearest(const struct reach *all, int n, int own, int x,
                            int y)
{
    const double d = compute_distance_to_lamp(&all[own], x, y);

    if (d > all[own].radius)
        return false;
    for (int i = 0; i < n; i++) {
        const struct reach *r = &all[i];

        if (i != own && x >= r->left && x < r->right && y >= r->top &&
            y < r->bottom &&
            compute_distance_to_lamp(r, x, y) < d + (i < own ? 1e-9 : 0))
            return false;
    }
    return true;
}

struct sum {
    double rgb[3], luminance, x, y;
};

static void add_pixel_light(struct sum *sum, const double rgb[3], double x,
                            double y)
{
    const double l = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];

    for (int c = 0; c < 3; c++)
        sum->rgb[c] += rgb[c];
    sum->luminance += l;
    sum->x += l * x;
    sum->y += l * y;
}

/* Adds to SUM the light above WHITE of all pixels that belong to lamp OWN. */
static void add_excess_light(struct sum *sum,
                             const struct glint_samples *samples,
                             const struct reach *all, int n, int own,
                             double white)
{
    const struct reach *r = &all[own];

    for (int y = r->top; y < r->bottom; y++)
        for (int x = r->left; x < r->right; x++) {
            double over[3];
            float rgb[3];

            glint_samples_get_light(samples, x, y, rgb);
            for (int c = 0; c < 3; c++)
                over[c] = fmax((double)rgb[c] - white, 0);
            if ((over[0] > 0 || over[1] > 0 || over[2] > 0) &&
                is_lamp_nearest(all, n, own, x, y))
                add_pixel_light(sum, over, x + 0.5, y + 0.5);
        }
}

/* Returns the light of TRACK, a lamp detected in the proxy. WHITE is the linear
 * light of the proxy's white. */
static struct sum
compute_light_seen_in_proxy(const struct glint_lamp_track *track, double white)
{
    const double flux = (double)track->flux_q16 / 65536 * white;
    struct sum sum = {.luminance = 0};
    double rgb[3];

    for (int c = 0; c < 3; c++)
        rgb[c] = flux * track->rgb_q15[c] / 32768;
    add_pixel_light(&sum, rgb, track->x_q8 / 256.0, track->y_q8 / 256.0);
    return sum;
}

/* Sets position, colour and power of LAMP to the measured SUM. A lamp without
 * power is hidden by a mask or an object and stays so. */
static void set_lamp_from_measured_light(struct glint_engine_lamp *lamp,
                                         const struct sum *sum,
                                         const struct glint_view *view,
                                         double focal_mm)
{
    struct glint_lamp_track *const track = &lamp->track;

    if (!(sum->luminance > 0) || !(lamp->lamp.power > 0))
        return;
    track->x_q8 = (int32_t)lrint(256 * sum->x / sum->luminance);
    track->y_q8 = (int32_t)lrint(256 * sum->y / sum->luminance);
    glint_view_to_angles(view, focal_mm, track->x_q8 / 256.0,
                         track->y_q8 / 256.0, &lamp->lamp);
    lamp->lamp.power = fmin(sum->luminance, GLINT_MAX_LAMP_POWER) * lamp->level;
    for (int c = 0; c < 3; c++)
        lamp->lamp.rgb[c] = sum->rgb[c] / sum->luminance;
}

void add_lamp_excess(struct glint_engine_lamp *lamp, int n,
                     const struct glint_samples *samples, double white,
                     const struct glint_view *view, double focal_mm)
{
    struct reach *const all = n > 0 ? malloc((size_t)n * sizeof *all) : NULL;

    for (int i = 0; i < n && all; i++)
        all[i] = compute_lamp_region(&lamp[i].track, view->width, view->height);
    for (int i = 0; i < n && all; i++) {
        struct sum sum = compute_light_seen_in_proxy(&lamp[i].track, white);

        add_excess_light(&sum, samples, all, n, i, white);
        set_lamp_from_measured_light(&lamp[i], &sum, view, focal_mm);
    }
    free(all);
}
