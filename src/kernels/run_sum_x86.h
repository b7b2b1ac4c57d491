/* SPDX-License-Identifier: MIT
 *
 * glint_run_sum in vectors of x86, V of 32-bit lanes, for whoever defines them
 * as for composite_x86.h, and w_sums, w_last and w_narrow.
 */

#define w_add(a, b) OP(add_epi32)(a, b)

static inline V w_rounded(V sum_q24)
{
    const V twice = OP(srai_epi32)(sum_q24, 7);

    return OP(srai_epi32)(w_add(twice, OP(set1_epi32)(1)), 1);
}

void KERNEL(glint_run_sum)(uint32_t *change_q24, uint32_t *carry_q24,
                           uint16_t *light_q16, int n)
{
    const V zero = WHOLE(setzero)();
    V carry = OP(set1_epi32)((int32_t)*carry_q24);

    for (int i = 0; i < n; i += V_N) {
        V *at = (V *)(void *)(change_q24 + i);
        const V a = w_add(w_sums(WHOLE(load)(at)), carry);
        const V b = w_add(w_sums(WHOLE(load)(at + 1)), w_last(a));

        WHOLE(store)(at, zero);
        WHOLE(store)(at + 1, zero);
        carry = w_last(b);
        v_store((int16_t *)light_q16 + i, w_narrow(w_rounded(a), w_rounded(b)));
    }
    *carry_q24 = w_first(carry);
}
