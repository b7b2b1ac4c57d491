/* SPDX-License-Identifier: MIT */
#include "flare/edges/outline.h"

#include "base/divide.h"
#include "base/q.h"

enum { TO_Q16 = 16 - GLINT_VERTEX_FRAC, STRIP_HALF_Q16 = 1 << 11 };

/* --------------------------------------------------------------- functions */

int64_t glint_disc_evaluate_function_q16(const struct glint_vertex *v)
{
    const int64_t x = v->stop_x_q16 / 2, y = v->stop_y_q16 / 2;

    return q_clamp_sat((INT64_C(1) << 15) - q_shift(x * x + y * y, 15),
                       -(1 << 30), 1 << 30);
}

/* A point 2^14 stop radii away has a function value of 2^31. Times 2^30 the
 * value fits into 64 bits. */
int64_t glint_arc_compute_signed_distance_q16(const struct glint_stop *stop,
                                              int64_t straight_q16,
                                              int64_t disc_q16)
{
    return q_shift(straight_q16 * stop->off_q30 + disc_q16 * stop->round_q30,
                   30);
}

/* Sets VALUE[i] to the distance of corner AT[i], i below N, from side SIDE of
 * the stop, stop radii, positive inside. For round sides, DISC[i] must be (1 -
 * r^2) / 2 with r the distance of AT[i] from the stop's centre
 * (glint_disc_evaluate_function_q16()). */
static void compute_side_distances(const struct glint_stop *stop, int side,
                                   const struct glint_vertex *const *at, int n,
                                   const int64_t *disc, int64_t *value)
{
    for (int i = 0; i < n; i++) {
        value[i] = glint_side_compute_straight_distance_q16(stop, side, at[i]);
        if (stop->round_q30)
            value[i] =
                glint_arc_compute_signed_distance_q16(stop, value[i], disc[i]);
    }
}

/* ---------------------------------------------------------------- classify */

enum side { OUTSIDE, CUT, INSIDE };

static enum side classify_corner_values(const int64_t *value, int n)
{
    int inside = 0;

    for (int i = 0; i < n; i++)
        inside += value[i] >= 0;
    return inside == n ? INSIDE : inside ? CUT : OUTSIDE;
}

static enum side get_outermost_side(enum side a, enum side b)
{
    return a < b ? a : b;
}

static enum side classify_by_barrels(const struct glint_corners *c)
{
    enum side all = INSIDE;

    for (int barrel = 0; barrel < 2; barrel++) {
        int64_t value[4];

        for (int i = 0; i < c->n; i++)
            value[i] = glint_barrel_evaluate_function_q16(barrel, c->at[i]);
        all = get_outermost_side(all, classify_corner_values(value, c->n));
    }
    return all;
}

/* Returns whether a primitive lies inside a round stop, lies outside, or is cut
 * by the stop's outline. The circle may bulge into a primitive whose corners
 * all lie outside. So only primitives far outside count as OUTSIDE. */
static enum side classify_by_disc(const struct glint_corners *c,
                                  const struct glint_stop *stop)
{
    int64_t value[4];
    enum side side;

    for (int i = 0; i < c->n; i++)
        value[i] = glint_disc_evaluate_function_q16(c->at[i]) - stop->inset_q16;
    side = classify_corner_values(value, c->n);
    if (side != OUTSIDE)
        return side;
    for (int i = 0; i < c->n; i++)
        value[i] += 1 << 14;
    return get_outermost_side(CUT, classify_corner_values(value, c->n));
}

static enum side classify_by_stop(const struct glint_corners *c,
                                  const struct glint_stop *stop)
{
    enum side all = INSIDE;
    int64_t disc[4] = {0}, value[4];

    if (stop->n_blades == 0)
        return classify_by_disc(c, stop);
    for (int i = 0; i < c->n && stop->round_q30; i++)
        disc[i] = glint_disc_evaluate_function_q16(c->at[i]);
    for (int side = 0; side < stop->n_blades && all != OUTSIDE; side++) {
        compute_side_distances(stop, side, c->at, c->n, disc, value);
        all = get_outermost_side(all, classify_corner_values(value, c->n));
    }
    return all;
}

int glint_outline_classify_primitive(const struct glint_corners *corners,
                                     const struct glint_stop *stop)
{
    const enum side at_barrel = classify_by_barrels(corners);
    const enum side at_stop =
        at_barrel == OUTSIDE ? OUTSIDE : classify_by_stop(corners, stop);

    if (at_stop == OUTSIDE)
        return -1;
    return (at_stop == CUT ? GLINT_CUT_STOP : 0) |
           (at_barrel == CUT ? GLINT_CUT_BARREL : 0);
}

/* --------------------------------------------------------------------- cut */

static int64_t interpolate_at_uv(const int64_t *value_q16,
                                 const struct glint_uv *p)
{
    return value_q16[0] + q_shift((value_q16[1] - value_q16[0]) * p->u_q28 +
                                      (value_q16[2] - value_q16[0]) * p->v_q28,
                                  28);
}

