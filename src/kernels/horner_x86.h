/* SPDX-License-Identifier: MIT
 *
 * What SSE4.1 and AVX2 have alike, for whoever defines W, a vector, OP(name),
 * an operation on its lanes, and WHOLE(name), one on the whole.
 */

#define w_add    OP(add_epi32)
#define w_set(x) OP(set1_epi32)(x)

static inline W w_load(const int32_t *p)
{
    return WHOLE(loadu)((const W *)(const void *)p);
}

static inline void w_store(int32_t *p, W x)
{
    WHOLE(storeu)((W *)(void *)p, x);
}

/* A shift to the right by so many bits of the lower lane of each pair's
 * product, and to the left into the upper lane of the other. */
struct shift {
    W half;
    __m128i right, left;
};

static inline struct shift shift_by(int fraction)
{
    return (struct shift){OP(set1_epi64x)(1LL << (fraction - 1)),
                          _mm_cvtsi32_si128(fraction),
                          _mm_cvtsi32_si128(32 - fraction)};
}

struct factor {
    W even, odd;
};

static inline struct factor factor_of(W x)
{
    return (struct factor){x, OP(srli_epi64)(x, 32)};
}

/* The lower 32 bits of each product, rounded and shifted. */
static inline W w_times(W a, struct factor x, struct shift s)
{
    const W even = OP(mul_epi32)(a, x.even);
    const W odd = OP(mul_epi32)(OP(srli_epi64)(a, 32), x.odd);

    return OP(blend_epi16)(OP(srl_epi64)(OP(add_epi64)(even, s.half), s.right),
                           OP(sll_epi64)(OP(add_epi64)(odd, s.half), s.left),
                           0xcc);
}
