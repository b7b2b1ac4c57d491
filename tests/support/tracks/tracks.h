/* SPDX-License-Identifier: MIT
 *
 * Simulates a body that moves among stationary foods (landmarks), by one of
 * four motions. Each frame contains what the body observes: the positions of
 * the foods in the body's own axes. Motions are random by a seed, and computed
 * in double precision.
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
    /* type of motion: straight with turns (0), a spiral along x (1), straight
     * with turns and random rotations about x and y (2), random steps and turns
     * (3) */
    int motion;
    int n_frames, n_foods;
    /* number of frames from the end of one food (landmark) to the start of the
     * next; 0: foods exist in all frames */
    int reset_every;
    /* significant digits to which observed positions are rounded; 0: not
     * rounded */
    int digits;
    uint32_t seed;
};

struct track {
    struct track_options options;
    uint32_t rng;
    int frame, next_slot;
    /* true position, 0 .. 15 on each axis, and orientation (quaternion) */
    double at[3], turn[4];
    double heading[3], spin[4];
    double first_at[3], first_turn[4];
    double food[TRACK_FOODS][3];
};

struct track_frame {
    /* true pose: rigid motion from the body's axes to those of frame 0 */
    struct glint_rigid pose;
    /* fields "tv" and "rv" of the recording: translation and rotation since the
     * previous frame, in the axes of that frame */
    double step[3], spin[3];
    double seen[TRACK_FOODS][3];
    bool is_new[TRACK_FOODS];
    double food_distance; /* mean distance of the foods from the body */
};

void track_begin_motion(struct track *track,
                        const struct track_options *options);
void track_next_frame(struct track *track, struct track_frame *frame);

/* Sets TO to V rotated by Q if FORTH, otherwise by the inverse of Q. */
void track_rotate_vector(const double q[4], const double v[3], bool forth,
                         double to[3]);

/* Writes the whole track as a recording of a body with N_SENSORS sensors of
 * ANGLE_DEG degrees. IS_SECOND: uses the alternative key names. */
void track_write_recording(const struct track_options *options, bool is_second,
                           int n_sensors, double angle_deg, FILE *to);

#endif
