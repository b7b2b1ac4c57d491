/* SPDX-License-Identifier: MIT
 *
 * composite_c.c in vectors, for whoever defines the vectors: V, of V_N int16
 * lanes, V_PARTS of which are sixteen, and the operations used here. Included
 * once by each variant, which names the functions by KERNEL(name).
 *
 * Pixels go by sixteen, first the even ones of each pair and then the odd ones,
 * in V_PARTS vectors; chroma and what is of whole pairs fills one vector, where
 * that has sixteen lanes, twice.
 *
 * TONE, MIX: constants as this variant wants them, which LOAD_TONE and LOAD_MIX
 * make of the plain ones. CONSTANT(c) is one of their lanes, TIMES(x, f, I) x
 * times factor I of F.
 */

enum { BLOCK = V_N * V_PARTS };

static WHOLLY_INLINE V decode(const TONE *t, V code)
{
    const V w = v_sub_unsigned_sat(code, CONSTANT(t->toe_end));
    V rise = v_add(CONSTANT(t->rise[1]), TIMES(w, t->factor, GLINT_TONE_RISE));

    rise = v_add(CONSTANT(t->rise[0]), v_times(w, rise));
    return v_add(TIMES(code, t->factor, GLINT_TONE_TOE),
                 v_times(v_times(w, w), rise));
}

static WHOLLY_INLINE V encode(const TONE *t, V light)
{
    const V zeros = v_zeros(light);
    const PLACES at = v_places_of(t, zeros);
    const V z = v_raise(t, light, zeros, at);
    const V turn =
        v_add(CONSTANT(t->turn), TIMES(z, t->factor, GLINT_TONE_TURN));
    V x = v_times(turn, v_look(t->curve, at));

    x = v_add(v_look(t->slope, at), v_times(z, x));
    return v_add(v_look(t->level, at), v_times(z, x));
}

static WHOLLY_INLINE V change_of(const TONE *t, V code, V light)
{
    return v_sub_unsigned_sat(encode(t, v_add_half(decode(t, code), light)),
                              code);
}

static WHOLLY_INLINE void tint_of(const MIX *m, V cb_q7, V cr_q7, V tint[3])
{
    const V half = v_set(1 << 14);
    const V b = v_sub(cb_q7, half), r = v_sub(cr_q7, half);
    const V blue = TIMES(b, m->from_ycc, GLINT_MIX_BLUE_CB);

    tint[0] = TIMES(r, m->from_ycc, GLINT_MIX_RED_CR);
    tint[1] = v_add(TIMES(b, m->from_ycc, GLINT_MIX_GREEN_CB),
                    TIMES(r, m->from_ycc, GLINT_MIX_GREEN_CR));
    tint[2] = v_add(blue, blue);
}

static WHOLLY_INLINE V change_part(const MIX *m, V base, V tint, V light)
{
    const V half = v_add_sat(base, tint);

    return change_of(&m->tone, v_max(v_add_sat(half, half), v_set(0)), light);
}

/* What one channel of N vectors, 1 or 2, changes by; no loop, as those would be
 * too long for compilers to unroll. */
static WHOLLY_INLINE void change_channel(const MIX *m, int n, const V *base,
                                         V tint, const V *light, V *change)
{
    change[0] = change_part(m, base[0], tint, light[0]);
    if (n > 1)
        change[n - 1] = change_part(m, base[n - 1], tint, light[n - 1]);
}

/* The light of N vectors of a channel from *AT on, which is loaded when WAIT is
 * there: one vector is of pixels in their order, unless PAIRS. */
static WHOLLY_INLINE void load_light(const uint16_t *at, int pairs, V wait,
                                     V *light)
{
    LOAD_AFTER(at, wait);
    if (pairs)
        v_load_pairs(at, light);
    else
        light[0] = v_load((const int16_t *)at);
}

/* What R', B' and Y' of N vectors of pixels of LUMA_Q7 change by: channel by
 * channel, so that no more is under way than there are registers for. */
