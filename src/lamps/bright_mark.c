/* SPDX-License-Identifier: MIT
 *
 * Which blocks of a row may have a bright pixel.
 */
#include "base/bytes.h"
#include "base/compiler.h"
#include "lamps/bright.h"
#include "lamps/bright_code.h"

/* ------------------------------------------------------------ one threshold */

/* High bits of the bytes of N words at P that are CODE or more. */
static WHOLLY_INLINE uint64_t high_codes(const uint8_t *p, int n, int code,
                                         int is_above_128)
{
    uint64_t found = 0;

    for (int i = 0; i < n; i++)
        found |= bytes_reach(bytes_load(p + 8 * i), code, is_above_128);
    return found;
}

/* The least of N_BITS bits that becomes CODE or more when its highest bits are
 * repeated below it. */
static int least_of_565(int code, int n_bits)
{
    int v = 0;

    while (v < (1 << n_bits) - 1 &&
           (v << (8 - n_bits) | v >> (2 * n_bits - 8)) < code)
        v++;
    return v;
}

/* Bits for the pixels, four a word, of which some sample is CODE or more. */
static uint64_t high_565(const uint8_t *p, int n, int code)
{
    const uint64_t each = UINT64_C(0x0001000100010001);
    const uint64_t add_5 = (uint64_t)(32 - least_of_565(code, 5)) * each;
    const uint64_t add_6 = (uint64_t)(64 - least_of_565(code, 6)) * each;
    uint64_t found = 0;

    for (int i = 0; i < n; i++) {
        const uint64_t v = bytes_load(p + 8 * i);

        found |= ((v >> 11 & 31 * each) + add_5) & 32 * each;
        found |= (((v & 31 * each) + add_5) & 32 * each);
        found |= ((v >> 5 & 63 * each) + add_6) >> 1 & 32 * each;
    }
    return found;
}

/* Which bytes of a word are a sample of a colour. */
static uint64_t bytes_of_light(const struct glint_layout *layout)
{
    const struct glint_layout_sample *s = &layout->sample[0];

    if (layout->kind == GLINT_LAYOUT_RGB && s->step == 4)
        return UINT64_C(0x00ffffff00ffffff);
    return UINT64_MAX;
}

static WHOLLY_INLINE uint64_t high_of(const uint8_t *p, int n, int code)
{
    return code > 128 ? high_codes(p, n, code, 1) : high_codes(p, n, code, 0);
}

/* Marks the whole blocks of a row at PX without chroma. STEP: bytes of a pixel.
 */
static WHOLLY_INLINE int mark_blocks(struct glint_bright *b, const uint8_t *px,
                                     int step)
{
    const uint64_t bytes = bytes_of_light(b->layout);
    const int n = b->width / BRIGHT_BLOCK, code = b->low_code;
    int any = 0;

    for (int i = 0; i < n; i++) {
        const uint64_t found = high_of(px, BRIGHT_BLOCK / 8 * step, code);

        b->block[i] = (found & bytes) != 0;
        any |= b->block[i];
        px += BRIGHT_BLOCK * step;
    }
    return any;
}

/* The same for each step apart, so that the loops inside have constant ends. */
static int mark_row(struct glint_bright *b, const uint8_t *px)
{
    switch (b->layout->sample[0].step) {
    case 1:
        return mark_blocks(b, px, 1);
    case 3:
        return mark_blocks(b, px, 3);
    default:
        return mark_blocks(b, px, 4);
    }
}

static int mark_row_565(struct glint_bright *b, const uint8_t *px)
{
    int any = 0;

    for (int i = 0; i < b->width / BRIGHT_BLOCK; i++) {
        b->block[i] = high_565(px + i * 2 * BRIGHT_BLOCK, BRIGHT_BLOCK / 4,
                               b->low_code) != 0;
        any |= b->block[i];
    }
    return any;
}

/* ------------------------------------------------------------- Y, Cb and Cr */

/* The greatest and the least of the bytes at every fourth place. */
struct extremes {
    uint8_t most[4], least[4];
};

static WHOLLY_INLINE uint8_t larger(uint8_t a, uint8_t b)
{
    return a > b ? a : b;
}

static WHOLLY_INLINE uint8_t smaller(uint8_t a, uint8_t b)
{
    return a < b ? a : b;
}

/* Of N times 16 bytes at P, N 1, 2 or 4: what is short is taken twice. Written
 * so that compilers make vectors of it, which they do of loops that are in no
 * other one; what is least is most of 255 - v. */
static NEVER_INLINE void find_extremes(struct extremes *e, const uint8_t *p,
                                       int n)
{
    const uint8_t *q = n > 1 ? p + 16 : p;
    const uint8_t *r = n > 2 ? p + 32 : p, *s = n > 2 ? p + 48 : q;
    uint8_t most[32], half[16];

    for (int i = 0; i < 16; i++)
        most[i] = larger(larger(p[i], q[i]), larger(r[i], s[i]));
    for (int i = 0; i < 16; i++)
        most[16 + i] =
            (uint8_t)(255 - smaller(smaller(p[i], q[i]), smaller(r[i], s[i])));
    for (int i = 0; i < 8; i++)
        half[i] = larger(most[i], most[i + 8]);
    for (int i = 0; i < 8; i++)
        half[8 + i] = larger(most[16 + i], most[24 + i]);
    for (int i = 0; i < 4; i++)
        e->most[i] = larger(half[i], half[i + 4]);
    for (int i = 0; i < 4; i++)
        e->least[i] = (uint8_t)(255 - larger(half[8 + i], half[12 + i]));
}

