/* SPDX-License-Identifier: MIT */
#include "flare/edges/ghost_shade.h"

#include <stddef.h>

#include "base/compiler.h"
#include "base/q.h"
#include "base/real.h"
#include "flare/edges/patch.h"

enum { WHITE_LOG2 = 20 }; /* display white is 2^WHITE_LOG2, _q20 */

/* ------------------------------------------------------------------ tables */

static int64_t compute_magnitude(int64_t x)
{
    return x < 0 ? -x : x;
}

static int64_t max_int64(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static int compute_level_shift(const struct glint_shade *s, int level)
{
    return 17 - s->log2 + level;
}

/* Converts a coordinate in the stop, -1 .. 1 stop radii, to the distance from
 * the first node of the transmission table, clamped to 0 .. 2 stop radii. */
static int32_t clamp_stop_position_to_table(int64_t at_q16)
{
    return q_clamp_sat(at_q16 + (1 << 16), 0, (1 << 17) - 1);
}

/* Returns the transmission of the stop at (X, Y), stop radii, interpolated
 * between the four nodes of mip level LEVEL around that point. */
static int32_t interpolate_shade_light_q15(const struct glint_shade *s,
                                           int level, int64_t x_q16,
                                           int64_t y_q16)
{
    const int shift = compute_level_shift(s, level);
    const int side = (1 << (s->log2 - level)) + 1;
    const int32_t one = 1 << shift, x = clamp_stop_position_to_table(x_q16),
                  y = clamp_stop_position_to_table(y_q16);
    const int32_t u = x & (one - 1), v = y & (one - 1);
    const uint16_t *at =
        s->level_q15[level] + (ptrdiff_t)(y >> shift) * side + (x >> shift);
    const int64_t low = (int64_t)at[0] * (one - u) + (int64_t)at[1] * u;
    const int64_t high =
        (int64_t)at[side] * (one - u) + (int64_t)at[side + 1] * u;

    return (int32_t)q_shift(low * (one - v) + high * v, 2 * shift);
}

/* Returns the detail that mip level LEVEL of the stop's transmission lacks near
 * (X, Y), stop radii: the max difference between LEVEL and finer levels. */
static int read_roughness_q8(const struct glint_shade *s, int level,
                             int64_t x_q16, int64_t y_q16)
{
    const int shift = compute_level_shift(s, level);
    const int side = (1 << (s->log2 - level)) + 1;
    const int32_t half = 1 << (shift - 1);

    return s->rough_q8[level]
                      [((clamp_stop_position_to_table(y_q16) + half) >> shift) *
                           side +
                       ((clamp_stop_position_to_table(x_q16) + half) >> shift)];
}

/* Returns the mip level of the stop's transmission for a cell with the corners
 * CORNER. The distance of the level's nodes is 1/2 to 1 times the max distance
 * of the corners in the stop. */
static int choose_shade_level(const struct glint_shade *s,
                              const struct glint_vertex *const *corner)
{
    int64_t far = 0;
    int level;

    for (int k = 1; k < 4; k += 2) {
        far = max_int64(far, compute_magnitude((int64_t)corner[k]->stop_x_q16 -
                                               corner[0]->stop_x_q16));
        far = max_int64(far, compute_magnitude((int64_t)corner[k]->stop_y_q16 -
                                               corner[0]->stop_y_q16));
    }
    level = bit_length((uint64_t)far) - 1 - compute_level_shift(s, 0);
    return level < 0 ? 0 : level < s->log2 ? level : s->log2 - 1;
}

/* Returns the smallest visible difference from LIGHT. For linear pictures it is
 * LIGHT / 128, otherwise the light of one code. With each octave below white,
 * the light of one code falls to 2/3, down to where codes are linear in
 * light. */
static int64_t compute_visible_difference_q20(const struct glint_ghost_edges *g,
                                              int64_t light_q20)
{
    const int log2 = bit_length((uint64_t)light_q20 | 1) - 1;
    int64_t code_q20 = 9869;

    if (!g->coded)
        return max_int64(light_q20 >> 7, 1);
    for (int k = WHITE_LOG2; k > log2 && code_q20 > 318; k--)
        code_q20 = code_q20 * 2 / 3;
    return code_q20;
}

/* ----------------------------------------------------------------- patches */

/* Changes of two positions along a side of a cell, summed over two opposite
 * sides: of the position in the picture, pixels, and of that in the stop, stop
 * radii. */
struct span {
    int64_t x_q8, y_q8, stop_q16[2];
};

/* Returns the sum of the changes along two opposite sides of a cell: from
 * corner A to corner B, and from corner D to corner C. */
static struct span sum_side_changes(const struct glint_vertex *const *at, int a,
                                    int b, int d, int c)
{
    return (struct span){
        (int64_t)at[b]->x_q8 - at[a]->x_q8 + at[c]->x_q8 - at[d]->x_q8,
        (int64_t)at[b]->y_q8 - at[a]->y_q8 + at[c]->y_q8 - at[d]->y_q8,
        {(int64_t)at[b]->stop_x_q16 - at[a]->stop_x_q16 + at[c]->stop_x_q16 -
             at[d]->stop_x_q16,
         (int64_t)at[b]->stop_y_q16 - at[a]->stop_y_q16 + at[c]->stop_y_q16 -
             at[d]->stop_y_q16}};
}

/* Returns (A B - C D) / DET, a coefficient of the map from pixels to the stop,
 * as _q24, clamped to +-2^32. A and C are _q16, B and D _q8, DET _q16. */
static int64_t compute_slope_q24(int64_t a, int64_t b, int64_t c, int64_t d,
                                 struct glint_real det)
{
    return real_integer(real_over(real_of(a * b - c * d, -24), det), 24,
                        INT64_C(1) << 32);
}

/* Sets the linear map of patch P from pixels to positions in the stop, fitted
 * to the corners AT of a cell. The box of P must be set. Returns 0 if a
 * coefficient is out of range. */
static int set_pixel_to_stop_map(struct glint_patch *p,
                                 const struct glint_vertex *const *at)
{
    const int64_t most_q24 = INT64_C(1) << 24;
    const struct span a = sum_side_changes(at, 0, 1, 3, 2),
                      b = sum_side_changes(at, 0, 3, 1, 2);
    const struct glint_real det =
        real_of(a.x_q8 * b.y_q8 - a.y_q8 * b.x_q8, -16);
    const int64_t x_q8 =
        ((int64_t)at[0]->x_q8 + at[1]->x_q8 + at[2]->x_q8 + at[3]->x_q8) >> 2;
    const int64_t y_q8 =
        ((int64_t)at[0]->y_q8 + at[1]->y_q8 + at[2]->y_q8 + at[3]->y_q8) >> 2;

    if (det.mantissa == 0)
        return 0;
    for (int k = 0; k < 2; k++) {
        const int64_t sum_q16 =
            k ? (int64_t)at[0]->stop_y_q16 + at[1]->stop_y_q16 +
                    at[2]->stop_y_q16 + at[3]->stop_y_q16
              : (int64_t)at[0]->stop_x_q16 + at[1]->stop_x_q16 +
                    at[2]->stop_x_q16 + at[3]->stop_x_q16;
        const int64_t across = compute_slope_q24(a.stop_q16[k], b.y_q8,
                                                 b.stop_q16[k], a.y_q8, det);
        const int64_t down = compute_slope_q24(b.stop_q16[k], a.x_q8,
                                               a.stop_q16[k], b.x_q8, det);
        int64_t from_q24;

        if (compute_magnitude(across) > most_q24 ||
            compute_magnitude(down) > most_q24 ||
            compute_magnitude(sum_q16) > 1 << 24)
            return 0;
        from_q24 =
            sum_q16 * 64 + q_shift(across * (p->box.x0 * 256 + 128 - x_q8) +
                                       down * (p->box.y0 * 256 + 128 - y_q8),
                                   8);
        /* The position may wrap modulo 2^32 here; the changes added to it wrap
         * it back at pixels within the cell. */
        p->at_q24[k] = (int32_t)(uint32_t)(uint64_t)from_q24;
        p->across_q24[k] = (int32_t)across;
        p->down_q24[k] = (int32_t)down;
    }
    return 1;
}

/* Sets the box of patch P to the on-screen pixels within its bounding box.
 * Returns 0 if there are none. */
static int set_patch_box(struct glint_patch *p,
                         const struct glint_ghost_edges *g)
{
    int32_t low[2] = {INT32_MAX, INT32_MAX}, high[2] = {INT32_MIN, INT32_MIN};

    for (int i = 0; i < p->n; i++) {
        low[0] = q_smaller(low[0], p->x_q8[i]);
        low[1] = q_smaller(low[1], p->y_q8[i]);
        high[0] = q_larger(high[0], p->x_q8[i]);
        high[1] = q_larger(high[1], p->y_q8[i]);
    }
    p->box = glint_box_intersect((struct glint_box){low[0] >> 8, low[1] >> 8,
                                                    (high[0] + 255) >> 8,
                                                    (high[1] + 255) >> 8},
                                 (struct glint_box){0, 0, g->width, g->height});
    return !glint_box_is_empty(p->box);
}

static void set_patch_level(struct glint_patch *p, const struct glint_shade *s)
{
    int64_t most = 1;

    for (int k = 0; k < 2; k++)
        most = max_int64(most, max_int64(compute_magnitude(p->across_q24[k]),
                                         compute_magnitude(p->down_q24[k])));
    p->level = bit_length((uint64_t)most) - 1 - (25 - s->log2);
    p->level = p->level < 0 ? 0 : p->level < s->log2 ? p->level : s->log2 - 1;
}

/* Stores patch P in the edge array. The patch covers the cell with the corners
 * AT. The corners and the light of P must be set. */
static void store_patch(struct glint_ghost_edges *g, struct glint_patch *p,
                        const struct glint_vertex *const *at)
{
    const int n = glint_patch_count_slots(p->n), first = g->n_edges;
    struct glint_edge head = {0};

    if (p->light == 0 || !set_patch_box(p, g) || !set_pixel_to_stop_map(p, at))
        return;
    set_patch_level(p, g->stop->shade);
    g->n_edges += n;
    if (g->n_edges <= g->max_edges) {
        glint_patch_write_slots(&g->edge[first], p, g->number);
        return;
    }
    if (first < g->max_edges)
        glint_patch_fill_empty_slots(&g->edge[first], g->max_edges - first);
    head.x_q8 = p->box.x0 * 256;
    head.y_q8 = p->box.y0 * 256;
    head.end_y_q8 = p->box.y1 * 256;
    head.right = p->box.x1 - 1;
    head.patch = 1;
    if (g->bins)
        g->more_refs += q_smaller(INT32_MAX - g->more_refs,
                                  glint_edge_count_bin_entries(&head, g->bins));
}

static void add_outline_patch(struct glint_ghost_edges *g, int32_t light)
{
    const struct glint_outline *o = &g->rows->outline;
    struct glint_patch *p = g->patch;

    p->n = o->n;
    p->light = light;
    for (int i = 0; i < o->n; i++) {
        p->x_q8[i] = q_narrow(q_shift(o->x_q16[i], 8));
        p->y_q8[i] = q_narrow(q_shift(o->y_q16[i], 8));
    }
    store_patch(g, p, p->cell);
}

/* ------------------------------------------------------------------- cells */

/* Returns log2 of the width or the height of a cell in pixels, whichever is
 * larger, rounded down. */
static int compute_cell_size_log2(const struct glint_vertex *const *corner)
{
    int64_t far = 0;

    for (int k = 1; k < 4; k++) {
        far = max_int64(
            far, compute_magnitude((int64_t)corner[k]->x_q8 - corner[0]->x_q8));
        far = max_int64(
            far, compute_magnitude((int64_t)corner[k]->y_q8 - corner[0]->y_q8));
    }
    return bit_length((uint64_t)far >> 8) - 1;
}

/* Returns an upper bound on how far the stop's transmission within a cell may
 * deviate from the mean of LIGHT, which is the transmission at the cell's
 * corners by mip level LEVEL. */
static int bound_cell_roughness_q8(const struct glint_shade *s, int level,
                                   const struct glint_vertex *const *corner,
                                   const int32_t light[4])
{
    int32_t low = light[0], high = light[0];
    int most = 0;

    for (int k = 0; k < 4; k++) {
        const int rough = read_roughness_q8(s, level, corner[k]->stop_x_q16,
                                            corner[k]->stop_y_q16);

        most = rough > most ? rough : most;
        low = light[k] < low ? light[k] : low;
        high = light[k] > high ? light[k] : high;
    }
    return most + ((high - low) >> 7);
}

static int draw_shaded_cell(struct glint_ghost_edges *g,
                            const struct glint_corners *c, int turn, int cuts,
                            int64_t *energy_q16)
{
    const struct glint_shade *s = g->stop->shade;
    const struct glint_vertex *const *corner = c->at;
    const int level = s->log2 ? choose_shade_level(s, corner) : 0;
    const int64_t whole_q16 = *energy_q16;
    struct glint_patch p;
    int32_t light[4];
    int64_t irradiance_q22, light_q20, sum = 0;

    if (!s->log2)
        return 1;
    for (int k = 0; k < 4; k++) {
        light[k] = interpolate_shade_light_q15(s, level, corner[k]->stop_x_q16,
                                               corner[k]->stop_y_q16);
        sum += light[k];
    }
    *energy_q16 = q_shift(whole_q16 * sum, 17);
    irradiance_q22 = glint_compute_irradiance_q22(
        g->bundle, 0, turn * c->area2_q16, 2 * GLINT_VERTEX_FRAC + 1,
        g->limit_q8, &g->n_held);
    light_q20 = q_shift(irradiance_q22 * whole_q16, 18);
    if (compute_cell_size_log2(corner) < 1 ||
        light_q20 * bound_cell_roughness_q8(s, level, corner, light) >> 8 <
            compute_visible_difference_q20(g, light_q20))
        return 1;
    p.clear = sum > 1 << 16;
    for (int k = 0; k < 4; k++)
        p.cell[k] = corner[k];
    if (cuts) {
        g->patch = &p;
        glint_ghost_add_clipped_primitive(g, corner, 4, 0);
        g->patch = NULL;
        return 0;
    }
    *energy_q16 = p.clear ? whole_q16 : 0;
    p.light = glint_ghost_pack_cell_light(g, irradiance_q22, whole_q16, 1);
    p.n = 4;
    for (int k = 0; k < 4; k++) {
        const struct glint_vertex *v = corner[turn > 0 ? k : 3 - k];

        p.x_q8[k] = v->x_q8;
        p.y_q8[k] = v->y_q8;
    }
    store_patch(g, &p, corner);
    return 1;
}

static void dim_cell_corners(const struct glint_shade *shade,
                             struct glint_ghost_cell *c,
                             struct glint_vertex dimmed[4])
{
    const int level = shade->log2 ? choose_shade_level(shade, c->corner) : 0;

    for (int k = 0; k < 4 && shade->log2; k++) {
        dimmed[k] = *c->corner[k];
        if (!(c->at[k].barrels & NODE_LOST))
            dimmed[k].energy_q16 =
                (int32_t)q_shift((int64_t)dimmed[k].energy_q16 *
                                     interpolate_shade_light_q15(
                                         shade, level, dimmed[k].stop_x_q16,
                                         dimmed[k].stop_y_q16),
                                 15);
        c->corner[k] = &dimmed[k];
    }
}

const struct glint_shade_method glint_shade_method = {
    .emit = glint_ghost_emit_soft_outline,
    .cell = draw_shaded_cell,
    .patch = add_outline_patch,
    .draw = glint_patch_draw,
    .corners = dim_cell_corners};
