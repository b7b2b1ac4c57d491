/* SPDX-License-Identifier: MIT */
#include "flare/ghost_edges.h"

#include "base/compiler.h"
#include "base/q.h"

enum { LOST = 4 }; /* of a node: no ray; bits 0 and 1 are the barrels */

typedef int32_t point_q8[2];

/* --------------------------------------------------------------------- edges
 */

/* Adds the edge A to B with LIGHT to its inner side and OTHER beyond, if it can
 * change a pixel. */
static void add_edge(struct glint_ghost_edges *g, const int32_t a_q8[2],
                     const int32_t b_q8[2], int32_t light, int32_t other)
{
    const int32_t right_q8 = g->width * 256, bottom_q8 = g->height * 256;
    struct glint_edge edge;

    if (light == other || (a_q8[1] <= 0 && b_q8[1] <= 0) ||
        (a_q8[1] >= bottom_q8 && b_q8[1] >= bottom_q8) ||
        (a_q8[0] >= right_q8 && b_q8[0] >= right_q8) || a_q8[1] == b_q8[1])
        return;
    if (g->n_edges++ >= g->max_edges)
        return;
    glint_edge_set(&edge, a_q8, b_q8, light, other);
    edge.bundle = g->number;
    g->edge[g->n_edges - 1] = edge;
}

/* --------------------------------------------------------------------- nodes
 */

/* Of the two rows that are there. */
static const struct glint_vertex *node(const struct glint_ghost_edges *g, int i,
                                       int j)
{
    return &g->row[j & 1][i];
}

static int vertex_valid(const struct glint_vertex *v)
{
    return v->energy_q16 >= 0 && v->x_q8 > -GLINT_VERTEX_LIMIT_Q8 &&
           v->x_q8 < GLINT_VERTEX_LIMIT_Q8 &&
           v->y_q8 > -GLINT_VERTEX_LIMIT_Q8 && v->y_q8 < GLINT_VERTEX_LIMIT_Q8;
}

static int64_t radius2_q32(const struct glint_vertex *v)
{
    return (int64_t)v->stop_x_q16 * v->stop_x_q16 +
           (int64_t)v->stop_y_q16 * v->stop_y_q16;
}

/* The sides that V lies on or outside of; of a round stop the only one. */
static uint64_t sides_of(const struct glint_stop *stop,
                         const struct glint_vertex *v)
{
    const int64_t apothem_q16 = stop->apothem_q16;
    uint64_t sides = 0;

    if (stop->n_blades == 0)
        return radius2_q32(v) >= INT64_C(1) << 32;
    if (radius2_q32(v) < (apothem_q16 - 1) * (apothem_q16 - 1))
        return 0;
    for (int k = 0; k < stop->n_blades; k++)
        sides |= (uint64_t)(glint_side_q16(stop, k, v) <= 0) << k;
    return sides;
}

static void set_nodes(struct glint_ghost_edges *g, int j)
{
    const int n = g->bundle->n_cells;
    uint64_t *sides = g->rows->sides[j & 1];
    uint8_t *barrels = g->rows->barrels[j & 1];

    if (g->transfer)
        glint_transfer_row(g->transfer, &g->place, n, j,
                           g->rows->vertex[j & 1]);
    g->row[j & 1] = g->transfer ? g->rows->vertex[j & 1]
                                : g->vertex + (ptrdiff_t)j * (n + 1);
    for (int i = 0; i <= n; i++) {
        const struct glint_vertex *v = node(g, i, j);

        if (!vertex_valid(v)) {
            sides[i] = 0;
            barrels[i] = LOST;
            continue;
        }
        sides[i] = sides_of(g->stop, v);
        barrels[i] = (uint8_t)((v->barrel_q16[0] >= 1 << 16) +
                               2 * (v->barrel_q16[1] >= 1 << 16));
    }
}

/* --------------------------------------------------------------------- parts
 */

