/* SPDX-License-Identifier: MIT
 *
 * turn_c.c in vectors of x86, for whoever defines W, W_N, KERNEL, OP and WHOLE
 * as for horner_x86.h.
 */

/* Products of the even lanes with a factor, and of the odd ones. */
struct products {
    W even, odd;
};

static inline struct products times(W x, W factor)
{
    return (struct products){OP(mul_epi32)(x, factor),
                             OP(mul_epi32)(OP(srli_epi64)(x, 32), factor)};
}

static inline struct products plus(struct products a, struct products b)
{
    return (struct products){OP(add_epi64)(a.even, b.even),
                             OP(add_epi64)(a.odd, b.odd)};
}

static inline struct products minus(struct products a, struct products b)
{
    return (struct products){OP(sub_epi64)(a.even, b.even),
                             OP(sub_epi64)(a.odd, b.odd)};
}

/* Shifts of 64 bits there are of what is not negative: sums are raised by 2^62,
 * and a half for rounding. */
struct down {
    W raise, lower;
    __m128i by;
};

static inline struct down down_by(int shift)
{
    const long long raise = 1LL << 62;

    return (struct down){OP(set1_epi64x)(raise + (1LL << (shift - 1))),
                         OP(set1_epi64x)(raise >> shift),
                         _mm_cvtsi32_si128(shift)};
}

static inline W shifted(W sum, struct down d)
{
    return OP(sub_epi64)(OP(srl_epi64)(OP(add_epi64)(sum, d.raise), d.by),
                         d.lower);
}

/* Into OUT; returns where it fits. */
static inline W scale(struct down d, W limit, struct products sum, int32_t *out)
{
    const W even = shifted(sum.even, d), odd = shifted(sum.odd, d);
    const W low = OP(blend_epi16)(even, OP(slli_epi64)(odd, 32), 0xcc);
    const W high = OP(blend_epi16)(OP(srli_epi64)(even, 32), odd, 0xcc);
    const W narrow = OP(cmpeq_epi32)(high, OP(srai_epi32)(low, 31));
    const W within = OP(cmpgt_epi32)(limit, OP(abs_epi32)(low));
    /* the least of all has no magnitude */
    const W least = OP(cmpeq_epi32)(low, OP(set1_epi32)(INT32_MIN));
    const W fits = WHOLE(andnot)(least, WHOLE(and)(narrow, within));

    WHOLE(storeu)((W *)(void *)out, WHOLE(and)(low, fits));
    return fits;
}

static inline void lose(W x_fits, W y_fits, int32_t *lost)
{
    const W fit = WHOLE(and)(x_fits, y_fits);
    const W unfit = WHOLE(andnot)(fit, OP(set1_epi32)(-1));
    W *at = (W *)(void *)lost;

    WHOLE(storeu)(at, WHOLE(or)(WHOLE(loadu)(at), unfit));
}

void KERNEL(glint_turn)(const struct glint_turn *t, const int32_t *x,
                        const int32_t *y, int32_t (*out)[GLINT_TURNED],
                        int32_t (*lost)[GLINT_TURNED])
{
    const W c = OP(set1_epi32)(t->cos), s = OP(set1_epi32)(t->sin);
    const W limit = OP(set1_epi32)(t->limit);
    const struct down d = down_by(t->shift);

    for (int i = 0; i < GLINT_TURNED; i += W_N) {
        const W a = WHOLE(loadu)((const W *)(const void *)(x + i));
        const W b = WHOLE(loadu)((const W *)(const void *)(y + i));
        const struct products xc = times(a, c), xs = times(a, s);
        const struct products yc = times(b, c), ys = times(b, s);

        lose(scale(d, limit, minus(xc, ys), out[0] + i),
             scale(d, limit, plus(xs, yc), out[1] + i), lost[0] + i);
        lose(scale(d, limit, plus(xc, ys), out[2] + i),
             scale(d, limit, minus(xs, yc), out[3] + i), lost[1] + i);
    }
}