/* All four places as one. */
static WHOLLY_INLINE int most_of(const struct extremes *e)
{
    return bright_larger(bright_larger(e->most[0], e->most[1]),
                         bright_larger(e->most[2], e->most[3]));
}

static WHOLLY_INLINE int least_of(const struct extremes *e)
{
    return smaller(smaller(e->least[0], e->least[1]),
                   smaller(e->least[2], e->least[3]));
}

/* Whether a pixel may be bright whose luma is MOST at most and whose chroma is
 * in LEAST .. MOST: no channel of the block can exceed that of these. A code is
 * left for what rounding does. */
static WHOLLY_INLINE int may_be_bright(const struct glint_bright *b, int luma,
                                       const int most[2], const int least[2])
{
    const int32_t(*m_q16)[3] = b->ycc.to_rgb_q16;
    const int32_t red_q16 = (most[1] - 128) * m_q16[0][2];
    const int32_t green_q16 =
        (least[0] - 128) * m_q16[1][1] + (least[1] - 128) * m_q16[1][2];
    const int32_t blue_q16 = (most[0] - 128) * m_q16[2][1];
    const int32_t added_q16 =
        bright_larger(red_q16, bright_larger(green_q16, blue_q16));

    return (luma - b->ycc.black) * m_q16[0][0] + added_q16 >= b->low_sum_q16;
}

/* Of YUYV and UYVY. */
static int mark_row_packed(struct glint_bright *b, const uint8_t *px)
{
    const int y = b->layout->sample[0].offset;
    const int cb = b->layout->sample[1].offset;
    const int cr = b->layout->sample[2].offset;
    int any = 0;

    for (int i = 0; i < b->width / BRIGHT_BLOCK; i++) {
        struct extremes e;

        find_extremes(&e, px + i * 2 * BRIGHT_BLOCK, BRIGHT_BLOCK / 8);
        b->block[i] =
            (uint8_t)may_be_bright(b, bright_larger(e.most[y], e.most[y + 2]),
                                   (const int[]){e.most[cb], e.most[cr]},
                                   (const int[]){e.least[cb], e.least[cr]});
        any |= b->block[i];
    }
    return any;
}

/* Of a block of planes: Y at PX, N times 16 bytes of chroma at each of C. */
static WHOLLY_INLINE int may_be_bright_in_planes(const struct glint_bright *b,
                                                 const uint8_t *px,
                                                 const uint8_t *const c[2],
                                                 int n)
{
    struct extremes luma, cb, cr;

    find_extremes(&luma, px, BRIGHT_BLOCK / 16);
    find_extremes(&cb, c[0], n);
    find_extremes(&cr, c[1], n);
    return may_be_bright(b, most_of(&luma),
                         (const int[]){most_of(&cb), most_of(&cr)},
                         (const int[]){least_of(&cb), least_of(&cr)});
}

/* The same of a plane that chroma shares, CB its first place, 0 or 1. */
static WHOLLY_INLINE int may_be_bright_shared(const struct glint_bright *b,
                                              const uint8_t *px,
                                              const uint8_t *c, int cb)
{
    struct extremes luma, e;
    const int cr = 1 - cb;

    find_extremes(&luma, px, BRIGHT_BLOCK / 16);
    find_extremes(&e, c, BRIGHT_BLOCK / 16);
    return may_be_bright(
        b, most_of(&luma),
        (const int[]){bright_larger(e.most[cb], e.most[cb + 2]),
                      bright_larger(e.most[cr], e.most[cr + 2])},
        (const int[]){smaller(e.least[cb], e.least[cb + 2]),
                      smaller(e.least[cr], e.least[cr + 2])});
}

static int mark_row_shared(struct glint_bright *b)
{
    const struct glint_bright_code *code = b->code;
    const int cb = code[2].first < code[1].first;
    const uint8_t *first = cb ? code[2].first : code[1].first;
    int any = 0;

    for (int i = 0; i < b->width / BRIGHT_BLOCK; i++) {
        b->block[i] = (uint8_t)may_be_bright_shared(
            b, code[0].first + i * BRIGHT_BLOCK, first + i * BRIGHT_BLOCK, cb);
        any |= b->block[i];
    }
    return any;
}

static int mark_row_planes(struct glint_bright *b)
{
    const struct glint_bright_code *code = b->code;
    const int bytes = BRIGHT_BLOCK >> code[1].shift;
    int any = 0;

    for (int i = 0; i < b->width / BRIGHT_BLOCK; i++) {
        const uint8_t *const c[2] = {code[1].first + i * bytes,
                                     code[2].first + i * bytes};
        const uint8_t *px = code[0].first + i * BRIGHT_BLOCK;

        b->block[i] =
            (uint8_t)(bytes == 16 ? may_be_bright_in_planes(b, px, c, 1)
                                  : may_be_bright_in_planes(b, px, c, 2));
        any |= b->block[i];
    }
    return any;
}

int glint_bright_mark(struct glint_bright *b)
{
    const uint8_t *first = b->code[0].first;

    if (b->layout->kind == GLINT_LAYOUT_565)
        return mark_row_565(b, first);
    if (b->layout->kind != GLINT_LAYOUT_YCC)
        return mark_row(b, first - b->layout->sample[0].offset);
    if (glint_layout_is_packed(b->layout))
        return mark_row_packed(b, first - b->layout->sample[0].offset);
    return b->layout->planes == 2 ? mark_row_shared(b) : mark_row_planes(b);
}
