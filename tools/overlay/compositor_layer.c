/* SPDX-License-Identifier: MIT */
#include "overlay/compositor_layer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --------------------------------------------------------------- measuring */

/* The pixels around a lamp whose light above white is counted as its own. */
struct reach {
    double x, y, radius;
    int left, top, right, bottom;
};

static int within(double v, int most)
{
    return (int)fmin(fmax(v, 0), most);
}

static struct reach reach_of(const struct glint_lamp_track *track, int width,
                             int height)
{
    struct reach r = {.x = track->x_q8 / 256.0, .y = track->y_q8 / 256.0};

    r.radius = 3 * track->size_q8 / 256.0 + 4;
    r.left = within(floor(r.x - r.radius), width);
    r.right = within(ceil(r.x + r.radius), width);
    r.top = within(floor(r.y - r.radius), height);
    r.bottom = within(ceil(r.y + r.radius), height);
    return r;
}

static double distance(const struct reach *r, int x, int y)
{
    return hypot(x + 0.5 - r->x, y + 0.5 - r->y);
}

/* Checks whether lamp OWN reaches the pixel, and none of the N lamps that reach
 * it is nearer. */
static bool is_nearest(const struct reach *all, int n, int own, int x, int y)
{
    const double d = distance(&all[own], x, y);

    if (d > all[own].radius)
        return false;
    for (int i = 0; i < n; i++) {
        const struct reach *r = &all[i];

        if (i != own && x >= r->left && x < r->right && y >= r->top &&
            y < r->bottom && distance(r, x, y) < d + (i < own ? 1e-9 : 0))
            return false;
    }
    return true;
}

struct sum {
    double rgb[3], luminance, x, y;
};

static void add_light(struct sum *sum, const double rgb[3], double x, double y)
{
    const double l = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];

    for (int c = 0; c < 3; c++)
        sum->rgb[c] += rgb[c];
    sum->luminance += l;
    sum->x += l * x;
    sum->y += l * y;
}

/* Adds to SUM the light above WHITE of the pixels of lamp OWN. */
static void add_excess(struct sum *sum, const struct glint_samples *samples,
                       const struct reach *all, int n, int own, double white)
{
    const struct reach *r = &all[own];

    for (int y = r->top; y < r->bottom; y++)
        for (int x = r->left; x < r->right; x++) {
            double over[3];
            float rgb[3];

            glint_samples_light(samples, x, y, rgb);
            for (int c = 0; c < 3; c++)
                over[c] = fmax((double)rgb[c] - white, 0);
            if ((over[0] > 0 || over[1] > 0 || over[2] > 0) &&
                is_nearest(all, n, own, x, y))
                add_light(sum, over, x + 0.5, y + 0.5);
        }
}

/* Returns the light of TRACK that the finder saw in the proxy, times WHITE, the
 * light of the proxy's white. */
static struct sum seen_of(const struct glint_lamp_track *track, double white)
{
    const double flux = (double)track->flux_q16 / 65536 * white;
    struct sum sum = {.luminance = 0};
    double rgb[3];

    for (int c = 0; c < 3; c++)
        rgb[c] = flux * track->rgb_q15[c] / 32768;
    add_light(&sum, rgb, track->x_q8 / 256.0, track->y_q8 / 256.0);
    return sum;
}

static void set_lamp(struct compositor *compositor, int i,
                     const struct sum *sum)
{
    struct glint_lamp *const lamp = &compositor->lamp[i];
    struct glint_lamp_track *const track = &compositor->finder.track[i];
    const double focal = compositor->settings.setup.optics.focal_mm;

    if (!(sum->luminance > 0))
        return;
    track->x_q8 = (int32_t)lrint(256 * sum->x / sum->luminance);
    track->y_q8 = (int32_t)lrint(256 * sum->y / sum->luminance);
    glint_view_to_angles(&compositor->view, focal, track->x_q8 / 256.0,
                         track->y_q8 / 256.0, lamp);
    lamp->power = fmin(sum->luminance, LAMP_MAX_POWER) * compositor->level[i];
    for (int c = 0; c < 3; c++)
        lamp->rgb[c] = sum->rgb[c] / sum->luminance;
}