/* What cuts: side K of the stop, or barrel K - BARREL. */
enum { BARREL = 64, NOTHING = -1 };

/* Positive inside. */
static int64_t cut_q16(const struct glint_ghost_edges *g, int cut,
                       const struct glint_vertex *v)
{
    return cut < BARREL ? glint_side_q16(g->stop, cut, v)
                        : glint_barrel_q16(cut - BARREL, v);
}

/* The visible part of the edge between two neighbouring nodes, from the one
 * that comes first in the grid. */
struct part {
    point_q8 end[2];
    int cut[2]; /* what ends it there, or NOTHING: the node itself */
    int visible;
};

struct interval {
    int64_t t_q30[2];
    int cut[2];
};

static void shorten(const struct glint_ghost_edges *g, struct interval *in,
                    int cut, const struct glint_vertex *a,
                    const struct glint_vertex *b)
{
    const int64_t fa = cut_q16(g, cut, a), fb = cut_q16(g, cut, b);
    int64_t t_q30;

    if (fa <= 0 && fb <= 0) {
        in->t_q30[1] = -1;
        return;
    }
    t_q30 = fa * (INT64_C(1) << 30) / (fa - fb); /* 2^31.5 times 2^30 */
    if (fa <= 0 && t_q30 >= in->t_q30[0]) {
        in->t_q30[0] = t_q30;
        in->cut[0] = cut;
    }
    if (fb <= 0 && t_q30 <= in->t_q30[1]) {
        in->t_q30[1] = t_q30;
        in->cut[1] = cut;
    }
}

static void place(const struct glint_vertex *a, const struct glint_vertex *b,
                  int64_t t_q30, int32_t at_q8[2])
{
    at_q8[0] =
        a->x_q8 + q_narrow(q_shift((b->x_q8 - (int64_t)a->x_q8) * t_q30, 30));
    at_q8[1] =
        a->y_q8 + q_narrow(q_shift((b->y_q8 - (int64_t)a->y_q8) * t_q30, 30));
}

static int lowest_bit(uint64_t x)
{
    return bit_length(x & (~x + 1)) - 1;
}

/* A node's cuts. */
struct outside {
    uint64_t sides;
    uint8_t barrels;
};

static void find_part(const struct glint_ghost_edges *g,
                      const struct glint_vertex *a, struct outside at_a,
                      const struct glint_vertex *b, struct outside at_b,
                      struct part *part)
{
    struct interval in = {{0, INT64_C(1) << 30}, {NOTHING, NOTHING}};

    part->visible =
        !(at_a.sides & at_b.sides) && !(at_a.barrels & at_b.barrels);
    if (!part->visible)
        return;
    for (uint64_t m = at_a.sides | at_b.sides; m; m &= m - 1)
        shorten(g, &in, lowest_bit(m), a, b);
    for (int k = 0; k < 2; k++)
        if ((at_a.barrels | at_b.barrels) >> k & 1)
            shorten(g, &in, BARREL + k, a, b);
    part->visible = in.t_q30[0] < in.t_q30[1];
    for (int k = 0; k < 2 && part->visible; k++) {
        place(a, b, in.t_q30[k], part->end[k]);
        part->cut[k] = in.cut[k];
    }
}

/* --------------------------------------------------------------------- cells
 */

struct cell {
    const struct glint_vertex *corner[4]; /* in order */
    struct outside at[4];
    struct outside any; /* of the four */
};

static void set_cell(const struct glint_ghost_edges *g, int i, int j,
                     struct cell *c)
{
    const struct glint_ghost_rows *r = g->rows;

    c->any = (struct outside){0, 0};
    for (int k = 0; k < 4; k++) {
        const int across = i + (k == 1 || k == 2), down = j + (k >= 2);

        c->corner[k] = node(g, across, down);
        c->at[k] = (struct outside){r->sides[down & 1][across],
                                    r->barrels[down & 1][across]};
        c->any.sides |= c->at[k].sides;
        c->any.barrels |= c->at[k].barrels;
    }
}

