/* SPDX-License-Identifier: MIT */
#include "flare/window.h"

#include "base/divide.h"
#include "base/q.h"
#include "base/real.h"

enum {
    ACROSS = GLINT_WINDOW_ACROSS,
    DOWN = GLINT_WINDOW_DOWN,
    MOST_PASSES = 8,
    ONE_NODE_Q16 = 1 << 16,
    LEAST_HALF_Q30 = 1 << 12
};

/* A rectangle within the window of a ray bundle. The unit is the distance
 * between nodes of its grid; the origin is the first node. */
struct extent {
    int32_t low_q16[2], high_q16[2]; /* [across, down] */
};

/* -------------------------------------------------------------------- nodes */

static int is_barrel_output(int kind)
{
    return kind >= GLINT_OUT_RADIUS;
}

static int has_transfer_output(const struct glint_transfer *t, int kind)
{
    return t->outputs >> kind & 1;
}

static void trace_window_nodes(struct glint_window_nodes *n,
                               struct glint_transfer *t)
{
    const uint32_t outputs = t->outputs;

    /* The positions on the sensor and the energies do not affect the result, so
     * they are not computed. */
    t->outputs &=
        ~(UINT32_C(1) << GLINT_OUT_SENSOR_X |
          UINT32_C(1) << GLINT_OUT_SENSOR_Y | UINT32_C(1) << GLINT_OUT_ENERGY);
    for (int j = 0; j < DOWN; j++) {
        const int32_t v_q30 = glint_transfer_v(t, j, DOWN - 1);

        for (int first = 0; first < ACROSS; first += GLINT_RAYS) {
            int32_t u_q30[GLINT_RAYS], out[GLINT_OUT_KINDS][GLINT_RAYS];

            for (int i = 0; i < GLINT_RAYS; i++)
                u_q30[i] = glint_transfer_u(
                    t, (2 * (first + i) - (ACROSS - 1)) *
                           ((INT32_C(1) << 30) / (ACROSS - 1)));
            glint_transfer_rays(t, v_q30, u_q30, first == 0, out);
            for (int k = 0; k < GLINT_OUT_KINDS; k++)
                for (int i = 0; has_transfer_output(t, k) && i < GLINT_RAYS;
                     i++)
                    n->at[k][j][first + i] = out[k][i];
        }
    }
    t->outputs = outputs;
    n->n_rays += ACROSS * DOWN;
}

/* Returns 1/4 of the second difference of output K around node (I, J), which is
 * twice the deviation of the output from a straight line between nodes; at most
 * about 2^31, as values are below 2^30. */
static int64_t
compute_quarter_second_difference(const struct glint_window_nodes *n, int k,
                                  int i, int j)
{
    const int32_t(*at)[ACROSS] = n->at[k];
    const int x = i < 1 ? 1 : i > ACROSS - 2 ? ACROSS - 2 : i;
    const int y = j < 1 ? 1 : j > DOWN - 2 ? DOWN - 2 : j;
    const int64_t across =
        (int64_t)at[j][x - 1] - 2 * (int64_t)at[j][x] + at[j][x + 1];
    const int64_t down =
        (int64_t)at[y - 1][i] - 2 * (int64_t)at[y][i] + at[y + 1][i];

    return ((across < 0 ? -across : across) + (down < 0 ? -down : down)) / 4;
}

/* Returns a bit mask of those sides of the octagon around the stop for which
 * (X, Y) lies outside by more than BEND. */
static uint32_t find_outside_octagon_sides(int64_t x, int64_t y, int64_t radius,
                                           int64_t bend)
{
    const int64_t straight = radius + bend;
    const int64_t slanted = radius + radius * 106 / 256 + 2 * bend;

    return (uint32_t)((x > straight) | (x < -straight) << 1 |
                      (y > straight) << 2 | (y < -straight) << 3 |
                      (x + y > slanted) << 4 | (x + y < -slanted) << 5 |
                      (x - y > slanted) << 6 | (x - y < -slanted) << 7);
}

static void classify_node_by_stop(struct glint_window_nodes *n, int i, int j)
{
    const int64_t x = n->at[GLINT_OUT_STOP_X][j][i];
    const int64_t y = n->at[GLINT_OUT_STOP_Y][j][i];
    const int64_t bend_x =
        compute_quarter_second_difference(n, GLINT_OUT_STOP_X, i, j);
    const int64_t bend_y =
        compute_quarter_second_difference(n, GLINT_OUT_STOP_Y, i, j);
    const int64_t bend = bend_x > bend_y ? bend_x : bend_y;

    n->bend[j][i] = (int32_t)(bend < INT32_MAX ? bend : INT32_MAX);
    n->beyond[j][i] = find_outside_octagon_sides(x, y, n->radius, bend);
    n->inside[j][i] = x * x + y * y < n->radius * n->radius;
}