void compositor_measure(struct compositor *compositor,
                        const struct glint_samples *samples, double white)
{
    const int n = compositor->n_own;
    struct reach *all;

    if (compositor->is_listed || compositor->n_hand || n == 0)
        return;
    all = malloc((size_t)n * sizeof *all);
    for (int i = 0; i < n && all; i++)
        all[i] = reach_of(&compositor->finder.track[i], compositor->view.width,
                          compositor->view.height);
    for (int i = 0; i < n && all; i++) {
        struct sum sum = seen_of(&compositor->finder.track[i], white);

        add_excess(&sum, samples, all, n, i, white);
        set_lamp(compositor, i, &sum);
    }
    free(all);
}

/* ------------------------------------------------------------------ drawing */

static enum glint_status draw_as_for_codes(struct compositor *compositor,
                                           float *rgb)
{
    const size_t n =
        3 * (size_t)compositor->view.width * (size_t)compositor->view.height;
    struct glint_image layer = {.format = GLINT_LINEAR_Q20,
                                .width = compositor->view.width,
                                .height = compositor->view.height};
    enum glint_status status;

    memset(rgb, 0, n * sizeof *rgb);
    /* RGB holds integers until they are converted. */
    glint_image_place(&layer, rgb);
    compositor->frame.for_codes = true;
    status = glint_frame_draw(&compositor->frame, compositor->lamp,
                              compositor->n_lamps, compositor_scale(compositor),
                              &layer, &compositor->report);
    compositor->frame.for_codes = false;
    for (size_t i = 0; i < n; i++) {
        int32_t light_q20;

        memcpy(&light_q20, &rgb[i], sizeof light_q20);
        rgb[i] = (float)light_q20 * 0x1p-20F;
    }
    return status;
}

enum glint_status compositor_draw_layer(struct compositor *compositor,
                                        bool is_deep, float *rgb)
{
    const double start = tool_seconds();
    enum glint_status status;

    if (is_deep && compositor->n_lamps > 0)
        status = glint_frame_draw_alone(
            &compositor->frame, compositor->lamp, compositor->n_lamps,
            compositor_scale(compositor), rgb, &compositor->report);
    else
        status = draw_as_for_codes(compositor, rgb);
    compositor_drawn(compositor);
    compositor->flare_ms = 1e3 * (tool_seconds() - start);
    return status;
}

/* -------------------------------------------------------------------- veil */

/* Returns what lamp I, which the finder found, has over what the picture shows
 * of it where nothing of the scene hides it, of a video followed from the last
 * frame by a third of a second: what is estimated of a lamp that clips may jump
 * for a frame. */
static double excess_found(const struct compositor *compositor, int i,
                           int32_t elapsed_us)
{
    const double excess = glint_lamp_excess(
        &compositor->lamp[i], &compositor->finder.track[i],
        compositor->level[i], compositor->share[i], compositor->white);
    const double k = 1 - exp(-3e-6 * elapsed_us);

    for (int j = 0; j < compositor->n_before && elapsed_us > 0; j++)
        if (compositor->id_before[j] == compositor->id[i])
            return compositor->excess_before[j] +
                   k * (excess - compositor->excess_before[j]);
    return excess;
}

void compositor_veil(struct compositor *compositor, int32_t elapsed_us)
{
    struct glint_frame_veil *veil = &compositor->frame.veil;
    const struct settings *s = &compositor->settings;
    const bool found = !compositor->is_listed && compositor->n_hand == 0;
    /* each frame anew: keys may turn a gain down to 0, and up again */
    const bool is_on =
        s->options.gain > 0 && (s->options.only == GLINT_ONLY_VEIL ||
                                s->options.only == GLINT_ONLY_ALL);
    const size_t n = (size_t)compositor->n_lamps;

    for (int i = 0; i < compositor->n_lamps; i++)
        compositor->excess[i] =
            found && i < compositor->n_own
                ? excess_found(compositor, i, elapsed_us)
                : compositor->lamp[i].power / compositor->share[i];
    memcpy(compositor->excess_before, compositor->excess,
           n * sizeof *compositor->excess);
    memcpy(compositor->id_before, compositor->id, n * sizeof *compositor->id);
    compositor->n_before = compositor->n_lamps;
    for (int i = 0; i < compositor->n_lamps; i++)
        compositor->excess[i] *= compositor->share[i];
    veil->excess = compositor->excess;
    veil->alone_gain = 1;
    veil->glare = is_on ? s->options.veil : 0;
    veil->haze = is_on ? s->options.haze : 0;
    veil->front = is_on ? s->front.dirt : NULL;
}
