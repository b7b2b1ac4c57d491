/* SPDX-License-Identifier: MIT
 *
 * What is bright in a picture, row by row, and the light there.
 *
 *   in   a picture of 8 bits in any format; a luma code
 *   out  luma of the rows where it may reach that code; linear light of pixels
 *
 *     glint_bright_begin(b, image, low);
 *     for each row y: if (glint_bright_scan(b, y))
 *             ... b->luma where b->block says so, glint_bright_read(b, x) ...
 *
 * Most of a picture by night is dark, and that is seen without luma: eight
 * bytes at a time are compared with the least code that luma can come from, and
 * blocks of BRIGHT_BLOCK pixels without one are left out.
 */
#ifndef GLINT_FLARE_BRIGHT_H
#define GLINT_FLARE_BRIGHT_H

#include "base/layout.h"
#include "tile/curve.h"

struct glint_arena;

enum { BRIGHT_BLOCK = 32 }; /* pixels */

/* Where a code of a row's pixels lies. */
struct glint_bright_code {
    const uint8_t *first;
    int step, shift; /* pixel x has that at first + (x >> shift) * step */
};

struct glint_bright {
    int width;
    uint8_t *luma;  /* full-range codes of a row, where its block is marked */
    uint8_t *block; /* [width / BRIGHT_BLOCK, rounded up]: 0: all dark */

    /* Private. */
    const struct glint_image *image;
    const struct glint_layout *layout;
    struct glint_bright_code code[3]; /* of the row; Y Cb Cr, R G B, or two
                                         bytes */
    int n_codes;
    int low;      /* luma code */
    int low_code; /* the least byte of a bright pixel's brightest sample */
    struct glint_curve *curve;
    int curve_tone; /* that curve is of; -1: none yet */
    struct glint_ycc ycc;
    uint8_t full_luma[256]; /* of Y codes */
};

/* Takes what rows of WIDTH pixels need from ARENA, which may only measure. */
void glint_bright_carve(struct glint_bright *b, struct glint_arena *arena,
                        int width);
void glint_bright_init(struct glint_bright *b, int width);

/* Prepares for IMAGE, which is kept until the next one. LOW is 1 .. 255. */
void glint_bright_begin(struct glint_bright *b, const struct glint_image *image,
                        int low);

/* Sets block and luma for row Y. Returns 0 if all of it is dark. */
int glint_bright_scan(struct glint_bright *b, int y);

/* The linear light of pixel X of the row scanned last, 0 .. white. */
void glint_bright_read(const struct glint_bright *b, int x, int32_t rgb_q20[3]);

/* The first of pixels X + 1 .. END - 1 that is not as X is, or END: lamps and
 * skies are white in many pixels on end. */
int glint_bright_same(const struct glint_bright *b, int x, int end);

#endif
