/* SPDX-License-Identifier: MIT
 *
 * Compares the library's division, which uses 32-bit words, with the
 * compiler's division.
 */
#include "base/divide.h"
#include "support/test.h"

static uint64_t seed = 12345;

static uint64_t random_bits(void)
{
    seed ^= seed << 13;
    seed ^= seed >> 7;
    return seed ^= seed << 17;
}

static void check_division(int64_t n, int64_t d)
{
    assert_int_equal(glint_divide(n, d), n / d);
    assert_int_equal(q_divide(n, d), n / d);
}

/* Returns a random number of any magnitude and sign. */
static int64_t random_signed_number(void)
{
    const int64_t size = (int64_t)(random_bits() >> (1 + random_bits() % 63));

    return random_bits() & 1 ? -size : size;
}

TEST(random_divisions_are_exact)
{
    for (int i = 0; i < 1000000; i++) {
        const int64_t n = random_signed_number(), d = random_signed_number();

        if (d != 0)
            check_division(n, d);
    }
}

/* Checks numerators at and next to multiples of the divisor D, and powers of
 * two. */
TEST(divisions_near_multiples_are_exact)
{
    for (int i = 0; i < 300000; i++) {
        const int64_t d =
            1 + (int64_t)(random_bits() >> (2 + random_bits() % 62));
        const int64_t most = INT64_MAX / d - 1;
        const int64_t q =
            (int64_t)(random_bits() >> (1 + random_bits() % 62)) % (most + 1);

        for (int off = -1; off <= 1; off++)
            check_division(q * d + off, d);
    }
    for (int a = 0; a < 63; a++)
        for (int b = 0; b < 63; b++)
            for (int off = -1; off <= 1; off++)
                if ((INT64_C(1) << b) + off != 0) {
                    check_division(INT64_C(1) << a, (INT64_C(1) << b) + off);
                    check_division((INT64_C(1) << a) - 1,
                                   (INT64_C(1) << b) + off);
                }
    check_division(INT64_MAX, 1);
    check_division(INT64_MAX, INT64_MAX);
    check_division(INT64_MAX - 1, INT64_MAX);
    check_division(-INT64_MAX, 3);
    check_division(0, -7);
}

static void check_reciprocal(uint32_t x)
{
    assert_int_equal(glint_compute_reciprocal(x), (UINT64_MAX >> 1) / x);
    assert_int_equal(q_reciprocal(x), (UINT64_MAX >> 1) / x);
}

TEST(reciprocals_are_exact)
{
    for (uint32_t off = 0; off < 300000; off++) {
        check_reciprocal(UINT32_C(0x80000000) + off);
        check_reciprocal(UINT32_C(0xc0000000) - off);
        check_reciprocal(UINT32_MAX - off);
        check_reciprocal((uint32_t)random_bits() | UINT32_C(0x80000000));
    }
}

/* Checks that q_divide_to_fraction_q30() differs from n / d by at most 2^-30
 * upwards and 2^-29 downwards. */
TEST(q30_fraction_is_within_its_error)
{
    for (int i = 0; i < 300000; i++) {
        const uint64_t d = 1 + (random_bits() >> (2 + random_bits() % 62));
        const uint64_t n = i % 16 ? random_bits() % (d + 1) : i % 32 ? d : 0;
        const double part = (double)n / (double)d;
        const double got = q_divide_to_fraction_q30(n, d) * 0x1p-30;

        assert_true(got <= 1 && (n > 0 || got == 0));
        assert_true(got <= part + 0x1p-30 && got >= part - 0x1p-29);
    }
}
