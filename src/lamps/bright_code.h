/* SPDX-License-Identifier: MIT
 *
 * Reads single pixels of a row. The functions are inlined into loops over rows.
 */
#ifndef GLINT_LAMPS_BRIGHT_CODE_H
#define GLINT_LAMPS_BRIGHT_CODE_H

#include "base/compiler.h"
#include "base/q.h"
#include "lamps/bright.h"

static WHOLLY_INLINE int code_at(const struct glint_bright *b, int i, int x)
{
    const struct glint_bright_code *c = &b->code[i];

    return c->first[(x >> c->shift) * c->step];
}

static inline int bright_is_rgb(const struct glint_bright *b)
{
    return b->layout->kind == GLINT_LAYOUT_RGB ||
           b->layout->kind == GLINT_LAYOUT_565;
}

/* Sets RGB to the codes of pixel X of a picture in RGB. */
static WHOLLY_INLINE void bright_read_rgb_codes(const struct glint_bright *b,
                                                int x, int rgb[3])
{
    if (b->layout->kind == GLINT_LAYOUT_565) {
        const int bits = code_at(b, 0, x) | code_at(b, 1, x) << 8;
        const int red = bits >> 11, green = bits >> 5 & 63, blue = bits & 31;

        rgb[0] = red << 3 | red >> 2;
        rgb[1] = green << 2 | green >> 4;
        rgb[2] = blue << 3 | blue >> 2;
    } else {
        for (int i = 0; i < 3; i++)
            rgb[i] = code_at(b, i, x);
    }
}

static WHOLLY_INLINE void bright_decode_ycc_pixel(const struct glint_bright *b,
                                                  int x, int32_t rgb_q20[3])
{
    int32_t rgb_q7[3];

    convert_ycc_to_rgb(&b->ycc, code_at(b, 0, x), code_at(b, 1, x),
                       code_at(b, 2, x), rgb_q7);
    for (int i = 0; i < 3; i++)
        rgb_q20[i] = curve_decode_to_light(
            b->curve, q_clamp_sat(rgb_q7[i], 0, CODE_WHITE_Q7));
}

/* Sets RGB to the linear light of pixel X, 0 .. white. */
static WHOLLY_INLINE void bright_read_pixel_light(const struct glint_bright *b,
                                                  int x, int32_t rgb_q20[3])
{
    int rgb[3];

    if (b->layout->kind == GLINT_LAYOUT_YCC) {
        bright_decode_ycc_pixel(b, x, rgb_q20);
        return;
    }
    if (bright_is_rgb(b))
        bright_read_rgb_codes(b, x, rgb);
    else
        rgb[0] = rgb[1] = rgb[2] = b->full_luma[code_at(b, 0, x)];
    for (int i = 0; i < 3; i++)
        rgb_q20[i] = b->curve->decode_q20[rgb[i]];
}

/* Returns the luma of RGB, by the weights of BT.709 in 256ths. */
static WHOLLY_INLINE int bright_compute_luma(const int rgb[3])
{
    return (54 * rgb[0] + 183 * rgb[1] + 19 * rgb[2] + 128) >> 8;
}

static WHOLLY_INLINE int bright_larger(int a, int b)
{
    return a > b ? a : b;
}

static WHOLLY_INLINE int
bright_compute_rgb_brightness(const struct glint_bright *b, int x)
{
    int rgb[3], largest;

    bright_read_rgb_codes(b, x, rgb);
    largest = bright_larger(rgb[0], bright_larger(rgb[1], rgb[2]));
    return largest < BRIGHT_CLIPPED ? largest
                                    : b->beyond[bright_compute_luma(rgb)];
}

/* Returns the largest amount, over R, G and B, that Cb and Cr of pixel X add to
 * its luma, in full-range codes. */
static WHOLLY_INLINE int32_t
bright_compute_max_chroma_term_q16(const struct glint_bright *b, int x)
{
    const int cb = code_at(b, 1, x) - 128, cr = code_at(b, 2, x) - 128;
    const int32_t(*m_q16)[3] = b->ycc.to_rgb_q16;
    const int32_t red_q16 = cr * m_q16[0][2], blue_q16 = cb * m_q16[2][1];
    const int32_t green_q16 = cb * m_q16[1][1] + cr * m_q16[1][2];

    return bright_larger(red_q16, bright_larger(green_q16, blue_q16));
}

static WHOLLY_INLINE int
bright_compute_ycc_brightness(const struct glint_bright *b, int code,
                              int32_t added_q16)
{
    const int32_t sum_q16 =
        (code - b->ycc.black) * b->ycc.to_rgb_q16[0][0] + added_q16;
    const int largest = (sum_q16 + (1 << 15)) >> 16;

    if (largest < BRIGHT_CLIPPED)
        return bright_larger(largest, 0);
    return b->beyond[b->full_luma[code]];
}

/* Returns the brightness of pixel X of B's current row. */
static WHOLLY_INLINE int
bright_compute_pixel_brightness(const struct glint_bright *b, int x)
{
    if (bright_is_rgb(b))
        return bright_compute_rgb_brightness(b, x);
    return bright_compute_ycc_brightness(
        b, code_at(b, 0, x),
        b->layout->kind == GLINT_LAYOUT_YCC
            ? bright_compute_max_chroma_term_q16(b, x)
            : 0);
}

#endif
