/* SPDX-License-Identifier: MIT */
#include "flare/bright.h"

#include "base/arena.h"
#include "base/compiler.h"
#include "base/q.h"

#define EACH_BYTE UINT64_C(0x0101010101010101)
#define LOW_BITS  (0x7f * EACH_BYTE)
#define HIGH_BITS (0x80 * EACH_BYTE)

/* Chroma is within bound I while |C - 128| is below it: 8, 16, 32, 64. */
#define CHROMA_BOUND(i) (8 << (i))

static size_t blocks_of(int width)
{
    return ((size_t)width + BRIGHT_BLOCK - 1) / BRIGHT_BLOCK;
}

void glint_bright_carve(struct glint_bright *b, struct glint_arena *arena,
                        int width)
{
    b->curve = glint_arena_take(arena, 1, sizeof *b->curve);
    b->full_luma = glint_arena_take(arena, 256, 1);
    b->beyond = glint_arena_take(arena, 256, 1);
    b->value = glint_arena_take(arena, (size_t)width, sizeof *b->value);
    b->block = glint_arena_take(arena, blocks_of(width), sizeof *b->block);
}

void glint_bright_init(struct glint_bright *b, int width)
{
    b->width = width;
    b->curve_tone = -1;
}

static int is_rgb(const struct glint_layout *layout)
{
    return layout->kind == GLINT_LAYOUT_RGB || layout->kind == GLINT_LAYOUT_565;
}

/* Steps of 15: the least of them below luma 192, the last from 252 on. */
static void set_beyond(uint8_t beyond[256])
{
    for (int luma = 0; luma < 256; luma++)
        beyond[luma] =
            (uint8_t)(BRIGHT_CLIPPED + (luma > 177 ? (luma - 177) / 15 : 0));
}

void glint_bright_begin(struct glint_bright *b, const struct glint_image *image)
{
    b->image = image;
    b->layout = glint_layout_of(image->format);
    b->n_codes = b->layout->kind == GLINT_LAYOUT_GREY  ? 1
                 : b->layout->kind == GLINT_LAYOUT_565 ? 2
                                                       : 3;
    if (b->curve_tone != (int)image->transfer)
        glint_curve_init(b->curve, image->transfer);
    b->curve_tone = (int)image->transfer;
    glint_ycc_init(&b->ycc, image->matrix, image->range);
    for (int code = 0; code < 256; code++)
        b->full_luma[code] = (uint8_t)q_clamp_sat(
            q_shift((int64_t)(code - b->ycc.black) * b->ycc.to_rgb_q16[0][0],
                    16),
            0, 255);
    set_beyond(b->beyond);
}

/* Full-range codes that chroma within +-BOUND can add to luma at most. */
static int chroma_adds(const struct glint_bright *b, int bound)
{
    int64_t most_q16 = 0;

    for (int i = 0; i < 3; i++) {
        const int64_t sum_q16 =
            bound * (int64_t)(q_magnitude(b->ycc.to_rgb_q16[i][1]) +
                              q_magnitude(b->ycc.to_rgb_q16[i][2]));

        most_q16 = sum_q16 > most_q16 ? sum_q16 : most_q16;
    }
    return (int)((most_q16 + 65535) >> 16);
}

/* The least Y code whose luma is LUMA or more; 256: there is none. */
static int least_of_luma(const struct glint_bright *b, int luma)
{
    int code = luma > 0 ? 1 : 0;

    while (code < 256 && b->full_luma[code] < luma)
        code++;
    return code;
}

void glint_bright_set_low(struct glint_bright *b, int low)
{
    const int channel = low < BRIGHT_CLIPPED ? low : BRIGHT_CLIPPED;

    b->low = low;
    for (int i = 0; i < BRIGHT_BOUNDS; i++)
        b->low_code[i] =
            is_rgb(b->layout) ? channel
            : b->layout->kind == GLINT_LAYOUT_GREY
                ? least_of_luma(b, channel)
                : least_of_luma(b,
                                channel - chroma_adds(b, CHROMA_BOUND(i)) - 1);
}

/* ----------------------------------------------------------------- scanning */

/* Eight bytes, the first lowest; written so that compilers make one load of it.
 */
static WHOLLY_INLINE uint64_t load(const uint8_t *p)
{
    return (uint64_t)p[0] | (uint64_t)p[1] << 8 | (uint64_t)p[2] << 16 |
           (uint64_t)p[3] << 24 | (uint64_t)p[4] << 32 | (uint64_t)p[5] << 40 |
           (uint64_t)p[6] << 48 | (uint64_t)p[7] << 56;
}

