/* SPDX-License-Identifier: MIT */
#include "video/transfer.h"

#include <stddef.h>
#include <string.h>

#define WHITE_Q24 (INT32_C(1) << 24)
#define ONE_Q31   (UINT64_C(1) << 31)

/* Parameters of a transfer curve: light(v) = ((v + a) / (1 + a))^(power / 45)
 * for v above the toe, else v / divisor. */
struct power {
    int power;       /* exponent times 45 */
    int a_10000;     /* a times 10000 */
    int toe_10000;   /* toe times 10000 */
    int divisor_100; /* divisor times 100 */
};

static const struct power powers[] = {
    [GLINT_TRANSFER_BT709] = {100, 990, 810, 450},
    [GLINT_TRANSFER_SRGB] = {108, 550, 404, 1292},
    [GLINT_TRANSFER_LINEAR] = {45, 0, 0, 100},
    [GLINT_TRANSFER_GAMMA22] = {99, 0, 0, 100},
    [GLINT_TRANSFER_GAMMA28] = {126, 0, 0, 100},
    [GLINT_TRANSFER_240M] = {100, 1115, 912, 400}};

const char *const glint_transfer_words[] = {
    "709", "srgb", "linear", "gamma22", "gamma28", "240m",
    "pq",  "hlg",  "log100", "log316",  NULL};

struct tag {
    const char *name;
    int value;
};

static int find_tag_index(const struct tag *tags, const char *name)
{
    while (tags->name && strcmp(tags->name, name) != 0)
        tags++;
    return tags->name ? tags->value : -1;
}

int glint_transfer_from_tag(const char *tag)
{
    static const struct tag tags[] = {{"bt709", GLINT_TRANSFER_BT709},
                                      {"smpte170m", GLINT_TRANSFER_BT709},
                                      {"bt2020-10", GLINT_TRANSFER_BT709},
                                      {"bt2020-12", GLINT_TRANSFER_BT709},
                                      {"iec61966-2-4", GLINT_TRANSFER_BT709},
                                      {"bt1361e", GLINT_TRANSFER_BT709},
                                      {"iec61966-2-1", GLINT_TRANSFER_SRGB},
                                      {"linear", GLINT_TRANSFER_LINEAR},
                                      {"bt470m", GLINT_TRANSFER_GAMMA22},
                                      {"gamma22", GLINT_TRANSFER_GAMMA22},
                                      {"bt470bg", GLINT_TRANSFER_GAMMA28},
                                      {"gamma28", GLINT_TRANSFER_GAMMA28},
                                      {"smpte240m", GLINT_TRANSFER_240M},
                                      {"smpte2084", GLINT_TRANSFER_PQ},
                                      {"arib-std-b67", GLINT_TRANSFER_HLG},
                                      {"log100", GLINT_TRANSFER_LOG100},
                                      {"log316", GLINT_TRANSFER_LOG316},
                                      {NULL, 0}};

    return find_tag_index(tags, tag);
}

int glint_primaries_from_tag(const char *tag)
{
    static const struct tag tags[] = {{"bt709", GLINT_PRIMARIES_BT709},
                                      {"smpte170m", GLINT_PRIMARIES_BT709},
                                      {"smpte240m", GLINT_PRIMARIES_BT709},
                                      {"bt470bg", GLINT_PRIMARIES_BT709},
                                      {"bt470m", GLINT_PRIMARIES_BT709},
                                      {"bt2020", GLINT_PRIMARIES_BT2020},
                                      {"smpte431", GLINT_PRIMARIES_P3},
                                      {"smpte432", GLINT_PRIMARIES_P3},
                                      {NULL, 0}};

    return find_tag_index(tags, tag);
}

const int32_t glint_primaries_from_bt709_q16[GLINT_PRIMARIES][3][3] = {
    {{65536, 0, 0}, {0, 65536, 0}, {0, 0, 65536}},
    {{41117, 21580, 2839}, {4528, 60263, 745}, {1074, 5768, 58694}},
    {{53901, 11635, 0}, {2175, 63361, 0}, {1120, 4745, 59671}}};

const int32_t glint_primaries_to_bt709_q16[GLINT_PRIMARIES][3][3] = {
    {{65536, 0, 0}, {0, 65536, 0}, {0, 0, 65536}},
    {{108822, -38512, -4774}, {-8163, 74246, -547}, {-1190, -6592, 73318}},
    {{80278, -14742, 0}, {-2756, 68292, 0}, {-1287, -5153, 71976}}};