/* Sign of the turn at each corner, if it is the same at all four; else 0. */
static int convexity(const struct glint_corners *c)
{
    int64_t x[4], y[4], most = INT64_MIN, least = INT64_MAX;

    for (int i = 0; i < 4; i++) { /* sides */
        x[i] = (int64_t)c->at[(i + 1) & 3]->x_q8 - c->at[i]->x_q8;
        y[i] = (int64_t)c->at[(i + 1) & 3]->y_q8 - c->at[i]->y_q8;
    }
    for (int i = 0; i < 4; i++) {
        const int64_t turn = x[i] * y[(i + 1) & 3] - y[i] * x[(i + 1) & 3];

        most = turn > most ? turn : most;
        least = turn < least ? turn : least;
    }
    return least > 0 ? 1 : most < 0 ? -1 : 0;
}

/* X, below 2^44, to the nearest of STEPS steps per octave. */
static int64_t in_steps(int64_t x, int steps)
{
    const int log2 = bit_length((uint64_t)x) - 1;
    int64_t base;
    uint32_t k;

    if (steps == 0 || x <= steps)
        return x;
    base = INT64_C(1) << log2;
    k = (uint32_t)(((x - base) * steps + base / 2) >> log2);
    return base + (((int64_t)((k << 19) / (uint32_t)steps) << log2) >> 19);
}

/* The light of 2^SHARE_LOG2 cells over AREA2 / 2^FRAC pixels, as it is packed;
 * SIGN -1: of a mirrored one. */
static int32_t light_of(const struct glint_ghost_edges *g, int64_t area2,
                        int frac, int share_log2, int64_t energy_q16, int sign)
{
    const int64_t irradiance_q22 =
        glint_irradiance_q22(g->bundle, share_log2, area2, frac, g->limit_q8);

    return glint_light_pack(
        sign * in_steps(q_shift(irradiance_q22 * energy_q16, 18), g->steps));
}

/* ------------------------------------------------------------- by themselves
 */

/* The edges of OUTLINE, closed. */
static void add_outline(struct glint_ghost_edges *g,
                        const struct glint_outline *o, int32_t light)
{
    point_q8 first, last, here;

    for (int i = 0; i < o->n; i++) {
        here[0] = q_narrow(q_shift(o->x_q16[i], 8));
        here[1] = q_narrow(q_shift(o->y_q16[i], 8));
        if (i > 0)
            add_edge(g, last, here, light, 0);
        for (int k = 0; k < 2; k++) {
            last[k] = here[k];
            first[k] = i ? first[k] : here[k];
        }
    }
    if (o->n > 0)
        add_edge(g, last, first, light, 0);
}

/* What the cuts leave of a convex primitive, its light spread over at least a
 * strip. */
static void add_alone(struct glint_ghost_edges *g,
                      const struct glint_vertex *const *corner, int n,
                      int share_log2)
{
    struct glint_outline *o = &g->rows->outline;
    const struct glint_vertex *turned[4];
    struct glint_corners c;
    int cut, thin;

    glint_corners_set(&c, corner, n);
    for (int i = 0; i < n; i++)
        turned[i] = corner[c.area2_q16 >= 0 ? i : n - 1 - i];
    glint_corners_set(&c, turned, n);
    cut = glint_outline_classify(&c, g->stop);
    if (cut < 0 ||
        glint_box_empty(glint_corners_reach(&c, g->width, g->height)))
        return;
    thin = glint_corners_thin(&c);
    for (int k = 0; k < (cut ? n - 2 : 1); k++) {
        int64_t area2 = c.area2_q16, share_q28;
        int frac = 2 * GLINT_VERTEX_FRAC + 1, share = share_log2;

        if (cut)
            glint_outline_cut(o, &c, k, g->stop, cut);
        else
            glint_outline_whole(o, &c);
        if (o->n == 0)
            continue;
        share_q28 = 1 << 28;
        if (thin) {
            share_q28 = o->share_q28;
            share -= cut && n == 4;
            area2 = glint_outline_widen_q32(o);
            frac = 33;
        }
        add_outline(g, o,
                    light_of(g, area2, frac, share,
                             q_shift(o->energy_q16 * share_q28, 28), 1));
    }
}

