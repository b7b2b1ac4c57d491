/* SPDX-License-Identifier: MIT */
#include "panel/row_pack.h"

#include <string.h>

/* ------------------------------------------------------------------- layout */

/* Returns the mask of FIELD in a word of N_BITS, or 0 if it does not fit
 * there. */
static uint64_t bits_of(const struct glint_pixel_field *field, int n_bits)
{
    if (field->length < 1 || field->offset < 0 || field->length > 16 ||
        field->offset > n_bits - field->length)
        return 0;
    return ((UINT64_C(1) << field->length) - 1) << field->offset;
}

bool glint_pixel_layout_is_valid(const struct glint_pixel_layout *layout)
{
    const struct glint_pixel_field *const field[] = {
        &layout->red, &layout->green, &layout->blue, &layout->transparency};
    uint64_t taken = 0;

    if (layout->bytes < 2 || layout->bytes > 4)
        return false;
    for (int i = 0; i < 4; i++) {
        const uint64_t bits = bits_of(field[i], 8 * layout->bytes);

        if (i == 3 && field[i]->length == 0)
            continue;
        if (!bits || bits & taken)
            return false;
        taken |= bits;
    }
    return true;
}

static bool is_whole_byte(const struct glint_pixel_field *field)
{
    return field->length == 8 && field->offset % 8 == 0;
}

static enum glint_pack_way way_of(const struct glint_pixel_layout *l)
{
    if (l->bytes > 2 && is_whole_byte(&l->red) && is_whole_byte(&l->green) &&
        is_whole_byte(&l->blue))
        return GLINT_PACK_BYTES;
    if (l->bytes == 2 && l->red.length <= 8 && l->green.length <= 8 &&
        l->blue.length <= 8)
        return GLINT_PACK_HALVES;
    return GLINT_PACK_TABLES;
}

/* ------------------------------------------------------------------ packing */

static bool is_low_first(void)
{
    const uint16_t one = 1;
    uint8_t first;

    memcpy(&first, &one, 1);
    return first == 1;
}

static void pack_fours(uint8_t *restrict dst, const uint8_t *a,
                       const uint8_t *b, const uint8_t *c, const uint8_t *d,
                       int n)
{
    for (int i = 0; i < n; i++) {
        dst[4 * i] = a[i];
        dst[4 * i + 1] = b[i];
        dst[4 * i + 2] = c[i];
        dst[4 * i + 3] = d[i];
    }
}

static void pack_threes(uint8_t *restrict dst, const uint8_t *a,
                        const uint8_t *b, const uint8_t *c, int n)
{
    for (int i = 0; i < n; i++) {
        dst[3 * i] = a[i];
        dst[3 * i + 1] = b[i];
        dst[3 * i + 2] = c[i];
    }
}

static void pack_bytes(const struct glint_row_pack *p, uint8_t *dst,
                       const uint8_t *const channel[3], int n)
{
    const uint8_t *byte[4];

    for (int i = 0; i < 4; i++)
        byte[i] = p->channel[i] < 3 ? channel[p->channel[i]] : p->rest;
    if (p->layout.bytes == 4)
        pack_fours(dst, byte[0], byte[1], byte[2], byte[3], n);
    else
        pack_threes(dst, byte[0], byte[1], byte[2], n);
}

/* Returns (CODE * MOST + THRESHOLD) / 255 without a division: exact for sums
 * below 65535, and none is above 255 * 255 + 254. */
static inline uint16_t fewer(uint8_t code, uint16_t most, uint8_t threshold)
{
    const uint16_t sum = (uint16_t)(code * most + threshold);

    return (uint16_t)((uint16_t)(sum + 1 + (sum >> 8)) >> 8);
}

static inline uint16_t at(uint16_t bits, int offset)
{
    return (uint16_t)(bits << offset);
}

static void pack_halves(const struct glint_row_pack *p, uint16_t *restrict dst,
                        const uint8_t *r, const uint8_t *g, const uint8_t *b,
                        const uint8_t *threshold, int n)
{
    const struct glint_pixel_layout *const l = &p->layout;
    const uint16_t most_r = (uint16_t)((1 << l->red.length) - 1),
                   most_g = (uint16_t)((1 << l->green.length) - 1),
                   most_b = (uint16_t)((1 << l->blue.length) - 1);
    const int to_r = l->red.offset, to_g = l->green.offset,
              to_b = l->blue.offset;
    const uint16_t opaque = (uint16_t)p->opaque;

    for (int i = 0; i < n; i++)
        dst[i] =
            (uint16_t)(opaque | at(fewer(r[i], most_r, threshold[i]), to_r) |
                       at(fewer(g[i], most_g, threshold[i]), to_g) |
                       at(fewer(b[i], most_b, threshold[i]), to_b));
}

