/* SPDX-License-Identifier: MIT
 *
 * The four motions of row D3, with what a body on them sees of foods that stand
 * still: by a seeded generator, frame by frame, in double precision.
 *
 *     track_begin(&track, &options);
 *     while (...) track_next(&track, &frame);
 */
#ifndef GLINT_TESTS_TRACKS_H
#define GLINT_TESTS_TRACKS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "bake/motion/rigid.h"

enum { TRACK_FOODS = 32, TRACK_MOTIONS = 4 };

struct track_options {
    int motion; /* 0: straight with turns; 1: a spiral along x; 2: the first,
                   turned at random about x and y; 3: random steps and turns */
    int n_frames, n_foods;
    int reset_every; /* frames from one food's end to the next one's; 0: none */
    int digits;      /* significant ones of what is seen; 0: all */
    uint32_t seed;
};

struct track {
    struct track_options options;
    uint32_t rng;
    int frame, next_slot;
    double at[3], turn[4]; /* in the box of 0 .. 15 */
    double heading[3], spin[4];
    double first_at[3], first_turn[4];
    double food[TRACK_FOODS][3];
};

struct track_frame {
    struct glint_rigid pose; /* the truth: from the body's axes to frame 0's */
    double step[3], spin[3]; /* tv and rv: by how much it moved and turned since
                                the frame before, in that frame's axes */
    double seen[TRACK_FOODS][3];
    bool is_new[TRACK_FOODS];
    double food_distance; /* mean, from the body */
};

void track_begin(struct track *track, const struct track_options *options);
void track_next(struct track *track, struct track_frame *frame);

/* Writes the whole track as a recording, in the words of the second spelling if
 * IS_SECOND, with some N_SENSORS sensors of ANGLE_DEG. */
void track_write(const struct track_options *options, bool is_second,
                 int n_sensors, double angle_deg, FILE *to);

#endif
