/* SPDX-License-Identifier: MIT
 *
 * What SSE4.1 and AVX2 have alike, for whoever defines V, a vector, OP(name),
 * an operation on its lanes, WHOLE(name), one on the whole, v_half, which loads
 * eight lanes to all of it, and v_bytes, of two 64-bit numbers the same.
 */

/* Sixteen bytes, from any address. */
static inline __m128i b_load(const void *p)
{
    return _mm_loadu_si128((const __m128i *)p);
}

static inline void b_store(void *p, __m128i x)
{
    _mm_storeu_si128((__m128i *)p, x);
}

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

#define v_add              OP(add_epi16)
#define v_sub              OP(sub_epi16)
#define v_add_sat          OP(adds_epi16)
#define v_sub_unsigned_sat OP(subs_epu16)
#define v_times            OP(mulhrs_epi16)
#define v_low_product      OP(mullo_epi16)
#define v_max              OP(max_epi16)
#define v_and              WHOLE(and)
#define v_or               WHOLE(or)
#define v_and_not          WHOLE(andnot)
#define v_equal            OP(cmpeq_epi16)
#define v_left             OP(slli_epi16)
#define v_right            OP(srli_epi16)
#define v_right_signed     OP(srai_epi16)
#define v_shuffle          OP(shuffle_epi8)

/* Nothing need wait: constants take no registers. */
#define AFTER(x, y)      (void)(y)
#define LOAD_AFTER(p, y) (void)(y)

/* A plus half of B, unsigned. */
#define v_add_half(a, b) v_add(a, v_right(b, 1))

/* Rounded up; of values of 0 or more. */
#define v_mean OP(avg_epu16)

static inline int v_is_zero(V x)
{
    return WHOLE(testz)(x, x);
}

/* ----------------------------------------------------------------- constants
 */

/* Constants stay in memory, where they are operands. */
#define TONE                struct glint_tone16
#define MIX                 struct glint_mix
#define LOAD_TONE(t, tone)  const struct glint_tone16 *const t = tone
#define LOAD_MIX(m, mix)    const struct glint_mix *const m = mix
#define CONSTANT(c)         v_load(c)
#define TIMES(x, factor, i) v_times(x, v_load((factor).all[i]))

/* -------------------------------------------------------------------- tables
 */

/* Twice the zeros that lead, 0 .. 30, in both bytes; of 0 that is 0x90, for
 * which no table has an entry. The least of what each four bits say. */
static inline V v_zeros(V x)
{
    const V four = v_set(0x0f0f);
    const V high =
        v_shuffle(v_bytes(0, 0x0202020204040690), v_and(v_right(x, 4), four));
    const V low = v_shuffle(v_bytes(0x0808080808080808, 0x0a0a0a0a0c0c0e90),
                            v_and(x, four));
    const V of_bytes = OP(add_epi8)(OP(min_epu8)(high, low), v_set(16));

    return OP(min_epu8)(
        of_bytes,
        v_shuffle(of_bytes, v_bytes(0x0e0f0c0d0a0b0809, 0x0607040502030001)));
}

/* Places of the two bytes of an entry, in the halves of a table: where the top
 * bit is set there is none. */
typedef struct {
    V low, high;
} PLACES;

static inline PLACES v_places_of(const TONE *t, V twice)
{
    const PLACES p = {OP(adds_epu8)(twice, v_set(0x7170)),
                      OP(sub_epi8)(twice, v_set(0x0f10))};

    (void)t;
    return p;
}

static inline V v_look(const int16_t *table, PLACES at)
{
    return v_or(v_shuffle(v_half(table), at.low),
                v_shuffle(v_half(table + 8), at.high));
}

/* X times 2^ZEROS. */
static inline V v_raise(const TONE *t, V x, V zeros, PLACES at)
{
    (void)zeros;
    return v_low_product(x, v_look(t->power, at));
}

/* ------------------------------------------------------------ codes to lanes
 *
 * Codes of 8 bits come as _q7 and go from it, held to 0 .. 255.
 */

/* Luma, and chroma, of pairs of two bytes each; luma second if LUMA_AT. */
static inline void v_load_packed(const uint8_t *p, int luma_at, V y[V_PARTS],
                                 V c[2])
{
    const __m128i a = b_load(p), b = b_load(p + 16);
    const __m128i white = _mm_set1_epi16(255);
    const __m128i even =
        _mm_packus_epi16(_mm_and_si128(a, white), _mm_and_si128(b, white));
    const __m128i odd =
        _mm_packus_epi16(_mm_srli_epi16(a, 8), _mm_srli_epi16(b, 8));

    v_pairs_of(luma_at ? odd : even, y);
    v_chroma_of(luma_at ? even : odd, c);
}

static inline void v_store_packed(uint8_t *p, int luma_at, const V y[V_PARTS],
                                  const V c[2])
{
    const __m128i luma = b_of_pairs(y), chroma = b_of_chroma(c);
    const __m128i even = luma_at ? chroma : luma;
    const __m128i odd = luma_at ? luma : chroma;

    b_store(p, _mm_unpacklo_epi8(even, odd));
    b_store(p + 16, _mm_unpackhi_epi8(even, odd));
}

static inline void v_load_code_pairs(const uint8_t *p, V x[V_PARTS])
{
    v_pairs_of(b_load(p), x);
}

static inline void v_store_code_pairs(uint8_t *p, const V x[V_PARTS])
{
    b_store(p, b_of_pairs(x));
}

static inline void v_load_chroma(const uint8_t *p, V c[2])
{
    v_chroma_of(b_load(p), c);
}

static inline void v_store_chroma(uint8_t *p, const V c[2])
{
    b_store(p, b_of_chroma(c));
}
