/* SPDX-License-Identifier: MIT
 *
 * The four body motions of row D3, with the positions of stationary foods
 * (landmarks) as observed from the body: random by a seed, frame by frame, in
 * double precision.
 *
 *     track_begin_motion(&track, &options);
 *     while (...) track_next_frame(&track, &frame);
 */
#ifndef GLINT_TESTS_TRACKS_H
#define GLINT_TESTS_TRACKS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "bake/motion/rigid.h"

enum { TRACK_FOODS = 32, TRACK_MOTIONS = 4 };

struct track_options {
    /* 0: straight with turns; 1: a spiral along x; 2: as 0, rotated at
     * random about x and y; 3: random steps and turns */
    int motion;
    int n_frames, n_foods;
    /* frames from the end of one food to the start of the next; 0: foods
     * stay */
    int reset_every;
    int digits; /* significant digits of observed positions; 0: all */
    uint32_t seed;
};

struct track {
    struct track_options options;
    uint32_t rng;
    int frame, next_slot;
    /* position in the box 0 .. 15, and orientation (quaternion) */
    double at[3], turn[4];
    double heading[3], spin[4];
    double first_at[3], first_turn[4];
    double food[TRACK_FOODS][3];
};

struct track_frame {
    /* true pose: from the body's axes to those of frame 0 */
    struct glint_rigid pose;
    /* tv and rv: translation and rotation since the previous frame, in that
     * frame's axes */
    double step[3], spin[3];
    double seen[TRACK_FOODS][3];
    bool is_new[TRACK_FOODS];
    double food_distance; /* mean distance from the body */
};

void track_begin_motion(struct track *track,
                        const struct track_options *options);
void track_next_frame(struct track *track, struct track_frame *frame);

/* Writes the whole track as a recording (with the alternative key names if
 * IS_SECOND) and N_SENSORS sensors of ANGLE_DEG. */
void track_write_recording(const struct track_options *options, bool is_second,
                           int n_sensors, double angle_deg, FILE *to);

#endif
