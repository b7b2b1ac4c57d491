/* SPDX-License-Identifier: MIT
 *
 * Measures the brightness histogram of a picture, and its white level.
 *
 *    in   a picture for which glint_bright_begin_picture() was called
 *    out  number of pixels of a grid that reach each brightness; codes
 *
 * White is the brightness from which objects may be lamps. In an underexposed
 * picture it may be far below the max code. If at least one pixel in
 * 2^WHITE_PART_LOG2 is clipped, white is the code at which codes clip.
 * Otherwise white is the code that this fraction of pixels reaches. It is at
 * least WHITE_LEAST, so that noise is not mistaken for lamps. */
#ifndef GLINT_LAMPS_WHITE_H
#define GLINT_LAMPS_WHITE_H

#include "lamps/bright.h"

enum {
    WHITE_GRID_X = 160, /* max number of columns of the sampling grid */
    WHITE_GRID_Y = 96,
    WHITE_PART_LOG2 = 11,
    WHITE_LEAST = 64
};

struct glint_white {
    int n;                 /* number of pixels sampled */
    int32_t at_least[257]; /* [i]: number of sampled pixels of brightness i or
                              more */
    int32_t light_q20;     /* linear light of white */
};

/* Measures the brightness of the picture of HEIGHT rows that BRIGHT reads. */
void glint_white_measure_picture(struct glint_white *white,
                                 struct glint_bright *bright, int height);

/* Returns the min code, 1 .. BRIGHT_CLIPPED, whose linear light is at least
 * LIGHT times 2^(EV / 256). EV must not be above 0. */
int glint_white_find_code(const struct glint_bright *bright, int32_t light_q20,
                          int32_t ev_q8);

/* Returns the min brightness that no more than 1 / 2^PART_LOG2 of the sampled
 * pixels reach. */
int glint_white_find_top_quantile(const struct glint_white *white,
                                  int part_log2);

/* Returns the fraction of pixels whose brightness is VALUE or more. */
int32_t glint_white_compute_fraction_q15(const struct glint_white *white,
                                         int value);

/* Returns log2 of LIGHT / white in 1/256 stops, with an error of at most 1/256
 * stop; 0 counts as light of 2^-20. */
int32_t glint_compute_light_log2_q8(int64_t light_q20);

#endif
