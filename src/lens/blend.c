/* SPDX-License-Identifier: MIT
 *
 * Interpolates the polynomials of a ghost between two neighbouring positions of
 * a zoom lens.
 *
 *   in   two transfers (polynomials of u and v) of the same ghost, angle and
 *        wavelength
 *   out  one transfer: each coefficient and the pupil box interpolated linearly
 *
 * In the coordinates of its pupil box a ghost changes slowly with the zoom.
 * Between both positions the weights are 0 or more and sum to 1. The sum of
 * magnitudes of each mixed output is then at most the larger of the two sums,
 * so it stays below 2^30, as transfer.c requires. In extrapolation the weights
 * are up to 2 and -1, so sums may triple; two bits are reserved for this. Each
 * coefficient is rounded once. The unit of the result is the coarser of the two
 * units.
 *
 * Each barrel (the rim of a lens surface, which cuts rays) is mixed with the
 * corresponding barrel of the other position, which pair.c finds. A barrel
 * without a counterpart keeps its position in the stop, because boxes may
 * change faster than the visible rays. Near the position that lacks it, the
 * barrel is widened until it blocks nothing. */
#include "lens/blend.h"

#include "base/q.h"
#include "base/real.h"
#include "lens/terms.h"

enum {
    ROWS = GLINT_MAX_POWER + 1,
    BARREL = GLINT_OUT_BARREL_0,
    /* (1 + r^2) / 2, the value of a barrel's polynomial, at r = 0: no light is
     * blocked */
    OPEN_Q16 = 1 << 15,
    /* Min value of 46 + exponent of a barrel's unit; OPEN_Q16 is then below
     * 2^30 units. */
    LEAST_UP = 16,
    MOST_HEAD = 28,
    /* Max move of a box for which first-order terms are exact enough: 1/2 of a
     * half width. */
    NEAR_Q24 = 1 << 23,
    /* A barrel that one position lacks is widened over the last quarter of the
     * distance to that position. */
    LATE_Q30 = 3 << 28,
    MOST_MOVE = 8, /* max distance between the boxes of both positions, in half
                      widths */
    /* number of bits reserved for extrapolation, which triples sums */
    BEYOND = 2
};

/* Returns X / 2^S, rounded; S may exceed 62. */
static int64_t shift_right_rounded(int64_t x, int s)
{
    return s > 62 ? 0 : q_shift(x, s);
}

static uint8_t get_max_u8(uint8_t a, uint8_t b)
{
    return a > b ? a : b;
}

/* Returns A (1 - PART) + B PART, rounded, in units of 2^E. A is in units of
 * 2^EA, B in units of 2^EB. EA and EB are at most E. */
static int32_t mix_coefficient(int32_t a, int32_t ea, int32_t b, int32_t eb,
                               int32_t e, int32_t part_q30)
{
    return (
        int32_t)(shift_right_rounded((int64_t)a * (TRANSFER_ONE_Q30 - part_q30),
                                     30 + e - ea) +
                 shift_right_rounded((int64_t)b * part_q30, 30 + e - eb));
}

/* Returns (B - A) / SIZE, where B, A and SIZE are in units of 2^EB, 2^EA and
 * 2^ES. Sets *FAR if SIZE is not above 0, its unit is more than 2^30 times that
 * of the difference or less than 2^-30, or the magnitude of the quotient
 * exceeds MOST_MOVE. Returns 0 if *FAR is or was set. */
static int32_t compute_box_move_q24(int64_t b, int32_t eb, int64_t a,
                                    int32_t ea, int64_t size, int32_t es,
                                    int *far)
{
    const int32_t e = ea > eb ? ea : eb;
    const int64_t off =
        shift_right_rounded(b, e - eb) - shift_right_rounded(a, e - ea);
    int64_t q;

    if (size <= 0 || es - e > 30 || e - es > 30) {
        *far = 1;
        return 0;
    }
    q = real_integer(real_over(real_of(off, e), real_of(size, es)), 24,
                     INT64_C(1) << 40);
    *far |= q > MOST_MOVE * (INT64_C(1) << 24) ||
            q < -MOST_MOVE * (INT64_C(1) << 24);
    return *far ? 0 : (int32_t)q;
}

