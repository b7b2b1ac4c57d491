/* SPDX-License-Identifier: MIT
 *
 * A scene with a recorded motion, baked from text and drawn in linear light. */
#ifndef TESTS_SUPPORT_TRACKS_MOVING_H
#define TESTS_SUPPORT_TRACKS_MOVING_H

#include <stddef.h>
#include <stdint.h>

#include "glint/scene/model.h"
#include "glint/scene/motion_bake.h"
#include "scenes/scene_frame.h"

enum {
    MOVING_WIDTH = 96,
    MOVING_HEIGHT = 64,
    MOVING_FOODS = 5,
    MOVING_SENSORS = 6 /* two sensors per axis, one for each direction */
};

/* The body of the recording; the field of view of its sensors is not set. */
extern const struct glint_motion_body moving_body;

struct moving {
    unsigned char *data;
    size_t bytes;
    struct glint_scene_model model;
    struct scene_frame frame;
    int32_t light_q20[3 * MOVING_WIDTH * MOVING_HEIGHT];
};

/* Set the motion that the line "motion run" of a scene text loads: a track of
 * type MOTION (see tracks.h), or N stationary foods (landmarks). Sensors detect
 * a food within ANGLE_DEG degrees of their axis. */
void moving_bake_track(int motion, int n_frames, double angle_deg);
void moving_bake_foods(double (*food)[3], int n, double angle_deg);
double moving_angle_to_food_deg(void);

/* These functions fail the test if TEXT cannot be drawn. */
struct moving *moving_open_scene(const char *text, int tile_log2, int samples);
void moving_draw_frame(struct moving *d);
void moving_close_scene(struct moving *d);

#endif
