/* SPDX-License-Identifier: MIT */
#include "base/divide.h"

#include "base/q.h"

static uint32_t multiply_high(uint32_t a, uint32_t b)
{
    return (uint32_t)((uint64_t)a * b >> 32);
}

/* Returns an approximation of 2^63 / X for X >= 2^31. The linear start value
 * has an error of at most 1/17, which each of three steps of Newton's method
 * squares. Products are truncated, so that the result is never too large. */
static uint32_t approximate_reciprocal(uint32_t x)
{
    /* start value: 48/17 - 32/17 x in _q31, modulo 2^32, where x is X in
     * _q32 */
    uint32_t r_q31 = 1768515944 - multiply_high(x, 4042322161U);

    for (int i = 0; i < 3; i++)
        r_q31 = (uint32_t)((uint64_t)r_q31 *
                               (UINT32_MAX - multiply_high(r_q31, x)) >>
                           31);
    return r_q31;
}

uint32_t glint_compute_reciprocal(uint32_t x)
{
    uint32_t r = approximate_reciprocal(x);
    uint64_t rest = (UINT64_MAX >> 1) - (uint64_t)r * x;

    for (; rest >= x; rest -= x)
        r++;
    return r;
}

/* Computes the quotient by long division. Each step divides the upper 32 bits
 * of the remainder by those of D, which gives up to 30 bits of the quotient.
 * Both are rounded so that the quotient is never too large. The loop ends when
 * the remainder is less than four times D. */
int64_t glint_divide(int64_t n, int64_t d)
{
    const uint64_t by = q_magnitude(d);
    const int wide = bit_length(by);
    /* NOLINTNEXTLINE: the caller guarantees that D is not 0 */
    const uint32_t top = (uint32_t)(by << (64 - wide) >> 32);
    const uint32_t one_over =
        approximate_reciprocal(top < UINT32_MAX ? top + 1 : top);
    uint64_t rest = q_magnitude(n), q = 0;
    int more;

    while ((more = bit_length(rest) - wide) >= 2) {
        const uint32_t of = (uint32_t)(rest << (64 - wide - more) >> 32);
        const uint64_t ratio = multiply_high(of, one_over); /* _q31 */
        const uint64_t times =
            more < 31 ? ratio >> (31 - more) : ratio << (more - 31);

        q += times;
        rest -= times * by;
    }
    for (; rest >= by; rest -= by)
        q++;
    return (n < 0) == (d < 0) ? (int64_t)q : -(int64_t)q;
}
