/* SPDX-License-Identifier: MIT
 *
 * Checks divisions that are done by multiplication. y4m_scaled_quotient() is
 * checked for every numerator. y4m_divide_fraction() is monotonic, so that for
 * each quotient only the first numerators with this quotient and the last ones
 * before it need a check.
 */
#include "support/test.h"
#include "video/y4m_divide.h"

/* Returns N / D, rounded to nearest, ties away from 0. D > 0. */
static int64_t divide_rounded(int64_t n, int64_t d)
{
    return n >= 0 ? (2 * n + d) / (2 * d) : -((-2 * n + d) / (2 * d));
}

/* Returns the number of integers K in -MOST .. MOST for which the quotient of K
 * 2^UP and D is wrong. */
static long count_wrong_quotients(int32_t most, int up, int32_t d)
{
    const int64_t factor = y4m_scaled_quotient_factor(up, d);
    long wrong = 0;

    for (int32_t k = -most; k <= most; k++)
        wrong += y4m_scaled_quotient(k, factor) !=
                 divide_rounded(k * (INT64_C(1) << up), d);
    return wrong;
}

/* Checks the divisions for codes of 8 .. 16 bits, in full and limited range. */
TEST(divides_codes_exactly)
{
    for (int bits = 8; bits <= 16; bits++) {
        const int32_t most = (1 << bits) - 1;

        assert_int_equal(count_wrong_quotients(most, 20, most), 0);
        assert_int_equal(count_wrong_quotients(most, 20, 219 << (bits - 8)), 0);
        assert_int_equal(count_wrong_quotients(most, 20, 224 << (bits - 8)), 0);
    }
}

static const int32_t kr_q16[2] = {13933, 19595}, kb_q16[2] = {4732, 7471};

/* Checks the divisions for colour differences, for BT.709 and BT.601. */
TEST(divides_colour_differences_exactly)
{
    for (int m = 0; m < 2; m++) {
        assert_int_equal(count_wrong_quotients(1 << 20, 15, 65536 - kr_q16[m]),
                         0);
        assert_int_equal(count_wrong_quotients(1 << 20, 15, 65536 - kb_q16[m]),
                         0);
    }
}

static int32_t clamp_quotient(int64_t v)
{
    return v < 0 ? 0 : v > 1 << 20 ? 1 << 20 : (int32_t)v;
}

TEST(divides_green_exactly)
{
    long wrong = 0;

    for (int m = 0; m < 2; m++) {
        const int32_t d = 65536 - kr_q16[m] - kb_q16[m];
        const int64_t factor = y4m_fraction_factor(d);

        for (int64_t q = -2; q <= (1 << 20) + 2; q++) {
            /* first numerator whose quotient is Q */
            const int64_t first = q * d - d / 2;

            for (int64_t n = first - 2; n <= first + 2; n++)
                wrong += y4m_divide_fraction(n, d, factor) !=
                         clamp_quotient(divide_rounded(n, d));
        }
        wrong += y4m_divide_fraction(-(INT64_C(1) << 40), d, factor) != 0;
        wrong += y4m_divide_fraction(INT64_C(1) << 40, d, factor) != 1 << 20;
    }
    assert_int_equal(wrong, 0);
}

TEST(halves_round_to_nearest)
{
    for (int s = 1; s < 24; s++)
        for (int64_t n = -70000; n < 70000; n++)
            assert_true(y4m_divide_by_power_of_two(16 * n, s) ==
                        divide_rounded(16 * n, INT64_C(1) << s));
}