static WHOLLY_INLINE void change_pixels(const MIX *m, int n, int pairs,
                                        const V *luma_q7, V tint[3],
                                        const uint16_t *const light[3], int i,
                                        V kept[3][V_PARTS])
{
    V base[V_PARTS], green[V_PARTS], sum[V_PARTS], any[V_PARTS], l[V_PARTS];

    for (int k = 0; k < n; k++)
        base[k] = v_add(TIMES(luma_q7[k], m->from_ycc, GLINT_MIX_BASE),
                        CONSTANT(m->black));
    load_light(light[0] + i, pairs, base[0], l);
    change_channel(m, n, base, tint[0], l, kept[0]);
    for (int k = 0; k < n; k++) {
        sum[k] = TIMES(kept[0][k], m->to_ycc, GLINT_MIX_LUMA);
        any[k] = l[k];
    }
    load_light(light[1] + i, pairs, sum[n - 1], l);
    AFTER(tint[1], sum[n - 1]);
    change_channel(m, n, base, tint[1], l, green);
    for (int k = 0; k < n; k++) {
        sum[k] = v_add(sum[k], TIMES(green[k], m->to_ycc, GLINT_MIX_LUMA + 1));
        any[k] = v_or(any[k], l[k]);
    }
    load_light(light[2] + i, pairs, sum[n - 1], l);
    AFTER(tint[2], sum[n - 1]);
    change_channel(m, n, base, tint[2], l, kept[1]);
    for (int k = 0; k < n; k++) {
        const V dark = v_equal(v_or(any[k], l[k]), v_set(0));

        sum[k] =
            v_add(sum[k], TIMES(kept[1][k], m->to_ycc, GLINT_MIX_LUMA + 2));
        kept[0][k] = v_and_not(dark, kept[0][k]);
        kept[1][k] = v_and_not(dark, kept[1][k]);
        kept[2][k] = v_and_not(dark, sum[k]);
    }
}

void KERNEL(glint_add_luma)(uint8_t *luma, const uint8_t *cb, const uint8_t *cr,
                            const uint16_t *const light[3],
                            int16_t *const change[3], int n,
                            const struct glint_mix *mix, const int16_t *round)
{
    const V rounding = v_repeat(round);
    LOAD_MIX(m, mix);

    for (int i = 0; i < n; i += V_N) {
        const V y_q7 = v_load_codes(luma + i);
        V tint[3], d[3][V_PARTS];

        tint_of(m, v_load_codes(cb + i), v_load_codes(cr + i), tint);
        change_pixels(m, 1, 0, &y_q7, tint, light, i, d);
        v_store_codes(luma + i, v_add_sat(v_add(y_q7, rounding), d[2][0]));
        for (int c = 0; c < 3; c++)
            v_store(change[c] + i, d[c][0]);
    }
}

/* What light does to sixteen pixels: to luma at once, and to what their chroma
 * goes by: the means of R', B' and Y' of the pairs. */
static WHOLLY_INLINE void change_block(const MIX *m, V luma_q7[V_PARTS],
                                       V cb_q7, V cr_q7,
                                       const uint16_t *const light[3], int i,
                                       const V rounding[V_PARTS], V mean[3])
{
    V tint[3], d[3][V_PARTS];

    tint_of(m, cb_q7, cr_q7, tint);
    change_pixels(m, V_PARTS, 1, luma_q7, tint, light, i, d);
    for (int k = 0; k < V_PARTS; k++)
        luma_q7[k] = v_add_sat(v_add(luma_q7[k], rounding[k]), d[2][k]);
    for (int c = 0; c < 3; c++)
        mean[c] = v_pair_mean(d[c]);
}

/* OWN, K: as in composite_c.c. */
#define ADD_CHROMA(m, code_q7, rounding, own, luma, k) \
    v_add_sat(                                         \
        v_add(code_q7, rounding),                      \
        v_sub(TIMES(own, (m)->to_ycc, k), TIMES(luma, (m)->to_ycc, (k) + 1)))

