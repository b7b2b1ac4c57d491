/* SPDX-License-Identifier: MIT
 *
 * composite_c.c in vectors, for whoever defines the vectors: V, of V_N int16
 * lanes, and the operations used here. Included once by each variant, which
 * names the functions by KERNEL(name).
 */

#include "base/compiler.h"

/* The lanes of A where MASK is all ones, else those of B. */
#define PICK(mask, a, b) v_pick(mask, a, b)

struct tone {
    V toe_end, toe, toe_end_light, toe_light, power[5], offset;
    const struct glint_tone16 *tables;
};

static inline void tone_init(struct tone *t, const struct glint_tone16 *from)
{
    t->toe_end = v_set(from->toe_end_q7);
    t->toe = v_set(from->toe_q15);
    t->toe_end_light = v_set((int16_t)from->toe_end_q16);
    t->toe_light = v_set((int16_t)from->toe_q13);
    t->offset = v_set(from->offset_q7);
    for (int i = 0; i < 5; i++)
        t->power[i] = v_set(from->power_q15[i]);
    t->tables = from;
}

static inline V decode(const struct tone *t, V code)
{
    const V k = v_index(v_right(code, 12));
    const V place = v_left(v_and(code, v_set(4095)), 3);
    V x = v_look(v_table(t->tables->piece[3]), k);

    x = v_add(v_look(v_table(t->tables->piece[2]), k), v_times(place, x));
    x = v_add(v_look(v_table(t->tables->piece[1]), k), v_times(place, x));
    x = v_add_unsigned_sat(v_look(v_table(t->tables->piece[0]), k),
                           v_times(place, x));
    return PICK(v_greater(t->toe_end, code), v_times(code, t->toe), x);
}

static inline V encode(const struct tone *t, V light)
{
    const V four = v_set(4);
    const V k =
        v_index(v_add(v_add(v_add(four, v_not_less(light, v_set(1 << 8))),
                            v_not_less(light, v_set(1 << 10))),
                      v_add(v_not_less(light, v_set(1 << 12)),
                            v_not_less(light, v_set(1 << 14)))));
    const V m = v_sub(
        v_right(v_low_product(light, v_look(v_table(t->tables->lift), k)), 1),
        v_set(20480));
    const V toe = v_high_product(v_left(light, 3), t->toe_light);
    V x = t->power[4];

    for (int i = 3; i >= 0; i--)
        x = v_add(t->power[i], v_times(m, x));
    x = v_sub(
        v_high_product(v_left(x, 1),
                       v_look(v_table((const int16_t *)t->tables->scale), k)),
        t->offset);
    return PICK(v_not_less(light, t->toe_end_light), x, toe);
}

static inline V change_of(const struct tone *t, V code, V light)
{
    const V lit = encode(t, v_add_unsigned_sat(decode(t, code), light));
    const V change = v_max(v_sub(lit, code), v_set(0));

    return v_and_not(v_equal(light, v_set(0)), change);
}

/* The constants of a struct glint_mix. */
struct mix {
    struct tone tone;
    V black, luma, red_cr, green_cb, green_cr, blue_cb;
    V to_luma[3], to_chroma[3]; /* Cb and Cr by turns */
};

static inline void mix_init(struct mix *m, const struct glint_mix *from)
{
    tone_init(&m->tone, &from->tone);
    m->black = v_set(from->black);
    m->luma = v_set(from->luma_q15);
    m->red_cr = v_set(from->red_cr_q15);
    m->green_cb = v_set(from->green_cb_q15);
    m->green_cr = v_set(from->green_cr_q15);
    m->blue_cb = v_set(from->blue_cb_q15);
    for (int c = 0; c < 3; c++) {
        m->to_luma[c] = v_set(from->to_luma_q15[c]);
        m->to_chroma[c] =
            v_set_pair(from->to_chroma_q15[0][c], from->to_chroma_q15[1][c]);
    }
}

/* Adds light to the pixels of LUMA, CB, CR: returns their luma, and what R',
 * G', B' change by. */
