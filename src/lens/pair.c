/* SPDX-License-Identifier: MIT
 *
 * Finds corresponding barrels of two zoom positions.
 *
 *   in   the barrels of a bundle at both positions, as polynomials
 *   out  for each barrel of the other position, the barrels of this position
 *        with which it is mixed
 *
 * A model does not state to which surface a barrel (the rim that cuts rays)
 * belongs. Two barrels correspond if their polynomials have nearly the same
 * values in one of two comparisons. The first is at equal points of each
 * position's box, which follows the visible rays. The second is at equal points
 * of the pupil, because boxes may change faster than barrels move. The pair
 * that differs least is matched first. A barrel that remains is matched to the
 * most similar barrel of the other position even if that one is matched
 * already. */
#include "base/q.h"
#include "lens/blend.h"
#include "lens/terms.h"

enum {
    BARREL = GLINT_OUT_BARREL_0,
    /* max difference between the values of corresponding barrels, _q16 */
    LIKE_Q16 = 1 << 15,
    FAR_Q16 = 1 << 28,
    ACROSS = 3 /* number of sample points per row; there are two rows */
};

struct glint_blend_output glint_blend_get_output(struct glint_transfer *t,
                                                 int kind)
{
    return (struct glint_blend_output){.kind = (uint8_t)kind,
                                       .exponent = t->exponent[kind],
                                       .row = t->table[kind],
                                       .degree_u = t->degree_u[kind],
                                       .degree_v = t->degree_v[kind]};
}

int32_t glint_blend_evaluate_q16(const struct glint_blend_output *o,
                                 int64_t u_q24, int64_t v_q24)
{
    const int32_t exponent = o->exponent;
    int64_t sum = 0;

    for (int b = o->degree_v; b >= 0; b--) {
        int64_t of_u = 0;

        for (int a = o->degree_u; a >= 0; a--)
            of_u = q_shift(of_u * u_q24, 24) + o->row[b][a];
        sum = q_shift(sum * v_q24, 24) + of_u;
    }
    if (exponent < -16)
        sum = -16 - exponent > 62 ? 0 : q_shift(sum, -16 - exponent);
    return q_clamp_sat(sum, -FAR_Q16, FAR_Q16);
}

