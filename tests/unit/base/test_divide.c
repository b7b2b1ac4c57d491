/* SPDX-License-Identifier: MIT
 *
 * Division that uses words of 32 bits, against the compiler's.
 */
#include "base/divide.h"
#include "support/test.h"

static uint64_t seed = 12345;

static uint64_t draw(void)
{
    seed ^= seed << 13;
    seed ^= seed >> 7;
    return seed ^= seed << 17;
}

static void expect(int64_t n, int64_t d)
{
    assert_int_equal(glint_divide(n, d), n / d);
    assert_int_equal(q_divide(n, d), n / d);
}

/* Returns a number of any size and either sign. */
static int64_t draw_any(void)
{
    const int64_t size = (int64_t)(draw() >> (1 + draw() % 63));

    return draw() & 1 ? -size : size;
}

TEST(any)
{
    for (int i = 0; i < 1000000; i++) {
        const int64_t n = draw_any(), d = draw_any();

        if (d != 0)
            expect(n, d);
    }
}

/* Numerators at, below and above multiples of D, and powers of two, must be
 * divided exactly. */
TEST(borders)
{
    for (int i = 0; i < 300000; i++) {
        const int64_t d = 1 + (int64_t)(draw() >> (2 + draw() % 62));
        const int64_t most = INT64_MAX / d - 1;
        const int64_t q = (int64_t)(draw() >> (1 + draw() % 62)) % (most + 1);

        for (int off = -1; off <= 1; off++)
            expect(q * d + off, d);
    }
    for (int a = 0; a < 63; a++)
        for (int b = 0; b < 63; b++)
            for (int off = -1; off <= 1; off++)
                if ((INT64_C(1) << b) + off != 0) {
                    expect(INT64_C(1) << a, (INT64_C(1) << b) + off);
                    expect((INT64_C(1) << a) - 1, (INT64_C(1) << b) + off);
                }
    expect(INT64_MAX, 1);
    expect(INT64_MAX, INT64_MAX);
    expect(INT64_MAX - 1, INT64_MAX);
    expect(-INT64_MAX, 3);
    expect(0, -7);
}

static void expect_reciprocal(uint32_t x)
{
    assert_int_equal(glint_reciprocal(x), (UINT64_MAX >> 1) / x);
    assert_int_equal(q_reciprocal(x), (UINT64_MAX >> 1) / x);
}

TEST(reciprocal)
{
    for (uint32_t off = 0; off < 300000; off++) {
        expect_reciprocal(UINT32_C(0x80000000) + off);
        expect_reciprocal(UINT32_C(0xc0000000) - off);
        expect_reciprocal(UINT32_MAX - off);
        expect_reciprocal((uint32_t)draw() | UINT32_C(0x80000000));
    }
}

/* q_part_q30() must be off n / d by no more than 2^-30 up and 2^-29 down. */
TEST(part)
{
    for (int i = 0; i < 300000; i++) {
        const uint64_t d = 1 + (draw() >> (2 + draw() % 62));
        const uint64_t n = i % 16 ? draw() % (d + 1) : i % 32 ? d : 0;
        const double part = (double)n / (double)d;
        const double got = q_part_q30(n, d) * 0x1p-30;

        assert_true(got <= 1 && (n > 0 || got == 0));
        assert_true(got <= part + 0x1p-30 && got >= part - 0x1p-29);
    }
}
