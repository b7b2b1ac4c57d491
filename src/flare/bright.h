/* SPDX-License-Identifier: MIT
 *
 * What is bright in a picture, row by row, and the light there.
 *
 *   in   a picture of 8 bits in any format; a luma code
 *   out  luma of the rows where it may reach that code; linear light of pixels
 *
 *     glint_bright_begin(b, image, low);
 *     for each row y: if (glint_bright_scan(b, y))
 *             ... b->luma where b->block says so, glint_bright_read() ...
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

/* Linear light of a pixel, 0 .. white. In lamps and skies it is often that of
 * the one before. */
struct glint_bright_pixel {
    uint32_t codes; /* that it was made from */
    int32_t rgb_q20[3];
};

struct glint_bright {
    int width;
    uint8_t *luma;  /* full-range codes of a row, where its block is marked */
    uint8_t *block; /* [width / BRIGHT_BLOCK, rounded up]: 0: all dark */

    /* Private. */
    const struct glint_image *image;
    const struct glint_layout *layout;
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

/* The light of pixel (X, Y). P is one read before from the same picture, or
 * glint_bright_none(). Returns 0 if it is the same. */
int glint_bright_read(const struct glint_bright *b, int x, int y,
                      struct glint_bright_pixel *p);

static inline struct glint_bright_pixel glint_bright_none(void)
{
    return (struct glint_bright_pixel){.codes = UINT32_MAX};
}

#endif
