/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include <stddef.h>

#include "base/compiler.h"

static int16_t clamp_to_int16(int x, int low, int high)
{
    return (int16_t)(x < low ? low : x > high ? high : x);
}

static int16_t add_saturating(int a, int b)
{
    return clamp_to_int16(a + b, INT16_MIN, INT16_MAX);
}

/* Returns a * b / 2^15, rounded. A and B must not both be INT16_MIN. */
static int16_t multiply_q15(int a, int b)
{
    return (int16_t)((a * b + (1 << 14)) >> 15);
}

static uint16_t decode_code_to_light(const struct glint_tone16 *t, int16_t code)
{
    const int16_t *f = t->factor.one;
    const int w = code > t->toe_end[0] ? code - t->toe_end[0] : 0;
    int rise = t->rise[1][0] + multiply_q15(w, f[GLINT_TONE_RISE]);

    rise = t->rise[0][0] + multiply_q15(w, rise);
    return (uint16_t)(multiply_q15(code, f[GLINT_TONE_TOE]) +
                      multiply_q15(multiply_q15(w, w), rise));
}

static int16_t encode_light_to_code(const struct glint_tone16 *t,
                                    uint16_t light)
{
    const int zeros = 16 - bit_length(light);
    const int16_t z = (int16_t)(uint16_t)((uint32_t)light << zeros);
    const int turn =
        t->turn[0] + multiply_q15(z, t->factor.one[GLINT_TONE_TURN]);
    int x;

    if (zeros == 16)
        return 0;
    x = t->slope[zeros] + multiply_q15(z, multiply_q15(turn, t->curve[zeros]));
    return (int16_t)(t->level[zeros] + multiply_q15(z, x));
}

/* Returns the increase of CODE when LIGHT is added to its linear light. */
static int16_t compute_code_change(const struct glint_tone16 *t, int16_t code,
                                   uint16_t light_q16)
{
    const int16_t lit = encode_light_to_code(
        t, (uint16_t)(decode_code_to_light(t, code) + (light_q16 >> 1)));

    return lit > code ? (int16_t)(lit - code) : 0;
}

/* Indices of the changes on which chroma depends, in the array of the changes
 * of R', G', B' and Y'. They are those of R', B' and Y'. */
static const int chroma_changes[3] = {0, 2, 3};

/* Sets RGB to the full-range R', G', B' of a pixel with Y', Cb and Cr, _q7. */
static WHOLLY_INLINE void convert_to_rgb(int luma_q7, int cb_q7, int cr_q7,
                                         int16_t rgb[3],
                                         const struct glint_mix *mix)
{
    const int16_t *from = mix->from_ycc.one;
    const int base =
        multiply_q15(luma_q7, from[GLINT_MIX_BASE]) + mix->black[0];
    const int b_q7 = cb_q7 - (1 << 14), r_q7 = cr_q7 - (1 << 14);
    const int tint[3] = {multiply_q15(r_q7, from[GLINT_MIX_RED_CR]),
                         multiply_q15(b_q7, from[GLINT_MIX_GREEN_CB]) +
                             multiply_q15(r_q7, from[GLINT_MIX_GREEN_CR]),
                         2 * multiply_q15(b_q7, from[GLINT_MIX_BLUE_CB])};

    for (int c = 0; c < 3; c++)
        rgb[c] = clamp_to_int16(2 * add_saturating(base, tint[c]), 0,
                                GLINT_WHITE_Q15);
}

/* Sets CHANGE to the changes of R', G', B' (_q15) and Y' (_q7) when LIGHT is
 * added to a pixel. */
static void compute_pixel_change(int luma_q7, int cb_q7, int cr_q7,
                                 const uint16_t light[3], int16_t change[4],
                                 const struct glint_mix *mix)
{
    const int16_t *to = mix->to_ycc.one;
    int16_t rgb[3];

    change[0] = change[1] = change[2] = change[3] = 0;
    if (!(light[0] | light[1] | light[2]))
        return;
    convert_to_rgb(luma_q7, cb_q7, cr_q7, rgb, mix);
    for (int c = 0; c < 3; c++) {
        change[c] = compute_code_change(&mix->tone, rgb[c], light[c]);
        change[3] = (int16_t)(change[3] +
                              multiply_q15(change[c], to[GLINT_MIX_LUMA + c]));
    }
}

static uint8_t add_light_to_luma(int code, int16_t change_q7, int16_t round_q7)
{
    return (uint8_t)(add_saturating(code * 128 + round_q7, change_q7) >> 7);
}

/* Adds light to one pixel. Returns the pixel's new luma, and sets CHANGE to the
 * changes of R', G', B' and Y'. */
