/* SPDX-License-Identifier: MIT
 *
 * Finds bright pixels of a picture, row by row, and reads their light.
 *
 *    in   a picture in any format but GLINT_LINEAR_Q20; a min brightness
 *    out  brightness of the pixels in rows that may reach it; linear light
 *
 *      glint_bright_begin_picture(b, image);
 *      glint_bright_set_min_brightness(b, low);
 *      for each row y: if (glint_bright_scan_row(b, y))
 *              ... b->value in blocks with nonzero b->block,
 *              glint_bright_read_pixel_light(b, x) ...
 *
 * The brightness of a pixel is its largest channel, so that lamps of any colour
 * are found. Below BRIGHT_CLIPPED it is the full-range code of that channel.
 * Otherwise the largest channel is clipped, and brightness rises with luma, to
 * which the two other channels contribute. So the sun is brighter than the red
 * sky around it.
 *
 * Most of a night picture is dark. Dark blocks are found without computing
 * brightness: eight bytes at a time are compared with the min code that a
 * bright pixel must have, and blocks of BRIGHT_BLOCK pixels without such a byte
 * are skipped. For pictures in Y, Cb, Cr, a block's max luma and its min and
 * max chroma give an upper bound of its R, G and B. */
#ifndef GLINT_LAMPS_BRIGHT_H
#define GLINT_LAMPS_BRIGHT_H

#include "image/layout.h"
#include "image/curve.h"

struct glint_arena;

enum {
    BRIGHT_BLOCK = 32,    /* pixels per block */
    BRIGHT_CLIPPED = 250, /* min code of a channel that counts as clipped;
                             clipped channels carry no colour information */
    /* brightness of clipped pixels whose luma is 237 .. 251 */
    BRIGHT_WHITE = 254,
    BRIGHT_HOT = 255 /* brightness of clipped pixels of luma 252 or more */
};

/* The memory layout of one channel of a row. The channel is Y, Cb, Cr, R, G, B
 * or a byte of RGB565. */
struct glint_bright_code {
    const uint8_t *first;
    int step, shift; /* the code of pixel x is at first + (x >> shift) * step */
};

struct glint_bright {
    int width;
    uint8_t *value;  /* [width, rounded up to complete blocks]: brightness of
                        the row's pixels; set only in blocks that are listed in
                        marked */
    uint8_t *block;  /* [number of blocks]: max brightness in the block, or 0 if
                        it is below low */
    int32_t *marked; /* indices of the blocks with a nonzero value in BLOCK,
                        rising */
    int n_marked;

    /* Private. */
    const struct glint_image *image;
    const struct glint_layout *layout;
    /* channels of the row: Y Cb Cr, or R G B, or two bytes */
    struct glint_bright_code code[3];
    int n_codes;  /* number of channels in use; the remaining elements of CODE
                     repeat the first */
    int low;      /* min brightness of a bright pixel, 1 .. 255 */
    int low_code; /* min code (of grey, R, G or B) of a bright pixel; 256 if no
                     code is bright */
    int32_t low_sum_q16; /* min value of the largest channel of a bright pixel,
                            computed from Y, Cb and Cr; one code lower, to allow
                            for rounding */
    struct glint_curve *curve;
    int curve_tone; /* transfer function of the table CURVE; -1 if there is no
                       table yet */
    struct glint_ycc ycc;
    uint8_t *full_luma; /* [256]: full-range luma of each Y code */
    uint8_t *beyond;    /* [luma]: brightness of a clipped pixel */
};

/* Allocates the tables for rows of WIDTH pixels from ARENA. If ARENA only
 * measures, only adds up their size. */
void glint_bright_allocate(struct glint_bright *b, struct glint_arena *arena,
                           int width);
void glint_bright_init(struct glint_bright *b, int width);

/* Prepares for reading IMAGE, which must stay valid until the next call. */
void glint_bright_begin_picture(struct glint_bright *b,
                                const struct glint_image *image);

/* Sets the min brightness of bright pixels to LOW, 1 .. 255. Must be called
 * before the first scan. */
void glint_bright_set_min_brightness(struct glint_bright *b, int low);

/* Computes the brightness of row Y: sets b->block and b->value. Returns the max
 * brightness, or 0 if it is below low. */
int glint_bright_scan_row(struct glint_bright *b, int y);

/* Sets RGB to the linear light, 0 .. white, of pixel X in the row of the last
 * glint_bright_scan_row() or glint_bright_select_row(). */
void glint_bright_read_pixel_light(const struct glint_bright *b, int x,
                                   int32_t rgb_q20[3]);

/* Returns the linear light of the next higher code of channel C minus that of
 * the code at LIGHT, which is the resolution of the pixel format there; 0 for
 * formats with 8 bits. */
int32_t glint_bright_compute_code_step_q20(const struct glint_bright *b, int c,
                                           int32_t light_q20);

/* Selects row Y, without scanning it, for glint_bright_read_pixel_light(). */
void glint_bright_select_row(struct glint_bright *b, int y);

#endif
