/* SPDX-License-Identifier: MIT */
#include "flare/edges/cuts.h"

#include "base/compiler.h"
#include "base/divide.h"
#include "base/q.h"
#include "flare/edges/outline.h"

/* Numbers of cuts (outlines that clip edges): side K of the stop is cut K,
 * barrel aperture K is cut BARREL + K. */
enum { BARREL = 64, NOTHING = GLINT_CUT_NOTHING };

/* ------------------------------------------------------------------- nodes */

static int64_t compute_squared_radius_q32(const struct glint_vertex *v)
{
    return (int64_t)v->stop_x_q16 * v->stop_x_q16 +
           (int64_t)v->stop_y_q16 * v->stop_y_q16;
}

/* Returns half the number of the stop's sides if every side has a parallel
 * opposite side, else 0. */
static int count_parallel_side_pairs(const struct glint_stop *stop)
{
    const int half = stop->n_blades / 2;

    for (int k = 0; k < half; k++)
        for (int c = 0; c < 2; c++)
            if (stop->normal_q30[k][c] != -stop->normal_q30[half + k][c])
                return 0;
    return stop->n_blades % 2 ? 0 : half;
}

/* Returns the value at V of the function whose zero line is the outline of a
 * round stop; it is positive inside. The function is 1 - (1 + r^2) / 2 minus
 * the stop's inset (by which soft edges shrink it), where r is the distance
 * from the stop's centre in stop radii. The value is clamped far outside. */
static int64_t evaluate_round_stop_q16(const struct glint_stop *stop,
                                       const struct glint_vertex *v)
{
    const int64_t value_q16 =
        (((INT64_C(1) << 32) - compute_squared_radius_q32(v)) >> 17) -
        stop->inset_q16;

    return value_q16 > -(1 << 30) ? value_q16 : -(1 << 30);
}

/* Returns a mask with a bit for each straight side of the stop: 1 if V lies on
 * that side or outside. LEAST is the apothem minus half a unit of _q16,
 * because glint_side_compute_signed_distance_q16() rounds. HALF is the number
 * of pairs of parallel sides, which are tested together; 0: sides are tested
 * one by one. */
static inline uint64_t find_outside_sides(const struct glint_stop *stop,
                                          int half,
                                          const struct glint_vertex *v,
                                          int64_t least_q46)
{
    const int n = half ? half : stop->n_blades;
    uint64_t sides = 0, opposite = 0;

    for (int k = n - 1; k >= 0; k--) {
        const int64_t along_q46 =
            (int64_t)stop->normal_q30[k][0] * v->stop_x_q16 +
            (int64_t)stop->normal_q30[k][1] * v->stop_y_q16;

        sides = 2 * sides + (along_q46 >= least_q46);
        opposite = 2 * opposite + (-along_q46 >= least_q46);
    }
    return half ? sides | opposite << half : sides;
}

/* Returns a mask with a bit for each arc of a stop with round blades: 1 if V
 * lies on that arc or outside. */
static uint64_t find_outside_arcs(const struct glint_stop *stop,
                                  const struct glint_vertex *v)
{
    const int64_t disc_q16 = glint_disc_evaluate_function_q16(v);
    uint64_t sides = 0;

    for (int k = stop->n_blades - 1; k >= 0; k--) {
        const int64_t straight_q16 =
            glint_side_compute_straight_distance_q16(stop, k, v);

        sides = 2 * sides + (glint_arc_compute_signed_distance_q16(
                                 stop, straight_q16, disc_q16) <= 0);
    }
    return sides;
}