/* Returns where a linear function, FA at A and FB at B, is zero. Products are
 * below 2^28 times 2^33. */
static int32_t find_zero_coordinate(int32_t a_q28, int32_t b_q28, int64_t fa,
                                    int64_t fb)
{
    return a_q28 + (int32_t)q_divide((b_q28 - a_q28) * fa, fa - fb);
}

/* Clips polygon O by a half plane, which is the set of points where a linear
 * function is 0 or more. VALUE has the values of that function at the corners
 * of the triangle. */
static void clip_by_half_plane(struct glint_outline *o,
                               const int64_t *value_q16)
{
    int64_t here, next;
    int n = 0;

    if (o->n == 0 || classify_corner_values(value_q16, 3) == INSIDE)
        return;
    o->uv[o->n] = o->uv[0];
    here = interpolate_at_uv(value_q16, &o->uv[0]);
    for (int i = 0; i < o->n; i++, here = next) {
        const struct glint_uv *a = &o->uv[i], *b = &o->uv[i + 1];

        next = interpolate_at_uv(value_q16, b);
        if (here >= 0)
            o->kept[n++] = *a;
        if ((here >= 0) != (next >= 0))
            o->kept[n++] = (struct glint_uv){
                find_zero_coordinate(a->u_q28, b->u_q28, here, next),
                find_zero_coordinate(a->v_q28, b->v_q28, here, next)};
    }
    o->n = n < 3 ? 0 : n;
    for (int i = 0; i < o->n; i++)
        o->uv[i] = o->kept[i];
}

static void clip_by_barrels(struct glint_outline *o,
                            const struct glint_vertex *const *at)
{
    for (int barrel = 0; barrel < 2; barrel++) {
        int64_t value[3];

        for (int i = 0; i < 3; i++)
            value[i] = glint_barrel_evaluate_function_q16(barrel, at[i]);
        clip_by_half_plane(o, value);
    }
}

/* Returns how far the function (1 - r^2) / 2 lies above the plane through its
 * values at the corners of the triangle AT, on average over the triangle. At
 * barycentric coordinates l this height is half the sum of l_i l_j |s_i -
 * s_j|^2, where s are stop positions. The mean of l_i l_j is 1/12. */
static int64_t compute_disc_bulge_q16(const struct glint_vertex *const *at)
{
    int64_t sum_q16 = 0;

    for (int i = 0; i < 3; i++) {
        const struct glint_vertex *a = at[i], *b = at[i < 2 ? i + 1 : 0];
        const int64_t dx = (int64_t)a->stop_x_q16 - b->stop_x_q16;
        const int64_t dy = (int64_t)a->stop_y_q16 - b->stop_y_q16;
        const int64_t one = 1 << 16;

        if (dx > one || dx < -one || dy > one || dy < -one)
            return 0; /* The approximation does not hold for such a large
                         triangle. */
        sum_q16 += (dx * dx + dy * dy) >> 16;
    }
    return sum_q16 / 24;
}

static void clip_by_stop(struct glint_outline *o,
                         const struct glint_vertex *const *at,
                         const struct glint_stop *stop, int lowered)
{
    const int64_t lift_q16 = lowered ? 0 : compute_disc_bulge_q16(at);
    const int64_t arc_lift_q16 =
        stop->round_q30 ? q_shift(lift_q16 * stop->round_q30, 30) : 0;
    int64_t disc[3] = {0}, value[3];

    for (int i = 0; i < 3 && (stop->n_blades == 0 || stop->round_q30); i++)
        disc[i] = glint_disc_evaluate_function_q16(at[i]);
    if (stop->n_blades == 0) {
        for (int i = 0; i < 3; i++)
            value[i] = disc[i] + lift_q16 - stop->inset_q16;
        clip_by_half_plane(o, value);
    }
    for (int side = 0; side < stop->n_blades; side++) {
        compute_side_distances(stop, side, at, 3, disc, value);
        for (int i = 0; i < 3; i++)
            value[i] += arc_lift_q16;
        clip_by_half_plane(o, value);
    }
}

/* Converts the corners of O from barycentric coordinates u, v to pixels.
 * Products are below 2^29 times 2^28. */
static void convert_corners_to_pixels(struct glint_outline *o,
                                      const struct glint_vertex *const *at)
{
    const int64_t ux = at[1]->x_q8 - at[0]->x_q8;
    const int64_t uy = at[1]->y_q8 - at[0]->y_q8;
    const int64_t vx = at[2]->x_q8 - at[0]->x_q8;
    const int64_t vy = at[2]->y_q8 - at[0]->y_q8;

    for (int i = 0; i < o->n; i++) {
        const int64_t u = o->uv[i].u_q28, v = o->uv[i].v_q28;

        o->x_q16[i] = at[0]->x_q8 * (INT64_C(1) << TO_Q16) +
                      q_shift(ux * u + vx * v, 28 - TO_Q16);
        o->y_q16[i] = at[0]->y_q8 * (INT64_C(1) << TO_Q16) +
                      q_shift(uy * u + vy * v, 28 - TO_Q16);
    }
}