/* High bits of the bytes of N words at P that are CODE or more. No byte carries
 * into the next: both addends are below 128. */
static WHOLLY_INLINE uint64_t high_codes(const uint8_t *p, int n, int code,
                                         int is_above_128)
{
    const uint64_t add =
        (uint64_t)((is_above_128 ? 256 : 128) - code) * EACH_BYTE;
    uint64_t found = 0;

    for (int i = 0; i < n; i++) {
        const uint64_t v = load(p + 8 * i), sum = (v & LOW_BITS) + add;

        found |= is_above_128 ? sum & v : sum | v;
    }
    return found & HIGH_BITS;
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
        const uint64_t v = load(p + 8 * i);

        found |= ((v >> 11 & 31 * each) + add_5) & 32 * each;
        found |= (((v & 31 * each) + add_5) & 32 * each);
        found |= ((v >> 5 & 63 * each) + add_6) >> 1 & 32 * each;
    }
    return found;
}

/* Bits for the bytes of N words at P, those of BYTES, that are not within
 * +-BOUND of 128: a power of two, 64 at most. No byte carries. */
static WHOLLY_INLINE uint64_t far_from_128(const uint8_t *p, int n, int bound,
                                           uint64_t bytes)
{
    const uint64_t add = (uint64_t)bound * EACH_BYTE;
    const uint64_t far = (uint64_t)(256 - 2 * bound) * EACH_BYTE;
    uint64_t found = 0;

    for (int i = 0; i < n; i++) {
        const uint64_t v = load(p + 8 * i);

        found |= ((v & LOW_BITS) + add) ^ (~v & HIGH_BITS);
    }
    return found & far & bytes;
}

/* Which bytes of a word are luma, or a sample of a colour. */
static uint64_t bytes_of_light(const struct glint_layout *layout)
{
    const struct glint_layout_sample *s = &layout->sample[0];

    if (glint_layout_is_packed(layout))
        return UINT64_C(0x00ff00ff00ff00ff) << (8 * s->offset);
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
    const int n = b->width / BRIGHT_BLOCK, code = b->low_code[0];
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
                               b->low_code[0]) != 0;
        any |= b->block[i];
    }
    return any;
}

/* Whether the block at PX of a packed row may have a bright pixel. */
static WHOLLY_INLINE int may_be_bright(const struct glint_bright *b,
                                       const uint8_t *px, uint64_t luma)
{
    for (int i = 0; i < BRIGHT_BOUNDS; i++) {
        if (high_of(px, BRIGHT_BLOCK / 4, b->low_code[i]) & luma)
            return 1;
        if (!far_from_128(px, BRIGHT_BLOCK / 4, CHROMA_BOUND(i), ~luma))
            return 0;
    }
    return 1;
}

static int mark_row_packed(struct glint_bright *b, const uint8_t *px)
{
    const uint64_t luma = bytes_of_light(b->layout);
    int any = 0;

    for (int i = 0; i < b->width / BRIGHT_BLOCK; i++) {
        b->block[i] =
            (uint8_t)may_be_bright(b, px + i * 2 * BRIGHT_BLOCK, luma);
        any |= b->block[i];
    }
    return any;
}

/* The same of a block whose luma is at PX and whose chroma is WORDS words at
 * each of C. */
static WHOLLY_INLINE int may_be_bright_in_planes(const struct glint_bright *b,
                                                 const uint8_t *px,
                                                 const uint8_t *const c[2],
                                                 int words)
{
    for (int i = 0; i < BRIGHT_BOUNDS; i++) {
        if (high_of(px, BRIGHT_BLOCK / 8, b->low_code[i]))
            return 1;
        if (!far_from_128(c[0], words, CHROMA_BOUND(i), UINT64_MAX) &&
            !far_from_128(c[1], words, CHROMA_BOUND(i), UINT64_MAX))
            return 0;
    }
    return 1;
}

