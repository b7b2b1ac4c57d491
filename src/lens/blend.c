/* SPDX-License-Identifier: MIT
 *
 * Mixes the polynomials of two neighbouring positions of a zoom.
 *
 *   in   two transfers of the same ghost, angle and wavelength
 *   out  one: every coefficient and the box in proportion
 *
 * In the coordinates of its box a ghost changes slowly with the zoom. Between
 * both, shares are 0 or more and sum to 1, so that sums of magnitudes stay
 * below the larger of both, which keeps the proof of the transfer; beyond, they
 * are up to 2 and -1, and sums up to three times that, for which there are two
 * bits of room. Each coefficient rounds once. The unit is the coarser one.
 *
 * Barrels have no names in a model. Each of the other position is mixed with
 * the one whose polynomial is most like its own, in their boxes or else where
 * both boxes lie on the pupil. One that has no partner becomes wider towards
 * the position that lacks it, until it cuts nothing. */
#include "lens/blend.h"

#include "base/q.h"
#include "base/real.h"
#include "lens/terms.h"

enum {
    ROWS = GLINT_MAX_POWER + 1,
    BARREL = GLINT_OUT_BARREL_0,
    /* most that two polynomials of the same barrel differ by, summed over
     * their coefficients, _q16: 1 is at the rim */
    LIKE_Q16 = 3 << 14,
    /* and most at the same place of the pupil */
    NEAR_Q16 = 1 << 15,
    ACROSS = 3,
    PLACES = 2 * ACROSS,
    OPEN_Q16 = 1 << 15, /* a barrel through whose middle all light goes */
    LEAST_UP = 16,      /* of units of 2^-30 or more, in which that is 2^29 */
    MOST_HEAD = 28,
    NEAR_Q24 = 1 << 23, /* half widths */
    LATE_Q30 = 3 << 28, /* share of the way after which a barrel opens */
    MOST_MOVE = 8,      /* half widths that boxes may lie apart */
    BEYOND = 2          /* bits that going on takes, to three times the size */
};

/* Returns X / 2^S, rounded, for any S of 0 or more. */
static int64_t down(int64_t x, int s)
{
    return s > 62 ? 0 : q_shift(x, s);
}

static uint8_t larger(uint8_t a, uint8_t b)
{
    return a > b ? a : b;
}

/* Returns A (1 - PART) + B PART in the unit 2^E; A is of 2^EA, B of 2^EB, both
 * at most E. */
static int32_t mix(int32_t a, int32_t ea, int32_t b, int32_t eb, int32_t e,
                   int32_t part_q30)
{
    return (
        int32_t)(down((int64_t)a * (TRANSFER_ONE_Q30 - part_q30), 30 + e - ea) +
                 down((int64_t)b * part_q30, 30 + e - eb));
}

/* Returns (B - A) / SIZE, where B is of 2^EB, A of 2^EA and SIZE of 2^ES; or
 * sets *FAR if that is more than MOST_MOVE. */
