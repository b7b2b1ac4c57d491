/* SPDX-License-Identifier: MIT
 *
 * What is bright in a picture, row by row, and the light there.
 *
 *   in   a picture of 8 bits in any format; a brightness
 *   out  brightness of the pixels of rows where it may reach that; linear light
 *
 *     glint_bright_begin(b, image);
 *     glint_bright_set_low(b, low);
 *     for each row y: if (glint_bright_scan(b, y))
 *             ... b->value where b->block says so, glint_bright_read(b, x) ...
 *
 * Brightness is the largest channel, so that a lamp of any colour counts: its
 * full-range code below BRIGHT_CLIPPED, where it says how bright a pixel is.
 * Above, the five values that are left say how much of the other channels is
 * clipped, too, by luma: a sun is more than the red sky around it.
 *
 * Most of a picture by night is dark, and that is seen without colour: eight
 * bytes at a time are compared with codes that a bright pixel must exceed, and
 * blocks of BRIGHT_BLOCK pixels without one are left out. Of Y, Cb, Cr the
 * largest luma of a block and the ends of its chroma bound its channels.
 */
#ifndef GLINT_LAMPS_BRIGHT_H
#define GLINT_LAMPS_BRIGHT_H

#include "image/layout.h"
#include "image/curve.h"

struct glint_arena;

enum {
    BRIGHT_BLOCK = 32,    /* pixels */
    BRIGHT_CLIPPED = 250, /* a channel here or above says nothing of colour */
    /* brightness that clipped pixels of luma 237 or more have, too */
    BRIGHT_WHITE = 254,
    BRIGHT_HOT = 255 /* the same for luma 252 or more */
};

/* Where a code of a row's pixels lies. */
struct glint_bright_code {
    const uint8_t *first;
    int step, shift; /* pixel x has that at first + (x >> shift) * step */
};

struct glint_bright {
    int width;
    uint8_t *value;  /* brightness of a row, where its block is marked, and room
                        for the rest of the last block */
    uint8_t *block;  /* [width / BRIGHT_BLOCK, rounded up]: the greatest
                        brightness in it, or 0: all is below low */
    int32_t *marked; /* the blocks that are not 0, from the left */
    int n_marked;

    /* Private. */
    const struct glint_image *image;
    const struct glint_layout *layout;
    /* codes of the row: Y Cb Cr, R G B, or two bytes */
    struct glint_bright_code code[3];
    int n_codes;         /* number of codes in use; the rest repeat the first */
    int low;             /* least brightness of a bright pixel, 1 .. 255 */
    int low_code;        /* the least byte, of grey or of R, G or B, of a bright
                            pixel; 256: no code is enough */
    int32_t low_sum_q16; /* the least largest channel of Y, Cb, Cr that a bright
                            pixel has, less a code for rounding */
    struct glint_curve *curve;
    int curve_tone; /* transfer function of curve; -1: there is none yet */
    struct glint_ycc ycc;
    uint8_t *full_luma; /* full-range luma of each Y code */
    uint8_t *beyond;    /* brightness of a clipped pixel, by luma */
};

/* Takes what rows of WIDTH pixels need from ARENA, which may only measure. */
void glint_bright_carve(struct glint_bright *b, struct glint_arena *arena,
                        int width);
void glint_bright_init(struct glint_bright *b, int width);

/* Prepares for IMAGE, which is kept until the next one. */
void glint_bright_begin(struct glint_bright *b,
                        const struct glint_image *image);

/* LOW is 1 .. 255; before the first scan. */
void glint_bright_set_low(struct glint_bright *b, int low);

/* Sets block and value for row Y. Returns 0 if all of it is below low. */
int glint_bright_scan(struct glint_bright *b, int y);

/* Sets each block to whether it may have a pixel of low or above, but for one
 * that the width cuts off. Returns 0 if none may. Part of the scan. */
int glint_bright_mark(struct glint_bright *b);

/* The linear light of pixel X of the row scanned last, 0 .. white. */
void glint_bright_read(const struct glint_bright *b, int x, int32_t rgb_q20[3]);

/* How much more than LIGHT the next code of channel C is, 0 .. white, where
 * codes have fewer than 8 bits; else 0. */
int32_t glint_bright_step_q20(const struct glint_bright *b, int c,
                              int32_t light_q20);

/* The first of pixels X + 1 .. END - 1 that is not as X is, or END: lamps and
 * skies are white in many pixels on end. */
int glint_bright_same(const struct glint_bright *b, int x, int end);

/* Makes row Y the one that read and value_at are of, without a scan. */
void glint_bright_go(struct glint_bright *b, int y);

/* Brightness of pixel X of that row. */
int glint_bright_value_at(const struct glint_bright *b, int x);

#endif