static inline V add_pixels(const struct mix *m, V luma, V cb, V cr,
                           const uint16_t *const light[3], int i, V rounding,
                           V change[3])
{
    const V half = v_set(128), white = v_set(GLINT_WHITE_Q7);
    const V y = v_left(v_sub(luma, m->black), 6);
    const V base = v_add(y, v_times(y, m->luma));
    const V b = v_left(v_sub(cb, half), 8), r = v_left(v_sub(cr, half), 8);
    const V tint[3] = {v_times(r, m->red_cr),
                       v_add(v_times(b, m->green_cb), v_times(r, m->green_cr)),
                       v_times(b, m->blue_cb)};
    V sum = rounding;

    for (int c = 0; c < 3; c++) {
        const V l = v_load((const int16_t *)light[c] + i);
        const V halved = v_add_sat(tint[c], base);
        const V own = v_min(v_max(v_add_sat(halved, halved), v_set(0)), white);

        change[c] = change_of(&m->tone, own, l);
        sum = v_add_sat(sum, v_times(change[c], m->to_luma[c]));
    }
    return v_add(luma, v_right_signed(sum, 7));
}

void KERNEL(glint_add_luma)(uint8_t *luma, const uint8_t *cb, const uint8_t *cr,
                            const uint16_t *const light[3],
                            int16_t *const change[3], int n,
                            const struct glint_mix *mix, const int16_t *round)
{
    const V rounding = v_repeat(round);
    for (int i = 0; i < n; i += V_N) {
        struct mix m;
        V d[3];

        FORGET(mix);
        mix_init(&m, mix);
        v_store_codes(luma + i,
                      add_pixels(&m, v_load_codes(luma + i),
                                 v_load_codes(cb + i), v_load_codes(cr + i),
                                 light, i, rounding, d));
        for (int c = 0; c < 3; c++)
            v_store(change[c] + i, d[c]);
    }
}

void KERNEL(glint_add_pairs)(uint8_t *luma, uint8_t *chroma,
                             const uint16_t *const light[3],
                             int16_t *const mean[3], int n,
                             enum glint_pair_step step,
                             const struct glint_mix *mix, const int16_t *round,
                             const int16_t *round_chroma)
{
    const V rounding = v_repeat(round),
            chroma_rounding = v_repeat(round_chroma);
    for (int i = 0; i < n; i += V_N) {
        struct mix m;
        const V code = v_load_codes(chroma + i);
        V sum = chroma_rounding, d[3];

        FORGET(mix);
        mix_init(&m, mix);
        v_store_codes(luma + i,
                      add_pixels(&m, v_load_codes(luma + i), v_evens(code),
                                 v_odds(code), light, i, rounding, d));
        for (int c = 0; c < 3; c++) {
            d[c] = v_mean(d[c], v_swap(d[c]));
            if (step == GLINT_PAIRS_FIRST)
                v_store(mean[c] + i, d[c]);
            if (step == GLINT_PAIRS_SECOND)
                d[c] = v_mean(d[c], v_load(mean[c] + i));
            sum = v_add_sat(sum, v_times(d[c], m.to_chroma[c]));
        }
        if (step != GLINT_PAIRS_FIRST)
            v_store_codes(chroma + i, v_add(code, v_right_signed(sum, 7)));
    }
}

void KERNEL(glint_add_code)(uint8_t *code, const uint16_t *light, int n,
                            const struct glint_tone16 *tone16,
                            const int16_t *round)
{
    const V rounding = v_repeat(round);
    struct tone tone;

    tone_init(&tone, tone16);
    for (int i = 0; i < n; i += V_N) {
        const V c = v_load_codes(code + i);
        const V l = v_load((const int16_t *)light + i);
        const V d = change_of(&tone, v_left(c, 7), l);

        v_store_codes(code + i,
                      v_add(c, v_right_signed(v_add_sat(d, rounding), 7)));
    }
}

void KERNEL(glint_run_sum)(uint32_t *change_q24, uint32_t *carry_q24,
                           uint16_t *light_q16, int n)
{
    W carry = w_set(*carry_q24);

    for (int i = 0; i < n; i += V_N) {
        const W a = w_add(w_sums(w_load(change_q24 + i)), carry);
        const W b = w_add(w_sums(w_load(change_q24 + i + V_N / 2)), w_last(a));

        w_clear(change_q24 + i);
        w_clear(change_q24 + i + V_N / 2);
        carry = w_last(b);
        v_store((int16_t *)light_q16 + i,
                w_narrow(w_right_signed(w_add(a, w_set(128)), 8),
                         w_right_signed(w_add(b, w_set(128)), 8)));
    }
    *carry_q24 = w_first(carry);
}