static uint8_t add_light_to_pixel(int luma, int cb, int cr,
                                  const uint16_t light[3], int16_t change[4],
                                  const struct glint_mix *mix, int16_t round_q7)
{
    compute_pixel_change(luma * 128, cb * 128, cr * 128, light, change, mix);
    return add_light_to_luma(luma, change[3], round_q7);
}

void glint_add_luma_c(uint8_t *luma, const uint8_t *cb, const uint8_t *cr,
                      const uint16_t *const light[3], int16_t *const change[3],
                      int n, const struct glint_mix *mix, const int16_t *round)
{
    for (int i = 0; i < n; i++) {
        const uint16_t here[3] = {light[0][i], light[1][i], light[2][i]};
        int16_t changed[4];

        luma[i] = add_light_to_pixel(luma[i], cb[i], cr[i], here, changed, mix,
                                     round[i & 7]);
        for (int c = 0; c < 3; c++)
            change[c][i] = changed[chroma_changes[c]];
    }
}

static int16_t average_rounded_up(int a, int b)
{
    return (int16_t)((a + b + 1) >> 1);
}

/* Returns the new code of chroma whose code was CODE. Its pixels changed, in
 * the mean, by OWN in B' (for Cb) or R' (for Cr), and by LUMA in Y'. K is the
 * index in to_ycc of the factor of OWN; the factor of LUMA is next. */
static uint8_t add_change_to_chroma(int code, int own, int luma, int k,
                                    const struct glint_mix *mix,
                                    int16_t round_q7)
{
    const int16_t *to = mix->to_ycc.one;
    const int change_q7 =
        multiply_q15(own, to[k]) - multiply_q15(luma, to[k + 1]);

    return (uint8_t)(clamp_to_int16(code * 128 + round_q7 + change_q7, 0,
                                    INT16_MAX) >>
                     7);
}

void glint_add_pairs_c(uint8_t *luma, uint8_t *chroma,
                       const uint16_t *const light[3], int16_t *const mean[3],
                       int n, enum glint_pair_step step,
                       const struct glint_mix *mix, const int16_t *round,
                       const int16_t *round_chroma)
{
    for (int i = 0; i < n; i += 2) {
        int16_t changed[2][4], own[3];

        for (int k = 0; k < 2; k++) {
            const uint16_t here[3] = {light[0][i + k], light[1][i + k],
                                      light[2][i + k]};

            luma[i + k] =
                add_light_to_pixel(luma[i + k], chroma[i], chroma[i + 1], here,
                                   changed[k], mix, round[(i + k) & 7]);
        }
        for (int c = 0; c < 3; c++) {
            own[c] = average_rounded_up(changed[0][chroma_changes[c]],
                                        changed[1][chroma_changes[c]]);
            if (step == GLINT_PAIRS_FIRST)
                mean[c][i / 2] = own[c];
            if (step == GLINT_PAIRS_SECOND)
                own[c] = average_rounded_up(own[c], mean[c][i / 2]);
        }
        if (step == GLINT_PAIRS_FIRST)
            continue;
        chroma[i] =
            add_change_to_chroma(chroma[i], own[1], own[2], GLINT_MIX_CB_BLUE,
                                 mix, round_chroma[i & 7]);
        chroma[i + 1] = add_change_to_chroma(chroma[i + 1], own[0], own[2],
                                             GLINT_MIX_CR_RED, mix,
                                             round_chroma[(i + 1) & 7]);
    }
}

void glint_add_packed_c(uint8_t *pixels, const uint16_t *const light[3], int n,
                        int luma_at, const struct glint_mix *mix,
                        const int16_t *round, const int16_t *round_chroma)
{
    for (int i = 0; i < n; i += 2) {
        const uint16_t *const here[3] = {light[0] + i, light[1] + i,
                                         light[2] + i};
        const int16_t turned[2] = {round[i & 7], round[(i + 1) & 7]};
        const int16_t turned_chroma[2] = {round_chroma[i & 7],
                                          round_chroma[(i + 1) & 7]};
        uint8_t *px = pixels + 2 * i, *at[2] = {px + luma_at, px + 1 - luma_at};
        uint8_t luma[2] = {at[0][0], at[0][2]};
        uint8_t chroma[2] = {at[1][0], at[1][2]};

        glint_add_pairs_c(luma, chroma, here, NULL, 2, GLINT_PAIRS_ALONE, mix,
                          turned, turned_chroma);
        for (int k = 0; k < 2; k++) {
            at[0][2 * k] = luma[k];
            at[1][2 * k] = chroma[k];
        }
    }
}

/* Returns PART / WHOLE, _q15, by Newton's method with an error below 2^-12.
 * PART and WHOLE must be 0 or more. PART is clamped to WHOLE. */
