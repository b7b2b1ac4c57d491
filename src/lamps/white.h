/* SPDX-License-Identifier: MIT
 *
 * Measures the brightness histogram of a picture, and its white.
 *
 *    in   a picture for which glint_bright_begin() was called
 *    out  number of pixels of a grid that reach each brightness; codes
 *
 * In an underexposed picture a lamp may be far darker than full white. So white
 * is the code at which codes clip if at least one pixel in 2^WHITE_PART_LOG2
 * clips. Else it is the code that this fraction of pixels reaches, but at least
 * WHITE_LEAST, so that noise is not mistaken for lamps.
 */
#ifndef GLINT_LAMPS_WHITE_H
#define GLINT_LAMPS_WHITE_H

#include "lamps/bright.h"

enum {
    WHITE_GRID_X = 160, /* max columns of the grid */
    WHITE_GRID_Y = 96,
    WHITE_PART_LOG2 = 11,
    WHITE_LEAST = 64
};

struct glint_white {
    int n;                 /* number of pixels read */
    int32_t at_least[257]; /* [i]: number of pixels read with brightness i or
                              more */
    int32_t light_q20;     /* linear light of white */
};

/* Measures the picture given to glint_bright_begin(), of HEIGHT rows. */
void glint_white_measure(struct glint_white *white, struct glint_bright *bright,
                         int height);

/* Returns the min code, 1 .. BRIGHT_CLIPPED, whose light is at least LIGHT
 * times 2^(EV / 256). EV must be 0 or less. */
int glint_white_code(const struct glint_bright *bright, int32_t light_q20,
                     int32_t ev_q8);

/* Returns the min brightness reached by at most 1 / 2^PART_LOG2 of the
 * pixels. */
int glint_white_reached_by(const struct glint_white *white, int part_log2);

/* Returns the fraction of pixels that have VALUE or more, _q15. */
int32_t glint_white_share_q15(const struct glint_white *white, int value);

/* Returns log2 of LIGHT / white, in 1/256 stops, with an error of at most 1/256
 * stop. Light of 0 counts as 2^-20. */
int32_t glint_stops_q8(int64_t light_q20);

#endif
