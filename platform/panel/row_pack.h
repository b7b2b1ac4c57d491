/* SPDX-License-Identifier: MIT
 *
 * panel/row_pack.h - packed pixels of any true-colour layout.
 *
 *     in   R', G', B' bytes, an array each (panel/row_rgb.h)
 *     out  words of 16, 24 or 32 bits, in the order of the machine's bytes,
 *          as Linux describes framebuffers: offset and length of each channel
 *
 * A channel of n bits gets code c as (c (2^n - 1) + 127) / 255: the nearest,
 * and for 16 bits the inverse of what panel/row_rgb.h reads. Transparency is
 * written opaque; unused bits are zero.
 *
 * With dithering the 127 becomes one of 64 thresholds by the place of the pixel
 * (8 x 8, the same in all channels): bands of smooth gradients turn to grain.
 */
#ifndef GLINT_PLATFORM_PANEL_ROW_PACK_H
#define GLINT_PLATFORM_PANEL_ROW_PACK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bits of a pixel's word that hold a channel; length 0: it has none. */
struct glint_pixel_field {
    int offset, length;
};

struct glint_pixel_layout {
    int bytes; /* bytes of a pixel: 2, 3 or 4 */
    struct glint_pixel_field red, green, blue, transparency;
};

enum glint_pack_way { GLINT_PACK_BYTES, GLINT_PACK_HALVES, GLINT_PACK_TABLES };

struct glint_row_pack {
    struct glint_pixel_layout layout;

    /* Private. */
    enum glint_pack_way way;
    bool dither;
    int channel[4]; /* BYTES: number of the channel in each byte of a pixel; 3:
                       none */
    uint8_t *rest;  /* BYTES: a row of the byte that holds no channel */
    uint8_t *threshold[8]; /* HALVES: thresholds of a row of pixels, for each
                              row modulo 8 */
    uint32_t *table[3];    /* TABLES: bits of each colour, by code */
    uint32_t opaque;
};

/* Returns whether LAYOUT can be written: whole bytes, fields that fit and do
 * not overlap, and all three colours. */
bool glint_pixel_layout_is_valid(const struct glint_pixel_layout *layout);

/* Returns the bytes of memory that rows of up to WIDTH pixels take. */
size_t glint_row_pack_bytes(int width);

/* Prepares PACK for rows of up to WIDTH pixels in LAYOUT, which is valid. PACK
 * keeps using MEM[glint_row_pack_bytes(width)], aligned as by malloc. DITHER
 * has an effect with pixels of 16 bits only. */
void glint_row_pack_init(struct glint_row_pack *pack,
                         const struct glint_pixel_layout *layout, bool dither,
                         void *mem, int width);

/* Packs N pixels of CHANNEL (R', G', B') into DST, aligned to 4 bytes. Y is
 * their row, for dithering. */
void glint_row_pack_write(const struct glint_row_pack *pack, void *dst,
                          const uint8_t *const channel[3], int y, int n);

#endif