static int16_t divide_clamped_q15(int part, int whole)
{
    const int zeros = 16 - bit_length((uint32_t)whole);
    const int n_q15 = (uint16_t)((uint32_t)whole << zeros) >> 1;
    const int n = n_q15 > 1 << 14 ? n_q15 : 1 << 14;
    const int d = (uint16_t)((uint32_t)(part < whole ? part : whole) << zeros);
    int16_t r_q14 =
        (int16_t)(GLINT_SHARE_FROM - multiply_q15(n, GLINT_SHARE_SLOPE));
    int16_t q_q14;

    for (int k = 0; k < 2; k++) {
        const int16_t rest_q14 = (int16_t)((1 << 15) - multiply_q15(n, r_q14));

        r_q14 = multiply_q15(r_q14, rest_q14);
        r_q14 = add_saturating(r_q14, r_q14);
    }
    q_q14 = multiply_q15(d >> 1, r_q14);
    return add_saturating(q_q14, q_q14);
}

/* Adds light to 2 x 2 pixels. Both rows are read before either is written,
 * because they may be the same row. */
static void add_light_to_quad(uint8_t *const luma[2], uint8_t *const chroma[2],
                              const uint16_t light[3],
                              const struct glint_mix *mix,
                              const int16_t *const round[2],
                              const int16_t *const round_chroma[2])
{
    const uint8_t y[2][2] = {{luma[0][0], luma[0][1]},
                             {luma[1][0], luma[1][1]}};
    const uint8_t c[2][2] = {{chroma[0][0], chroma[0][1]},
                             {chroma[1][0], chroma[1][1]}};
    const int y_q7 = (y[0][0] + y[0][1] + y[1][0] + y[1][1]) * 32;
    const int c_q7[2] = {(c[0][0] + c[1][0]) * 64, (c[0][1] + c[1][1]) * 64};
    const int headroom = mix->white[0] > y_q7 ? mix->white[0] - y_q7 : 0;
    const int16_t *to = mix->to_ycc.one;
    int16_t change[4], q;
    int change_c[2];

    compute_pixel_change(y_q7, c_q7[0], c_q7[1], light, change, mix);
    q = divide_clamped_q15(change[3], headroom);
    change_c[0] = multiply_q15(change[2], to[GLINT_MIX_CB_BLUE]) -
                  multiply_q15(change[3], to[GLINT_MIX_CB_LUMA]);
    change_c[1] = multiply_q15(change[0], to[GLINT_MIX_CR_RED]) -
                  multiply_q15(change[3], to[GLINT_MIX_CR_LUMA]);
    for (int row = 0; row < 2; row++)
        for (int k = 0; k < 2; k++) {
            const int16_t more = add_saturating(
                change[3], multiply_q15(y_q7 - y[row][k] * 128, q));
            const int16_t more_c = add_saturating(
                change_c[k], multiply_q15(c_q7[k] - c[row][k] * 128, q));

            luma[row][k] = add_light_to_luma(
                y[row][k], clamp_to_int16(more, 0, INT16_MAX), round[row][k]);
            chroma[row][k] =
                (uint8_t)(clamp_to_int16(c[row][k] * 128 +
                                             round_chroma[row][k] + more_c,
                                         0, INT16_MAX) >>
                          7);
        }
}

void glint_add_quads_c(uint8_t *const luma[2], uint8_t *const chroma[2],
                       const uint16_t *const light[3], int n,
                       const struct glint_mix *mix,
                       const int16_t *const round[2],
                       const int16_t *const round_chroma[2])
{
    for (int i = 0; i < n; i += 2) {
        const uint16_t here[3] = {light[0][i / 2], light[1][i / 2],
                                  light[2][i / 2]};
        uint8_t *const y[2] = {luma[0] + i, luma[1] + i};
        uint8_t *const c[2] = {chroma[0] + i, chroma[1] + i};
        const int16_t *const r[2] = {round[0] + (i & 7), round[1] + (i & 7)};
        const int16_t *const rc[2] = {round_chroma[0] + (i & 7),
                                      round_chroma[1] + (i & 7)};

        add_light_to_quad(y, c, here, mix, r, rc);
    }
}

void glint_add_quads_packed_c(uint8_t *const pixels[2],
                              const uint16_t *const light[3], int n,
                              int luma_at, const struct glint_mix *mix,
                              const int16_t *const round[2])
{
    for (int i = 0; i < n; i += 2) {
        const uint16_t here[3] = {light[0][i / 2], light[1][i / 2],
                                  light[2][i / 2]};
        const int16_t *const r[2] = {round[0] + (i & 7), round[1] + (i & 7)};
        uint8_t codes[2][4]; /* Y, Y, Cb, Cr */
        uint8_t *const y[2] = {codes[0], codes[1]};
        uint8_t *const c[2] = {codes[0] + 2, codes[1] + 2};

        for (int row = 0; row < 2; row++)
            for (int k = 0; k < 4; k++)
                codes[row][k] =
                    pixels[row][2 * i + 2 * (k & 1) + ((k >> 1) ^ luma_at)];
        add_light_to_quad(y, c, here, mix, r, r);
        for (int row = 0; row < 2; row++)
            for (int k = 0; k < 4; k++)
                pixels[row][2 * i + 2 * (k & 1) + ((k >> 1) ^ luma_at)] =
                    codes[row][k];
    }
}

