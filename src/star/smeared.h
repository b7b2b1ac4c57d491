/* SPDX-License-Identifier: MIT
 *
 * Table of the smear: the light that dust, scratches, smudges and masks in the
 * stop diffract around a lamp. It consists of nested squares. Each square is
 * twice as wide as the previous one and has the same number of table steps per
 * side. A program links the drawing code only if it refers to
 * glint_star_add_smear_row. */
#ifndef GLINT_STAR_SMEARED_H
#define GLINT_STAR_SMEARED_H

#include <stdint.h>

#include "glint/real.h"

enum {
    GLINT_STAR_SMEAR_RINGS = 9,
    GLINT_STAR_SMEAR_HALF = 32, /* number of table steps from the centre of a
                                   square to its side */
    /* distance from the centre to a side of the first square, pixels */
    GLINT_STAR_SMEAR_PX = 8
};

struct glint_star;
struct glint_star_lamp;
struct glint_star_stretch;

/* Function that adds one component of the starburst of LAMP (lines, halo, core
 * or smear) to the pixels of ROW. */
typedef void glint_star_part_fn(const struct glint_star *star,
                                const struct glint_star_lamp *lamp,
                                struct glint_star_stretch *row);
glint_star_part_fn glint_star_add_smear_row;

struct glint_star_smear {
    glint_star_part_fn *part; /* draws the smear: glint_star_add_smear_row() */
    /* for each square, light per unit of the table */
    struct glint_real step[GLINT_STAR_SMEAR_RINGS];
    /* Table values, [square][row][column][channel], rows for y >= 0 only. The
     * other half is the point reflection of this half through the centre. */
    uint16_t light[GLINT_STAR_SMEAR_RINGS][GLINT_STAR_SMEAR_HALF + 1]
                  [2 * GLINT_STAR_SMEAR_HALF + 1][3];
};

#endif