static void pack_tables(const struct glint_row_pack *p, uint8_t *dst,
                        const uint8_t *const channel[3], int n)
{
    const int bytes = p->layout.bytes, skip = is_low_first() ? 0 : 4 - bytes;

    for (int i = 0; i < n; i++) {
        const uint32_t word = p->table[0][channel[0][i]] |
                              p->table[1][channel[1][i]] |
                              p->table[2][channel[2][i]] | p->opaque;
        uint8_t byte[4];

        memcpy(byte, &word, 4);
        memcpy(dst + (ptrdiff_t)i * bytes, byte + skip, (size_t)bytes);
    }
}

void glint_row_pack_write(const struct glint_row_pack *pack, void *dst,
                          const uint8_t *const channel[3], int y, int n)
{
    switch (pack->way) {
    case GLINT_PACK_BYTES:
        pack_bytes(pack, dst, channel, n);
        return;
    case GLINT_PACK_HALVES:
        pack_halves(pack, dst, channel[0], channel[1], channel[2],
                    pack->threshold[pack->dither ? y & 7 : 0], n);
        return;
    case GLINT_PACK_TABLES:
        pack_tables(pack, dst, channel, n);
        return;
    }
}

/* ------------------------------------------------------------------- tables */

/* Notes which channel each byte of a pixel holds, in the order of memory. */
static void place_bytes(struct glint_row_pack *p, uint8_t *mem, int width)
{
    const struct glint_pixel_layout *const l = &p->layout;
    int free_byte = 0 + 1 + 2 + 3;

    for (int i = 0; i < 4; i++)
        p->channel[i] = 3;
    for (int i = 0; i < 3; i++) {
        const struct glint_pixel_field *const field[] = {&l->red, &l->green,
                                                         &l->blue};
        const int byte = field[i]->offset / 8;

        p->channel[is_low_first() ? byte : l->bytes - 1 - byte] = i;
        free_byte -= byte;
    }
    p->rest = mem;
    memset(p->rest, (int)(p->opaque >> 8 * free_byte & 255), (size_t)width);
}

/* Returns the threshold of pixel X, Y (0 .. 7): one of (2 i + 1) * 255 / 128, i
 * = 0 .. 63, whose mean is 127. */
static int threshold_of(int x, int y)
{
    int bits = 0;

    for (int i = 0; i < 3; i++)
        bits = bits << 2 | (((x ^ y) >> i & 1) << 1) | (y >> i & 1);
    return (2 * bits + 1) * 255 / 128;
}

static void place_thresholds(struct glint_row_pack *p, uint8_t *mem, int width)
{
    for (int y = 0; y < 8; y++) {
        p->threshold[y] = mem + (ptrdiff_t)y * width;
        for (int x = 0; x < width; x++)
            p->threshold[y][x] =
                (uint8_t)(p->dither ? threshold_of(x & 7, y) : 127);
    }
}

static void fill_tables(struct glint_row_pack *p, void *mem)
{
    const struct glint_pixel_layout *const l = &p->layout;
    const struct glint_pixel_field *const field[] = {&l->red, &l->green,
                                                     &l->blue};

    for (int i = 0; i < 3; i++) {
        const uint32_t most = (UINT32_C(1) << field[i]->length) - 1;

        p->table[i] = (uint32_t *)mem + 256 * i;
        for (uint32_t code = 0; code < 256; code++)
            p->table[i][code] = (code * most + 127) / 255 << field[i]->offset;
    }
}

size_t glint_row_pack_bytes(int width)
{
    const size_t thresholds = 8 * (size_t)width;
    const size_t tables = 3 * 256 * sizeof(uint32_t);

    return thresholds > tables ? thresholds : tables;
}

void glint_row_pack_init(struct glint_row_pack *pack,
                         const struct glint_pixel_layout *layout, bool dither,
                         void *mem, int width)
{
    *pack = (struct glint_row_pack){
        .layout = *layout,
        .way = way_of(layout),
        .dither = dither,
        .opaque = (uint32_t)bits_of(&layout->transparency, 8 * layout->bytes),
    };
    switch (pack->way) {
    case GLINT_PACK_BYTES:
        place_bytes(pack, mem, width);
        return;
    case GLINT_PACK_HALVES:
        place_thresholds(pack, mem, width);
        return;
    case GLINT_PACK_TABLES:
        fill_tables(pack, mem);
        return;
    }
}
