/* SPDX-License-Identifier: MIT */
#include "image/mix.h"

#include "base/q.h"
#include "image/curve.h"

#define ALL(x)                                                                \
    {                                                                         \
        (int16_t)(x), (int16_t)(x), (int16_t)(x), (int16_t)(x), (int16_t)(x), \
            (int16_t)(x), (int16_t)(x), (int16_t)(x), (int16_t)(x),           \
            (int16_t)(x), (int16_t)(x), (int16_t)(x), (int16_t)(x),           \
            (int16_t)(x), (int16_t)(x), (int16_t)(x)                          \
    }

/* Factors of kernels/tone.h. White is 32767 in R'G'B' and 32640 in _q7; the
 * factor from one to the other is 32640 / 32768. */
#define FACTORS(toe, rise, turn)                                    \
    {                                                               \
        {toe, rise, turn, 32640, 0x0202},                           \
        {                                                           \
            ALL(toe), ALL(rise), ALL(turn), ALL(32640), ALL(0x0202) \
        }                                                           \
    }
#define POWERS                                                                \
    {                                                                         \
        1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, \
            INT16_MIN                                                         \
    }

/* clang-format off */
static const struct glint_tone16 srgb = {
    FACTORS(2515, -4461, -14694),
    ALL(1278), {ALL(19821), ALL(17721)}, ALL(18041),
    {32767, 32767, 24096, 17601, 12733, 9087, 6356, 4309, 2776, 1631, 827, 413,
     207, 103, 52, 26},
    {0, 7265, 5442, 4077, 3054, 2288, 1714, 1284, 962, 762, 413, 207, 103, 52,
     26, 13},
    {0, -1408, -1055, -790, -592, -444, -332, -249, -187, -46},
    POWERS};

static const struct glint_tone16 bt709 = {
    FACTORS(7271, -1681, -14309),
    ALL(2687), {ALL(25230), ALL(7012)}, ALL(18426),
    {32767, 32767, 23118, 16055, 10884, 7098, 4330, 2301, 1152, 576, 288, 144,
     72, 36, 18, 9},
    {0, 8166, 5978, 4376, 3203, 2345, 1745, 1152, 576, 288, 144, 72, 36, 18, 9,
     5},
    {0, -1485, -1087, -796, -583, -426, -288},
    POWERS};
/* clang-format on */

const struct glint_tone16 *glint_get_tone_constants(enum glint_tone transfer)
{
    return transfer == GLINT_TONE_SRGB ? &srgb : &bt709;
}

static void repeat_value_in_all_lanes(int16_t *lanes, int64_t x)
{
    for (int i = 0; i < GLINT_LANES; i++)
        lanes[i] = (int16_t)x;
}

static void set_factor_in_all_lanes(struct glint_factors *f, int i, int64_t x)
{
    f->one[i] = (int16_t)q_clamp_sat(x, -INT16_MAX, INT16_MAX);
    repeat_value_in_all_lanes(f->all[i], f->one[i]);
}

static int64_t divide_and_round(int64_t n, int64_t d)
{
    return (2 * n + (n < 0 ? -d : d)) / (2 * d);
}

/* Sets the factors that convert Y'CbCr in _q7 to half of R'G'B' in _q15: the
 * base (luma) and the tints (chroma). A code of 8 bits is 128.5 units of
 * R'G'B', so the factors are 257 / 512 of to_rgb. The factor of blue is halved
 * once more to fit into 16 bits. */
static void set_ycc_to_rgb_factors(struct glint_mix *mix,
                                   const struct glint_ycc *ycc)
{
    static const uint8_t at[][2] = {[GLINT_MIX_BASE] = {0, 0},
                                    [GLINT_MIX_RED_CR] = {0, 2},
                                    [GLINT_MIX_GREEN_CB] = {1, 1},
                                    [GLINT_MIX_GREEN_CR] = {1, 2},
                                    [GLINT_MIX_BLUE_CB] = {2, 1}};
    struct glint_factors *f = &mix->from_ycc;

    for (int i = 0; i <= GLINT_MIX_BLUE_CB; i++) {
        const int64_t m_q16 = ycc->to_rgb_q16[at[i][0]][at[i][1]];

        set_factor_in_all_lanes(
            f, i,
            divide_and_round(m_q16 * 257,
                             i == GLINT_MIX_BLUE_CB ? 2048 : 1024));
    }
    repeat_value_in_all_lanes(
        mix->black, -q_mul(ycc->black * 128, f->one[GLINT_MIX_BASE], 15));
}

/* Sets the factors from changes of R'G'B' to changes of Y'CbCr in _q7, which
 * are 256 / 257 of to_ycc. */
static void set_rgb_to_ycc_factors(struct glint_mix *mix,
                                   const struct glint_ycc *ycc)
{
    const int32_t(*m_q15)[3] = ycc->to_ycc_q15;
    const int32_t y_q15 = m_q15[0][0] + m_q15[0][1] + m_q15[0][2];
    struct glint_factors *f = &mix->to_ycc;

    repeat_value_in_all_lanes(mix->white,
                              128 * (ycc->black + q_mul(255, y_q15, 15)));
    for (int c = 0; c < 3; c++)
        set_factor_in_all_lanes(f, GLINT_MIX_LUMA + c,
                                divide_and_round(m_q15[0][c] * 256, 257));
    /* Cb is PER (B' - Y'), and Cr is PER (R' - Y'). As Y' contains a fraction
     * of B' and R', PER exceeds the factor of B' in Cb, or of R' in Cr, in the
     * matrix. */
    for (int k = 0; k < 2; k++) {
        const int own = k ? 0 : 2;
        const int64_t own_q15 = m_q15[k + 1][own];
        const int64_t per_q15 =
            divide_and_round(own_q15 * y_q15, y_q15 - m_q15[0][own]);

        set_factor_in_all_lanes(f, k ? GLINT_MIX_CR_RED : GLINT_MIX_CB_BLUE,
                                divide_and_round(per_q15 * 256, 257));
        set_factor_in_all_lanes(f, k ? GLINT_MIX_CR_LUMA : GLINT_MIX_CB_LUMA,
                                divide_and_round(per_q15 << 15, y_q15));
    }
}

void glint_mix_set_factors(struct glint_mix *mix,
                           const struct glint_image *image)
{
    struct glint_ycc ycc;

    glint_ycc_init(&ycc, image->matrix, image->range);
    mix->tone = *glint_get_tone_constants(image->transfer);
    set_ycc_to_rgb_factors(mix, &ycc);
    set_rgb_to_ycc_factors(mix, &ycc);
}