/* ------------------------------------------------------------------ BT.709 */

static uint64_t multiply_q30(uint64_t a_q30, uint64_t b_q30)
{
    return (a_q30 * b_q30 + (UINT64_C(1) << 29)) >> 30;
}

/* Returns x^9; X is 0 .. 1. */
static uint64_t raise_to_power_9_q30(uint64_t x_q30)
{
    const uint64_t x2_q30 = multiply_q30(x_q30, x_q30);
    const uint64_t x4_q30 = multiply_q30(x2_q30, x2_q30);

    return multiply_q30(multiply_q30(x4_q30, x4_q30), x_q30);
}

/* Returns the largest r with r^9 <= x; X is 0 .. 1. */
static uint64_t compute_root_9_q30(uint64_t x_q30)
{
    uint64_t r_q30 = 0;

    for (uint64_t bit = UINT64_C(1) << 30; bit; bit >>= 1)
        if ((r_q30 | bit) <= UINT64_C(1) << 30 &&
            raise_to_power_9_q30(r_q30 | bit) <= x_q30)
            r_q30 |= bit;
    return r_q30;
}

/* Returns the light of code v = STEP / STEPS by BT.709: v / 4.5 below 0.081,
 * else u^(20/9), u = (v + 0.099) / 1.099. */
static int32_t decode_bt709_q24(int step, int steps)
{
    const uint64_t divisor = UINT64_C(1099) * (uint64_t)steps;
    uint64_t u_q30, u2_q30;

    if ((int64_t)step * 1000 < INT64_C(81) * steps)
        return (int32_t)(((uint64_t)step * 20 * WHITE_Q24 +
                          UINT64_C(45) * (uint64_t)steps) /
                         (90 * (uint64_t)steps));
    u_q30 =
        (((1000 * (uint64_t)step + 99 * (uint64_t)steps) << 30) + divisor / 2) /
        divisor;
    u2_q30 = multiply_q30(u_q30, u_q30);
    return (int32_t)((multiply_q30(u2_q30, compute_root_9_q30(u2_q30)) +
                      (1 << 5)) >>
                     6);
}

/* ------------------------------------------------------------------ powers */

/* Returns log2(N / D); N and D are 1 .. 2^32. The 32 fraction bits are computed
 * by repeated squaring; the error is below 2^-29. */
static int64_t compute_log2_q32(uint64_t n, uint64_t d)
{
    int64_t whole = 31, bits = 0;
    uint64_t m_q31;

    while (n >= 2 * d) {
        d *= 2;
        whole++;
    }
    while (n < d) {
        n *= 2;
        whole--;
    }
    /* After the shifts n * 2^31 fits into 64 bits, because n < 2 d. */
    while (d >> 31) {
        n >>= 1;
        d >>= 1;
    }
    m_q31 = (n << 31) / d;
    /* If D was odd, the shifts above have rounded it down, so the quotient may
     * be too large. */
    if (m_q31 >= 2 * ONE_Q31)
        m_q31 = 2 * ONE_Q31 - 1;
    for (int i = 0; i < 32; i++) {
        m_q31 = (m_q31 * m_q31) >> 31;
        bits = 2 * bits + (m_q31 >= 2 * ONE_Q31);
        m_q31 >>= m_q31 >= 2 * ONE_Q31;
    }
    return (whole - 31) * (INT64_C(1) << 32) + bits;
}

/* Returns 2^X with FRAC fraction bits, by the series of e^(x ln 2) for the
 * fraction of X. 2^X must be below 2^(31 - FRAC). */
static int64_t compute_exp2(int64_t x_q32, int frac)
{
    const int64_t whole = x_q32 >> 32; /* integer part, rounded down */
    const uint64_t ln2_q31 = 1488522236;
    const uint64_t t_q31 = ((uint64_t)(x_q32 & 0xffffffff) * ln2_q31) >> 32;
    const int64_t down = 31 - frac - whole;
    uint64_t sum_q31 = ONE_Q31;

    for (unsigned n = 13; n > 0; n--)
        sum_q31 = ONE_Q31 + ((t_q31 * sum_q31) >> 31) / n;
    return down > 40
               ? 0
               : (int64_t)((sum_q31 + (UINT64_C(1) << down >> 1)) >> down);
}

