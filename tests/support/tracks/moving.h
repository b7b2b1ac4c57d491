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
    MOVING_SENSORS = 6 /* they look along both ways of each axis */
};

/* The body that is recorded, but for its angle of view. */
extern const struct glint_motion_body moving_body;

struct moving {
    unsigned char *data;
    size_t bytes;
    struct glint_scene_model model;
    struct scene_frame frame;
    int32_t light_q20[3 * MOVING_WIDTH * MOVING_HEIGHT];
};

/* Choose what "motion run" of a text is: a track of that kind (tracks.h), or N
 * foods that stand still; sensors see within ANGLE_DEG. */
void moving_of_track(int motion, int n_frames, double angle_deg);
void moving_of_foods(double (*food)[3], int n, double angle_deg);
double moving_angle_deg(void);

/* Fail the test if TEXT cannot be drawn. */
struct moving *moving_open(const char *text, int tile_log2, int samples);
void moving_draw(struct moving *d);
void moving_close(struct moving *d);

#endif