/* Sets the moves of BLEND between two boxes. The first is BOX, the box of this
 * position in units of 2^EXPONENT. The second is the box of the transfer, which
 * is still that of the other position. */
static void set_box_moves(struct glint_zoom_mix *blend, const int32_t box[3],
                          int32_t exponent)
{
    const struct glint_transfer *const t = blend->to;
    const int32_t *const of[2] = {box, t->box};
    const int32_t e[2] = {exponent, t->box_exponent};
    int far = 0;

    for (int k = 0; k < 2; k++) {
        struct glint_blend_move *const m = &blend->move[k];

        m->along_q24 = compute_box_move_q24(of[1][0], e[1], of[0][0], e[0],
                                            of[k][1], e[k], &far);
        m->wider_q24 = compute_box_move_q24(of[1][1], e[1], of[0][1], e[0],
                                            of[k][1], e[k], &far);
        m->higher_q24 = compute_box_move_q24(of[1][2], e[1], of[0][2], e[0],
                                             of[k][2], e[k], &far);
    }
    for (int k = 0; k < 2 && far; k++)
        blend->move[k] = (struct glint_blend_move){0, 0, 0};
    blend->far = far;
}

/* Returns whether each component of M is at most NEAR_Q24, which is 1/2 of the
 * box's half width or half height. */
static int is_box_move_small(const struct glint_blend_move *m)
{
    return q_magnitude(m->along_q24) <= NEAR_Q24 &&
           q_magnitude(m->wider_q24) <= NEAR_Q24 &&
           q_magnitude(m->higher_q24) <= NEAR_Q24;
}

/* If O is the x or y output of the position in the stop, records in STOP where
 * rays pass the stop. */
static void record_linear_stop_terms(struct glint_blend_stop *stop,
                                     const struct glint_blend_output *o)
{
    if (o->kind == GLINT_OUT_STOP_X) {
        stop->middle = o->row[0][0];
        stop->across = o->degree_u ? o->row[0][1] : 0;
        stop->x_exponent = o->exponent;
    } else if (o->kind == GLINT_OUT_STOP_Y) {
        stop->up = o->degree_v ? o->row[1][0] : 0;
        stop->y_exponent = o->exponent;
    }
}

static struct glint_blend_stop get_linear_stop_terms(struct glint_transfer *t)
{
    struct glint_blend_stop stop = {0, 0, 0, 0, 0};

    for (int kind = GLINT_OUT_STOP_X; kind <= GLINT_OUT_STOP_Y; kind++) {
        const struct glint_blend_output o = glint_blend_get_output(t, kind);

        if (has_transfer_output(t, kind))
            record_linear_stop_terms(&stop, &o);
    }
    return stop;
}

int glint_blend_mix_box(struct glint_zoom_mix *blend, const int32_t box[3],
                        int32_t exponent)
{
    struct glint_transfer *const t = blend->to;
    const int32_t e =
        (exponent > t->box_exponent ? exponent : t->box_exponent) +
        (blend->part_q30 < 0 ? BEYOND : 0);

    set_box_moves(blend, box, exponent);
    blend->stop[0] = get_linear_stop_terms(t);
    for (int k = 0; k < 3; k++)
        t->box[k] = mix_coefficient(box[k], exponent, t->box[k],
                                    t->box_exponent, e, blend->part_q30);
    t->box_exponent = e;
    return blend->part_q30 >= 0 ||
           (!blend->far && is_box_move_small(&blend->move[1]) &&
            t->box[1] > 0 && t->box[2] > 0);
}

/* Returns the change of the coefficient of u^A v^B in ROW when points of the
 * box move by M, to first order. */
static int64_t compute_coefficient_change(int32_t (*row)[GLINT_TABLE_WIDTH],
                                          int a, int b,
                                          const struct glint_blend_move *m)
{
    int64_t sum = (int64_t)row[b][a] *
                  ((int64_t)a * m->wider_q24 + (int64_t)b * m->higher_q24);

    if (a < GLINT_MAX_POWER)
        sum += (int64_t)row[b][a + 1] * (a + 1) * m->along_q24;
    return q_shift(sum, 24);
}

