/* SPDX-License-Identifier: MIT */
#include "flare/bright.h"

#include "base/arena.h"
#include "base/compiler.h"
#include "base/q.h"

#define EACH_BYTE UINT64_C(0x0101010101010101)
#define LOW_BITS  (0x7f * EACH_BYTE)
#define HIGH_BITS (0x80 * EACH_BYTE)

static size_t blocks_of(int width)
{
    return ((size_t)width + BRIGHT_BLOCK - 1) / BRIGHT_BLOCK;
}

void glint_bright_carve(struct glint_bright *b, struct glint_arena *arena,
                        int width)
{
    b->curve = glint_arena_take(arena, 1, sizeof *b->curve);
    b->luma = glint_arena_take(arena, (size_t)width, sizeof *b->luma);
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

void glint_bright_begin(struct glint_bright *b, const struct glint_image *image,
                        int low)
{
    b->image = image;
    b->layout = glint_layout_of(image->format);
    b->low = b->low_code = low;
    if (b->curve_tone != (int)image->transfer)
        glint_curve_init(b->curve, image->transfer);
    b->curve_tone = (int)image->transfer;
    glint_ycc_init(&b->ycc, image->matrix, image->range);
    for (int code = 0; code < 256; code++)
        b->full_luma[code] = (uint8_t)q_clamp_sat(
            q_shift((int64_t)(code - b->ycc.black) * b->ycc.to_rgb_q16[0][0],
                    16),
            0, 255);
    if (!is_rgb(b->layout))
        for (b->low_code = 1;
             b->low_code < 256 && b->full_luma[b->low_code] < low;)
            b->low_code++;
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

/* Which bytes of a word are luma, or a sample that luma is made of. */
static uint64_t bytes_of_luma(const struct glint_layout *layout)
{
    const struct glint_layout_sample *s = &layout->sample[0];

    if (glint_layout_is_packed(layout))
        return UINT64_C(0x00ff00ff00ff00ff) << (8 * s->offset);
    if (layout->kind == GLINT_LAYOUT_RGB && s->step == 4)
        return UINT64_C(0x00ffffff00ffffff);
    return UINT64_MAX;
}

/* Marks the whole blocks of a row at PX. STEP: bytes of a pixel. */
static WHOLLY_INLINE int mark_blocks(struct glint_bright *b, const uint8_t *px,
                                     int step, int is_above_128)
{
    const uint64_t luma_bytes = bytes_of_luma(b->layout);
    const int n = b->width / BRIGHT_BLOCK, code = b->low_code;
    int any = 0;

    for (int i = 0; i < n; i++) {
        const uint64_t found =
            high_codes(px, BRIGHT_BLOCK / 8 * step, code, is_above_128);

        b->block[i] = (found & luma_bytes) != 0;
        any |= b->block[i];
        px += BRIGHT_BLOCK * step;
    }
    return any;
}

/* The same for each step apart, so that the loops inside have constant ends. */
static WHOLLY_INLINE int mark_row(struct glint_bright *b, const uint8_t *px,
                                  int is_above_128)
{
    switch (b->layout->sample[0].step) {
    case 1:
        return mark_blocks(b, px, 1, is_above_128);
    case 2:
        return mark_blocks(b, px, 2, is_above_128);
    case 3:
        return mark_blocks(b, px, 3, is_above_128);
    default:
        return mark_blocks(b, px, 4, is_above_128);
    }
}

static int mark_row_565(struct glint_bright *b, const uint8_t *px)
{
    int any = 0;

    for (int i = 0; i < b->width / BRIGHT_BLOCK; i++) {
        b->block[i] =
            high_565(px + i * 2 * BRIGHT_BLOCK, BRIGHT_BLOCK / 4, b->low) != 0;
        any |= b->block[i];
    }
    return any;
}

/* --------------------------------------------------------------------- luma */

static WHOLLY_INLINE int code_at(const struct glint_bright *b, int i, int x)
{
    const struct glint_bright_code *c = &b->code[i];

    return c->first[(x >> c->shift) * c->step];
}

static void find_codes(struct glint_bright *b, int y)
{
    const struct glint_layout *layout = b->layout;

    b->n_codes = layout->kind == GLINT_LAYOUT_GREY  ? 1
                 : layout->kind == GLINT_LAYOUT_565 ? 2
                                                    : 3;
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

/* Full-range luma of pixels X .. END - 1. That of RGB has the weights of
 * BT.709, in 256ths, whose sum is 256: no more than the largest of the three.
 */
static void read_luma(struct glint_bright *b, int x, int end)
{
    if (!is_rgb(b->layout)) {
        const uint8_t *px = b->code[0].first;
        const int step = b->code[0].step;

        for (; x < end; x++)
            b->luma[x] = b->full_luma[px[x * step]];
        return;
    }
    for (; x < end; x++) {
        int rgb[3];

        read_rgb(b, x, rgb);
        b->luma[x] =
            (uint8_t)((54 * rgb[0] + 183 * rgb[1] + 19 * rgb[2] + 128) >> 8);
    }
}

static int mark(struct glint_bright *b, const uint8_t *row)
{
    if (b->layout->kind == GLINT_LAYOUT_565)
        return mark_row_565(b, row);
    if (b->low_code <= 255)
        return b->low_code > 128 ? mark_row(b, row, 1) : mark_row(b, row, 0);
    for (int i = 0; i < b->width / BRIGHT_BLOCK; i++)
        b->block[i] = 0; /* no code makes such luma */
    return 0;
}

int glint_bright_scan(struct glint_bright *b, int y)
{
    const int n_blocks = (int)blocks_of(b->width);
    int any = mark(b, b->image->plane[0] + y * b->image->stride_bytes[0]);

    if (n_blocks * BRIGHT_BLOCK > b->width) /* the rest is looked at as it is */
        any = b->block[n_blocks - 1] = 1;
    find_codes(b, y);
    for (int i = 0; any && i < n_blocks; i++) {
        const int end = (i + 1) * BRIGHT_BLOCK;

        if (b->block[i])
            read_luma(b, i * BRIGHT_BLOCK, end < b->width ? end : b->width);
    }
    return any;
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