static int64_t get_min_i64(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* Finds the overlap of both positions' boxes in the pupil: FIRST .. LAST along
 * u and 0 .. HIGH along v, in half sizes of this position's box. Returns 0 if
 * the boxes do not overlap or are too far apart. */
static int find_box_overlap(const struct glint_zoom_mix *blend, int64_t *first,
                            int64_t *last, int64_t *high)
{
    const struct glint_blend_move *const to = &blend->move[0];
    const int64_t one = 1 << 24, half = one + to->wider_q24;

    *first = -get_min_i64(one, half - to->along_q24);
    *last = get_min_i64(one, half + to->along_q24);
    *high = get_min_i64(one, one + to->higher_q24);
    return !blend->far && *first < *last;
}

/* Sets VALUES to the values of barrel O at all sample points. SIDE: 0 for a
 * barrel of this position, 1 for one of the other position. */
static void set_barrel_values(const struct glint_zoom_mix *blend, int side,
                              const struct glint_blend_output *o,
                              int32_t (*values)[GLINT_BLEND_PLACES])
{
    const struct glint_blend_move *const back = &blend->move[1];
    const int64_t one = 1 << 24;
    int64_t first, last, high;
    const int any = find_box_overlap(blend, &first, &last, &high);

    for (int k = 0; k < GLINT_BLEND_PLACES; k++) {
        int64_t u = first + (last - first) * (k % ACROSS) / (ACROSS - 1);
        int64_t v = k < ACROSS ? 0 : high;

        if (side) {
            u = q_shift(u * (one - back->wider_q24), 24) - back->along_q24;
            v = q_shift(v * (one - back->higher_q24), 24);
            /* U and V are clamped to the box, because moves are rounded to
             * units that may be as large as a box. */
            u = -get_min_i64(one, -get_min_i64(one, u));
            v = get_min_i64(one, v);
        }
        values[0][k] = glint_blend_evaluate_q16(o, (k % ACROSS - 1) * one,
                                                k < ACROSS ? 0 : one);
        values[1][k] = any ? glint_blend_evaluate_q16(o, u, v) : 0;
    }
}

/* Returns the difference between two barrels: the max difference of their
 * values over sample points of their own boxes, or over points of the pupil.
 * The smaller of these two maxima is returned, at most LIKE_Q16. */
static int64_t compute_barrel_difference_q16(const struct glint_zoom_mix *blend,
                                             int ours, int theirs)
{
    int64_t first, last, high, least = LIKE_Q16;

    for (int way = 0; way <= find_box_overlap(blend, &first, &last, &high);
         way++) {
        int64_t most = 0;

        for (int k = 0; k < GLINT_BLEND_PLACES; k++) {
            const int64_t off = (int64_t)q_magnitude(
                (int64_t)blend->barrel_q16[0][ours][way][k] -
                blend->barrel_q16[1][theirs][way][k]);

            most = off > most ? off : most;
        }
        least = get_min_i64(least, most);
    }
    return least;
}

void glint_blend_register_barrel(struct glint_zoom_mix *blend,
                                 const struct glint_blend_output *o)
{
    if (o->kind >= BARREL)
        set_barrel_values(blend, 1, o, blend->barrel_q16[1][blend->n_others++]);
}

/* Finds the two barrels that differ least, one of OURS and one of THEIRS (bit
 * masks). Returns whether they differ little enough to correspond. */
static int find_most_similar_pair(const struct glint_zoom_mix *blend,
                                  uint32_t ours, uint32_t theirs, int pair[2])
{
    int64_t least = LIKE_Q16;

    for (int i = 0; ours >> i; i++)
        for (int k = 0; theirs >> k; k++) {
            const int64_t off = ours >> i & theirs >> k & 1
                                    ? compute_barrel_difference_q16(blend, i, k)
                                    : LIKE_Q16;

            if (off < least) {
                least = off;
                pair[0] = i;
                pair[1] = k;
            }
        }
    return least < LIKE_Q16;
}

static void record_barrel_pair(struct glint_zoom_mix *blend, const int pair[2])
{
    blend->partners[pair[1]] |= UINT32_C(1) << pair[0];
    blend->taken |= UINT32_C(1) << pair[0];
}

/* Finds partners for the unmatched barrels OURS and THEIRS (bit masks) among
 * all barrels. OWN: mask of all barrels of this position. */
static void pair_unmatched_barrels(struct glint_zoom_mix *blend, uint32_t own,
                                   uint32_t ours, uint32_t theirs)
{
    const uint32_t all = (UINT32_C(1) << blend->n_others) - 1;
    int pair[2];

    for (int i = 0; ours >> i; i++)
        if (find_most_similar_pair(blend, ours & UINT32_C(1) << i, all, pair))
            record_barrel_pair(blend, pair);
    for (int k = 0; theirs >> k; k++)
        if (find_most_similar_pair(blend, own, theirs & UINT32_C(1) << k,
                                   pair)) {
            const struct glint_blend_output copy =
                glint_blend_get_output(blend->to, BARREL + pair[0]);

            pair[0] = glint_blend_add_barrel(blend->to, &copy);
            if (pair[0] >= 0)
                record_barrel_pair(blend, pair);
        }
}

void glint_blend_pair_barrels(struct glint_zoom_mix *blend)
{
    const uint32_t own = blend->to->outputs >> BARREL;
    uint32_t ours = own, theirs = (UINT32_C(1) << blend->n_others) - 1;
    int pair[2];

    for (int k = 0; ours >> k; k++) {
        const struct glint_blend_output o =
            glint_blend_get_output(blend->to, BARREL + k);

        if (ours >> k & 1)
            set_barrel_values(blend, 0, &o, blend->barrel_q16[0][k]);
    }
    while (find_most_similar_pair(blend, ours, theirs, pair)) {
        record_barrel_pair(blend, pair);
        ours &= ~(UINT32_C(1) << pair[0]);
        theirs &= ~(UINT32_C(1) << pair[1]);
    }
    if (blend->part_q30 > 0)
        pair_unmatched_barrels(blend, own, ours, theirs);
}

int glint_blend_add_barrel(struct glint_transfer *t,
                           const struct glint_blend_output *o)
{
    int kind = BARREL;

    while (kind < GLINT_OUT_KINDS && has_transfer_output(t, kind))
        kind++;
    if (kind == GLINT_OUT_KINDS)
        return -1;
    t->outputs |= UINT32_C(1) << kind;
    t->exponent[kind] = o->exponent;
    t->degree_u[kind] = o->degree_u;
    t->degree_v[kind] = o->degree_v;
    for (int b = 0; b <= GLINT_MAX_POWER; b++)
        for (int a = 0; a < GLINT_TABLE_WIDTH; a++)
            t->table[kind][b][a] = o->row[b][a];
    return kind - BARREL;
}
