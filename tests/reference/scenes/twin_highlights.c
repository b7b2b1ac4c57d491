/* SPDX-License-Identifier: MIT */
#include "reference/scenes/twin_highlights.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#define SIDE 8
#define NEAR 12 /* min distance of distinct highlights, pixels */

/* Sums over a square of pixels, or over the squares of a highlight: light,
 * light times position, light times squared position. */
struct sums {
    double flux, at[2], square, rgb[3];
    int n;
};

struct square {
    struct sums sums;
    bool is_taken;
};

struct squares {
    int across, down;
    struct square *of; /* [down][across] */
};

static void add_sums_to_highlight(struct sums *to, const struct sums *from)
{
    to->flux += from->flux;
    to->square += from->square;
    to->n += from->n;
    for (int k = 0; k < 2; k++)
        to->at[k] += from->at[k];
    for (int c = 0; c < 3; c++)
        to->rgb[c] += from->rgb[c];
}

/* Adds the light of the object that RAY hits, times SHARE, to pixel (X, Y). */
static void add_ray_light(const struct twin *twin, const struct twin_ray *ray,
                          int x, int y, double share, struct sums *to)
{
    const double at[2] = {x + .5, y + .5};
    struct twin_pixel seen;
    struct twin_hit hit;
    double light, weight;

    if (!reference_intersect_scene(twin, ray, HUGE_VAL, &hit))
        return;
    seen = reference_trace_ray(twin, ray);
    light = .2126 * (double)seen.rgb[0] + .7152 * (double)seen.rgb[1] +
            .0722 * (double)seen.rgb[2];
    weight = share * fmax(0, fmin(light - 1, 1));
    to->n = to->n || weight > 0;
    to->flux += weight * light;
    to->square += weight * light * (at[0] * at[0] + at[1] * at[1]);
    for (int k = 0; k < 2; k++)
        to->at[k] += weight * light * at[k];
    for (int c = 0; c < 3; c++)
        to->rgb[c] += weight * (double)seen.rgb[c];
}

static void sum_light_of_squares(const struct twin *twin,
                                 const struct twin_view *view,
                                 struct squares *q)
{
    const int n = view->samples;

    for (int y = 0; y < view->height; y++)
        for (int x = 0; x < view->width; x++)
            for (int k = 0; k < n * n; k++) {
                const int across = k % n, down = k / n;
                const double u = x + (across + .5) / n;
                const double v = y + (down + .5) / n;
                struct twin_ray ray;

                reference_make_camera_ray(twin, view, u, v, &ray);
                add_ray_light(twin, &ray, x, y, 1. / n / n,
                              &q->of[y / SIDE * q->across + x / SIDE].sums);
            }
}

/* Adds the sums of square (X, Y), and of all bright squares connected to it, to
 * TO. */
static void flood_fill_squares(struct squares *q, int x, int y, struct sums *to)
{
    struct square *s;

    if (x < 0 || y < 0 || x >= q->across || y >= q->down)
        return;
    s = &q->of[y * q->across + x];
    if (s->is_taken || !(s->sums.flux > 0))
        return;
    s->is_taken = true;
    add_sums_to_highlight(to, &s->sums);
    for (int k = 0; k < 9; k++)
        flood_fill_squares(q, x + k % 3 - 1, y + k / 3 - 1, to);
}

static bool are_highlights_within_merge_distance(const struct sums *a,
                                                 const struct sums *b)
{
    return hypot(a->at[0] / a->flux - b->at[0] / b->flux,
                 a->at[1] / a->flux - b->at[1] / b->flux) < NEAR;
}

static int compare_highlight_flux(const void *a, const void *b)
{
    const double p = ((const struct sums *)a)->flux;
    const double q = ((const struct sums *)b)->flux;

    return p < q ? 1 : p > q ? -1 : 0;
}

/* Merges highlights of S[N] that are nearer to each other than NEAR, the
 * fainter one into the brighter one. S is sorted by descending brightness.
 * Returns the number of remaining highlights. */
static int merge_near_highlights(struct sums *s, int n)
{
    for (int i = 0; i < n; i++)
        for (int k = i + 1; k < n; k++)
            if (are_highlights_within_merge_distance(&s[i], &s[k])) {
                add_sums_to_highlight(&s[i], &s[k]);
                s[k] = s[n - 1];
                qsort(s, (size_t)(n - 1), sizeof *s, compare_highlight_flux);
                return merge_near_highlights(s, n - 1);
            }
    return n;
}

static struct twin_highlight make_highlight_from_sums(const struct sums *s)
{
    struct twin_highlight h = {
        s->at[0] / s->flux, s->at[1] / s->flux, s->flux, {0}, 0, s->n};

    h.variance = s->square / s->flux - h.x * h.x - h.y * h.y;
    for (int c = 0; c < 3; c++)
        h.rgb[c] = s->rgb[c] / s->flux;
    return h;
}

static int find_highlights(struct squares *q, struct twin_highlight *found)
{
    struct sums s[TWIN_HIGHLIGHTS + 1];
    int n = 0;

    for (int y = 0; y < q->down; y++)
        for (int x = 0; x < q->across; x++) {
            struct sums next = {0};

            flood_fill_squares(q, x, y, &next);
            if (!(next.flux > 0))
                continue;
            s[n++] = next;
            qsort(s, (size_t)n, sizeof *s, compare_highlight_flux);
            n = n > TWIN_HIGHLIGHTS ? TWIN_HIGHLIGHTS : n;
        }
    n = merge_near_highlights(s, n);
    for (int i = 0; i < n; i++)
        found[i] = make_highlight_from_sums(&s[i]);
    return n;
}

int reference_find_highlights(const struct twin *twin,
                              const struct twin_view *view,
                              struct twin_highlight *found)
{
    struct squares q = {(view->width + SIDE - 1) / SIDE,
                        (view->height + SIDE - 1) / SIDE, NULL};
    struct twin seen = *twin;
    int n;

    q.of = calloc((size_t)q.across * (size_t)q.down, sizeof *q.of);
    if (!q.of)
        return -1;
    reference_set_pixel_size(&seen, view);
    sum_light_of_squares(&seen, view, &q);
    n = find_highlights(&q, found);
    free(q.of);
    return n;
}