/* Sets a bit in n->beyond of each node for each barrel aperture outside of
 * which the node certainly lies: by more than the outputs deviate from straight
 * lines between nodes. */
static void classify_nodes_by_barrels(struct glint_window_nodes *n,
                                      const struct glint_transfer *t)
{
    for (int k = 0; k < GLINT_OUT_KINDS; k++) {
        int64_t one;

        if (!is_barrel_output(k) || !has_transfer_output(t, k))
            continue;
        one = real_integer(real_of(1, 0), -t->exponent[k], INT64_C(1) << 31);
        for (int j = 0; j < DOWN; j++)
            for (int i = 0; i < ACROSS; i++)
                n->beyond[j][i] |=
                    (uint32_t)(n->at[k][j][i] >
                               one + compute_quarter_second_difference(n, k, i,
                                                                       j))
                    << (8 + k);
    }
}

/* -------------------------------------------------------------------- cells */

static void extend_extent_to_point(struct extent *e, int32_t across_q16,
                                   int32_t down_q16)
{
    const int32_t at_q16[2] = {across_q16, down_q16};

    for (int k = 0; k < 2; k++) {
        if (at_q16[k] < e->low_q16[k])
            e->low_q16[k] = at_q16[k];
        if (at_q16[k] > e->high_q16[k])
            e->high_q16[k] = at_q16[k];
    }
}

/* Returns the distance between the position of node (I, J) in the stop and the
 * stop's centre, in units of the stop outputs. */
static int64_t
compute_distance_from_stop_centre(const struct glint_window_nodes *n, int i,
                                  int j)
{
    const int64_t x = n->at[GLINT_OUT_STOP_X][j][i];
    const int64_t y = n->at[GLINT_OUT_STOP_Y][j][i];

    return q_root((uint64_t)(x * x + y * y));
}

/* Extends E by a point where a grid line crosses the stop's circle. The line
 * runs from node (I, J), which must be inside, to a neighbouring node; nothing
 * changes if both are inside. WAY: direction to the neighbour, 0 across, 1
 * down; STEP: 1 or -1. */
static void extend_extent_to_circle(struct extent *e,
                                    const struct glint_window_nodes *n, int i,
                                    int j, int way, int step)
{
    const int i2 = i + (way == 0 ? step : 0), j2 = j + (way == 1 ? step : 0);
    int64_t here, there;
    int32_t part_q16;

    if (n->inside[j2][i2])
        return;
    here = compute_distance_from_stop_centre(n, i, j);
    there = compute_distance_from_stop_centre(n, i2, j2);
    part_q16 =
        (int32_t)q_divide((n->radius - here) * ONE_NODE_Q16, there - here + 1) *
        step;
    extend_extent_to_point(e, i * ONE_NODE_Q16 + (way == 0 ? part_q16 : 0),
                           j * ONE_NODE_Q16 + (way == 1 ? part_q16 : 0));
}

/* Returns whether the cell at (I, J) is small compared with the stop and nearly
 * flat. Only in such cells is the circle of the stop located exactly. */
static int is_cell_small_and_flat(const struct glint_window_nodes *n, int i,
                                  int j)
{
    int64_t size = 0, bend = 0;

    for (int k = GLINT_OUT_STOP_X; k <= GLINT_OUT_STOP_Y; k++) {
        int64_t low = INT32_MAX, high = -INT32_MAX;

        for (int corner = 0; corner < 4; corner++) {
            const int x = i + (corner & 1), y = j + (corner >> 1);

            low = n->at[k][y][x] < low ? n->at[k][y][x] : low;
            high = n->at[k][y][x] > high ? n->at[k][y][x] : high;
            bend = n->bend[y][x] > bend ? n->bend[y][x] : bend;
        }
        size = high - low > size ? high - low : size;
    }
    return 3 * size < n->radius && 16 * bend < n->radius;
}

static void extend_extent_by_cell(struct extent *e,
                                  const struct glint_window_nodes *n, int i,
                                  int j)
{
    if (n->beyond[j][i] & n->beyond[j][i + 1] & n->beyond[j + 1][i] &
        n->beyond[j + 1][i + 1])
        return;
    if (!is_cell_small_and_flat(n, i, j)) {
        extend_extent_to_point(e, i * ONE_NODE_Q16, j * ONE_NODE_Q16);
        extend_extent_to_point(e, (i + 1) * ONE_NODE_Q16,
                               (j + 1) * ONE_NODE_Q16);
        return;
    }
    for (int corner = 0; corner < 4; corner++) {
        const int right = corner & 1, low = corner >> 1;

        if (!n->inside[j + low][i + right])
            continue;
        extend_extent_to_point(e, (i + right) * ONE_NODE_Q16,
                               (j + low) * ONE_NODE_Q16);
        extend_extent_to_circle(e, n, i + right, j + low, 0, right ? -1 : 1);
        extend_extent_to_circle(e, n, i + right, j + low, 1, low ? -1 : 1);
    }
}