/* Sets TO to changes of the mixed coefficients of O and output KIND of the
 * transfer (unit 2^EXPONENT), in units of 2^E. With them, both outputs refer to
 * the same points of the pupil. Returns whether the magnitudes of all
 * coefficients and changes sum to less than 2^30. */
static int compute_coefficient_changes(const struct glint_zoom_mix *blend,
                                       int kind, int32_t exponent,
                                       const struct glint_blend_output *o,
                                       int32_t e,
                                       int32_t (*to)[GLINT_TABLE_WIDTH])
{
    int32_t(*const ours)[GLINT_TABLE_WIDTH] = blend->to->table[kind];
    const int64_t part = blend->part_q30 >> 15;
    const int64_t both_q15 = part * ((1 << 15) - part) >> 15;
    int64_t all = 0;

    for (int b = 0; b <= blend->to->degree_v[kind]; b++)
        for (int a = 0; a <= blend->to->degree_u[kind]; a++) {
            const int64_t x =
                shift_right_rounded(
                    compute_coefficient_change(ours, a, b, &blend->move[0]) *
                        both_q15,
                    15 + e - exponent) -
                shift_right_rounded(
                    compute_coefficient_change(o->row, a, b, &blend->move[1]) *
                        both_q15,
                    15 + e - o->exponent);
            const int64_t size = (int64_t)q_magnitude(x);

            all += size + (int64_t)q_magnitude(mix_coefficient(
                              ours[b][a], exponent, o->row[b][a], o->exponent,
                              e, blend->part_q30));
            to[b][a] = size < TRANSFER_ONE_Q30 ? (int32_t)x : 0;
        }
    return all < TRANSFER_ONE_Q30;
}

/* Mixes O into output KIND of the transfer, whose unit is 2^EXPONENT. Returns
 * the exponent of the mixed output's unit. */
static int32_t mix_polynomial(const struct glint_zoom_mix *blend, int kind,
                              int32_t exponent,
                              const struct glint_blend_output *o)
{
    struct glint_transfer *const t = blend->to;
    /* One bit is reserved for the changes, or BEYOND bits for extrapolation. */
    const int32_t e = (exponent > o->exponent ? exponent : o->exponent) +
                      (blend->part_q30 < 0 ? BEYOND : 1);
    int32_t more[ROWS][GLINT_TABLE_WIDTH];
    int moves;

    t->degree_u[kind] = get_max_u8(t->degree_u[kind], o->degree_u);
    t->degree_v[kind] = get_max_u8(t->degree_v[kind], o->degree_v);
    moves = compute_coefficient_changes(blend, kind, exponent, o, e, more);
    for (int b = 0; b <= t->degree_v[kind]; b++)
        for (int a = 0; a <= t->degree_u[kind]; a++)
            t->table[kind][b][a] =
                mix_coefficient(t->table[kind][b][a], exponent, o->row[b][a],
                                o->exponent, e, blend->part_q30) +
                (moves ? more[b][a] : 0);
    return e;
}

/* ------------------------------------------------------------------ energy */

/* Returns the exponent of the unit of the energy polynomial, before it is
 * squared. */
static int32_t compute_energy_exponent(const struct glint_transfer *t)
{
    int32_t e = t->exponent[GLINT_OUT_ENERGY];

    for (int k = 0; k < t->roots; k++)
        e = (e - 29) / 2;
    return e + t->head;
}

/* Mixes the energy output O into the transfer. The head of an energy is the max
 * exponent by which all values can be scaled without overflow; a coarser unit
 * allows a larger head. */
static void mix_energy_output(const struct glint_zoom_mix *blend,
                              const struct glint_blend_output *o)
{
    struct glint_transfer *const t = blend->to;
    const int32_t before = compute_energy_exponent(t);
    const int32_t now = mix_polynomial(blend, GLINT_OUT_ENERGY, before, o);
    int head = t->head + now - before, other = o->head + now - o->exponent;
    int32_t e;

    head = head < other ? head : other;
    head = t->head == 0 || o->head == 0 ? 0 : head;
    head = head < MOST_HEAD ? head : MOST_HEAD;
    e = now - head;
    for (int k = 0; k < t->roots; k++)
        e = 2 * e + 29;
    t->head = (uint8_t)head;
    t->exponent[GLINT_OUT_ENERGY] = e;
}