void glint_cuts_classify_row(const struct glint_stop *stop,
                             const struct glint_vertex *row, int n,
                             uint64_t *sides, uint8_t *barrels)
{
    const int half = count_parallel_side_pairs(stop);
    const int64_t apothem_q16 = stop->apothem_q16;
    const int64_t least_q46 =
        apothem_q16 * (INT64_C(1) << 30) - (INT64_C(1) << 29);
    const int64_t within_q32 =
        apothem_q16 > 0 ? (apothem_q16 - 1) * (apothem_q16 - 1) : 0;

    for (int i = 0; i < n; i++) {
        const struct glint_vertex *v = &row[i];

        sides[i] = stop->n_blades == 0 ? evaluate_round_stop_q16(stop, v) <= 0
                   : compute_squared_radius_q32(v) < within_q32 ? 0
                   : stop->round_q30
                       ? find_outside_arcs(stop, v)
                       : find_outside_sides(stop, half, v, least_q46);
        barrels[i] = (uint8_t)((v->barrel_q16[0] >= 1 << 16) +
                               2 * (v->barrel_q16[1] >= 1 << 16));
    }
}

int glint_cuts_count_outside_bits(struct glint_outside o)
{
    int n = (o.barrels & 1) + (o.barrels >> 1 & 1);

    for (uint64_t m = o.sides; m && n < 3; m &= m - 1)
        n++;
    return n;
}

/* -------------------------------------------------- visible parts of edges */

/* Returns the value at V of the function of cut CUT. The function is positive
 * inside and 0 on the cut. */
static int64_t evaluate_cut_function_q16(const struct glint_stop *stop, int cut,
                                         const struct glint_vertex *v)
{
    if (cut >= BARREL)
        return glint_barrel_evaluate_function_q16(cut - BARREL, v);
    return stop->n_blades ? glint_side_compute_signed_distance_q16(stop, cut, v)
                          : evaluate_round_stop_q16(stop, v);
}

struct interval {
    int64_t t_q30[2];
    int cut[2];
};

static void clip_interval_by_cut(const struct glint_stop *stop,
                                 struct interval *in, int cut,
                                 const struct glint_vertex *a,
                                 const struct glint_vertex *b)
{
    const int64_t fa = evaluate_cut_function_q16(stop, cut, a),
                  fb = evaluate_cut_function_q16(stop, cut, b);
    const int end = fb <= 0; /* index (0 or 1) of the end that lies outside */
    int32_t t_q30;

    if (fa > 0 && fb > 0)
        return;
    if (fa <= 0 && fb <= 0) {
        in->t_q30[1] = -1;
        return;
    }
    t_q30 = q_divide_to_fraction_q30(q_magnitude(fa),
                                     q_magnitude(fa) + q_magnitude(fb));
    if (end ? t_q30 <= in->t_q30[1] : t_q30 >= in->t_q30[0]) {
        in->t_q30[end] = t_q30;
        in->cut[end] = cut;
    }
}

static void interpolate_vertex_position(const struct glint_vertex *a,
                                        const struct glint_vertex *b,
                                        int64_t t_q30, int32_t at_q8[2])
{
    at_q8[0] =
        a->x_q8 + q_narrow(q_shift((b->x_q8 - (int64_t)a->x_q8) * t_q30, 30));
    at_q8[1] =
        a->y_q8 + q_narrow(q_shift((b->y_q8 - (int64_t)a->y_q8) * t_q30, 30));
}

static int find_lowest_bit(uint64_t x)
{
    return bit_length(x & (~x + 1)) - 1;
}

void glint_cuts_find_visible_part(const struct glint_stop *stop,
                                  const struct glint_vertex *a,
                                  struct glint_outside at_a,
                                  const struct glint_vertex *b,
                                  struct glint_outside at_b,
                                  struct glint_edge_part *part)
{
    struct interval in = {{0, INT64_C(1) << 30}, {NOTHING, NOTHING}};