/* Whether none of sixteen pixels gets light. */
static WHOLLY_INLINE int all_dark(const uint16_t *const light[3], int i)
{
    V any = v_set(0);

    for (int c = 0; c < 3; c++)
        for (int k = 0; k < BLOCK; k += V_N)
            any = v_or(any, v_load((const int16_t *)light[c] + i + k));
    return v_is_zero(any);
}

void KERNEL(glint_add_pairs)(uint8_t *luma, uint8_t *chroma,
                             const uint16_t *const light[3],
                             int16_t *const mean[3], int n,
                             enum glint_pair_step step,
                             const struct glint_mix *mix, const int16_t *round,
                             const int16_t *round_chroma)
{
    LOAD_MIX(m, mix);
    V rounding[V_PARTS], c_rounding[2];

    v_round_pairs(round, rounding);
    v_round_chroma(round_chroma, c_rounding);
    for (int i = 0; i < n; i += BLOCK) {
        V y[V_PARTS], c[2], d[3];

        if (step == GLINT_PAIRS_ALONE && all_dark(light, i))
            continue;
        v_load_code_pairs(luma + i, y);
        v_load_chroma(chroma + i, c);
        change_block(m, y, c[0], c[1], light, i, rounding, d);
        v_store_code_pairs(luma + i, y);
        for (int k = 0; k < 3; k++) {
            if (step == GLINT_PAIRS_FIRST)
                v_store_mean(mean[k] + i / 2, d[k]);
            if (step == GLINT_PAIRS_SECOND)
                d[k] = v_mean(d[k], v_load_mean(mean[k] + i / 2));
        }
        if (step == GLINT_PAIRS_FIRST)
            continue;
        c[0] =
            ADD_CHROMA(m, c[0], c_rounding[0], d[1], d[2], GLINT_MIX_CB_BLUE);
        c[1] = ADD_CHROMA(m, c[1], c_rounding[1], d[0], d[2], GLINT_MIX_CR_RED);
        v_store_chroma(chroma + i, c);
    }
}

static WHOLLY_INLINE void add_packed(uint8_t *pixels,
                                     const uint16_t *const light[3], int n,
                                     int luma_at, const struct glint_mix *mix,
                                     const int16_t *round,
                                     const int16_t *round_chroma)
{
    LOAD_MIX(m, mix);
    V rounding[V_PARTS], c_rounding[2];

    v_round_pairs(round, rounding);
    v_round_chroma(round_chroma, c_rounding);
    for (int i = 0; i < n; i += BLOCK) {
        V y[V_PARTS], c[2], d[3];

        if (all_dark(light, i))
            continue;
        v_load_packed(pixels + 2 * i, luma_at, y, c);
        change_block(m, y, c[0], c[1], light, i, rounding, d);
        c[0] =
            ADD_CHROMA(m, c[0], c_rounding[0], d[1], d[2], GLINT_MIX_CB_BLUE);
        c[1] = ADD_CHROMA(m, c[1], c_rounding[1], d[0], d[2], GLINT_MIX_CR_RED);
        v_store_packed(pixels + 2 * i, luma_at, y, c);
    }
}

/* Twice, as choosing for every block costs as much as adding a channel's light
 * to a pixel. */
void KERNEL(glint_add_packed)(uint8_t *pixels, const uint16_t *const light[3],
                              int n, int luma_at, const struct glint_mix *mix,
                              const int16_t *round, const int16_t *round_chroma)
{
    if (luma_at)
        add_packed(pixels, light, n, 1, mix, round, round_chroma);
    else
        add_packed(pixels, light, n, 0, mix, round, round_chroma);
}

/* --------------------------------------------------------------------- quads
 *
 * Two rows of as many pixels as have a vector of quads, V_QUADS blocks of
 * sixteen.
 */

enum { V_QUADS = 2 * V_N / 16 };

#if V_PARTS == 2
/* Of one block: the means of its pairs, its chroma, and the other way round;
 * who has two blocks says how. */
static WHOLLY_INLINE V v_pairs_joined(V x[1][2])
{
    return v_mean(x[0][0], x[0][1]);
}

