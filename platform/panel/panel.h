/* SPDX-License-Identifier: MIT
 *
 * panel/panel.h - pictures for a panel of packed true-colour pixels.
 *
 *     glint_panel_open(&panel, &cfg, &error);         takes all memory
 *     glint_panel_clear(&panel, mem, stride);         once: black everywhere
 *     glint_panel_draw(&panel, &image, mem, stride);  each frame
 *     glint_panel_close(&panel);
 *
 * A picture of another size than the panel is scaled to fit, in its shape, by
 * taking for each pixel of the panel the nearest one of the picture; or it is
 * centred as it is, and its sides are cut off where they do not fit. Draw does
 * not touch the parts of the panel off-screen.
 *
 * Each row is made in cached memory and then copied, so the panel's own memory
 * is only written, and in order: it may be write-combining. Rows that show the
 * same row of the picture are made once.
 *
 * Packed pixels of any true-colour layout (glint_row_pack):
 *
 *     in   R', G', B' bytes, an array each
 *     out  words of 16, 24 or 32 bits, in the order of the machine's bytes,
 *          as Linux describes framebuffers: offset and length of each channel
 *
 * A channel of n bits gets code c as (c (2^n - 1) + 127) / 255: the nearest,
 * and for 16 bits the inverse of what glint_row_rgb reads. Transparency is
 * written opaque; unused bits are zero. With dithering the 127 becomes one of
 * 64 thresholds by the place of the pixel (8 x 8, the same in all channels):
 * bands of smooth gradients turn to grain.
 *
 * A stretch of a row as R', G', B' bytes (glint_row_rgb), of a picture of 8-bit
 * codes, any format but GLINT_LINEAR_Q20: R' = Y' ky + Cr k and so on, in
 * integers. Constants have 13 fraction bits (_q13), one rounding to the nearest
 * code, ties up, then a clamp to 0 .. 255. Over all codes that is within 1 of
 * the same sum in exact arithmetic, equal to it for 99.6 % of them and for all
 * greys. Chroma of subsampled formats is repeated, as where flares are drawn
 * (src/image/codes.c). Channels may point into the picture itself where nothing
 * has to be computed.
 */
#ifndef GLINT_PLATFORM_PANEL_PANEL_H
#define GLINT_PLATFORM_PANEL_PANEL_H

#include "source_sink.h"

struct glint_row_rgb {
    const uint8_t *channel[3]; /* R', G', B' of the last read */

    /* Private. */
    uint8_t *rgb[3], *luma, *cb, *cr; /* rows in the caller's memory */
};

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

enum glint_panel_fit { GLINT_PANEL_FIT, GLINT_PANEL_CENTRE };

struct glint_panel_config {
    /* Sizes of panel and picture, 1 .. GLINT_PANEL_SIDE. */
    int width, height;
    struct glint_pixel_layout layout;
    int image_width, image_height;
    enum glint_panel_fit fit;
    bool dither; /* pixels of 16 bits are dithered */
};

struct glint_panel {
    struct glint_panel_config cfg;
    /* Shown: the area of the panel that the picture covers. Seen: the part of
     * the picture that is shown there. */
    struct glint_panel_area {
        int x, y, width, height;
    } shown, seen;

    /* Private. */
    struct glint_row_rgb rgb;
    struct glint_row_pack pack;
    uint16_t *from_x; /* pixel of the seen part for each pixel shown; NULL: the
                         same */
    uint8_t *line;    /* a row of the seen part, packed */
    uint8_t *scaled;  /* a row as it is shown, packed */
    void *mem;        /* memory of all private arrays; NULL: closed */
};

/* Splits N pairs of bytes. Arrays do not overlap. */
void glint_split_pairs(uint8_t *restrict a, uint8_t *restrict b,
                       const uint8_t *restrict from, int n);

/* Splits N pairs of pixels of FORMAT, GLINT_YUYV or GLINT_UYVY, each with two
 * samples of luma and one of Cb and Cr. */
void glint_split_packed(enum glint_pixel_format format, uint8_t *luma,
                        uint8_t *cb, uint8_t *cr, const uint8_t *from, int n);

/* Returns the bytes of memory that rows of up to WIDTH pixels take. */
size_t glint_row_rgb_bytes(int width);

/* Prepares ROW for up to WIDTH pixels. It keeps using
 * MEM[glint_row_rgb_bytes(width)]. */
void glint_row_rgb_init(struct glint_row_rgb *row, void *mem, int width);

/* Sets row->channel to the pixels X .. X + N - 1 of row Y of IMAGE. X is
 * even. */
void glint_row_rgb_read(struct glint_row_rgb *row,
                        const struct glint_image *image, int x, int y, int n);

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

/* Prepares PANEL for CFG and takes all memory. GLINT_E_UNSUPPORTED: a layout
 * that is not valid, or a size out of range. GLINT_E_MEMORY. On failure PANEL
 * is closed. */
enum glint_status glint_panel_open(struct glint_panel *panel,
                                   const struct glint_panel_config *cfg,
                                   struct glint_error *error);

/* Fills the panel at MEM, whose rows are STRIDE bytes apart, with opaque
 * black. */
void glint_panel_clear(struct glint_panel *panel, uint8_t *mem,
                       ptrdiff_t stride);

/* Draws IMAGE, of the configured size and any 8-bit format, to the panel at
 * MEM. */
void glint_panel_draw(struct glint_panel *panel,
                      const struct glint_image *image, uint8_t *mem,
                      ptrdiff_t stride);

/* Frees the memory of PANEL, unless it is closed already. */
void glint_panel_close(struct glint_panel *panel);

#endif
