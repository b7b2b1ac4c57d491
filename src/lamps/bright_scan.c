/* SPDX-License-Identifier: MIT
 *
 * Reads the brightness of the blocks of a row. */
#include "base/compiler.h"
#include "lamps/bright.h"
#include "lamps/bright_code.h"

/* --------------------------------------------------------------- R, G and B */

/* Returns the brightness of pixel X, which is clipped. */
static WHOLLY_INLINE uint8_t beyond_of_rgb(const struct glint_bright *b, int x)
{
    int rgb[3];

    bright_read_rgb(b, x, rgb);
    return b->beyond[bright_luma(rgb)];
}

/* Sets the values of pixels X .. END - 1; returns the greatest. */
static int read_values_rgb(struct glint_bright *b, int x, int end)
{
    int greatest = 0;

    for (; x < end; x++) {
        int rgb[3], value;

        bright_read_rgb(b, x, rgb);
        value = bright_larger(rgb[0], bright_larger(rgb[1], rgb[2]));
        if (value >= BRIGHT_CLIPPED)
            value = b->beyond[bright_luma(rgb)];
        b->value[x] = (uint8_t)value;
        greatest = bright_larger(greatest, value);
    }
    return greatest;
}

enum { RGB_BYTES = 3 * BRIGHT_BLOCK };

/* Sets LARGEST[I] to the largest of bytes P[I .. I + 2], for each I up to
 * RGB_BYTES - 3; returns the greatest of all. The last vector overlaps the one
 * before. */
static NEVER_INLINE int find_largest(const uint8_t *p,
                                     uint8_t largest[RGB_BYTES])
{
    uint8_t greatest = 0;

    for (int i = 0; i < RGB_BYTES - 16; i++) {
        const uint8_t two = p[i] > p[i + 1] ? p[i] : p[i + 1];
        const uint8_t most = two > p[i + 2] ? two : p[i + 2];

        largest[i] = most;
        greatest = greatest > most ? greatest : most;
    }
    for (int i = RGB_BYTES - 18; i < RGB_BYTES - 2; i++) {
        const uint8_t two = p[i] > p[i + 1] ? p[i] : p[i + 1];
        const uint8_t most = two > p[i + 2] ? two : p[i + 2];

        largest[i] = most;
        greatest = greatest > most ? greatest : most;
    }
    return greatest;
}

/* Does what read_values_rgb() does, for a whole block from X with three bytes a
 * pixel. */
static int read_block_rgb24(struct glint_bright *b, int x)
{
    const ptrdiff_t at = (ptrdiff_t)3 * x - b->layout->sample[0].offset;
    uint8_t largest[RGB_BYTES], *value = b->value + x;
    int greatest = find_largest(b->code[0].first + at, largest);

    for (int i = 0; i < BRIGHT_BLOCK; i++)
        value[i] = largest[3 * i];
    if (greatest < BRIGHT_CLIPPED)
        return greatest;
    greatest = 0;
    for (int i = 0; i < BRIGHT_BLOCK; i++) {
        if (value[i] >= BRIGHT_CLIPPED)
            value[i] = beyond_of_rgb(b, x + i);
        greatest = bright_larger(greatest, value[i]);
    }
    return greatest;
}

/* ------------------------------------------------------------- Y, Cb and Cr */

/* Returns A * B / 2^16, rounded down. */
static WHOLLY_INLINE int16_t high_product(int16_t a, int16_t b)
{
    return (int16_t)((int32_t)a * b >> 16);
}

/* Sets VALUE to the largest channels of pixels with LUMA, CB and CR, clamped to
 * 0 .. 255, within a fifth of a code before rounding. Written for compilers to
 * vectorize in 16 bits: codes have 7 fraction bits, coefficients 13 and
 * products 4, at most 2.12 * 255 * 16 < 2^14. */
static WHOLLY_INLINE void mix_block(const struct glint_bright *b,
                                    uint8_t value[BRIGHT_BLOCK],
                                    const uint8_t luma[BRIGHT_BLOCK],
                                    const uint8_t cb[BRIGHT_BLOCK],
                                    const uint8_t cr[BRIGHT_BLOCK])
{
    const int32_t(*m_q16)[3] = b->ycc.to_rgb_q16;
    const int16_t white = (int16_t)q_shift(m_q16[0][0], 3);
    const int16_t red = (int16_t)q_shift(m_q16[0][2], 3);
    const int16_t blue = (int16_t)q_shift(m_q16[2][1], 3);
    const int16_t green_u = (int16_t)q_shift(m_q16[1][1], 3);
    const int16_t green_v = (int16_t)q_shift(m_q16[1][2], 3);
    const int16_t black = (int16_t)b->ycc.black;

    for (int i = 0; i < BRIGHT_BLOCK; i++) {
        const int16_t y = (int16_t)((luma[i] - black) * 128);
        const int16_t u = (int16_t)((cb[i] - 128) * 128);
        const int16_t v = (int16_t)((cr[i] - 128) * 128);
        const int16_t r = high_product(v, red), l = high_product(u, blue);
        const int16_t g =
            (int16_t)(high_product(u, green_u) + high_product(v, green_v));
        const int16_t rl = r > l ? r : l, most = rl > g ? rl : g;
        const int16_t code =
            (int16_t)((high_product(y, white) + most + 9) >> 4);
        const int16_t held = code < 255 ? code : 255;

        value[i] = (uint8_t)(held > 0 ? held : 0);
    }
}