/* Returns the rectangle of the window of T that contains all rays that may pass
 * the stop and the barrel apertures. */
static struct extent find_transmitted_extent(struct glint_window_nodes *n,
                                             struct glint_transfer *t)
{
    struct extent e = {{INT32_MAX, INT32_MAX}, {-1, -1}};

    trace_window_nodes(n, t);
    for (int j = 0; j < DOWN; j++)
        for (int i = 0; i < ACROSS; i++)
            classify_node_by_stop(n, i, j);
    classify_nodes_by_barrels(n, t);
    for (int j = 0; j < DOWN - 1; j++)
        for (int i = 0; i < ACROSS - 1; i++)
            extend_extent_by_cell(&e, n, i, j);
    return e;
}

/* ------------------------------------------------------------------- window */

/* Extends E along axis K (0 across, 1 down) by 1 / PART of its size at both
 * ends, but not outside 0 .. STEPS. A circle that spans six or more cells
 * bulges by 1/100 of its size between the lines of the grid. */
static void enlarge_extent_along_axis(struct extent *e, int k, int steps,
                                      int part)
{
    const int32_t most_q16 = steps * ONE_NODE_Q16;
    const int32_t more_q16 = (e->high_q16[k] - e->low_q16[k]) / part + 1;

    e->low_q16[k] -= more_q16;
    e->high_q16[k] += more_q16;
    e->low_q16[k] = e->low_q16[k] > 0 ? e->low_q16[k] : 0;
    e->high_q16[k] = e->high_q16[k] < most_q16 ? e->high_q16[k] : most_q16;
}

/* Narrows the window of T to E, a rectangle within it. Returns whether width or
 * height shrank by more than an eighth. */
static int narrow_window_to_extent(struct glint_transfer *t, struct extent *e)
{
    struct glint_box_window *w = &t->window;
    const struct glint_box_window old = *w;
    const int64_t wide_q16 = (int64_t)(ACROSS - 1) << 16;
    const int64_t high_q16 = (int64_t)(DOWN - 1) << 16;
    const int64_t high_q30 = (int64_t)old.v_to_q30 - old.v_from_q30;
    const int64_t left = e->low_q16[0], right = e->high_q16[0];

    w->u_middle_q30 += q_narrow(
        q_divide(old.u_half_q30 * (left + right - wide_q16), wide_q16));
    w->u_half_q30 =
        q_narrow(q_divide(old.u_half_q30 * (right - left), wide_q16));
    w->v_to_q30 = q_narrow(old.v_from_q30 +
                           q_divide(high_q30 * e->high_q16[1], high_q16));
    if (t->annulus || t->whole)
        w->v_from_q30 += q_narrow(q_divide(high_q30 * e->low_q16[1], high_q16));
    return 8 * (int64_t)w->u_half_q30 < 7 * (int64_t)old.u_half_q30 ||
           8 * ((int64_t)w->v_to_q30 - w->v_from_q30) < 7 * high_q30;
}

int glint_window_narrow_to_stop(struct glint_window_nodes *nodes,
                                struct glint_transfer *t, int32_t opening_q30)
{
    int more = 1;

    nodes->radius =
        real_integer(real_of(opening_q30, -30), -t->exponent[GLINT_OUT_STOP_X],
                     INT64_C(1) << 30);
    nodes->radius += !nodes->radius;
    nodes->n_rays = 0;
    for (int pass = 0; more && pass < MOST_PASSES; pass++) {
        struct extent e = find_transmitted_extent(nodes, t);

        if (e.high_q16[0] < 0)
            return 0;
        enlarge_extent_along_axis(&e, 0, ACROSS - 1, 48);
        enlarge_extent_along_axis(&e, 1, DOWN - 1,
                                  24); /* 1/24, not 1/48, as E covers half of
                                          the window's height */
        more =
            narrow_window_to_extent(t, &e) &&
            t->window.u_half_q30 > LEAST_HALF_Q30 &&
            (int64_t)t->window.v_to_q30 - t->window.v_from_q30 > LEAST_HALF_Q30;
    }
    return 1;
}
