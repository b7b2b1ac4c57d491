/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

static int16_t held(int x, int low, int high)
{
    return (int16_t)(x < low ? low : x > high ? high : x);
}

static int16_t sum_sat(int a, int b)
{
    return held(a + b, INT16_MIN, INT16_MAX);
}

/* a * b / 2^15; not for the minimum times itself. */
static int16_t times(int a, int b)
{
    return (int16_t)((a * b + (1 << 14)) >> 15);
}

static uint16_t decode(const struct glint_tone16 *t, int16_t code_q7)
{
    const int k = code_q7 >> 12, place_q15 = (code_q7 & 4095) << 3;
    int x = t->piece[2][k], light;

    if (code_q7 < t->toe_end_q7[0])
        return (uint16_t)times(code_q7, t->toe_q15[0]);
    x = t->piece[1][k] + times(place_q15, x);
    light = (uint16_t)t->piece[0][k] + times(place_q15, x);
    return (uint16_t)(light < 65535 ? light : 65535);
}

static int16_t encode(const struct glint_tone16 *t, uint16_t light_q16)
{
    const int k = 4 - (light_q16 >= 1 << 8) - (light_q16 >= 1 << 10) -
                  (light_q16 >= 1 << 12) - (light_q16 >= 1 << 14);
    const int m_q15 = ((light_q16 * t->lift[k] & 65535) >> 1) - 20480;
    int power_q15 = t->power_q15[4][0];

    if (light_q16 < t->toe_end_q16[0])
        return (int16_t)((((light_q16 << 3) & 65535) *
                          (unsigned)(uint16_t)t->toe_q13[0]) >>
                         16);
    for (int i = 3; i >= 0; i--)
        power_q15 = t->power_q15[i][0] + times(m_q15, power_q15);
    return (
        int16_t)((int)(2 * (unsigned)power_q15 * (uint16_t)t->scale[k] >> 16) -
                 t->offset_q7[0]);
}

/* What CODE changes by. */
static int16_t change_of(const struct glint_tone16 *t, int16_t code_q7,
                         uint16_t light_q16)
{
    const unsigned sum = decode(t, code_q7) + (unsigned)light_q16;
    const int16_t lit = encode(t, (uint16_t)(sum < 65535 ? sum : 65535));

    return light_q16 && lit > code_q7 ? (int16_t)(lit - code_q7) : 0;
}

/* Adds light to one pixel: returns its luma, and what R', G', B' change by. */
static uint8_t add_pixel(int luma, int cb, int cr, const uint16_t light[3],
                         int16_t change[3], const struct glint_mix *mix,
                         int16_t round_q7)
{
    const int y_q6 = (luma - mix->black[0]) * 64;
    const int base_q6 = y_q6 + times(y_q6, mix->luma_q15[0]);
    const int b_q8 = (cb - 128) * 256, r_q8 = (cr - 128) * 256;
    int16_t tint_q6[3], sum_q7 = round_q7;

    tint_q6[0] = times(r_q8, mix->red_cr_q15[0]);
    tint_q6[1] = (int16_t)(times(b_q8, mix->green_cb_q15[0]) +
                           times(r_q8, mix->green_cr_q15[0]));
    tint_q6[2] = times(b_q8, mix->blue_cb_q15[0]);
    for (int c = 0; c < 3; c++) {
        const int16_t half_q7 = sum_sat(tint_q6[c], base_q6);
        const int16_t code_q7 =
            held(sum_sat(half_q7, half_q7), 0, GLINT_WHITE_Q7);

        change[c] = change_of(&mix->tone, code_q7, light[c]);
        sum_q7 = sum_sat(sum_q7, times(change[c], mix->to_luma_q15[c][0]));
    }
    return (uint8_t)held(luma + (sum_q7 >> 7), 0, 255);
}

void glint_add_luma_c(uint8_t *luma, const uint8_t *cb, const uint8_t *cr,
                      const uint16_t *const light[3], int16_t *const change[3],
                      int n, const struct glint_mix *mix, const int16_t *round)
{
    for (int i = 0; i < n; i++) {
        const uint16_t here[3] = {light[0][i], light[1][i], light[2][i]};
        int16_t changed[3];

        luma[i] =
            add_pixel(luma[i], cb[i], cr[i], here, changed, mix, round[i & 7]);
        for (int c = 0; c < 3; c++)
            change[c][i] = changed[c];
    }
}

