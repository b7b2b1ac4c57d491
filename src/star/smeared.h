/* SPDX-License-Identifier: MIT
 *
 * The light that dust, scratches, smudges and masks in the stop diffract around
 * a lamp: a table in nested squares around it, each twice as wide as the
 * previous square, with the same number of steps. Its drawing code is linked
 * only by programs that name glint_star_smear_part. */
#ifndef GLINT_STAR_SMEARED_H
#define GLINT_STAR_SMEARED_H

#include <stdint.h>

#include "glint/real.h"

enum {
    GLINT_STAR_SMEAR_RINGS = 9,
    GLINT_STAR_SMEAR_HALF = 32, /* steps from the middle to a side */
    GLINT_STAR_SMEAR_PX = 8     /* pixels from the middle to a side of the first
                                   square */
};

struct glint_star;
struct glint_star_lamp;
struct glint_star_stretch;

/* Adds the light of LAMP to ROW. */
typedef void glint_star_part_fn(const struct glint_star *star,
                                const struct glint_star_lamp *lamp,
                                struct glint_star_stretch *row);
glint_star_part_fn glint_star_smear_part;

struct glint_star_smear {
    glint_star_part_fn *part;                       /* glint_star_smear_part */
    struct glint_real step[GLINT_STAR_SMEAR_RINGS]; /* light that the value 1
                                                       stands for */
    /* [ring][row][column][channel], the half with y from 0 on; the other half
     * is its mirror image about the middle. */
    uint16_t light[GLINT_STAR_SMEAR_RINGS][GLINT_STAR_SMEAR_HALF + 1]
                  [2 * GLINT_STAR_SMEAR_HALF + 1][3];
};

#endif
