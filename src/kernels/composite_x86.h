/* SPDX-License-Identifier: MIT
 *
 * What SSE4.1 and AVX2 have alike, for whoever defines V, a vector, OP(name),
 * an operation on its lanes, and WHOLE(name), one on the whole.
 */

static inline V v_set(int16_t x)
{
    return OP(set1_epi16)(x);
}

static inline V v_load(const int16_t *p)
{
    return WHOLE(load)((const V *)(const void *)p);
}

static inline void v_store(int16_t *p, V x)
{
    WHOLE(store)((V *)(void *)p, x);
}

/* As they lie, from any address. */
static inline V v_load_bytes(const uint8_t *p)
{
    return WHOLE(loadu)((const V *)(const void *)p);
}

static inline void v_store_bytes(uint8_t *p, V x)
{
    WHOLE(storeu)((V *)(void *)p, x);
}

#define v_add                OP(add_epi16)
#define v_sub                OP(sub_epi16)
#define v_add_sat            OP(adds_epi16)
#define v_add_unsigned_sat   OP(adds_epu16)
#define v_times              OP(mulhrs_epi16)
#define v_high_product       OP(mulhi_epu16)
#define v_low_product        OP(mullo_epi16)
#define v_min                OP(min_epi16)
#define v_max                OP(max_epi16)
#define v_and                WHOLE(and)
#define v_or                 WHOLE(or)
#define v_and_not            WHOLE(andnot)
#define v_equal              OP(cmpeq_epi16)
#define v_greater            OP(cmpgt_epi16)
#define v_left               OP(slli_epi16)
#define v_right              OP(srli_epi16)
#define v_right_signed       OP(srai_epi16)
#define v_look(table, index) OP(shuffle_epi8)(table, index)
#define v_pick(mask, a, b)   OP(blendv_epi8)(b, a, mask)

/* Rounded up; of values of 0 or more. */
#define v_mean OP(avg_epu16)

/* Of each pair of lanes: the other one, twice the first, twice the second. */
static inline V v_swap(V x)
{
    return v_look(x, v_places(0x0d0c0f0e09080b0a, 0x0504070601000302));
}

static inline V v_evens(V x)
{
    return v_look(x, v_places(0x0d0c0d0c09080908, 0x0504050401000100));
}

static inline V v_odds(V x)
{
    return v_look(x, v_places(0x0f0e0f0e0b0a0b0a, 0x0706070603020302));
}

/* Unsigned. */
static inline V v_not_less(V a, V b)
{
    return v_equal(OP(max_epu16)(a, b), a);
}

/* Places of the bytes of the entries K + BASE of a table, 0 .. 7. */
static inline V v_index(V k, V entry, int base)
{
    return v_add(v_low_product(k, entry),
                 v_set((int16_t)(0x0100 + base * 0x0202)));
}

static inline int v_is_zero(V x)
{
    return WHOLE(testz)(x, x);
}

#define W              V
#define w_add          OP(add_epi32)
#define w_right_signed OP(srai_epi32)

static inline W w_set(uint32_t x)
{
    return OP(set1_epi32)((int32_t)x);
}

static inline W w_load(const uint32_t *p)
{
    return WHOLE(load)((const W *)(const void *)p);
}

static inline void w_clear(uint32_t *p)
{
    WHOLE(store)((W *)(void *)p, WHOLE(setzero)());
}