static WHOLLY_INLINE V v_chroma_joined(V c[1][2], int k)
{
    return c[0][k];
}

static WHOLLY_INLINE V v_quads_of_block(V x, int b)
{
    (void)b;
    return x;
}
#endif

struct quads {
    V luma[V_QUADS][V_PARTS], chroma[V_QUADS][2];
};

struct quad_rounding {
    V luma[V_PARTS], chroma[2];
};

static WHOLLY_INLINE void load_rounding(const int16_t *const round[2],
                                        const int16_t *const round_chroma[2],
                                        struct quad_rounding rounding[2])
{
    for (int k = 0; k < 2; k++) {
        v_round_pairs(round[k], rounding[k].luma);
        v_round_chroma(round_chroma[k], rounding[k].chroma);
    }
}

static WHOLLY_INLINE int quads_are_dark(const uint16_t *const light[3], int i)
{
    const V red = v_load((const int16_t *)light[0] + i);
    const V green = v_load((const int16_t *)light[1] + i);

    return v_is_zero(
        v_or(v_or(red, green), v_load((const int16_t *)light[2] + i)));
}

/* As in composite_c.c. */
static WHOLLY_INLINE V share_of(const TONE *t, V part, V whole)
{
    const V zeros = v_zeros(whole);
    const PLACES at = v_places_of(t, zeros);
    const V held = v_sub(part, v_sub_unsigned_sat(part, whole));
    const V n = v_max(v_right(v_raise(t, whole, zeros, at), 1), v_set(1 << 14));
    const V d = v_right(v_raise(t, held, zeros, at), 1);
    V r = v_sub(v_set((int16_t)GLINT_SHARE_FROM),
                v_times(n, v_set(GLINT_SHARE_SLOPE))),
      q;

    for (int k = 0; k < 2; k++) {
        r = v_times(r, v_sub(v_set(INT16_MIN), v_times(n, r)));
        r = v_add_sat(r, r);
    }
    q = v_times(d, r);
    return v_add_sat(q, q);
}

/* Means of quads, what these change by, and what share of their room to white
 * that is. */
struct quad_change {
    V luma_q7, luma, chroma_q7[2], chroma[2], share;
};

static WHOLLY_INLINE V changed(V code_q7, V rounding, V mean_q7, V change,
                               V share)
{
    return v_add_sat(
        v_add(code_q7, rounding),
        v_add_sat(change, v_times(v_sub(mean_q7, code_q7), share)));
}

static WHOLLY_INLINE void add_to_row(struct quads *q,
                                     const struct quad_rounding *r,
                                     const struct quad_change *d)
{
    for (int b = 0; b < V_QUADS; b++) {
        const V share = v_quads_of_block(d->share, b);
        const V mean = v_quads_of_block(d->luma_q7, b);
        const V luma = v_quads_of_block(d->luma, b);

        for (int k = 0; k < V_PARTS; k++) {
            const V less = v_times(v_sub(mean, q->luma[b][k]), share);

            q->luma[b][k] = v_add_sat(v_add(q->luma[b][k], r->luma[k]),
                                      v_max(v_add_sat(luma, less), v_set(0)));
        }
        for (int k = 0; k < 2; k++)
            q->chroma[b][k] = changed(q->chroma[b][k], r->chroma[k],
                                      v_quads_of_block(d->chroma_q7[k], b),
                                      v_quads_of_block(d->chroma[k], b), share);
    }
}