/* A cell that is no convex quad: two triangles, or the one that is left. */
static void add_triangles(struct glint_ghost_edges *g, const struct cell *c)
{
    static const int half[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const struct glint_vertex *left[4];
    int n = 0;

    for (int k = 0; k < 4; k++)
        if (!(c->at[k].barrels & LOST))
            left[n++] = c->corner[k];
    g->n_dropped += n < 4;
    if (n == 3)
        add_alone(g, left, 3, -1);
    for (int k = 0; n == 4 && k < 2; k++) {
        const struct glint_vertex *const t[3] = {c->corner[half[k][0]],
                                                 c->corner[half[k][1]],
                                                 c->corner[half[k][2]]};

        add_alone(g, t, 3, -1);
    }
}

/* ----------------------------------------------------------------- in the grid
 */

/* The part of side K of a cell, in the cell's order: corner K to K + 1. */
static void part_of_side(const struct glint_ghost_edges *g,
                         const struct cell *c, int k, struct part *part)
{
    const int reverse = k >= 2, next = (k + 1) & 3;
    const int from = reverse ? next : k, to = reverse ? k : next;

    find_part(g, c->corner[from], c->at[from], c->corner[to], c->at[to], part);
    if (reverse) {
        const struct part forward = *part;

        for (int end = 0; end < 2; end++) {
            part->end[end][0] = forward.end[1 - end][0];
            part->end[end][1] = forward.end[1 - end][1];
            part->cut[end] = forward.cut[1 - end];
        }
    }
}

/* VALUE at the corners as middle + u along + v across, u and v -1/2 .. 1/2. */
struct plane {
    int64_t middle4, u2, v2; /* so many times as much */
};

static struct plane plane_of(const int64_t value[4])
{
    return (struct plane){value[0] + value[1] + value[2] + value[3],
                          value[1] - value[0] + value[2] - value[3],
                          value[3] - value[0] + value[2] - value[1]};
}

/* X / Y as q16, if it is within the cell or near. */
static int near_q16(int64_t x, int64_t y, int64_t *q16)
{
    const int wide = bit_length((uint64_t)(x < 0 ? -x : x));
    const int down = wide > 45 ? wide - 45 : 0;

    x >>= down;
    y >>= down;
    if (y == 0)
        return 0;
    *q16 = x * 65536 / y;
    return *q16 > -3 * 16384 && *q16 < 3 * 16384;
}

/* Where the cuts A and B cross within the cell. */
static int crossing(const struct glint_ghost_edges *g, const struct cell *c,
                    int a, int b, int32_t at_q8[2])
{
    int64_t fa[4], fb[4], x[4], y[4], u_q16, v_q16, det;
    struct plane pa, pb, px, py;
    uint64_t most = 0;
    int down;

    for (int k = 0; k < 4; k++) {
        const struct glint_vertex *v = c->corner[k];

        fa[k] = cut_q16(g, a, v);
        fb[k] = cut_q16(g, b, v);
        most |=
            (uint64_t)(fa[k] ^ fa[k] >> 63) | (uint64_t)(fb[k] ^ fb[k] >> 63);
        x[k] = v->x_q8;
        y[k] = v->y_q8;
    }
    down = bit_length(most) > 27 ? bit_length(most) - 27 : 0;
    for (int k = 0; k < 4; k++) { /* sums below 2^29, their products 2^58 */
        fa[k] >>= down;
        fb[k] >>= down;
    }
    pa = plane_of(fa);
    pb = plane_of(fb);
    /* middle4 / 4 + u u2 / 2 + v v2 / 2 = 0 for both: 2 u u2 + 2 v v2 =
     * -middle4 */
    det = 2 * (pa.u2 * pb.v2 - pb.u2 * pa.v2);
    if (!near_q16(pb.middle4 * pa.v2 - pa.middle4 * pb.v2, det, &u_q16) ||
        !near_q16(pa.middle4 * pb.u2 - pb.middle4 * pa.u2, det, &v_q16))
        return 0;
    px = plane_of(x);
    py = plane_of(y);
    at_q8[0] = q_narrow(
        q_shift(px.middle4 * 32768 + px.u2 * u_q16 + px.v2 * v_q16, 17));
    at_q8[1] = q_narrow(
        q_shift(py.middle4 * 32768 + py.u2 * u_q16 + py.v2 * v_q16, 17));
    return 1;
}

/* The chords of a cell that is cut: they link what is left of its sides. */
static void add_chords(struct glint_ghost_edges *g, const struct cell *c,
                       int32_t light)
{
    struct part part[4];
    int n = 0;

    for (int k = 0; k < 4; k++) {
        part_of_side(g, c, k, &part[n]);
        n += part[n].visible;
    }
    for (int k = 0; k < n; k++) {
        const struct part *here = &part[k];
        const struct part *next = &part[k + 1 < n ? k + 1 : 0];
        point_q8 corner;

        if (here->cut[1] != next->cut[0] && here->cut[1] != NOTHING &&
            next->cut[0] != NOTHING &&
            crossing(g, c, here->cut[1], next->cut[0], corner)) {
            add_edge(g, here->end[1], corner, light, 0);
            add_edge(g, corner, next->end[0], light, 0);
        } else
            add_edge(g, here->end[1], next->end[0], light, 0);
    }
}

static int n_cuts(struct outside o)
{
    int n = (o.barrels & 1) + (o.barrels >> 1 & 1);

    for (uint64_t m = o.sides; m && n < 3; m &= m - 1)
        n++;
    return n;
}

static int64_t mean_energy_q16(const struct glint_corners *c)
{
    return ((int64_t)c->at[0]->energy_q16 + c->at[1]->energy_q16 +
            c->at[2]->energy_q16 + c->at[3]->energy_q16 + 2) >>
           2;
}

/* The light of a cell that shares its sides with its neighbours; what is drawn
 * by itself has none. */
static int32_t shared_light(struct glint_ghost_edges *g, const struct cell *c)
{
    struct glint_corners corners;
    const int cuts = n_cuts(c->any);
    int turn;
    int32_t light;

    if (c->any.barrels & LOST) {
        add_triangles(g, c);
        return 0;
    }
    glint_corners_set(&corners, c->corner, 4);
    turn = convexity(&corners);
    if (turn == 0 && !glint_corners_tiny(&corners, 16)) {
        add_triangles(g, c);
        return 0;
    }
    if (turn == 0 || cuts > 2 || (cuts > 0 && g->stop->n_blades == 0) ||
        glint_corners_thin(&corners)) {
        add_alone(g, c->corner, 4, 0);
        return 0;
    }
    light = light_of(g, turn * corners.area2_q16, 2 * GLINT_VERTEX_FRAC + 1, 0,
                     mean_energy_q16(&corners), turn);
    if (cuts)
        add_chords(g, c, light);
    return light;
}

/* Whether the cell at (I, J) is convex and wide enough; then its light. */
static int is_plain(const struct glint_ghost_edges *g, int i, int j,
                    int32_t *light)
{
    const struct glint_vertex *const corner[4] = {
        node(g, i, j), node(g, i + 1, j), node(g, i + 1, j + 1),
        node(g, i, j + 1)};
    struct glint_corners corners;
    int turn;

    glint_corners_set(&corners, corner, 4);
    turn = convexity(&corners);
    if (turn == 0 || glint_corners_thin(&corners))
        return 0;
    *light = light_of(g, turn * corners.area2_q16, 2 * GLINT_VERTEX_FRAC + 1, 0,
                      mean_energy_q16(&corners), turn);
    return 1;
}

/* The cell at (I, J): nearly all lie outside of what is seen, or inside of it
 * all. */
static int32_t light_at(struct glint_ghost_edges *g, int i, int j)
{
    const struct glint_ghost_rows *r = g->rows;
    const uint64_t *s = r->sides[j & 1] + i, *t = r->sides[~j & 1] + i;
    const uint8_t *a = r->barrels[j & 1] + i, *b = r->barrels[~j & 1] + i;
    const int any = a[0] | a[1] | b[0] | b[1];
    struct cell cell;
    int32_t light;

    if (!(any & LOST) &&
        ((s[0] & s[1] & t[0] & t[1]) | (a[0] & a[1] & b[0] & b[1])))
        return 0;
    if (!any && !(s[0] | s[1] | t[0] | t[1]) && is_plain(g, i, j, &light))
        return light;
    set_cell(g, i, j, &cell);
    return shared_light(g, &cell);
}

/* The visible part of the edge A to B, between the lights of two cells. */
static void add_shared(struct glint_ghost_edges *g,
                       const struct glint_vertex *a, struct outside at_a,
                       const struct glint_vertex *b, struct outside at_b,
                       int32_t light, int32_t other)
{
    struct part part;

    if (light == other)
        return;
    if (!(at_a.sides | at_b.sides) && !(at_a.barrels | at_b.barrels)) {
        const point_q8 from = {a->x_q8, a->y_q8}, to = {b->x_q8, b->y_q8};

        add_edge(g, from, to, light, other);
        return;
    }
    find_part(g, a, at_a, b, at_b, &part);
    if (part.visible)
        add_edge(g, part.end[0], part.end[1], light, other);
}

static struct outside outside_at(const struct glint_ghost_edges *g, int i,
                                 int j)
{
    return (struct outside){g->rows->sides[j & 1][i],
                            g->rows->barrels[j & 1][i]};
}

/* The edges between two rows of cells; the nodes of row J. */
static void add_level(struct glint_ghost_edges *g, int j, const int32_t *above,
                      const int32_t *below)
{
    for (int i = 0; i < g->bundle->n_cells; i++)
        if (above[i] != below[i])
            add_shared(g, node(g, i, j), outside_at(g, i, j), node(g, i + 1, j),
                       outside_at(g, i + 1, j), below[i], above[i]);
}

/* The edges between the cells of row J. */
static void add_upright(struct glint_ghost_edges *g, int j,
                        const int32_t *light)
{
    const int n = g->bundle->n_cells;

    for (int i = 0; i <= n; i++) {
        const int32_t before = i > 0 ? light[i - 1] : 0;
        const int32_t behind = i < n ? light[i] : 0;

        if (before != behind)
            add_shared(g, node(g, i, j), outside_at(g, i, j), node(g, i, j + 1),
                       outside_at(g, i, j + 1), before, behind);
    }
}

void glint_ghost_edges_emit(struct glint_ghost_edges *ghost)
{
    struct glint_ghost_rows *r = ghost->rows;
    const int n = ghost->bundle->n_cells;

    ghost->n_edges = ghost->n_dropped = 0;
    set_nodes(ghost, 0);
    for (int i = 0; i < n; i++)
        r->light[1][i] = 0;
    for (int j = 0; j < n; j++) {
        int32_t *here = r->light[j & 1], *above = r->light[~j & 1];

        set_nodes(ghost, j + 1);
        for (int i = 0; i < n; i++)
            here[i] = light_at(ghost, i, j);
        add_level(ghost, j, above, here);
        add_upright(ghost, j, here);
    }
    for (int i = 0; i < n; i++)
        r->light[n & 1][i] = 0;
    add_level(ghost, n, r->light[~n & 1], r->light[n & 1]);
}