    part->visible =
        !(at_a.sides & at_b.sides) && !(at_a.barrels & at_b.barrels);
    if (!part->visible)
        return;
    for (uint64_t m = at_a.sides | at_b.sides; m; m &= m - 1)
        clip_interval_by_cut(stop, &in, find_lowest_bit(m), a, b);
    for (int k = 0; k < 2; k++)
        if ((at_a.barrels | at_b.barrels) >> k & 1)
            clip_interval_by_cut(stop, &in, BARREL + k, a, b);
    part->visible = in.t_q30[0] < in.t_q30[1];
    for (int k = 0; k < 2 && part->visible; k++) {
        interpolate_vertex_position(a, b, in.t_q30[k], part->end_q8[k]);
        part->cut[k] = in.cut[k];
    }
}

/* ------------------------------------------------------- crossings of cuts */

/* A plane that approximates the values at the four corners of a cell: middle +
 * u slope_u + v slope_v. u and v run from -1/2 to 1/2 across the cell. */
struct plane {
    /* the coefficients as integers: 4 middle, 2 slope_u, 2 slope_v */
    int64_t middle4, u2, v2;
};

static struct plane fit_plane_to_corners(const int64_t value[4])
{
    return (struct plane){value[0] + value[1] + value[2] + value[3],
                          value[1] - value[0] + value[2] - value[3],
                          value[3] - value[0] + value[2] - value[1]};
}

/* Sets *Q16 to X / Y, a coordinate u or v in the cell. Returns 0 if the
 * coordinate is outside -3/4 .. 3/4, which is not in the cell or near it. */
static int divide_in_cell_q16(int64_t x, int64_t y, int64_t *q16)
{
    const int wide = bit_length(q_magnitude(x));
    const int down = wide > 45 ? wide - 45 : 0;

    x >>= down;
    y >>= down;
    if (4 * q_magnitude(x) >= 3 * q_magnitude(y))
        return 0;
    *q16 = q_divide(x * 65536, y);
    return 1;
}

int glint_cuts_find_crossing(const struct glint_stop *stop,
                             const struct glint_vertex *const corner[4], int a,
                             int b, int32_t at_q8[2])
{
    int64_t fa[4], fb[4], x[4], y[4], u_q16, v_q16, det;
    struct plane pa, pb, px, py;
    uint64_t most = 0;
    int down;

    for (int k = 0; k < 4; k++) {
        const struct glint_vertex *v = corner[k];

        fa[k] = evaluate_cut_function_q16(stop, a, v);
        fb[k] = evaluate_cut_function_q16(stop, b, v);
        most |=
            (uint64_t)(fa[k] ^ fa[k] >> 63) | (uint64_t)(fb[k] ^ fb[k] >> 63);
        x[k] = v->x_q8;
        y[k] = v->y_q8;
    }
    down = bit_length(most) > 27 ? bit_length(most) - 27 : 0;
    /* With these values the sums of fit_plane_to_corners() are below 2^29,
     * their products below 2^58. */
    for (int k = 0; k < 4; k++) {
        fa[k] >>= down;
        fb[k] >>= down;
    }
    pa = fit_plane_to_corners(fa);
    pb = fit_plane_to_corners(fb);
    /* At the crossing both planes are 0: middle4 / 4 + u u2 / 2 + v v2 / 2 = 0,
     * so 2 u u2 + 2 v v2 = -middle4. */
    det = 2 * (pa.u2 * pb.v2 - pb.u2 * pa.v2);
    if (!divide_in_cell_q16(pb.middle4 * pa.v2 - pa.middle4 * pb.v2, det,
                            &u_q16) ||
        !divide_in_cell_q16(pa.middle4 * pb.u2 - pb.middle4 * pa.u2, det,
                            &v_q16))
        return 0;
    px = fit_plane_to_corners(x);
    py = fit_plane_to_corners(y);
    at_q8[0] = q_narrow(
        q_shift(px.middle4 * 32768 + px.u2 * u_q16 + px.v2 * v_q16, 17));
    at_q8[1] = q_narrow(
        q_shift(py.middle4 * 32768 + py.u2 * u_q16 + py.v2 * v_q16, 17));
    return 1;
}
