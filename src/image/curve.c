/* SPDX-License-Identifier: MIT */
#include "image/curve.h"

#include "base/compiler.h"

/* The transfer curve of a standard: linear light as a function of v = code /
 * 255. Up to code last_toe (the toe), light is v / toe_divisor. Above it, light
 * is u^(2 + 2 / root), where u = (v + a) / (1 + a). */
struct standard {
    int last_toe;
    int toe_divisor_100; /* 100 times the divisor of the toe */
    int a_1000;          /* 1000 times a */
    int root; /* root in the exponent 2 + 2 / root; 5: u^2.4; 9: u^(20/9) = u^(1
                 / 0.45) */
};

/* sRGB; the toe ends at v = 0.04045 */
static const struct standard srgb = {10, 1292, 55, 5};
/* BT.709; the toe ends below v = 0.081 */
static const struct standard bt709 = {20, 450, 99, 9};

static uint64_t multiply_q30(uint64_t a_q30, uint64_t b_q30)
{
    return (a_q30 * b_q30 + (UINT64_C(1) << 29)) >> 30;
}

/* Returns x^N; N is 5 or 9, x is 0 .. 1. */
static uint64_t raise_to_power_q30(uint64_t x_q30, int n)
{
    const uint64_t x2_q30 = multiply_q30(x_q30, x_q30);
    const uint64_t x4_q30 = multiply_q30(x2_q30, x2_q30);

    return multiply_q30(n == 9 ? multiply_q30(x4_q30, x4_q30) : x4_q30, x_q30);
}

/* Returns the n-th root of x, rounded down: the largest r with r^n <= x.
 * Rounding of x and r^n changes r by at most 2^-27 where the function is used:
 * for r >= 0.38 with n = 5, and r >= 0.67 with n = 9. */
static uint64_t compute_root_q30(uint64_t x_q30, int n)
{
    uint64_t r_q30 = 0;

    for (uint64_t bit = UINT64_C(1) << 30; bit; bit >>= 1)
        if ((r_q30 | bit) <= UINT64_C(1) << 30 &&
            raise_to_power_q30(r_q30 | bit, n) <= x_q30)
            r_q30 |= bit;
    return r_q30;
}

static int32_t compute_light_of_code_q20(const struct standard *s, int code)
{
    const uint64_t divisor = 255 * (1000 + (uint64_t)s->a_1000);
    const uint64_t toe_divisor = 255 * (uint64_t)s->toe_divisor_100;
    uint64_t u_q30, u2_q30;

    if (code <= s->last_toe)
        return (int32_t)((((uint64_t)code * 100 << 20) + toe_divisor / 2) /
                         toe_divisor);
    u_q30 = (((uint64_t)(1000 * code + 255 * s->a_1000) << 30) + divisor / 2) /
            divisor;
    u2_q30 = multiply_q30(u_q30, u_q30);
    return (int32_t)((multiply_q30(u2_q30, compute_root_q30(u2_q30, s->root)) +
                      (1 << 9)) >>
                     10);
}

void glint_curve_init(struct glint_curve *curve, enum glint_tone transfer)
{
    const struct standard *s = transfer == GLINT_TONE_SRGB ? &srgb : &bt709;

    for (int i = 0; i < 256; i++)
        curve->decode_q20[i] = compute_light_of_code_q20(s, i);
    curve->decode_q20[256] = 2 * LINEAR_WHITE_Q20;
}

/* Returns N / D with FRAC fraction bits, rounded; D > 0. */
static int32_t divide_to_fraction(int64_t n, int64_t d, int frac)
{
    const int64_t twice = n * ((int64_t)2 << frac) + d;

    return (int32_t)(twice >= 0 ? twice / (2 * d)
                                : -((-twice + 2 * d - 1) / (2 * d)));
}

/* Sets the matrix from Y'CbCr to R'G'B'. B' - Y' is 2 (1 - kb) Cb, and R' - Y'
 * is 2 (1 - kr) Cr. G' follows because the luma of R', G', B' is Y'. */
static void set_ycc_to_rgb_matrix(struct glint_ycc *ycc, int64_t kr, int64_t kb,
                                  int y_steps, int c_steps)
{
    const int64_t one = 10000, kg = one - kr - kb;
    int32_t(*m_q16)[3] = ycc->to_rgb_q16;

    for (int i = 0; i < 3; i++)
        m_q16[i][0] = divide_to_fraction(255, y_steps, 16);
    m_q16[0][1] = 0;
    m_q16[0][2] = divide_to_fraction(255 * 2 * (one - kr), one * c_steps, 16);
    m_q16[1][1] =
        divide_to_fraction(-255 * 2 * kb * (one - kb), kg * one * c_steps, 16);
    m_q16[1][2] =
        divide_to_fraction(-255 * 2 * kr * (one - kr), kg * one * c_steps, 16);
    m_q16[2][1] = divide_to_fraction(255 * 2 * (one - kb), one * c_steps, 16);
    m_q16[2][2] = 0;
}

/* Sets the matrix from R'G'B' to Y'CbCr. The coefficient of green absorbs the
 * rounding errors of red and blue, so that the sums of the rows are exact. */
static void set_rgb_to_ycc_matrix(struct glint_ycc *ycc, int64_t kr, int64_t kb,
                                  int y_steps, int c_steps)
{
    const int64_t one = 10000;
    int32_t(*m_q15)[3] = ycc->to_ycc_q15;

    m_q15[0][0] = divide_to_fraction(kr * y_steps, one * 255, 15);
    m_q15[0][2] = divide_to_fraction(kb * y_steps, one * 255, 15);
    m_q15[0][1] =
        divide_to_fraction(y_steps, 255, 15) - m_q15[0][0] - m_q15[0][2];
    m_q15[1][0] = divide_to_fraction(-kr * c_steps, 2 * (one - kb) * 255, 15);
    m_q15[1][2] = divide_to_fraction(c_steps, 2 * 255, 15);
    m_q15[1][1] = -m_q15[1][0] - m_q15[1][2];
    m_q15[2][0] = divide_to_fraction(c_steps, 2 * 255, 15);
    m_q15[2][2] = divide_to_fraction(-kb * c_steps, 2 * (one - kr) * 255, 15);
    m_q15[2][1] = -m_q15[2][0] - m_q15[2][2];
}

void glint_ycc_init(struct glint_ycc *ycc, enum glint_matrix matrix,
                    enum glint_range range)
{
    static const int64_t k[][2] = {[GLINT_MATRIX_BT601] = {2990, 1140},
                                   [GLINT_MATRIX_BT709] = {2126, 722},
                                   [GLINT_MATRIX_BT2020] = {2627, 593}};
    const int64_t kr = k[matrix][0], kb = k[matrix][1];
    const int y_steps = range == GLINT_RANGE_FULL ? 255 : 219;
    const int c_steps = range == GLINT_RANGE_FULL ? 255 : 224;

    ycc->black = range == GLINT_RANGE_FULL ? 0 : 16;
    set_ycc_to_rgb_matrix(ycc, kr, kb, y_steps, c_steps);
    set_rgb_to_ycc_matrix(ycc, kr, kb, y_steps, c_steps);
}
