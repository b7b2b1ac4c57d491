/* SPDX-License-Identifier: MIT
 *
 * composite_c.c in vectors, for whoever defines the vectors: V, of V_N int16
 * lanes, and the operations used here. Included once by each variant, which
 * names the functions by KERNEL(name).
 */

/* The lanes of A where MASK is all ones, else those of B. */
#define PICK(mask, a, b) v_pick(mask, a, b)

struct tone {
    V toe_end, toe, toe_end_light, toe_light, power[5], scale, lift, offset;
    V piece[4];
};

static inline void tone_init(struct tone *t, const struct glint_tone16 *from)
{
    t->toe_end = v_set(from->toe_end_q7);
    t->toe = v_set(from->toe_q15);
    t->toe_end_light = v_set((int16_t)from->toe_end_q16);
    t->toe_light = v_set((int16_t)from->toe_q13);
    t->offset = v_set(from->offset_q7);
    t->lift = v_table(from->lift);
    t->scale = v_table((const int16_t *)from->scale);
    for (int i = 0; i < 5; i++)
        t->power[i] = v_set(from->power_q15[i]);
    for (int i = 0; i < 4; i++)
        t->piece[i] = v_table(from->piece[i]);
}

static inline V decode(const struct tone *t, V code)
{
    const V k = v_index(v_right(code, 12));
    const V place = v_left(v_and(code, v_set(4095)), 3);
    V x = v_look(t->piece[3], k);

    x = v_add(v_look(t->piece[2], k), v_times(place, x));
    x = v_add(v_look(t->piece[1], k), v_times(place, x));
    x = v_add_unsigned_sat(v_look(t->piece[0], k), v_times(place, x));
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
    const V m = v_sub(v_right(v_low_product(light, v_look(t->lift, k)), 1),
                      v_set(20480));
    const V toe = v_high_product(v_left(light, 3), t->toe_light);
    V x = t->power[4];

    for (int i = 3; i >= 0; i--)
        x = v_add(t->power[i], v_times(m, x));
    x = v_sub(v_high_product(v_left(x, 1), v_look(t->scale, k)), t->offset);
    return PICK(v_not_less(light, t->toe_end_light), x, toe);
}

static inline V change_of(const struct tone *t, V code, V light)
{
    const V lit = encode(t, v_add_unsigned_sat(decode(t, code), light));
    const V change = v_max(v_sub(lit, code), v_set(0));

    return v_and_not(v_equal(light, v_set(0)), change);
}

void KERNEL(glint_add_luma)(uint8_t *luma, const uint8_t *cb, const uint8_t *cr,
                            const uint16_t *const light[3],
                            int16_t *const change[3], int n,
                            const struct glint_mix *mix, const int16_t *round)
{
    const V white = v_set(GLINT_WHITE_Q7), half = v_set(128);
    const V rounding = v_repeat(round);
    struct tone tone;

    tone_init(&tone, &mix->tone);
    for (int i = 0; i < n; i += V_N) {
        const V code = v_load_codes(luma + i);
        const V y = v_left(v_sub(code, v_set(mix->black)), 6);
        const V base = v_add(y, v_times(y, v_set(mix->luma_q15)));
        const V b = v_left(v_sub(v_load_codes(cb + i), half), 8);
        const V r = v_left(v_sub(v_load_codes(cr + i), half), 8);
        const V tint[3] = {v_times(r, v_set(mix->red_cr_q15)),
                           v_add(v_times(b, v_set(mix->green_cb_q15)),
                                 v_times(r, v_set(mix->green_cr_q15))),
                           v_times(b, v_set(mix->blue_cb_q15))};
        V sum = rounding;

        for (int c = 0; c < 3; c++) {
            const V l = v_load((const int16_t *)light[c] + i);
            const V halved = v_add_sat(tint[c], base);
            const V own =
                v_min(v_max(v_add_sat(halved, halved), v_set(0)), white);
            const V d = change_of(&tone, own, l);

            v_store(change[c] + i, d);
            sum = v_add_sat(sum, v_times(d, v_set(mix->to_luma_q15[c])));
        }
        v_store_codes(luma + i, v_add(code, v_right_signed(sum, 7)));
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
