/* SPDX-License-Identifier: MIT
 *
 * panel/panel.h - draws pictures on a panel of packed true-colour pixels.
 *
 *     glint_panel_open(&panel, &cfg, &error); allocates memory
 *     glint_panel_clear(&panel, mem, stride); once: black everywhere
 *     glint_panel_draw(&panel, &image, mem, stride); each frame
 *     glint_panel_close(&panel);
 *
 * A picture of another size than the panel is scaled to fit at its aspect
 * ratio, by nearest-neighbour sampling; or it is centred unscaled and cropped.
 * Drawing does not write to the panel outside the picture.
 *
 * Each row is computed in cached memory and then copied to the panel. The
 * panel's memory may be write-combining (slow to read): it is never read, and
 * is written in order of addresses. If several panel rows show the same row of
 * the picture, this row is computed once.
 *
 * Packed pixels of any true-colour layout (glint_row_pack):
 *
 *     in R', G', B' bytes, an array each
 *     out words of 16, 24 or 32 bits, in the order of the machine's bytes,
 *          as Linux describes framebuffers: offset and length of each channel
 *
 * A code c, 0 .. 255, is written to a channel of n bits as (c (2^n - 1) + 127)
 * / 255, which is the nearest value. For 16-bit pixels this is the inverse of
 * glint_row_rgb_read(). A transparency channel is set to opaque; unused bits
 * are 0.
 *
 * glint_row_rgb reads part of a row as R', G', B' bytes from a picture of any
 * format except GLINT_LINEAR_Q20. It computes R' = Y' ky + Cr k and so on in
 * integers, where ky and k are constants of the colour matrix with 13 fraction
 * bits (_q13). A sum is rounded once to the nearest code, ties up, then clamped
 * to 0 .. 255. The result differs from exact arithmetic by at most 1; it is
 * equal for 99.6 % of codes and for all greys. Chroma samples of subsampled
 * formats are repeated, as in src/image/codes.c. If nothing has to be computed,
 * channels may point into the picture itself. */
#ifndef GLINT_PLATFORM_PANEL_PANEL_H
#define GLINT_PLATFORM_PANEL_PANEL_H

#include "source_sink.h"

struct glint_row_rgb {
    const uint8_t *channel[3]; /* R', G', B' of the pixels that were read
                                  last */

    /* Private members. */
    uint8_t *rgb[3], *luma, *cb, *cr; /* rows in the caller's memory */
};

/* Position and length of a channel in the word of a pixel, bits; length 0: the
 * channel does not exist. */
struct glint_pixel_field {
    int offset, length;
};

struct glint_pixel_layout {
    int bytes; /* number of bytes of a pixel: 2, 3 or 4 */
    struct glint_pixel_field red, green, blue, transparency;
};

enum glint_pack_way { GLINT_PACK_BYTES, GLINT_PACK_HALVES, GLINT_PACK_TABLES };

struct glint_row_pack {
    struct glint_pixel_layout layout;

    /* Private members. */
    enum glint_pack_way way;
    /* for the method BYTES: index of the channel in each byte of a pixel; 3:
     * the byte holds no colour */
    int channel[4];
    /* for the method BYTES: a row of values for the byte that holds no
     * colour */
    uint8_t *rest;
    /* for the method TABLES: bits in the word of a pixel for each code of each
     * channel */
    uint32_t *table[3];
    uint32_t opaque;
};

enum glint_panel_fit { GLINT_PANEL_FIT, GLINT_PANEL_CENTRE };

struct glint_panel_config {
    /* Sizes of panel and picture, 1 .. GLINT_PANEL_SIDE. */
    int width, height;
    struct glint_pixel_layout layout;
    int image_width, image_height;
    enum glint_panel_fit fit;
};

struct glint_panel {
    struct glint_panel_config cfg;
    /* shown: area of the panel in which the picture is drawn; seen: part of the
     * picture that is drawn there */
    struct glint_panel_area {
        int x, y, width, height;
    } shown, seen;

    /* Private members. */
    struct glint_row_rgb rgb;
    struct glint_row_pack pack;
    /* Picture column for each column of the shown area; NULL: not scaled. */
    uint16_t *from_x;
    uint8_t *line;   /* a row of the picture area that is shown, packed */
    uint8_t *scaled; /* the same row, scaled to the panel */
    void *mem;       /* memory of all private arrays; NULL: closed */
};

/* Splits N pairs of bytes: the first byte of each pair is copied to A, the
 * second to B. Arrays must not overlap. */
void glint_split_byte_pairs(uint8_t *restrict a, uint8_t *restrict b,
                            const uint8_t *restrict from, int n);

/* Splits N pairs of pixels of FORMAT, GLINT_YUYV or GLINT_UYVY, into rows of
 * luma, Cb and Cr; a pair has two samples of luma and one each of Cb and Cr. */
void glint_split_packed_pixels(enum glint_pixel_format format, uint8_t *luma,
                               uint8_t *cb, uint8_t *cr, const uint8_t *from,
                               int n);

/* Returns the bytes of memory that glint_row_rgb_init() needs for WIDTH. */
size_t glint_row_rgb_bytes(int width);

/* Prepares ROW for up to WIDTH pixels. MEM has glint_row_rgb_bytes(width) bytes
 * and must outlive ROW. */
void glint_row_rgb_init(struct glint_row_rgb *row, void *mem, int width);

/* Points row->channel to R', G', B' of pixels X .. X + N - 1 in row Y of IMAGE.
 * X must be even. */
void glint_row_rgb_read(struct glint_row_rgb *row,
                        const struct glint_image *image, int x, int y, int n);

/* Returns whether LAYOUT is supported: 2 to 4 bytes, fields of at most 16 bits
 * that fit and do not overlap, and all three colours. */
bool glint_pixel_layout_is_valid(const struct glint_pixel_layout *layout);

/* Returns the bytes of memory that glint_row_pack_init() needs for WIDTH. */
size_t glint_row_pack_bytes(int width);

/* Prepares PACK for rows of up to WIDTH pixels in LAYOUT, which must be valid.
 * MEM has glint_row_pack_bytes(width) bytes, must be aligned as by malloc and
 * outlive PACK. */
void glint_row_pack_init(struct glint_row_pack *pack,
                         const struct glint_pixel_layout *layout, void *mem,
                         int width);

/* Packs N pixels of CHANNEL (R', G', B') to DST, aligned to 4 bytes. */
void glint_row_pack_write(const struct glint_row_pack *pack, void *dst,
                          const uint8_t *const channel[3], int n);

/* Prepares PANEL for CFG and allocates all memory. Returns GLINT_E_UNSUPPORTED
 * if the layout is not valid or a size is out of range, or GLINT_E_MEMORY. On
 * failure PANEL is closed. */
enum glint_status glint_panel_open(struct glint_panel *panel,
                                   const struct glint_panel_config *cfg,
                                   struct glint_error *error);

/* Opens PANEL for CFG and pictures of IMAGE's size, unless it is open for this
 * size. The picture size of CFG is ignored. Sets *IS_NEW to whether PANEL was
 * opened, so that the borders around the picture must be cleared. */
enum glint_status glint_panel_open_for_image(
    struct glint_panel *panel, const struct glint_panel_config *cfg,
    const struct glint_image *image, bool *is_new, struct glint_error *error);

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
