/* SPDX-License-Identifier: MIT */
#include "flare/edges/ghost_edges.h"

#include "base/compiler.h"
#include "base/q.h"
#include "flare/edges/ghost_shade.h"
#include "flare/edges/patch.h"

enum {
    OCTAVES = GLINT_LIGHT_OCTAVES,
    WHITE_LOG2 = 20 /* display white is 2^WHITE_LOG2, _q20 */
};

typedef int32_t point_q8[2];

/* ------------------------------------------------------------------- edges */

/* Returns whether the light on both sides of an edge, LIGHT and OTHER (packed),
 * differs so little that the edge may be pixel-snapped. */
static int is_light_change_weak(const struct glint_ghost_edges *g,
                                int32_t light, int32_t other)
{
    const int64_t a_q20 = glint_light_unpack_q20(light);
    const int64_t b_q20 = glint_light_unpack_q20(other);
    const uint64_t size = (uint64_t)(a_q20 < 0 ? -a_q20 : a_q20) |
                          (uint64_t)(b_q20 < 0 ? -b_q20 : b_q20) | 1;
    const int64_t change_q20 = a_q20 - b_q20;
    const int32_t weak_q20 = g->rows->weak_q20[bit_length(size) - 1];

    return change_q20 < weak_q20 && change_q20 > -weak_q20;
}

static void make_ghost_edge(const struct glint_ghost_edges *g,
                            struct glint_edge *edge, const int32_t a_q8[2],
                            const int32_t b_q8[2], int32_t light, int32_t other)
{
    glint_edge_set_from_points(edge, a_q8, b_q8, light, other);
    edge->bundle = g->number & 0x3fffffff;
    edge->patch = 0;
    if (is_light_change_weak(g, light, other))
        glint_edge_snap_to_pixels(edge);
}

/* Counts the bin entries of an edge that does not fit into the edge array: adds
 * their number to more_refs. */
static void count_edge_bin_entries(struct glint_ghost_edges *g,
                                   const int32_t a_q8[2], const int32_t b_q8[2],
                                   int32_t light, int32_t other)
{
    struct glint_edge edge;

    make_ghost_edge(g, &edge, a_q8, b_q8, light, other);
    g->more_refs += q_smaller(INT32_MAX - g->more_refs,
                              glint_edge_count_bin_entries(&edge, g->bins));
}

/* Stores the edge from A to B, unless it cannot change any pixel. LIGHT is the
 * light on its inner side, OTHER that on its outer side. */
static void add_ghost_edge(struct glint_ghost_edges *g, const int32_t a_q8[2],
                           const int32_t b_q8[2], int32_t light, int32_t other)
{
    const int32_t right_q8 = g->width * 256, bottom_q8 = g->height * 256;
    const int32_t top_q8 = g->top * 256;
    struct glint_edge edge;

    if (light == other || (a_q8[1] <= top_q8 && b_q8[1] <= top_q8) ||
        (a_q8[1] >= bottom_q8 && b_q8[1] >= bottom_q8) ||
        (a_q8[0] >= right_q8 && b_q8[0] >= right_q8) || a_q8[1] == b_q8[1])
        return;
    if (g->n_edges++ >= g->max_edges) {
        if (g->bins)
            count_edge_bin_entries(g, a_q8, b_q8, light, other);
        return;
    }
    make_ghost_edge(g, &edge, a_q8, b_q8, light, other);
    g->edge[g->n_edges - 1] = edge;
}

/* ------------------------------------------------------------------- cells */

static void set_cell_corners(const struct glint_ghost_edges *g, int i, int j,
                             struct glint_ghost_cell *c)
{
    const struct glint_ghost_rows *r = g->rows;

    for (int k = 0; k < 4; k++) {
        const int across = i + (k == 1 || k == 2), down = j + (k >= 2);

        c->corner[k] = get_ghost_node(g, across, down);
        c->at[k] = (struct glint_outside){r->sides[down & 1][across],
                                          r->barrels[down & 1][across] &
                                              (NODE_BARRELS | NODE_LOST)};
    }
}

/* Returns twice the signed area of the triangle of corners I, I + 1 and I + 2
 * of a cell, pixels^2. */
static int64_t compute_corner_double_area_q16(const struct glint_corners *c,
                                              int i)
{
    const struct glint_vertex *a = c->at[i], *b = c->at[i + 1];
    const struct glint_vertex *d = c->at[(i + 2) & 3];

    return glint_compute_cross_product_q16(a->x_q8, a->y_q8, b->x_q8, b->y_q8,
                                           d->x_q8, d->y_q8);
}

