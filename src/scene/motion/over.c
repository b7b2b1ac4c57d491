/* SPDX-License-Identifier: MIT */
#include "scene/motion/over.h"

#include "base/compiler.h"
#include "base/divide.h"

enum { ALL_Q8 = 256, MOST_HALF_Q8 = GLINT_LINE_MOST_HALF_Q8, SUMMED = 4 };

struct glint_box glint_layers_touch(const struct glint_scene *s,
                                    struct glint_box tile)
{
    struct glint_box all = {0, 0, 0, 0};

    for (int i = 0; i < s->motion->n_layers; i++)
        all = glint_box_join(all, glint_box_cut(tile, s->motion->layer[i].box));
    return all;
}

/* Confines X0 .. X1 - 1 to pixels of row Y that line L may touch. */
static void confine(const struct glint_scene *s,
                    const struct glint_motion_layer *l, int y, int *x0, int *x1)
{
    const int32_t down = glint_place(s, y, 1) - l->y_q8;
    const int32_t *u = l->along_q14;
    const int64_t reach =
        (int64_t)(q_smaller(MOST_HALF_Q8,
                            q_larger(l->half_q8[0], l->half_q8[1])) +
                  128)
        << 14;
    int64_t at[2];

    if (q_magnitude(u[1]) < 1 << 8) /* it runs along the row */
        return;
    for (int k = 0; k < 2; k++)
        at[k] = q_divide((int64_t)down * u[0] + (k ? reach : -reach), u[1]) +
                l->x_q8 + 128 * (s->view.width - 1);
    if (at[0] > at[1]) {
        const int64_t swap = at[0];

        at[0] = at[1];
        at[1] = swap;
    }
    *x0 = q_larger(*x0, q_clamp_sat((at[0] >> 8) - 1, 0, INT32_MAX));
    *x1 = q_smaller(*x1, q_clamp_sat((at[1] >> 8) + 2, 0, INT32_MAX));
}

void glint_layers_list(struct glint_scene_worker *w, int y)
{
    const struct glint_motion_state *m = w->scene->motion;

    w->n_spans = 0;
    for (int i = 0; i < m->n_layers; i++) {
        const struct glint_box b = glint_box_cut(w->tile, m->layer[i].box);
        struct glint_layer_span span = {i, m->layer[i].kind, b.x0, b.x1};

        if (y < b.y0 || y >= b.y1)
            continue;
        if (!m->layer[i].ball)
            confine(w->scene, &m->layer[i], y, &span.x0, &span.x1);
        else if (!glint_scene_span(w->scene, m->layer[i].ball, y, &span.x0,
                                   &span.x1))
            continue;
        if (span.x0 < span.x1)
            w->span[w->n_spans++] = span;
    }
}

/* Returns the share of the samples of a pixel that see nothing nearer than
 * DEPTH, q8. */
static int seen_q8(const struct glint_scene_worker *w, int x, int y,
                   int32_t depth)
{
    const int n = w->scene->cfg.edge_samples;
    const int first = glint_sample_index(w, x, y, 0);
    int seen = 0;

    for (int k = 0; k < n; k++)
        seen += w->depth[first + k] <= depth;
    return seen * ALL_Q8 >> glint_samples_log2(n);
}

/* Returns what of pixel (X, Y) line L covers, q8. */
static int line_q8(const struct glint_scene_worker *w,
                   const struct glint_motion_layer *l, int x, int y)
{
    const int64_t dx = glint_place(w->scene, x, 0) - l->x_q8;
    const int64_t dy = glint_place(w->scene, y, 1) - l->y_q8;
    const int32_t along =
        (int32_t)q_shift(dx * l->along_q14[0] + dy * l->along_q14[1], 14);
    const int32_t across = (int32_t)q_magnitude(
        q_shift(dx * l->along_q14[1] - dy * l->along_q14[0], 14));
    const int32_t end =
        q_smaller(ALL_Q8, q_smaller(along, l->length_q8 - along) + 128);
    const int32_t most =
        q_larger(l->half_q8[0], l->half_q8[1]); /* below 2^30 */
    int32_t part_q30, half, cover;

    if (end <= 0 || across >= most + 128)
        return 0;
    part_q30 = q_part_q30((uint64_t)q_smaller(q_larger(along, 0), l->length_q8),
                          (uint64_t)l->length_q8);
    half = l->half_q8[0] + q_mul(l->half_q8[1] - l->half_q8[0], part_q30, 30);
    half = q_smaller(MOST_HALF_Q8, half);
    cover = q_smaller(q_smaller(ALL_Q8, 2 * half), half + 128 - across);
    if (cover <= 0)
        return 0;
    return (cover * end >> 8) *
               seen_q8(w, x, y,
                       l->depth[0] +
                           q_mul(l->depth[1] - l->depth[0], part_q30, 30)) >>
           8;
}

/* Returns the depth of what is T steps away towards SEEN_Q30. */
static int32_t depth_of(const struct glint_scene *s, int32_t t,
                        const int32_t seen_q30[3])
{
    const int32_t z = t <= 0 ? 1 : q_larger(1, q_mul(t, seen_q30[2], 30));

    return q_larger(1, glint_ratio((uint64_t)s->nearest << 30, (uint64_t)z));
}

/* Sets CHORD to that of the ray of place (X, Y) in BALL, and DEPTH to that of
 * where it enters; returns 0 if it misses it. */
