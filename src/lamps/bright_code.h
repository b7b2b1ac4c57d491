/* SPDX-License-Identifier: MIT
 *
 * Codes of single pixels, for what is inlined where rows are gone through.
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

/* R, G, B of pixel X of a picture of RGB. */
static WHOLLY_INLINE void bright_read_rgb(const struct glint_bright *b, int x,
                                          int rgb[3])
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

static WHOLLY_INLINE void bright_decode_ycc(const struct glint_bright *b, int x,
                                            int32_t rgb_q20[3])
{
    int32_t rgb_q7[3];

    ycc_to_rgb(&b->ycc, code_at(b, 0, x), code_at(b, 1, x), code_at(b, 2, x),
               rgb_q7);
    for (int i = 0; i < 3; i++)
        rgb_q20[i] =
            curve_decode(b->curve, q_clamp_sat(rgb_q7[i], 0, CODE_WHITE_Q7));
}

/* The linear light of pixel X, 0 .. white. */
static WHOLLY_INLINE void bright_read(const struct glint_bright *b, int x,
                                      int32_t rgb_q20[3])
{
    int rgb[3];

    if (b->layout->kind == GLINT_LAYOUT_YCC) {
        bright_decode_ycc(b, x, rgb_q20);
        return;
    }
    if (bright_is_rgb(b))
        bright_read_rgb(b, x, rgb);
    else
        rgb[0] = rgb[1] = rgb[2] = b->full_luma[code_at(b, 0, x)];
    for (int i = 0; i < 3; i++)
        rgb_q20[i] = b->curve->decode_q20[rgb[i]];
}

/* Luma of RGB has the weights of BT.709, in 256ths, whose sum is 256. */
static WHOLLY_INLINE int bright_luma(const int rgb[3])
{
    return (54 * rgb[0] + 183 * rgb[1] + 19 * rgb[2] + 128) >> 8;
}

static WHOLLY_INLINE int bright_larger(int a, int b)
{
    return a > b ? a : b;
}

#endif