/* Of NV12 both samples are in one plane, and it is looked at in two halves. */
static int mark_row_planes(struct glint_bright *b)
{
    const struct glint_bright_code *code = b->code;
    const int is_shared = b->layout->planes == 2;
    const int bytes = BRIGHT_BLOCK * code[1].step >> code[1].shift;
    const int words = (is_shared ? bytes / 2 : bytes) / 8;
    const uint8_t *low = is_shared && code[2].first < code[1].first
                             ? code[2].first
                             : code[1].first;
    int any = 0;

    for (int i = 0; i < b->width / BRIGHT_BLOCK; i++) {
        const uint8_t *const c[2] = {low + i * bytes,
                                     is_shared ? low + i * bytes + bytes / 2
                                               : code[2].first + i * bytes};
        const uint8_t *px = code[0].first + i * BRIGHT_BLOCK;

        b->block[i] =
            (uint8_t)(words == 2 ? may_be_bright_in_planes(b, px, c, 2)
                                 : may_be_bright_in_planes(b, px, c, 4));
        any |= b->block[i];
    }
    return any;
}

static int mark(struct glint_bright *b)
{
    const uint8_t *first = b->code[0].first;

    if (b->layout->kind == GLINT_LAYOUT_565)
        return mark_row_565(b, first);
    if (b->layout->kind != GLINT_LAYOUT_YCC)
        return mark_row(b, first - b->layout->sample[0].offset);
    if (glint_layout_is_packed(b->layout))
        return mark_row_packed(b, first - b->layout->sample[0].offset);
    return mark_row_planes(b);
}

/* -------------------------------------------------------------------- value */

static WHOLLY_INLINE int code_at(const struct glint_bright *b, int i, int x)
{
    const struct glint_bright_code *c = &b->code[i];

    return c->first[(x >> c->shift) * c->step];
}

void glint_bright_go(struct glint_bright *b, int y)
{
    const struct glint_layout *layout = b->layout;

    for (int i = 0; i < b->n_codes; i++)
        b->code[i] = (struct glint_bright_code){
            glint_layout_at(layout, b->image, i, 0, y), layout->sample[i].step,
            i ? layout->log2_x : 0};
    if (layout->kind == GLINT_LAYOUT_565)
        b->code[1].first = b->code[0].first + 1;
}

