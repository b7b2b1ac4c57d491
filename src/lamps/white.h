/* SPDX-License-Identifier: MIT
 *
 * How bright a picture is as a whole, and what is white in it.
 *
 *   in   a picture, of which bright has the codes
 *   out  how many of a grid of its pixels reach each brightness; codes
 *
 * A lamp may be far darker than white where a picture is underexposed. So white
 * is where codes clip if one pixel in 2^WHITE_PART_LOG2 does, else the code
 * that as many reach, yet no darker than WHITE_LEAST, or noise would be lamps.
 */
#ifndef GLINT_LAMPS_WHITE_H
#define GLINT_LAMPS_WHITE_H

#include "lamps/bright.h"

enum {
    WHITE_GRID_X = 160, /* pixels of the grid, at most */
    WHITE_GRID_Y = 96,
    WHITE_PART_LOG2 = 11,
    WHITE_LEAST = 64
};

struct glint_white {
    int n;                 /* pixels looked at */
    int32_t at_least[257]; /* [i]: number of those pixels with brightness i or
                              more */
    int32_t light_q20;     /* linear light of white */
};

/* BRIGHT has begun with a picture of HEIGHT rows. */
void glint_white_measure(struct glint_white *white, struct glint_bright *bright,
                         int height);

/* The least code, 1 .. BRIGHT_CLIPPED, that is EV_Q8 (0 or less) from LIGHT. */
int glint_white_code(const struct glint_bright *bright, int32_t light_q20,
                     int32_t ev_q8);

/* The least code that at most 1 / 2^PART_LOG2 of the pixels reach. */
int glint_white_reached_by(const struct glint_white *white, int part_log2);

/* Pixels of 2^15 that have VALUE or more. */
int32_t glint_white_share_q15(const struct glint_white *white, int value);

/* log2 of LIGHT_Q20, 0 taken for 1: -20 to 11 stops over white, within 1 / 256.
 */
int32_t glint_stops_q8(int64_t light_q20);

#endif