/* Returns the sign of the cell's area, 1 or -1, if the cell is convex, else 0.
 * The triangles at two opposite corners add up to the cell. */
static int find_convex_orientation(const struct glint_corners *c)
{
    const int64_t one = compute_corner_double_area_q16(c, 0),
                  other = c->area2_q16 - one;
    const int64_t two = compute_corner_double_area_q16(c, 1),
                  another = c->area2_q16 - two;

    if (one > 0 && other > 0 && two > 0 && another > 0)
        return 1;
    return one < 0 && other < 0 && two < 0 && another < 0 ? -1 : 0;
}

/* Sets the number of steps per octave to which irradiance is rounded, for each
 * octave. 8-bit codes resolve faint light more coarsely. With each octave by
 * which light gets fainter, the light of one code shrinks by only 2^(7/12), so
 * 3/4 of the steps of the octave above would suffice. 7/8 are used, as many
 * ghosts may overlap. */
static void set_irradiance_steps(struct glint_ghost_edges *g)
{
    int steps_q8 = g->steps * 256;

    for (int log2 = OCTAVES - 1; log2 >= 0; log2--) {
        g->rows->steps[log2] = (uint16_t)((steps_q8 + 255) >> 8);
        if (g->coded && log2 <= WHITE_LOG2)
            steps_q8 = steps_q8 > 256 + 32 ? steps_q8 / 8 * 7 : steps_q8;
    }
}

/* Sets, for each octave of light, the change of light below which an edge is
 * pixel-snapped. This change is snap_codes_q8 codes. With each octave below
 * white, the light of one code falls to 2/3, about 2^(-7/12). This continues
 * down to where codes are linear in light. */
static void set_snapping_limits(struct glint_ghost_edges *g)
{
    const int32_t least_q20 = 318;
    int32_t code_q20 = 9869; /* light of one code at white */

    for (int log2 = OCTAVES - 1; log2 >= 0; log2--) {
        g->rows->weak_q20[log2] =
            q_narrow((int64_t)code_q20 * g->snap_codes_q8 >> 8);
        if (log2 <= WHITE_LOG2)
            code_q20 =
                code_q20 * 2 / 3 > least_q20 ? code_q20 * 2 / 3 : least_q20;
    }
}

/* Returns irradiance X, below 2^44, rounded to the nearest step of its octave.
 * STEPS_OF[octave] is the number of steps per octave. */
static int64_t round_to_irradiance_step(int64_t x, const uint16_t *steps_of)
{
    const int log2 = bit_length((uint64_t)x | 1) - 1;
    const int steps = steps_of[log2];
    int64_t base;
    uint32_t k;

    if (steps == 0 || x <= steps)
        return x;
    base = INT64_C(1) << log2; /* NOLINT: x | 1 has a bit, so log2 >= 0 */
    k = (uint32_t)(((x - base) * steps + base / 2) >> log2);
    return base + (((int64_t)((k << 19) / (uint32_t)steps) << log2) >> 19);
}

int32_t glint_ghost_pack_cell_light(struct glint_ghost_edges *g,
                                    int64_t irradiance_q22, int64_t energy_q16,
                                    int sign)
{
    return glint_light_pack(
        sign * round_to_irradiance_step(
                   q_shift(irradiance_q22 * energy_q16, 18), g->rows->steps));
}

/* Returns the packed irradiance of a primitive that covers AREA2 / 2^FRAC
 * pixels and has 2^SHARE_LOG2 times the flux of a cell. SIGN is -1 for a
 * mirrored cell, else 1. */
static int32_t compute_packed_cell_light(struct glint_ghost_edges *g,
                                         int64_t area2, int frac,
                                         int share_log2, int64_t energy_q16,
                                         int sign)
{
    const int64_t irradiance_q22 = glint_compute_irradiance_q22(
        g->bundle, share_log2, area2, frac, g->limit_q8, &g->n_held);

    return glint_ghost_pack_cell_light(g, irradiance_q22, energy_q16, sign);
}

/* -------------------------------------------------- cells drawn separately */

static void add_outline_edges(struct glint_ghost_edges *g,
                              const struct glint_outline *o, int32_t light)
{
    point_q8 first, last, here;

    for (int i = 0; i < o->n; i++) {
        here[0] = q_narrow(q_shift(o->x_q16[i], 8));
        here[1] = q_narrow(q_shift(o->y_q16[i], 8));
        if (i > 0)
            add_ghost_edge(g, last, here, light, 0);
        for (int k = 0; k < 2; k++) {
            last[k] = here[k];
            first[k] = i ? first[k] : here[k];
        }
    }
    if (o->n > 0)
        add_ghost_edge(g, last, first, light, 0);
}