/* Copies the codes of a block that are STEP bytes apart. */
static WHOLLY_INLINE void take(uint8_t code[BRIGHT_BLOCK], const uint8_t *px,
                               int step)
{
    for (int k = 0; k < BRIGHT_BLOCK; k++)
        code[k] = px[k * step];
}

/* Copies the codes of a block that are STEP bytes apart, each for two pixels.
 */
static WHOLLY_INLINE void take_twice(uint8_t code[BRIGHT_BLOCK],
                                     const uint8_t *px, int step)
{
    for (int k = 0; k < BRIGHT_BLOCK / 2; k++)
        code[2 * k] = code[2 * k + 1] = px[k * step];
}

/* Copies code I of the pixels of a block from X; past the end of the row it
 * repeats that of the last pixel. With constant steps and ends compilers
 * vectorize the usual cases. */
static void gather(const struct glint_bright *b, int i, int x,
                   uint8_t code[BRIGHT_BLOCK])
{
    const struct glint_bright_code *c = &b->code[i];
    const int n = b->width - x < BRIGHT_BLOCK ? b->width - x : BRIGHT_BLOCK;
    const uint8_t *px = c->first + (x >> c->shift) * c->step;

    if (n < BRIGHT_BLOCK || (c->shift == 0 && c->step > 2)) {
        for (int k = 0; k < BRIGHT_BLOCK; k++)
            code[k] = px[((k < n ? k : n - 1) >> c->shift) * c->step];
    } else if (c->shift == 0) {
        if (c->step == 1)
            take(code, px, 1);
        else
            take(code, px, 2);
    } else {
        if (c->step == 1)
            take_twice(code, px, 1);
        else if (c->step == 2)
            take_twice(code, px, 2);
        else
            take_twice(code, px, 4);
    }
}

/* Sets the values of the block from pixel X, from luma and chroma or from luma
 * alone. Returns the greatest, or 0, without setting any, if all are below low
 * and none is clipped. */
static NEVER_INLINE int read_values_ycc(struct glint_bright *b, int x)
{
    uint8_t luma[BRIGHT_BLOCK], cb[BRIGHT_BLOCK], cr[BRIGHT_BLOCK];
    uint8_t value[BRIGHT_BLOCK];
    uint8_t greatest_code = 0, greatest = 0, *row = b->value + x;

    gather(b, 0, x, luma);
    if (b->layout->kind == GLINT_LAYOUT_GREY) {
        for (int i = 0; i < BRIGHT_BLOCK; i++)
            value[i] = b->full_luma[luma[i]];
    } else {
        gather(b, 1, x, cb);
        gather(b, 2, x, cr);
        mix_block(b, value, luma, cb, cr);
    }
    for (int i = 0; i < BRIGHT_BLOCK; i++)
        greatest_code = value[i] > greatest_code ? value[i] : greatest_code;
    for (int i = 0; i < BRIGHT_BLOCK && greatest_code >= BRIGHT_CLIPPED; i++)
        if (value[i] >= BRIGHT_CLIPPED)
            value[i] = b->beyond[b->full_luma[luma[i]]];
    if (greatest_code < b->low && greatest_code < BRIGHT_CLIPPED)
        return 0;
    for (int i = 0; i < BRIGHT_BLOCK; i++)
        greatest = greatest > value[i] ? greatest : value[i];
    for (int i = 0; i < BRIGHT_BLOCK; i++)
        row[i] = value[i];
    return greatest;
}

/* Sets the values of block I, which may have pixels of low or above. Returns
 * the greatest, or 0 if it is below low. */
static int read_block(struct glint_bright *b, int i)
{
    const int x = i * BRIGHT_BLOCK;
    const int end = x + BRIGHT_BLOCK < b->width ? x + BRIGHT_BLOCK : b->width;
    const int is_whole = end - x == BRIGHT_BLOCK;
    int greatest;

    if (!bright_is_rgb(b))
        greatest = read_values_ycc(b, x);
    else if (is_whole && b->layout->kind == GLINT_LAYOUT_RGB &&
             b->code[0].step == 3)
        greatest = read_block_rgb24(b, x);
    else
        greatest = read_values_rgb(b, x, end);
    return greatest < b->low ? 0 : greatest;
}

int glint_bright_scan(struct glint_bright *b, int y)
{
    const int n_blocks = (b->width + BRIGHT_BLOCK - 1) / BRIGHT_BLOCK;
    int any, greatest = 0;

    b->n_marked = 0;
    glint_bright_go(b, y);
    any = glint_bright_mark(b);
    /* a last block that is not whole is always read. */
    if (n_blocks * BRIGHT_BLOCK > b->width)
        any = b->block[n_blocks - 1] = 1;
    for (int i = 0; any && i < n_blocks; i++)
        if (b->block[i]) {
            b->block[i] = (uint8_t)read_block(b, i);
            b->marked[b->n_marked] = i;
            b->n_marked += b->block[i] > 0;
            greatest = bright_larger(greatest, b->block[i]);
        }
    return greatest;
}