/* R, G, B of pixel X of a picture of RGB. */
static WHOLLY_INLINE void read_rgb(const struct glint_bright *b, int x,
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

static WHOLLY_INLINE int larger(int a, int b)
{
    return a > b ? a : b;
}

/* Luma of RGB has the weights of BT.709, in 256ths, whose sum is 256. */
static WHOLLY_INLINE int value_of_rgb(const struct glint_bright *b, int x)
{
    int rgb[3], largest;

    read_rgb(b, x, rgb);
    largest = larger(rgb[0], larger(rgb[1], rgb[2]));
    if (largest < BRIGHT_CLIPPED)
        return largest;
    return b->beyond[(54 * rgb[0] + 183 * rgb[1] + 19 * rgb[2] + 128) >> 8];
}

/* What the chroma of pixel X adds to the largest channel, of full-range codes.
 */
static WHOLLY_INLINE int32_t chroma_q16(const struct glint_bright *b, int x)
{
    const int cb = code_at(b, 1, x) - 128, cr = code_at(b, 2, x) - 128;
    const int32_t(*m_q16)[3] = b->ycc.to_rgb_q16;
    const int32_t red_q16 = cb * m_q16[0][1] + cr * m_q16[0][2];
    const int32_t green_q16 = cb * m_q16[1][1] + cr * m_q16[1][2];
    const int32_t blue_q16 = cb * m_q16[2][1] + cr * m_q16[2][2];

    return larger(red_q16, larger(green_q16, blue_q16));
}

static WHOLLY_INLINE int value_of_luma(const struct glint_bright *b, int code,
                                       int32_t added_q16)
{
    const int32_t sum_q16 =
        (code - b->ycc.black) * b->ycc.to_rgb_q16[0][0] + added_q16;
    const int largest = (sum_q16 + (1 << 15)) >> 16;

    if (largest < BRIGHT_CLIPPED)
        return larger(largest, 0);
    return b->beyond[b->full_luma[code]];
}

int glint_bright_value_at(const struct glint_bright *b, int x)
{
    if (is_rgb(b->layout))
        return value_of_rgb(b, x);
    return value_of_luma(b, code_at(b, 0, x),
                         b->layout->kind == GLINT_LAYOUT_YCC ? chroma_q16(b, x)
                                                             : 0);
}

/* Value of pixels X .. END - 1; returns the greatest. */
static int read_values_rgb(struct glint_bright *b, int x, int end)
{
    int greatest = 0;

    for (; x < end; x++) {
        const int value = value_of_rgb(b, x);

        b->value[x] = (uint8_t)value;
        greatest = larger(greatest, value);
    }
    return greatest;
}

/* A * B / 2^16, rounded down. */
static WHOLLY_INLINE int16_t high_product(int16_t a, int16_t b)
{
    return (int16_t)((int32_t)a * b >> 16);
}

/* Largest channels from codes of luma and of chroma over each, held to 0 ..
 * 255 and within a fifth of a code before that is rounded; written so that
 * compilers make vectors of 16 bits of it. Codes have 7 fraction bits,
 * coefficients 13 and products 4: at most 2.12 * 255 * 16 < 2^14. */
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

/* The codes of a block from X; past the end of the row, of its last pixel. */
static void gather(const struct glint_bright *b, int i, int x,
                   uint8_t code[BRIGHT_BLOCK])
{
    const struct glint_bright_code *c = &b->code[i];
    const int n = b->width - x < BRIGHT_BLOCK ? b->width - x : BRIGHT_BLOCK;
    const uint8_t *px = c->first + (x >> c->shift) * c->step;

    if (c->shift)
        for (int k = 0; k < n; k++)
            code[k] = px[(k >> 1) * c->step];
    else
        for (int k = 0; k < n; k++)
            code[k] = px[k * c->step];
    for (int k = n; k < BRIGHT_BLOCK; k++)
        code[k] = code[n - 1];
}

/* The same of luma and chroma, or of luma alone. X begins a block. */
static int read_values_ycc(struct glint_bright *b, int x, int end)
{
    uint8_t luma[BRIGHT_BLOCK], cb[BRIGHT_BLOCK], cr[BRIGHT_BLOCK];
    uint8_t value[BRIGHT_BLOCK];
    uint8_t greatest_code = 0;
    int greatest = 0;

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
    for (int i = 0; i < end - x; i++) {
        b->value[x + i] = value[i];
        greatest = larger(greatest, value[i]);
    }
    return greatest;
}

/* Reads block I, which may have pixels of low or above. */
static int read_block(struct glint_bright *b, int i)
{
    const int x = i * BRIGHT_BLOCK;
    const int end = x + BRIGHT_BLOCK < b->width ? x + BRIGHT_BLOCK : b->width;
    const int greatest = is_rgb(b->layout) ? read_values_rgb(b, x, end)
                                           : read_values_ycc(b, x, end);

    return greatest < b->low ? 0 : greatest;
}

int glint_bright_scan(struct glint_bright *b, int y)
{
    const int n_blocks = (int)blocks_of(b->width);
    int any, greatest = 0;

    glint_bright_go(b, y);
    any = mark(b);
    if (n_blocks * BRIGHT_BLOCK > b->width) /* the rest is looked at as it is */
        any = b->block[n_blocks - 1] = 1;
    for (int i = 0; any && i < n_blocks; i++)
        if (b->block[i]) {
            b->block[i] = (uint8_t)read_block(b, i);
            greatest = larger(greatest, b->block[i]);
        }
    return greatest;
}

/* -------------------------------------------------------------------- light */

static void decode_ycc(const struct glint_bright *b, int x, int32_t rgb_q20[3])
{
    int32_t rgb_q7[3];

    ycc_to_rgb(&b->ycc, code_at(b, 0, x), code_at(b, 1, x), code_at(b, 2, x),
               rgb_q7);
    for (int i = 0; i < 3; i++)
        rgb_q20[i] =
            curve_decode(b->curve, q_clamp_sat(rgb_q7[i], 0, CODE_WHITE_Q7));
}

void glint_bright_read(const struct glint_bright *b, int x, int32_t rgb_q20[3])
{
    int rgb[3];

    if (b->layout->kind == GLINT_LAYOUT_YCC) {
        decode_ycc(b, x, rgb_q20);
        return;
    }
    if (is_rgb(b->layout))
        read_rgb(b, x, rgb);
    else
        rgb[0] = rgb[1] = rgb[2] = b->full_luma[code_at(b, 0, x)];
    for (int i = 0; i < 3; i++)
        rgb_q20[i] = b->curve->decode_q20[rgb[i]];
}

int glint_bright_same(const struct glint_bright *b, int x, int end)
{
    int code[3];

    for (int i = 0; i < b->n_codes; i++)
        code[i] = code_at(b, i, x);
    for (x++; x < end; x++)
        for (int i = 0; i < b->n_codes; i++)
            if (code_at(b, i, x) != code[i])
                return x;
    return end;
}
