/* SPDX-License-Identifier: MIT
 *
 * composite_c.c in vectors, for whoever defines the vectors: V, of V_N int16
 * lanes, and the operations used here. Included once by each variant, which
 * names the functions by KERNEL(name).
 */

#include "base/compiler.h"

/* The lanes of A where MASK is all ones, else those of B. */
#define PICK(mask, a, b) v_pick(mask, a, b)

static inline V decode(const struct glint_tone16 *t, V code)
{
    const V k = v_index(v_right(code, 12), v_load(t->entry), 0);
    const V place = v_left(v_and(code, v_set(4095)), 3);
    V x = v_look(v_load(t->piece[2]), k);

    x = v_add(v_look(v_load(t->piece[1]), k), v_times(place, x));
    x = v_add_unsigned_sat(v_look(v_load(t->piece[0]), k), v_times(place, x));
    return PICK(v_greater(v_load(t->toe_end_q7), code),
                v_times(code, v_load(t->toe_q15)), x);
}

static inline V encode(const struct glint_tone16 *t, V light)
{
    const V half = v_right(light, 1); /* compares are of signed lanes */
    const V k = v_index(v_add(v_add(v_greater(half, v_set((1 << 7) - 1)),
                                    v_greater(half, v_set((1 << 9) - 1))),
                              v_add(v_greater(half, v_set((1 << 11) - 1)),
                                    v_greater(half, v_set((1 << 13) - 1)))),
                        v_load(t->entry), 4);
    const V m =
        v_sub(v_right(v_low_product(light, v_look(v_load(t->lift), k)), 1),
              v_set(20480));
    const V toe = v_high_product(v_left(light, 3), v_load(t->toe_q13));
    V x = v_load(t->power_q15[4]);

    for (int i = 3; i >= 0; i--)
        x = v_add(v_load(t->power_q15[i]), v_times(m, x));
    x = v_sub(v_high_product(v_left(x, 1), v_look(v_load(t->scale), k)),
              v_load(t->offset_q7));
    return PICK(v_not_less(light, v_load(t->toe_end_q16)), x, toe);
}

static inline V change_of(const struct glint_tone16 *t, V code, V light)
{
    const V lit = encode(t, v_add_unsigned_sat(decode(t, code), light));
    const V change = v_max(v_sub(lit, code), v_set(0));

    return v_and_not(v_equal(light, v_set(0)), change);
}

/* Whether pixels I .. I + V_N - 1 get no light. */
static inline int is_dark(const uint16_t *const light[3], int i)
{
    return v_is_zero(v_or(v_or(v_load((const int16_t *)light[0] + i),
                               v_load((const int16_t *)light[1] + i)),
                          v_load((const int16_t *)light[2] + i)));
}

/* Adds light to the pixels of LUMA, CB, CR: returns their luma, and what R',
 * G', B' change by. */
static inline V add_pixels(const struct glint_mix *m, V luma, V cb, V cr,
                           const uint16_t *const light[3], int i, V rounding,
                           V change[3])
{
    const V half = v_set(128), white = v_set(GLINT_WHITE_Q7);
    const V y = v_left(v_sub(luma, v_load(m->black)), 6);
    const V base = v_add(y, v_times(y, v_load(m->luma_q15)));
    const V b = v_left(v_sub(cb, half), 8), r = v_left(v_sub(cr, half), 8);
    const V tint[3] = {v_times(r, v_load(m->red_cr_q15)),
                       v_add(v_times(b, v_load(m->green_cb_q15)),
                             v_times(r, v_load(m->green_cr_q15))),
                       v_times(b, v_load(m->blue_cb_q15))};
    V sum = rounding;

    for (int c = 0; c < 3; c++) {
        const V l = v_load((const int16_t *)light[c] + i);
        const V halved = v_add_sat(tint[c], base);
        const V own = v_min(v_max(v_add_sat(halved, halved), v_set(0)), white);

        change[c] = change_of(&m->tone, own, l);
        sum = v_add_sat(sum, v_times(change[c], v_load(m->to_luma_q15[c])));
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
        V d[3];

        FORGET(mix);
        v_store_codes(luma + i,
                      add_pixels(mix, v_load_codes(luma + i),
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
        const V code = v_load_codes(chroma + i);
        V sum = chroma_rounding, d[3];

        if (step == GLINT_PAIRS_ALONE && is_dark(light, i))
            continue;
        FORGET(mix);
        v_store_codes(luma + i,
                      add_pixels(mix, v_load_codes(luma + i), v_evens(code),
                                 v_odds(code), light, i, rounding, d));
        for (int c = 0; c < 3; c++) {
            d[c] = v_mean(d[c], v_swap(d[c]));
            if (step == GLINT_PAIRS_FIRST)
                v_store(mean[c] + i, d[c]);
            if (step == GLINT_PAIRS_SECOND)
                d[c] = v_mean(d[c], v_load(mean[c] + i));
            sum = v_add_sat(sum, v_times(d[c], v_load(mix->to_chroma_q15[c])));
        }
        if (step != GLINT_PAIRS_FIRST)
            v_store_codes(chroma + i, v_add(code, v_right_signed(sum, 7)));
    }
}

void KERNEL(glint_add_packed)(uint8_t *pixels, const uint16_t *const light[3],
                              int n, int luma_at, const struct glint_mix *mix,
                              const int16_t *round, const int16_t *round_chroma)
{
    const V rounding = v_repeat(round),
            chroma_rounding = v_repeat(round_chroma);
    const V white = v_set(255);

    for (int i = 0; i < n; i += V_N) {
        const V words = v_load_bytes(pixels + 2 * i);
        const V low = v_and(words, white), high = v_right(words, 8);
        const V code = luma_at ? low : high;
        V luma = luma_at ? high : low;
        V sum = chroma_rounding, d[3], chroma;

        if (is_dark(light, i))
            continue;
        FORGET(mix);
        luma = v_min(add_pixels(mix, luma, v_evens(code), v_odds(code), light,
                                i, rounding, d),
                     white);
        for (int c = 0; c < 3; c++)
            sum = v_add_sat(sum, v_times(v_mean(d[c], v_swap(d[c])),
                                         v_load(mix->to_chroma_q15[c])));
        chroma =
            v_min(v_max(v_add(code, v_right_signed(sum, 7)), v_set(0)), white);
        v_store_bytes(pixels + 2 * i, luma_at ? v_or(chroma, v_left(luma, 8))
                                              : v_or(luma, v_left(chroma, 8)));
    }
}

void KERNEL(glint_add_code)(uint8_t *code, const uint16_t *light, int n,
                            const struct glint_tone16 *tone,
                            const int16_t *round)
{
    const V rounding = v_repeat(round);

    for (int i = 0; i < n; i += V_N) {
        const V c = v_load_codes(code + i);
        const V l = v_load((const int16_t *)light + i);

        if (v_is_zero(l))
            continue;
        FORGET(tone);
        v_store_codes(
            code + i,
            v_add(c, v_right_signed(
                         v_add_sat(change_of(tone, v_left(c, 7), l), rounding),
                         7)));
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