/* Multiplies output KIND by the fraction SHARE_Q30. */
static void scale_output_table(struct glint_transfer *t, int kind,
                               int32_t share_q30)
{
    for (int b = 0; b < ROWS; b++)
        for (int a = 0; a < GLINT_TABLE_WIDTH; a++)
            t->table[kind][b][a] = q_mul(t->table[kind][b][a], share_q30, 30);
}

void glint_blend_scale_energy(struct glint_transfer *t, int32_t share_q30)
{
    for (int k = 0; k < t->roots; k++)
        share_q30 = (int32_t)q_root((uint64_t)share_q30 << 30);
    scale_output_table(t, GLINT_OUT_ENERGY, share_q30);
}

/* ----------------------------------------------------------------- barrels */

/* Widens barrel KIND at the fraction SHARE_Q30 of the distance to the position
 * that lacks it: beyond LATE_Q30, interpolates between the barrel and a barrel
 * that blocks nothing. A barrel with a unit so fine that sums would reach 2^30
 * stays unchanged. */
static void widen_barrel_opening(struct glint_transfer *t, int kind,
                                 int32_t share_q30)
{
    const int up = 46 + t->exponent[kind];

    if (up < LEAST_UP)
        return;
    share_q30 = share_q30 > LATE_Q30 ? 4 * (share_q30 - LATE_Q30) : 0;
    scale_output_table(t, kind, TRANSFER_ONE_Q30 - share_q30);
    t->table[kind][0][0] +=
        (int32_t)shift_right_rounded((int64_t)OPEN_Q16 * share_q30, up);
}

/* Returns compute_box_move_q24(), also for negative SIZE. */
static int32_t compute_signed_box_move_q24(int64_t b, int32_t eb, int64_t a,
                                           int32_t ea, int64_t size, int32_t es,
                                           int *far)
{
    return size < 0 ? compute_box_move_q24(-b, eb, -a, ea, -size, es, far)
                    : compute_box_move_q24(b, eb, a, ea, size, es, far);
}

/* Sets M to the move from the mixed box to the box of one position that
 * preserves positions in the stop. OF and MIXED state where the rays of both
 * boxes pass the stop. Returns whether M is small enough for first-order
 * terms. */
static int compute_move_preserving_stop(const struct glint_blend_stop *of,
                                        const struct glint_blend_stop *mixed,
                                        struct glint_blend_move *m)
{
    int far = 0;

    m->along_q24 = compute_signed_box_move_q24(
        mixed->middle, mixed->x_exponent, of->middle, of->x_exponent,
        of->across, of->x_exponent, &far);
    m->wider_q24 = compute_signed_box_move_q24(
        mixed->across, mixed->x_exponent, of->across, of->x_exponent,
        of->across, of->x_exponent, &far);
    m->higher_q24 = compute_signed_box_move_q24(mixed->up, mixed->y_exponent,
                                                of->up, of->y_exponent, of->up,
                                                of->y_exponent, &far);
    return !far && is_box_move_small(m);
}

/* Returns the max value of the polynomial of BARREL at the left, right and
 * upper point of the rim of the stop, each moved into the box. */
static int32_t find_max_at_rim_q16(const struct glint_blend_output *barrel,
                                   const struct glint_blend_stop *stop)
{
    const int32_t one = TRANSFER_ONE_Q30;
    const int32_t place[3][2] = {{-one, 0}, {one, 0}, {0, one}};
    int32_t most = INT32_MIN;

    for (int k = 0; k < 3; k++) {
        int far = 0;
        const int32_t u_q24 = compute_signed_box_move_q24(
            place[k][0], -30, stop->middle, stop->x_exponent, stop->across,
            stop->x_exponent, &far);
        const int32_t v_q24 =
            compute_signed_box_move_q24(place[k][1], -30, 0, stop->y_exponent,
                                        stop->up, stop->y_exponent, &far);
        const int32_t value_q16 = glint_blend_evaluate_q16(
            barrel, q_clamp_sat(u_q24, -(1 << 24), 1 << 24),
            q_clamp_sat(v_q24 < 0 ? -(int64_t)v_q24 : v_q24, 0, 1 << 24));

        most = most > value_q16 || far ? most : value_q16;
    }
    return most;
}