void glint_add_code_c(uint8_t *code, const uint16_t *light, int n,
                      const struct glint_tone16 *tone, const int16_t *round)
{
    for (int i = 0; i < n; i++) {
        const int16_t change =
            light[i] ? compute_code_change(
                           tone, (int16_t)((code[i] * 257) >> 1), light[i])
                     : 0;
        const int16_t change_q7 =
            multiply_q15(change, tone->factor.one[GLINT_TONE_Q7]);

        code[i] =
            (uint8_t)(add_saturating(code[i] * 128 + round[i & 7], change_q7) >>
                      7);
    }
}

void glint_run_sum_c(uint32_t *change, uint32_t *carry, uint16_t *light_q16,
                     int n, int more)
{
    uint32_t sum = *carry;

    for (int i = 0; i < n; i++) {
        int32_t light;

        sum += change[i];
        change[i] = 0;
        light = (((int32_t)sum >> (more - 1)) + 1) >> 1;
        light_q16[i] = (uint16_t)(light < 0       ? 0
                                  : light < 65535 ? light
                                                  : 65535);
    }
    *carry = sum;
}

/* Returns the full-range CODE after the fraction COVER_Q8 of the pixel's light
 * is hidden. */
static int16_t hide_light_fraction_of_code(const struct glint_tone16 *t,
                                           int16_t code, int cover_q8)
{
    const uint32_t light =
        decode_code_to_light(t, code) * (uint32_t)(256 - cover_q8);
    const int16_t left =
        encode_light_to_code(t, (uint16_t)((light + 128) >> 8));

    return left < code ? left : code;
}

void glint_cover_code_c(uint8_t *code, const uint16_t *cover_q8, int n,
                        const struct glint_tone16 *tone)
{
    for (int i = 0; i < n; i++) {
        const int16_t full = (int16_t)((code[i] * 257) >> 1);
        const int change_q7 = multiply_q15(
            hide_light_fraction_of_code(tone, full, cover_q8[i]) - full,
            tone->factor.one[GLINT_TONE_Q7]);

        if (cover_q8[i])
            code[i] = cover_q8[i] < 256
                          ? add_light_to_luma(code[i], (int16_t)change_q7, 64)
                          : 0;
    }
}

/* Hides the fraction COVER_Q8 of the light of one pixel, given as Y', Cb, Cr
 * in _q7. */
static void hide_light_fraction_of_pixel(int16_t ycc_q7[3], int cover_q8,
                                         const struct glint_mix *mix)
{
    const int16_t *to = mix->to_ycc.one;
    int16_t rgb[3];
    int change[4] = {0, 0, 0, 0};

    convert_to_rgb(ycc_q7[0], ycc_q7[1], ycc_q7[2], rgb, mix);
    for (int c = 0; c < 3; c++) {
        change[c] =
            hide_light_fraction_of_code(&mix->tone, rgb[c], cover_q8) - rgb[c];
        change[3] += multiply_q15(change[c], to[GLINT_MIX_LUMA + c]);
    }
    ycc_q7[0] = clamp_to_int16(ycc_q7[0] + change[3], 0, INT16_MAX);
    ycc_q7[1] = clamp_to_int16(
        ycc_q7[1] + multiply_q15(change[2], to[GLINT_MIX_CB_BLUE]) -
            multiply_q15(change[3], to[GLINT_MIX_CB_LUMA]),
        0, INT16_MAX);
    ycc_q7[2] = clamp_to_int16(
        ycc_q7[2] + multiply_q15(change[0], to[GLINT_MIX_CR_RED]) -
            multiply_q15(change[3], to[GLINT_MIX_CR_LUMA]),
        0, INT16_MAX);
}

void glint_cover_ycc_c(int16_t *const ycc_q7[3], const uint16_t *cover_q8,
                       int n, int black, const struct glint_mix *mix)
{
    for (int i = 0; i < n; i++) {
        int16_t here_q7[3] = {ycc_q7[0][i], ycc_q7[1][i], ycc_q7[2][i]};

        if (cover_q8[i] == 0)
            continue;
        if (cover_q8[i] < 256)
            hide_light_fraction_of_pixel(here_q7, cover_q8[i], mix);
        else {
            here_q7[0] = (int16_t)(black * 128);
            here_q7[1] = here_q7[2] = 1 << 14;
        }
        for (int c = 0; c < 3; c++)
            ycc_q7[c][i] = here_q7[c];
    }
}