void glint_ghost_add_clipped_primitive(struct glint_ghost_edges *g,
                                       const struct glint_vertex *const *corner,
                                       int n, int share_log2)
{
    struct glint_outline *o = &g->rows->outline;
    const struct glint_vertex *turned[4] = {corner[0]};
    struct glint_corners c;
    int32_t light;
    int cut, thin;

    glint_corners_set(&c, corner, n);
    for (int i = 0; i < n; i++)
        turned[i] = corner[c.area2_q16 >= 0 ? i : n - 1 - i];
    glint_corners_set(&c, turned, n);
    cut = glint_outline_classify_primitive(&c, g->stop);
    if (cut < 0 || glint_box_is_empty(glint_corners_compute_pixel_box(
                       &c, g->width, g->height)))
        return;
    cut |= cut && (g->transfer || g->rays) ? GLINT_CUT_LOWERED : 0;
    thin = glint_corners_are_thin(&c);
    for (int k = 0; k < (cut ? n - 2 : 1); k++) {
        int64_t area2 = c.area2_q16, share_q28;
        int frac = 2 * GLINT_VERTEX_FRAC + 1, share = share_log2;

        if (cut)
            glint_outline_clip_triangle(o, &c, k, g->stop, cut);
        else
            glint_outline_set_unclipped(o, &c);
        if (o->n == 0)
            continue;
        share_q28 = 1 << 28;
        if (thin) {
            share_q28 = o->share_q28;
            share -= cut && n == 4;
            area2 = glint_outline_replace_by_strip_q32(o);
            frac = 33;
        }
        light = compute_packed_cell_light(
            g, area2, frac, share, q_shift(o->energy_q16 * share_q28, 28), 1);
        if (g->patch)
            g->stop->shade->method->patch(g, light);
        if (!g->patch || g->patch->clear)
            add_outline_edges(g, o, light);
    }
}

/* Adds the edges of a cell that is not a convex quad, as two triangles. If one
 * corner is invalid, adds the triangle of the others; if more are, nothing. */