/* Moves barrel KIND so that it keeps its position in the stop. Only zoom
 * position SIDE (0: this one, 1: the other one) has the barrel. Does nothing if
 * the barrel would then block more, or the magnitudes of its coefficients would
 * sum to 2^30 or more. */
static void preserve_barrel_position_in_stop(const struct glint_zoom_mix *blend,
                                             int side, int kind)
{
    struct glint_transfer *const t = blend->to;
    const struct glint_blend_stop stop = get_linear_stop_terms(t);
    int32_t moved_row[ROWS][GLINT_TABLE_WIDTH];
    const struct glint_blend_output own = glint_blend_get_output(t, kind);
    struct glint_blend_output kept = own;
    struct glint_blend_move m;
    int64_t all = 0;

    if (!compute_move_preserving_stop(&blend->stop[side], &stop, &m))
        return;
    kept.row = moved_row;
    for (int b = 0; b <= own.degree_v; b++)
        for (int a = 0; a <= own.degree_u; a++) {
            const int64_t x =
                own.row[b][a] + compute_coefficient_change(own.row, a, b, &m);

            all += (int64_t)q_magnitude(x);
            kept.row[b][a] = all < TRANSFER_ONE_Q30 ? (int32_t)x : 0;
        }
    if (all >= TRANSFER_ONE_Q30 ||
        find_max_at_rim_q16(&kept, &stop) >= find_max_at_rim_q16(&own, &stop))
        return;
    for (int b = 0; b <= own.degree_v; b++)
        for (int a = 0; a <= own.degree_u; a++)
            own.row[b][a] = kept.row[b][a];
}

/* Adds barrel O, which only the other position has, widened if the zoom is near
 * this position. */
static void add_unmatched_barrel(struct glint_zoom_mix *blend,
                                 const struct glint_blend_output *o)
{
    const int added = glint_blend_add_barrel(blend->to, o);

    if (added < 0)
        return;
    blend->taken |= UINT32_C(1) << added;
    preserve_barrel_position_in_stop(blend, 1, BARREL + added);
    widen_barrel_opening(blend->to, BARREL + added,
                         TRANSFER_ONE_Q30 - blend->part_q30);
}

static void mix_barrel_output(struct glint_zoom_mix *blend,
                              const struct glint_blend_output *o)
{
    struct glint_transfer *const t = blend->to;
    const uint32_t partners = blend->partners[blend->n_mixed++];

    for (int k = 0; k < GLINT_BLEND_BARRELS; k++)
        if (partners >> k & 1)
            t->exponent[BARREL + k] =
                mix_polynomial(blend, BARREL + k, t->exponent[BARREL + k], o);
    if (!partners && blend->part_q30 > 0)
        add_unmatched_barrel(blend, o);
}

/* ------------------------------------------------------------- all outputs */

void glint_blend_mix_output(struct glint_zoom_mix *blend,
                            const struct glint_blend_output *o)
{
    struct glint_transfer *const t = blend->to;

    record_linear_stop_terms(&blend->stop[1], o);
    if (o->kind >= BARREL)
        mix_barrel_output(blend, o);
    else if (o->kind == GLINT_OUT_ENERGY)
        mix_energy_output(blend, o);
    else if (has_transfer_output(t, o->kind))
        t->exponent[o->kind] =
            mix_polynomial(blend, o->kind, t->exponent[o->kind], o);
}

void glint_blend_widen_barrels(const struct glint_zoom_mix *blend)
{
    if (blend->part_q30 < 0)
        return;
    for (int kind = BARREL; kind < GLINT_OUT_KINDS; kind++)
        if (has_transfer_output(blend->to, kind) &&
            !(blend->taken >> (kind - BARREL) & 1)) {
            preserve_barrel_position_in_stop(blend, 0, kind);
            widen_barrel_opening(blend->to, kind, blend->part_q30);
        }
}