/* Light from I on. */
static WHOLLY_INLINE void change_quads(const MIX *m, struct quads row[2],
                                       const struct quad_rounding rounding[2],
                                       const uint16_t *const light[3], int i)
{
    struct quad_change q;
    V tint[3], d[3][V_PARTS];

    q.luma_q7 =
        v_mean(v_pairs_joined(row[0].luma), v_pairs_joined(row[1].luma));
    for (int k = 0; k < 2; k++)
        q.chroma_q7[k] = v_mean(v_chroma_joined(row[0].chroma, k),
                                v_chroma_joined(row[1].chroma, k));
    tint_of(m, q.chroma_q7[0], q.chroma_q7[1], tint);
    change_pixels(m, 1, 0, &q.luma_q7, tint, light, i, d);
    q.luma = d[2][0];
    q.share = share_of(&m->tone, q.luma,
                       v_sub_unsigned_sat(CONSTANT(m->white), q.luma_q7));
    q.chroma[0] = v_sub(TIMES(d[1][0], m->to_ycc, GLINT_MIX_CB_BLUE),
                        TIMES(d[2][0], m->to_ycc, GLINT_MIX_CB_LUMA));
    q.chroma[1] = v_sub(TIMES(d[0][0], m->to_ycc, GLINT_MIX_CR_RED),
                        TIMES(d[2][0], m->to_ycc, GLINT_MIX_CR_LUMA));
    for (int k = 0; k < 2; k++)
        add_to_row(&row[k], &rounding[k], &q);
}

void KERNEL(glint_add_quads)(uint8_t *const luma[2], uint8_t *const chroma[2],
                             const uint16_t *const light[3], int n,
                             const struct glint_mix *mix,
                             const int16_t *const round[2],
                             const int16_t *const round_chroma[2])
{
    struct quad_rounding rounding[2];
    LOAD_MIX(m, mix);

    load_rounding(round, round_chroma, rounding);
    for (int i = 0; i < n; i += 2 * V_N) {
        struct quads row[2];

        if (quads_are_dark(light, i / 2))
            continue;
        for (int k = 0; k < 2; k++)
            for (int b = 0; b < V_QUADS; b++) {
                v_load_code_pairs(luma[k] + i + 16 * b, row[k].luma[b]);
                v_load_chroma(chroma[k] + i + 16 * b, row[k].chroma[b]);
            }
        change_quads(m, row, rounding, light, i / 2);
        for (int k = 0; k < 2; k++)
            for (int b = 0; b < V_QUADS; b++) {
                v_store_code_pairs(luma[k] + i + 16 * b, row[k].luma[b]);
                v_store_chroma(chroma[k] + i + 16 * b, row[k].chroma[b]);
            }
    }
}

void KERNEL(glint_add_quads_packed)(uint8_t *const pixels[2],
                                    const uint16_t *const light[3], int n,
                                    int luma_at, const struct glint_mix *mix,
                                    const int16_t *const round[2])
{
    struct quad_rounding rounding[2];
    LOAD_MIX(m, mix);

    load_rounding(round, round, rounding);
    for (int i = 0; i < n; i += 2 * V_N) {
        struct quads row[2];

        if (quads_are_dark(light, i / 2))
            continue;
        for (int k = 0; k < 2; k++)
            for (int b = 0; b < V_QUADS; b++)
                v_load_packed(pixels[k] + 2 * i + 32 * b, luma_at,
                              row[k].luma[b], row[k].chroma[b]);
        change_quads(m, row, rounding, light, i / 2);
        for (int k = 0; k < 2; k++)
            for (int b = 0; b < V_QUADS; b++)
                v_store_packed(pixels[k] + 2 * i + 32 * b, luma_at,
                               row[k].luma[b], row[k].chroma[b]);
    }
}

void KERNEL(glint_add_code)(uint8_t *code, const uint16_t *light, int n,
                            const struct glint_tone16 *tone,
                            const int16_t *round)
{
    const V rounding = v_repeat(round);
    LOAD_TONE(t, tone);

    for (int i = 0; i < n; i += V_N) {
        const V c_q7 = v_load_codes(code + i);
        const V l = v_load((const int16_t *)light + i);
        V change;

        if (v_is_zero(l))
            continue;
        change = v_and_not(v_equal(l, v_set(0)),
                           change_of(t, v_add(c_q7, v_right(c_q7, 8)), l));
        v_store_codes(code + i,
                      v_add_sat(v_add(c_q7, rounding),
                                TIMES(change, t->factor, GLINT_TONE_Q7)));
    }
}