static NEVER_INLINE void add_cell_as_triangles(struct glint_ghost_edges *g,
                                               const struct glint_ghost_cell *c)
{
    static const int half[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const struct glint_vertex *left[4];
    int n = 0;

    for (int k = 0; k < 4; k++)
        if (!(c->at[k].barrels & NODE_LOST))
            left[n++] = c->corner[k];
    g->n_dropped += n < 4;
    if (n == 3)
        glint_ghost_add_clipped_primitive(g, left, 3, -1);
    for (int k = 0; n == 4 && k < 2; k++) {
        const struct glint_vertex *const t[3] = {c->corner[half[k][0]],
                                                 c->corner[half[k][1]],
                                                 c->corner[half[k][2]]};

        glint_ghost_add_clipped_primitive(g, t, 3, -1);
    }
}

/* Adds the edges of a cell that is drawn as a closed outline and shares no
 * edges with its neighbours. TURN is the sign of the cell's area, or 0 if the
 * cell is not convex. */
static NEVER_INLINE void
add_cell_separately(struct glint_ghost_edges *g,
                    const struct glint_ghost_cell *c,
                    const struct glint_corners *corners, int turn)
{
    if (turn == 0 && !glint_corners_fit_into_pixel_part(corners, 16))
        add_cell_as_triangles(g, c);
    else
        glint_ghost_add_clipped_primitive(g, c->corner, 4, 0);
}

/* ------------------------------------------------------------- in the grid */

/* Sets PART to the visible part of side K of cell C, which runs from corner K
 * to corner K + 1. */
static void find_visible_side_part(const struct glint_ghost_edges *g,
                                   const struct glint_ghost_cell *c, int k,
                                   struct glint_edge_part *part)
{
    const int reverse = k >= 2, next = (k + 1) & 3;
    const int from = reverse ? next : k, to = reverse ? k : next;

    glint_cuts_find_visible_part(g->stop, c->corner[from], c->at[from],
                                 c->corner[to], c->at[to], part);
    if (reverse) {
        const struct glint_edge_part forward = *part;

        for (int end = 0; end < 2; end++) {
            part->end_q8[end][0] = forward.end_q8[1 - end][0];
            part->end_q8[end][1] = forward.end_q8[1 - end][1];
            part->cut[end] = forward.cut[1 - end];
        }
    }
}

/* Adds the chords of a cell that is cut by the stop or a barrel aperture.
 * Chords are edges that connect the visible parts of the cell's sides, and so
 * close its outline. */
static void add_cell_chords(struct glint_ghost_edges *g,
                            const struct glint_ghost_cell *c, int32_t light)
{
    struct glint_edge_part part[4];
    int n = 0;

    for (int k = 0; k < 4; k++) {
        find_visible_side_part(g, c, k, &part[n]);
        n += part[n].visible;
    }
    for (int k = 0; k < n; k++) {
        const struct glint_edge_part *here = &part[k];
        const struct glint_edge_part *next = &part[k + 1 < n ? k + 1 : 0];
        point_q8 corner;

        if (here->cut[1] != next->cut[0] && here->cut[1] != GLINT_CUT_NOTHING &&
            next->cut[0] != GLINT_CUT_NOTHING &&
            glint_cuts_find_crossing(g->stop, c->corner, here->cut[1],
                                     next->cut[0], corner)) {
            add_ghost_edge(g, here->end_q8[1], corner, light, 0);
            add_ghost_edge(g, corner, next->end_q8[0], light, 0);
        } else
            add_ghost_edge(g, here->end_q8[1], next->end_q8[0], light, 0);
    }
}

static int64_t compute_mean_energy_q16(const struct glint_corners *c)
{
    return ((int64_t)c->at[0]->energy_q16 + c->at[1]->energy_q16 +
            c->at[2]->energy_q16 + c->at[3]->energy_q16 + 2) >>
           2;
}

static void set_grid_cell_corners(const struct glint_ghost_edges *g, int i,
                                  int j, struct glint_corners *corners)
{
    const struct glint_vertex *const at[4] = {
        get_ghost_node(g, i, j), get_ghost_node(g, i + 1, j),
        get_ghost_node(g, i + 1, j + 1), get_ghost_node(g, i, j + 1)};

    glint_corners_set(corners, at, 4);
}

/* Returns whether row J of cells lies in the hole of an annular pupil box. Such
 * rows have no light. They touch the middle row of nodes, whose rays are not
 * traced. */
static int is_row_in_annulus_hole(const struct glint_ghost_edges *g, int j)
{
    const int middle = g->bundle->n_cells / 2;

    return g->transfer && g->transfer->annulus &&
           (j == middle - 1 || j == middle);
}

/* Multiplies the energy at the corners of a cell that is drawn separately by
 * the transmission of the stop (soft edge, dust or masks). Stores the new
 * corners in DIMMED. For a uniform stop nothing changes. */
static void dim_separate_cell(const struct glint_ghost_edges *g,
                              struct glint_ghost_cell *c,
                              struct glint_corners *corners,
                              struct glint_vertex dimmed[4])
{
    const struct glint_shade *shade = g->stop->shade;

    if (!shade)
        return;
    shade->method->corners(shade, c, dimmed);
    glint_corners_set(corners, c->corner, 4);
}

/* Returns the packed light of the cell at (I, J), for the edges that it shares
 * with its neighbours. Returns 0 for invisible cells. Cells that have to be
 * drawn separately are drawn here, and 0 is returned for them, too. Nearly all
 * cells are either completely visible or completely invisible. */
static int32_t find_cell_light(struct glint_ghost_edges *g, int i, int j)
{
    const struct glint_ghost_rows *r = g->rows;
    const uint64_t *s = r->sides[j & 1] + i, *t = r->sides[~j & 1] + i;
    const uint8_t *a = r->barrels[j & 1] + i, *b = r->barrels[~j & 1] + i;
    const uint8_t some = a[0] | a[1] | b[0] | b[1];
    const struct glint_outside any = {s[0] | s[1] | t[0] | t[1],
                                      some & NODE_BARRELS};
    struct glint_corners corners;
    struct glint_ghost_cell cell;
    struct glint_vertex dimmed[4];
    int64_t energy_q16;
    int32_t light;
    int cuts, turn, odd;

    if (some & NODE_LOST && is_row_in_annulus_hole(g, j))
        return 0;
    if (some & NODE_LOST) {
        set_cell_corners(g, i, j, &cell);
        dim_separate_cell(g, &cell, &corners, dimmed);
        add_cell_as_triangles(g, &cell);
        return 0;
    }
    /* All four corners lie outside the same side of the stop or the same barrel
     * aperture, or they lie off-screen on the same side of the picture, where
     * edges change no pixel. */
    if ((s[0] & s[1] & t[0] & t[1]) | (a[0] & a[1] & b[0] & b[1]))
        return 0;
    set_grid_cell_corners(g, i, j, &corners);
    turn = find_convex_orientation(&corners);
    cuts = any.sides || any.barrels ? glint_cuts_count_outside_bits(any) : 0;
    odd = turn == 0 || cuts > 2 ||
          (cuts && !g->transfer && !g->rays &&
           (g->stop->n_blades == 0 || g->stop->round_q30)) ||
          glint_corners_are_thin(&corners);
    if (odd || cuts)
        set_cell_corners(g, i, j, &cell);
    if (odd) {
        dim_separate_cell(g, &cell, &corners, dimmed);
        add_cell_separately(g, &cell, &corners, turn);
        return 0;
    }
    energy_q16 = compute_mean_energy_q16(&corners);
    if (g->stop->shade &&
        !g->stop->shade->method->cell(g, &corners, turn, cuts, &energy_q16))
        return 0;
    light = compute_packed_cell_light(g, turn * corners.area2_q16,
                                      2 * GLINT_VERTEX_FRAC + 1, 0, energy_q16,
                                      turn);
    if (cuts)
        add_cell_chords(g, &cell, light);
    return light;
}

/* Adds the visible part of the edge from node A to node B. The edge separates a
 * cell of light LIGHT from a cell of light OTHER. */
static void
add_shared_edge(struct glint_ghost_edges *g, const struct glint_vertex *a,
                struct glint_outside at_a, const struct glint_vertex *b,
                struct glint_outside at_b, int32_t light, int32_t other)
{
    struct glint_edge_part part;

    if (light == other)
        return;
    if (!(at_a.sides | at_b.sides) && !(at_a.barrels | at_b.barrels)) {
        const point_q8 from = {a->x_q8, a->y_q8}, to = {b->x_q8, b->y_q8};

        add_ghost_edge(g, from, to, light, other);
        return;
    }
    glint_cuts_find_visible_part(g->stop, a, at_a, b, at_b, &part);
    if (part.visible)
        add_ghost_edge(g, part.end_q8[0], part.end_q8[1], light, other);
}

static struct glint_outside
get_outside_bits_of_node(const struct glint_ghost_edges *g, int i, int j)
{
    return (struct glint_outside){g->rows->sides[j & 1][i],
                                  g->rows->barrels[j & 1][i] & NODE_BARRELS};
}

/* Adds the edges along row J of nodes, which separate two rows of cells. ABOVE
 * and BELOW are the light of the cells in these rows. */
static void add_horizontal_edges(struct glint_ghost_edges *g, int j,
                                 const int32_t *above, const int32_t *below)
{
    for (int i = 0; i < g->bundle->n_cells; i++)
        if (above[i] != below[i])
            add_shared_edge(
                g, get_ghost_node(g, i, j), get_outside_bits_of_node(g, i, j),
                get_ghost_node(g, i + 1, j),
                get_outside_bits_of_node(g, i + 1, j), below[i], above[i]);
}

/* Adds the edges between neighbouring cells within row J of cells. LIGHT is the
 * light of these cells. */
static void add_vertical_edges(struct glint_ghost_edges *g, int j,
                               const int32_t *light)
{
    const int n = g->bundle->n_cells;

    for (int i = 0; i <= n; i++) {
        const int32_t before = i > 0 ? light[i - 1] : 0;
        const int32_t behind = i < n ? light[i] : 0;

        if (before != behind)
            add_shared_edge(
                g, get_ghost_node(g, i, j), get_outside_bits_of_node(g, i, j),
                get_ghost_node(g, i, j + 1),
                get_outside_bits_of_node(g, i, j + 1), before, behind);
    }
}

void glint_ghost_emit_hard_outline(struct glint_ghost_edges *ghost)
{
    struct glint_ghost_rows *r = ghost->rows;
    const int n = ghost->bundle->n_cells;

    set_irradiance_steps(ghost);
    set_snapping_limits(ghost);
    glint_ghost_fill_node_row(ghost, 0);
    for (int i = 0; i < n; i++)
        r->light[1][i] = 0;
    for (int j = 0; j < n; j++) {
        int32_t *here = r->light[j & 1], *above = r->light[~j & 1];

        glint_ghost_fill_node_row(ghost, j + 1);
        for (int i = 0; i < n; i++)
            here[i] = find_cell_light(ghost, i, j);
        add_horizontal_edges(ghost, j, above, here);
        add_vertical_edges(ghost, j, here);
    }
    for (int i = 0; i < n; i++)
        r->light[n & 1][i] = 0;
    add_horizontal_edges(ghost, n, r->light[~n & 1], r->light[n & 1]);
}

void glint_ghost_emit_edges(struct glint_ghost_edges *ghost)
{
    const struct glint_shade *shade = ghost->stop->shade;

    ghost->n_edges = ghost->n_dropped = ghost->n_held = 0;
    ghost->more_refs = 0;
    if (shade)
        shade->method->emit(ghost);
    else
        glint_ghost_emit_hard_outline(ghost);
}
