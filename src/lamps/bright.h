/* SPDX-License-Identifier: MIT
 *
 * Finds bright pixels of a picture, row by row, and reads their light.
 *
 *    in   a picture in any format but GLINT_LINEAR_Q20; a min brightness
 *    out  brightness of the pixels in rows that may reach it; linear light
 *
 *      glint_bright_begin(b, image);
 *      glint_bright_set_low(b, low);
 *      for each row y: if (glint_bright_scan(b, y))
 *              ... b->value in blocks with nonzero b->block,
 *              glint_bright_read(b, x) ...
 *
 * Brightness is the largest channel, so that lamps of any colour are found.
 * Below BRIGHT_CLIPPED it is that channel's full-range code. From there on the
 * largest channel is clipped, and brightness rises with luma, which shows how
 * far the other channels are clipped, too: the sun is brighter than the red sky
 * around it.
 *
 * Most of a night picture is dark, which can be tested without computing
 * brightness: eight bytes at a time are compared with the min codes of a bright
 * pixel, and blocks of BRIGHT_BLOCK pixels without such a byte are skipped. In
 * Y, Cb, Cr the max luma of a block and the extremes of its chroma bound its
 * channels.
 */
#ifndef GLINT_LAMPS_BRIGHT_H
#define GLINT_LAMPS_BRIGHT_H

#include "image/layout.h"
#include "image/curve.h"

struct glint_arena;

enum {
    BRIGHT_BLOCK = 32,    /* pixels per block */
    BRIGHT_CLIPPED = 250, /* channels of this code or more are clipped and have
                             no colour information */
    /* brightness of clipped pixels whose luma is 237 .. 251 */
    BRIGHT_WHITE = 254,
    BRIGHT_HOT = 255 /* brightness of clipped pixels of luma 252 or more */
};

/* Addresses of one code (Y, Cb, Cr, R, G, B or a byte of RGB565) of the
 * pixels of a row. */
struct glint_bright_code {
    const uint8_t *first;
    int step, shift; /* the code of pixel x is at first + (x >> shift) * step */
};

struct glint_bright {
    int width;
    uint8_t *value;  /* brightness of the row's pixels, valid in marked blocks;
                        padded to whole blocks */
    uint8_t *block;  /* [width / BRIGHT_BLOCK, rounded up]: max brightness in a
                        block, or 0 if it is below low */
    int32_t *marked; /* indices of the blocks with nonzero block[i], rising */
    int n_marked;

    /* Private. */
    const struct glint_image *image;
    const struct glint_layout *layout;
    /* codes of the row: Y Cb Cr, or R G B, or two bytes */
    struct glint_bright_code code[3];
    int n_codes;  /* number of codes in use; the others repeat the first */
    int low;      /* min brightness of a bright pixel, 1 .. 255 */
    int low_code; /* min code (grey, R, G or B) of a bright pixel; 256 if no
                     code is bright */
    int32_t low_sum_q16; /* min, over bright pixels, of the max channel computed
                            from Y, Cb, Cr, minus one code for rounding */
    struct glint_curve *curve;
    int curve_tone; /* transfer function of curve, or -1 if curve is not set */
    struct glint_ycc ycc;
    uint8_t *full_luma; /* table: full-range luma of each Y code */
    uint8_t *beyond;    /* table: brightness of a clipped pixel by luma */
};

/* Allocates the tables for rows of WIDTH pixels from ARENA, or only measures
 * them. */
void glint_bright_carve(struct glint_bright *b, struct glint_arena *arena,
                        int width);
void glint_bright_init(struct glint_bright *b, int width);

/* Prepares for reading IMAGE, which must stay valid until the next call. */
void glint_bright_begin(struct glint_bright *b,
                        const struct glint_image *image);

/* Sets the min brightness of bright pixels to LOW, 1 .. 255. Must be called
 * before the first scan. */
void glint_bright_set_low(struct glint_bright *b, int low);

/* Sets block and value for row Y. Returns the max brightness, or 0 if it is
 * below low. */
int glint_bright_scan(struct glint_bright *b, int y);

/* Sets RGB to the linear light, 0 .. white, of pixel X in the row of the last
 * glint_bright_scan() or glint_bright_seek_row(). */
void glint_bright_read(const struct glint_bright *b, int x, int32_t rgb_q20[3]);

/* Returns the step in linear light from the code of LIGHT to the next code of
 * channel C if codes have fewer than 8 bits, else 0. */
int32_t glint_bright_step_q20(const struct glint_bright *b, int c,
                              int32_t light_q20);

/* Makes Y the row that glint_bright_read() reads, without scanning it. */
void glint_bright_seek_row(struct glint_bright *b, int y);

#endif
