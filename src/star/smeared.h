/* SPDX-License-Identifier: MIT
 *
 * Diffraction by dust, scratches, smudges and masks in the stop: light around a
 * lamp, tabulated in nested squares. Each square is twice as wide as the
 * previous one and has the same number of steps. A program links the drawing
 * code only if it refers to glint_star_add_smear_row.
 */
#ifndef GLINT_STAR_SMEARED_H
#define GLINT_STAR_SMEARED_H

#include <stdint.h>

#include "glint/real.h"

enum {
    GLINT_STAR_SMEAR_RINGS = 9,
    GLINT_STAR_SMEAR_HALF = 32, /* steps from the centre to a side */
    /* pixels from the centre to a side of the first square */
    GLINT_STAR_SMEAR_PX = 8
};

struct glint_star;
struct glint_star_lamp;
struct glint_star_stretch;

/* Adds the light of LAMP to ROW. */
typedef void glint_star_part_fn(const struct glint_star *star,
                                const struct glint_star_lamp *lamp,
                                struct glint_star_stretch *row);
glint_star_part_fn glint_star_add_smear_row;

struct glint_star_smear {
    glint_star_part_fn *part; /* glint_star_add_smear_row() */
    struct glint_real step[GLINT_STAR_SMEAR_RINGS]; /* light that the table
                                                       value 1 stands for */
    /* [ring][row][column][channel] for y >= 0. The half with y < 0 is its
     * point reflection through the centre. */
    uint16_t light[GLINT_STAR_SMEAR_RINGS][GLINT_STAR_SMEAR_HALF + 1]
                  [2 * GLINT_STAR_SMEAR_HALF + 1][3];
};

#endif