static int32_t move_q24(int32_t b, int32_t eb, int32_t a, int32_t ea,
                        int32_t size, int32_t es, int *far)
{
    const int32_t e = ea > eb ? ea : eb;
    const int64_t off = down(b, e - eb) - down(a, e - ea);
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

/* Sets how the boxes lie to each other: BOX of 2^EXPONENT and that of the
 * transfer, the other's. */
static void set_moves(struct glint_zoom_mix *blend, const int32_t box[3],
                      int32_t exponent)
{
    const struct glint_transfer *const t = blend->to;
    const int32_t *const of[2] = {box, t->box};
    const int32_t e[2] = {exponent, t->box_exponent};
    int far = 0;

    for (int k = 0; k < 2; k++) {
        struct glint_blend_move *const m = &blend->move[k];

        m->along_q24 =
            move_q24(of[1][0], e[1], of[0][0], e[0], of[k][1], e[k], &far);
        m->wider_q24 =
            move_q24(of[1][1], e[1], of[0][1], e[0], of[k][1], e[k], &far);
        m->higher_q24 =
            move_q24(of[1][2], e[1], of[0][2], e[0], of[k][2], e[k], &far);
    }
    for (int k = 0; k < 2 && far; k++)
        blend->move[k] = (struct glint_blend_move){0, 0, 0};
    blend->far = far;
}

/* Returns whether the other box lies near enough that a ghost goes on beyond
 * this one as it does between both. */
static int is_near(const struct glint_zoom_mix *blend)
{
    const struct glint_blend_move *const m = &blend->move[1];

    return q_magnitude(m->along_q24) <= NEAR_Q24 &&
           q_magnitude(m->wider_q24) <= NEAR_Q24 &&
           q_magnitude(m->higher_q24) <= NEAR_Q24;
}

int glint_blend_box(struct glint_zoom_mix *blend, const int32_t box[3],
                    int32_t exponent)
{
    struct glint_transfer *const t = blend->to;
    const int32_t e =
        (exponent > t->box_exponent ? exponent : t->box_exponent) +
        (blend->part_q30 < 0 ? BEYOND : 0);

    set_moves(blend, box, exponent);
    for (int k = 0; k < 3; k++)
        t->box[k] = mix(box[k], exponent, t->box[k], t->box_exponent, e,
                        blend->part_q30);
    t->box_exponent = e;
    return blend->part_q30 >= 0 ||
           (!blend->far && is_near(blend) && t->box[1] > 0 && t->box[2] > 0);
}

/* Returns by how much the coefficient of u^A v^B changes where a place of the
 * box moves as M says, to first order. */
static int64_t moved(int32_t (*row)[GLINT_TABLE_WIDTH], int a, int b,
                     const struct glint_blend_move *m)
{
    int64_t sum = (int64_t)row[b][a] *
                  ((int64_t)a * m->wider_q24 + (int64_t)b * m->higher_q24);

    if (a < GLINT_MAX_POWER)
        sum += (int64_t)row[b][a + 1] * (a + 1) * m->along_q24;
    return q_shift(sum, 24);
}

/* Sets TO to what the coefficients of output KIND of the transfer, of
 * 2^EXPONENT, and of O change by if both are taken at the same place of the
 * pupil, in the unit 2^E. Returns whether sums of it are small enough for the
 * transfer. */
static int find_moved(const struct glint_zoom_mix *blend, int kind,
                      int32_t exponent, const struct glint_blend_output *o,
                      int32_t e, int32_t (*to)[GLINT_TABLE_WIDTH])
{
    int32_t(*const ours)[GLINT_TABLE_WIDTH] = blend->to->of.table[kind];
    const int64_t part = blend->part_q30 >> 15;
    const int64_t both_q15 = part * ((1 << 15) - part) >> 15;
    int64_t all = 0;

    for (int b = 0; b < ROWS; b++)
        for (int a = 0; a < GLINT_TABLE_WIDTH; a++) {
            const int64_t x =
                down(moved(ours, a, b, &blend->move[0]) * both_q15,
                     15 + e - exponent) -
                down(moved(o->row, a, b, &blend->move[1]) * both_q15,
                     15 + e - o->exponent);
            const int64_t size = (int64_t)q_magnitude(x);

            all += size +
                   (int64_t)q_magnitude(mix(ours[b][a], exponent, o->row[b][a],
                                            o->exponent, e, blend->part_q30));
            to[b][a] = size < TRANSFER_ONE_Q30 ? (int32_t)x : 0;
        }
    return all < TRANSFER_ONE_Q30;
}

/* Mixes O into output KIND of the transfer, whose unit is 2^EXPONENT; returns
 * the exponent of what it becomes. */
static int32_t mix_output(const struct glint_zoom_mix *blend, int kind,
                          int32_t exponent, const struct glint_blend_output *o)
{
    struct glint_transfer *const t = blend->to;
    /* a bit of room for what moves, or what going on takes */
    const int32_t e = (exponent > o->exponent ? exponent : o->exponent) +
                      (blend->part_q30 < 0 ? BEYOND : 1);
    int32_t more[ROWS][GLINT_TABLE_WIDTH];
    const int moves = find_moved(blend, kind, exponent, o, e, more);

    for (int b = 0; b < ROWS; b++)
        for (int a = 0; a < GLINT_TABLE_WIDTH; a++)
            t->of.table[kind][b][a] =
                mix(t->of.table[kind][b][a], exponent, o->row[b][a],
                    o->exponent, e, blend->part_q30) +
                (moves ? more[b][a] : 0);
    t->degree_u[kind] = larger(t->degree_u[kind], o->degree_u);
    t->degree_v[kind] = larger(t->degree_v[kind], o->degree_v);
    return e;
}

/* ------------------------------------------------------------------ energy */

/* Returns the exponent of the energy's polynomial itself. */
static int32_t energy_exponent(const struct glint_transfer *t)
{
    int32_t e = t->exponent[GLINT_OUT_ENERGY];

    for (int k = 0; k < t->roots; k++)
        e = (e - 29) / 2;
    return e + t->head;
}

/* Heads scale so that all values fit; a coarser unit leaves them more room. */
static void mix_energy(const struct glint_zoom_mix *blend,
                       const struct glint_blend_output *o)
{
    struct glint_transfer *const t = blend->to;
    const int32_t before = energy_exponent(t);
    const int32_t now = mix_output(blend, GLINT_OUT_ENERGY, before, o);
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

/* Multiplies output KIND by SHARE. */
static void scale(struct glint_transfer *t, int kind, int32_t share_q30)
{
    for (int b = 0; b < ROWS; b++)
        for (int a = 0; a < GLINT_TABLE_WIDTH; a++)
            t->of.table[kind][b][a] =
                q_mul(t->of.table[kind][b][a], share_q30, 30);
}

void glint_blend_fade(struct glint_transfer *t, int32_t share_q30)
{
    for (int k = 0; k < t->roots; k++)
        share_q30 = (int32_t)q_root((uint64_t)share_q30 << 30);
    scale(t, GLINT_OUT_ENERGY, share_q30);
}

/* ----------------------------------------------------------------- barrels */

/* Opens barrel KIND as far as SHARE says: to a mean of it and of a barrel
 * through whose middle all goes. One whose unit is so fine that sums would not
 * stay below 2^30, which no barrel's is, is left as it is. */
static void open_barrel(struct glint_transfer *t, int kind, int32_t share_q30)
{
    const int up = 46 + t->exponent[kind];

    if (up < LEAST_UP)
        return;
    share_q30 = share_q30 > LATE_Q30 ? 4 * (share_q30 - LATE_Q30) : 0;
    scale(t, kind, TRANSFER_ONE_Q30 - share_q30);
    t->of.table[kind][0][0] += (int32_t)down((int64_t)OPEN_Q16 * share_q30, up);
}

/* Returns the sum of the differences of the coefficients of barrel KIND and O,
 * _q16. */
static int64_t unlike_q16(const struct glint_transfer *t, int kind,
                          const struct glint_blend_output *o)
{
    const int ours = -16 - t->exponent[kind], others = -16 - o->exponent;
    int64_t sum = 0;

    for (int b = 0; b < ROWS; b++)
        for (int a = 0; a < GLINT_TABLE_WIDTH; a++)
            sum += (int64_t)q_magnitude(
                down(t->of.table[kind][b][a], ours > 0 ? ours : 0) -
                down(o->row[b][a], others > 0 ? others : 0));
    return sum;
}

/* Returns the value, _q16, of the polynomial ROW of 2^EXPONENT and DEGREE in v
 * at a place of its box. */
static int64_t value_q16(int32_t (*row)[GLINT_TABLE_WIDTH], int32_t exponent,
                         int degree, int64_t u_q24, int64_t v_q24)
{
    int64_t sum = 0;

    for (int b = degree; b >= 0; b--) {
        int64_t of_u = 0;

        for (int a = GLINT_TABLE_WIDTH - 1; a >= 0; a--)
            of_u = q_shift(of_u * u_q24, 24) + row[b][a];
        sum = q_shift(sum * v_q24, 24) + of_u;
    }
    return down(sum, -16 - exponent > 0 ? -16 - exponent : 0);
}

/* Returns the largest difference of barrel KIND and O, _q16, at places of the
 * pupil that are in both boxes; NEAR_Q16 if there are none. */
static int64_t apart_q16(const struct glint_zoom_mix *blend, int kind,
                         const struct glint_blend_output *o)
{
    struct glint_transfer *const t = blend->to;
    const struct glint_blend_move *const to = &blend->move[0],
                                         *const back = &blend->move[1];
    const int64_t one = 1 << 24, half = one + to->wider_q24;
    const int64_t high =
        one + to->higher_q24 < one ? one + to->higher_q24 : one;
    const int64_t first =
        to->along_q24 - half > -one ? to->along_q24 - half : -one;
    const int64_t last =
        to->along_q24 + half < one ? to->along_q24 + half : one;
    int64_t most = 0;

    if (blend->far || last <= first)
        return NEAR_Q16;
    for (int k = 0; k < PLACES; k++) {
        const int64_t u = first + (last - first) * (k % ACROSS) / (ACROSS - 1);
        const int64_t v = k < ACROSS ? 0 : high;
        const int64_t ours = value_q16(t->of.table[kind], t->exponent[kind],
                                       t->degree_v[kind], u, v);
        const int64_t theirs = value_q16(
            o->row, o->exponent, o->degree_v,
            q_shift(u * (one - back->wider_q24), 24) - back->along_q24,
            q_shift(v * (one - back->higher_q24), 24));
        const int64_t off = ours > theirs ? ours - theirs : theirs - ours;

        most = off > most ? off : most;
    }
    return most;
}

/* Gives the transfer the barrel O in a place that is free, open as far as the
 * zoom is where it is not. */
static void add_barrel(struct glint_zoom_mix *blend,
                       const struct glint_blend_output *o)
{
    struct glint_transfer *const t = blend->to;
    int kind = BARREL;

    while (kind < GLINT_OUT_KINDS && transfer_has(t, kind))
        kind++;
    if (kind == GLINT_OUT_KINDS)
        return;
    t->outputs |= UINT32_C(1) << kind;
    blend->added |= UINT32_C(1) << kind;
    t->exponent[kind] = o->exponent;
    t->degree_u[kind] = o->degree_u;
    t->degree_v[kind] = o->degree_v;
    for (int b = 0; b < ROWS; b++)
        for (int a = 0; a < GLINT_TABLE_WIDTH; a++)
            t->of.table[kind][b][a] = o->row[b][a];
    open_barrel(t, kind, TRANSFER_ONE_Q30 - blend->part_q30);
}

/* Mixes O with the barrel that has not been mixed yet and differs least from
 * it, if that is by less than is alike: in their boxes, or AT the same PLACES
 * of the pupil. Returns whether there is one. */
static int mix_barrel(struct glint_zoom_mix *blend,
                      const struct glint_blend_output *o, int at_places)
{
    struct glint_transfer *const t = blend->to;
    int64_t least = at_places ? NEAR_Q16 : LIKE_Q16;
    int best = -1;

    for (int kind = BARREL; kind < GLINT_OUT_KINDS; kind++) {
        int64_t off;

        if (!transfer_has(t, kind) || (blend->mixed | blend->added) >> kind & 1)
            continue;
        off = at_places ? apart_q16(blend, kind, o) : unlike_q16(t, kind, o);
        if (off < least) {
            least = off;
            best = kind;
        }
    }
    if (best < 0)
        return 0;
    t->exponent[best] = mix_output(blend, best, t->exponent[best], o);
    blend->mixed |= UINT32_C(1) << best;
    return 1;
}

/* -------------------------------------------------------------------- both */

int glint_blend_output(struct glint_zoom_mix *blend,
                       const struct glint_blend_output *o)
{
    struct glint_transfer *const t = blend->to;

    if (o->kind >= BARREL)
        return mix_barrel(blend, o, 0);
    if (o->kind == GLINT_OUT_ENERGY)
        mix_energy(blend, o);
    else if (transfer_has(t, o->kind))
        t->exponent[o->kind] =
            mix_output(blend, o->kind, t->exponent[o->kind], o);
    return 1;
}

void glint_blend_barrel(struct glint_zoom_mix *blend,
                        const struct glint_blend_output *o)
{
    if (!mix_barrel(blend, o, 1) && blend->part_q30 > 0)
        add_barrel(blend, o);
}

void glint_blend_end(const struct glint_zoom_mix *blend)
{
    if (blend->part_q30 < 0)
        return;
    for (int kind = BARREL; kind < GLINT_OUT_KINDS; kind++)
        if (transfer_has(blend->to, kind) &&
            !((blend->mixed | blend->added) >> kind & 1))
            open_barrel(blend->to, kind, blend->part_q30);
}