static int64_t compute_exp2_q24(int64_t x_q32)
{
    return compute_exp2(x_q32, 24);
}

static int32_t decode_power_q24(const struct power *p, int64_t step,
                                int64_t steps)
{
    const int64_t n = 10000 * step + p->a_10000 * steps;
    const int64_t d = (10000 + p->a_10000) * steps;

    if (p->power == 45 || 10000 * step <= p->toe_10000 * steps)
        return (int32_t)((step * WHITE_Q24 * 100 + p->divisor_100 * steps / 2) /
                         (p->divisor_100 * steps));
    return (int32_t)compute_exp2_q24(
        compute_log2_q32((uint64_t)n, (uint64_t)d) * p->power / 45);
}

/* --------------------------------------------------------------- HDR, logs */

/* Returns the light of PQ [SMPTE ST 2084], 10000 cd/m2 at STEP = STEPS:
 *   (max(p - c1, 0) / (c2 - c3 p))^(8192 / 1305), p = v^(32 / 2523) */
static int32_t decode_pq_q24(int step, int steps)
{
    const int64_t c1_q30 = INT64_C(3424) << 18, c2_q30 = INT64_C(2413) << 23;
    const int64_t white_q32 =
        INT64_C(24147923032); /* log2 of the peak of PQ relative to white, 10000
                                 / 203 */
    int64_t p_q30, d_q30, log_q32;

    if (step == 0)
        return 0;
    p_q30 = compute_exp2(
        compute_log2_q32((uint64_t)step, (uint64_t)steps) * 32 / 2523, 30);
    if (p_q30 <= c1_q30)
        return 0;
    d_q30 = c2_q30 - ((2392 * p_q30) >> 7);
    log_q32 = compute_log2_q32((uint64_t)(p_q30 - c1_q30), (uint64_t)d_q30);
    return (int32_t)compute_exp2_q24(log_q32 * 8192 / 1305 + white_q32);
}

/* Returns the scene light of HLG [ITU-R BT.2100] of code v = STEP / STEPS: v^2
 * / 3 up to v = 1/2, else (e^((v - c) / a) + b) / 12; scaled so that v = 0.75
 * is light 1 and the peak is 3.774118. */
static int32_t decode_hlg_q24(int64_t step, int64_t steps)
{
    /* slope: log2(e) / a; c and b: as in the formula above; peak: the peak
     * light */
    const int64_t slope_q24 = 135346594, c_q32 = 2404798274;
    const int64_t b_q24 = 4775952, peak_q24 = 63319195;
    int64_t v_q32, light_q24;

    if (2 * step <= steps)
        light_q24 = step * step * 4 * WHITE_Q24 / (steps * steps);
    else {
        v_q32 = (step << 32) / steps;
        light_q24 =
            compute_exp2_q24(((v_q32 - c_q32) >> 8) * slope_q24 >> 16) + b_q24;
    }
    return (int32_t)((light_q24 * peak_q24 / 12 + WHITE_Q24 / 2) / WHITE_Q24);
}

/* Returns 10^(D (v - 1)), the light of code v = STEP / STEPS of a logarithmic
 * curve over D = DECADES_2 / 2 decades, and 0 at v = 0. */
static int32_t decode_log_q24(int64_t step, int64_t steps, int decades_2)
{
    const int64_t log2_10_q32 = INT64_C(14267572527);

    return step ? (int32_t)compute_exp2_q24((step - steps) * (log2_10_q32 / 2) *
                                            decades_2 / steps)
                : 0;
}

int32_t glint_transfer_decode_q24(enum glint_transfer_curve curve, int step,
                                  int steps)
{
    switch (curve) {
    case GLINT_TRANSFER_BT709:
        return decode_bt709_q24(step, steps);
    case GLINT_TRANSFER_PQ:
        return decode_pq_q24(step, steps);
    case GLINT_TRANSFER_HLG:
        return decode_hlg_q24(step, steps);
    case GLINT_TRANSFER_LOG100:
        return decode_log_q24(step, steps, 4);
    case GLINT_TRANSFER_LOG316:
        return decode_log_q24(step, steps, 5);
    default:
        return decode_power_q24(&powers[curve], step, steps);
    }
}