static int enter(const struct glint_scene *s, const struct glint_placed *ball,
                 int32_t x_q8, int32_t y_q8, struct glint_chord *chord,
                 int32_t *depth)
{
    struct glint_scene_ray ray;
    int32_t seen_q30[3];

    glint_view_ray(&s->view, x_q8, y_q8, &ray, seen_q30);
    if (!glint_ray_sphere(&ray, ball->at, ball->radius, chord) ||
        chord->t[1] <= 0)
        return 0;
    *depth = depth_of(s, chord->t[0], seen_q30);
    return 1;
}

/* Returns the share of pixels that a shell of COSINE_Q15 covers, q15: as much
 * as its material does not let pass at the rim, half of that in its middle.
 * Both factors are taken twice. */
static int64_t shell_q31(const struct glint_scene *s,
                         const struct glint_motion_layer *l, int32_t cosine_q15)
{
    const int32_t share_q15 =
        GLINT_SCENE_ONE_Q15 - s->material[l->material].pass_q15;

    return (int64_t)share_q15 * (2 * GLINT_SCENE_ONE_Q15 - cosine_q15);
}

/* Returns what of pixel (X, Y) a shell covers, q8, near its rim, or with the
 * camera in it. */
static NEVER_INLINE int rim_q8(const struct glint_scene_worker *w,
                               const struct glint_motion_layer *l, int x, int y)
{
    const struct glint_scene *s = w->scene;
    const struct glint_placed *ball = l->ball;
    const int n = s->cfg.edge_samples;
    const int32_t x_q8 = glint_place(s, x, 0), y_q8 = glint_place(s, y, 1);
    struct glint_chord chord;
    int32_t depth = 0, cosine_q15 = 0;
    int hits = 0, is_inner = 0;

    if (enter(s, ball, x_q8, y_q8, &chord, &depth)) {
        const int64_t radius = (int64_t)ball->radius * (INT64_C(1) << chord.up);
        const int64_t within =
            ((int64_t)ball->radius - ball->margin) * (INT64_C(1) << chord.up);

        cosine_q15 =
            q_part_q30((uint64_t)chord.half,
                       (uint64_t)(radius > chord.half ? radius : chord.half)) >>
            15;
        is_inner =
            within > 0 && v3_dot(chord.middle, chord.middle) <= within * within;
        hits = is_inner ? n : 0;
    }
    for (int k = 0; k < n && !is_inner; k++) {
        struct glint_chord at;
        int32_t sample_depth;

        if (!enter(s, ball, x_q8 + glint_sample(s, k, 0),
                   y_q8 + glint_sample(s, k, 1), &at, &sample_depth))
            continue;
        depth = q_larger(depth, sample_depth);
        hits++;
    }
    if (hits == 0)
        return 0;
    return (int)q_shift(
        (shell_q31(s, l, cosine_q15) * hits >> glint_samples_log2(n)) *
            seen_q8(w, x, y, depth),
        31);
}

/* Returns whether no sample of pixel (X, Y) sees anything nearer than DEPTH. */
static int is_clear(const struct glint_scene_worker *w, int x, int y,
                    int32_t depth)
{
    const int32_t *at = &w->depth[glint_sample_index(w, x, y, 0)];
    int nearer = 0;

    for (int k = 0; k < w->scene->cfg.edge_samples; k++)
        nearer |= at[k] > depth;
    return !nearer;
}

/* Returns what of pixel (X, Y) a shell covers, q8. */
static int shell_q8(const struct glint_scene_worker *w,
                    const struct glint_motion_layer *l, int x, int y)
{
    const struct glint_scene *s = w->scene;
    struct glint_scene_ray ray;
    int32_t seen_q30[3], across_q30[3], cosine_q30, t;
    int all_q8 = ALL_Q8;

    if (!l->ball->over_up)
        return rim_q8(w, l, x, y);
    glint_quick_ray(&s->view, glint_place(s, x, 0), glint_place(s, y, 1), &ray,
                    seen_q30);
    if (!glint_quick_meet(l->ball, &ray, across_q30, &cosine_q30) ||
        cosine_q30 < l->inner_q30)
        return rim_q8(w, l, x, y);
    if (!is_clear(w, x, y, l->depth[0])) { /* by the shell's farthest point */
        t = glint_quick_away(l->ball, &ray, cosine_q30);
        all_q8 = seen_q8(w, x, y, depth_of(s, t, seen_q30));
    }
    return (int)q_shift(shell_q31(s, l, cosine_q30 >> 15) * all_q8, 31);
}

int glint_layers_next(struct glint_scene_worker *w, int x)
{
    int end = w->tile.x1;

    w->n_over = 0;
    for (int i = 0; i < w->n_spans; i++) {
        const struct glint_layer_span *span = &w->span[i];

        if (x < span->x0) {
            end = q_smaller(end, span->x0);
        } else if (x < span->x1) {
            end = q_smaller(end, span->x1);
            w->over[w->n_over++] = span->layer;
        }
    }
    return end;
}

void glint_layers_over(const struct glint_scene_worker *w, int x, int y,
                       struct glint_scene_sum *sum)
{
    const struct glint_scene *s = w->scene;

    for (int i = 0; i < w->n_over; i++) {
        const struct glint_motion_layer *l = &s->motion->layer[w->over[i]];
        const int32_t *rgb_q15 = s->material[l->material].rgb_q15;
        int a;

        a = l->ball ? shell_q8(w, l, x, y) : line_q8(w, l, x, y);
        if (a == 0)
            continue;
        for (int c = 0; c < 3; c++)
            sum->rgb_q17[c] = q_shift(sum->rgb_q17[c] * (ALL_Q8 - a) +
                                          (int64_t)SUMMED * rgb_q15[c] * a,
                                      8);
        sum->cover_q10 = (int)q_shift(
            sum->cover_q10 * (int64_t)(ALL_Q8 - a) + SUMMED * ALL_Q8 * a, 8);
    }
}