/* Rounded up. */
static int16_t mean_of(int a, int b)
{
    return (int16_t)((a + b + 1) >> 1);
}

/* A code of chroma, Cb (K = 0) or Cr (1), whose pixels change by CHANGE. */
static uint8_t add_chroma(int code, int k, const int16_t change[3],
                          const struct glint_mix *mix, int16_t round_q7)
{
    int16_t sum_q7 = round_q7;

    for (int c = 0; c < 3; c++)
        sum_q7 = sum_sat(sum_q7, times(change[c], mix->to_chroma_q15[c][k]));
    return (uint8_t)held(code + (sum_q7 >> 7), 0, 255);
}

void glint_add_pairs_c(uint8_t *luma, uint8_t *chroma,
                       const uint16_t *const light[3], int16_t *const mean[3],
                       int n, enum glint_pair_step step,
                       const struct glint_mix *mix, const int16_t *round,
                       const int16_t *round_chroma)
{
    for (int i = 0; i < n; i += 2) {
        int16_t changed[2][3], own[3];

        for (int k = 0; k < 2; k++) {
            const uint16_t here[3] = {light[0][i + k], light[1][i + k],
                                      light[2][i + k]};

            luma[i + k] = add_pixel(luma[i + k], chroma[i], chroma[i + 1], here,
                                    changed[k], mix, round[(i + k) & 7]);
        }
        for (int c = 0; c < 3; c++) {
            own[c] = mean_of(changed[0][c], changed[1][c]);
            if (step == GLINT_PAIRS_FIRST)
                mean[c][i] = mean[c][i + 1] = own[c];
            if (step == GLINT_PAIRS_SECOND)
                own[c] = mean_of(own[c], mean[c][i]);
        }
        for (int k = 0; k < 2 && step != GLINT_PAIRS_FIRST; k++)
            chroma[i + k] = add_chroma(chroma[i + k], k, own, mix,
                                       round_chroma[(i + k) & 7]);
    }
}

void glint_add_packed_c(uint8_t *pixels, const uint16_t *const light[3], int n,
                        int luma_at, const struct glint_mix *mix,
                        const int16_t *round, const int16_t *round_chroma)
{
    for (int i = 0; i < n; i += 2) {
        uint8_t *luma = pixels + 2 * i + luma_at;
        uint8_t *chroma = pixels + 2 * i + 1 - luma_at;
        const int cb = chroma[0], cr = chroma[2];
        int16_t changed[2][3], own[3];

        for (int k = 0; k < 2; k++) {
            const uint16_t here[3] = {light[0][i + k], light[1][i + k],
                                      light[2][i + k]};

            luma[2 * k] = add_pixel(luma[2 * k], cb, cr, here, changed[k], mix,
                                    round[(i + k) & 7]);
        }
        for (int c = 0; c < 3; c++)
            own[c] = mean_of(changed[0][c], changed[1][c]);
        for (int k = 0; k < 2; k++)
            chroma[2 * k] = add_chroma(chroma[2 * k], k, own, mix,
                                       round_chroma[(i + k) & 7]);
    }
}

void glint_add_code_c(uint8_t *code, const uint16_t *light, int n,
                      const struct glint_tone16 *tone, const int16_t *round)
{
    for (int i = 0; i < n; i++) {
        const int16_t code_q7 = (int16_t)(code[i] * 128);
        const int16_t change_q7 = change_of(tone, code_q7, light[i]);

        code[i] = (uint8_t)held(
            code[i] + (sum_sat(change_q7, round[i & 7]) >> 7), 0, 255);
    }
}

void glint_run_sum_c(uint32_t *change_q24, uint32_t *carry_q24,
                     uint16_t *light_q16, int n)
{
    uint32_t sum_q24 = *carry_q24;

    for (int i = 0; i < n; i++) {
        int32_t light;

        sum_q24 += change_q24[i];
        change_q24[i] = 0;
        light = (int32_t)(sum_q24 + 128) >> 8;
        light_q16[i] = (uint16_t)(light < 0       ? 0
                                  : light < 65535 ? light
                                                  : 65535);
    }
    *carry_q24 = sum_q24;
}