/* Sets share_q28, the area of O divided by the area of the triangle, which is
 * 1/2 in u and v. Sets energy_q16, the mean energy of the corners of O. */
static void set_share_and_energy(struct glint_outline *o,
                                 const struct glint_vertex *const *at)
{
    const int64_t energy_q16[3] = {at[0]->energy_q16, at[1]->energy_q16,
                                   at[2]->energy_q16};
    const struct glint_uv *first = &o->uv[0];
    int64_t twice_q56 = 0, energy = 0;

    for (int i = 0; i < o->n; i++)
        energy += interpolate_at_uv(energy_q16, &o->uv[i]);
    for (int i = 1; i + 1 < o->n; i++) {
        const struct glint_uv *a = &o->uv[i], *b = &o->uv[i + 1];

        twice_q56 +=
            (int64_t)(a->u_q28 - first->u_q28) * (b->v_q28 - first->v_q28) -
            (int64_t)(a->v_q28 - first->v_q28) * (b->u_q28 - first->u_q28);
    }
    o->share_q28 = (int32_t)(twice_q56 >> 28);
    o->energy_q16 = (int32_t)(o->n ? energy / o->n : 0);
}

void glint_outline_clip_triangle(struct glint_outline *outline,
                                 const struct glint_corners *corners, int k,
                                 const struct glint_stop *stop, int cut)
{
    const struct glint_vertex *const at[3] = {
        corners->at[0], corners->at[k + 1], corners->at[k + 2]};
    const int32_t one_q28 = 1 << 28;

    outline->n = 3;
    outline->uv[0] = (struct glint_uv){0, 0};
    outline->uv[1] = (struct glint_uv){one_q28, 0};
    outline->uv[2] = (struct glint_uv){0, one_q28};
    if (cut & GLINT_CUT_BARREL)
        clip_by_barrels(outline, at);
    if (cut & GLINT_CUT_STOP)
        clip_by_stop(outline, at, stop, cut & GLINT_CUT_LOWERED);
    convert_corners_to_pixels(outline, at);
    set_share_and_energy(outline, at);
}

void glint_outline_set_unclipped(struct glint_outline *outline,
                                 const struct glint_corners *corners)
{
    int64_t energy_q16 = 0;

    outline->n = corners->n;
    for (int i = 0; i < corners->n; i++) {
        const struct glint_vertex *v = corners->at[i];

        outline->x_q16[i] = v->x_q8 * (INT64_C(1) << TO_Q16);
        outline->y_q16[i] = v->y_q8 * (INT64_C(1) << TO_Q16);
        energy_q16 += v->energy_q16;
    }
    outline->share_q28 = 1 << 28;
    outline->energy_q16 = (int32_t)(energy_q16 / corners->n);
}

/* ------------------------------------------------------------------- widen */

/* Lengthens the strip from A to B, which replaces a thin primitive, to the min
 * length of a strip. Coordinate 0 runs along the strip, with A[0] <= B[0].
 * Returns twice the strip's area, pixels^2. */
static int64_t lengthen_strip(int64_t a[2], int64_t b[2])
{
    const int64_t middle = (a[0] + b[0]) >> 1;

    if (b[0] - a[0] < 2 * STRIP_HALF_Q16) {
        a[0] = middle - STRIP_HALF_Q16;
        b[0] = middle + STRIP_HALF_Q16;
    }
    return 2 * (b[0] - a[0]) * 2 * STRIP_HALF_Q16;
}

int64_t glint_outline_replace_by_strip_q32(struct glint_outline *o)
{
    int left = 0, right = 0, top = 0, bottom = 0, flat;
    const int64_t *x = o->x_q16, *y = o->y_q16;
    int64_t a[2], b[2], area2_q32;

    for (int i = 1; i < o->n; i++) {
        left = x[i] < x[left] ? i : left;
        right = x[i] > x[right] ? i : right;
        top = y[i] < y[top] ? i : top;
        bottom = y[i] > y[bottom] ? i : bottom;
    }
    flat = x[right] - x[left] > y[bottom] - y[top];
    a[0] = flat ? x[left] : y[top], a[1] = flat ? y[left] : x[top];
    b[0] = flat ? x[right] : y[bottom], b[1] = flat ? y[right] : x[bottom];
    area2_q32 = lengthen_strip(a, b);
    o->n = 4;
    for (int i = 0; i < 4; i++) {
        /* The cyclic order of corners is the same in both cases: left, right,
         * right, left for a flat strip, and top, top, bottom, bottom for an
         * upright strip. */
        const int far = flat ? i == 1 || i == 2 : i >= 2;
        const int beyond = flat ? i >= 2 : i == 1 || i == 2;
        const int64_t along = far ? b[0] : a[0];
        const int64_t across =
            (far ? b[1] : a[1]) + (beyond ? STRIP_HALF_Q16 : -STRIP_HALF_Q16);

        o->x_q16[i] = flat ? along : across;
        o->y_q16[i] = flat ? across : along;
    }
    return area2_q32;
}
