/* SPDX-License-Identifier: MIT
 *
 * A scene with a recorded motion, baked from text and drawn in linear light. */
#ifndef TESTS_SUPPORT_TRACKS_DRAWN_H
#define TESTS_SUPPORT_TRACKS_DRAWN_H

#include <stddef.h>
#include <stdint.h>

#include "glint/scene/model.h"
#include "glint/scene/motion_bake.h"
#include "scenes/scene_frame.h"

enum {
    DRAWN_WIDTH = 96,
    DRAWN_HEIGHT = 64,
    DRAWN_FOODS = 5,
    DRAWN_SENSORS = 6 /* they look along both ways of each axis */
};

/* The body that is recorded, but for its angle of view. */
extern const struct glint_motion_body drawn_body;

struct drawn {
    unsigned char *data;
    size_t bytes;
    struct glint_scene_model model;
    struct scene_frame frame;
    int32_t light_q20[3 * DRAWN_WIDTH * DRAWN_HEIGHT];
};

/* Choose what "motion run" of a text is: a track of that kind (tracks.h), or N
 * foods that stand still; sensors see within ANGLE_DEG. */
void drawn_of_track(int motion, int n_frames, double angle_deg);
void drawn_of_foods(double (*food)[3], int n, double angle_deg);
double drawn_angle_deg(void);

/* Fail the test if TEXT cannot be drawn. */
struct drawn *drawn_open(const char *text, int tile_log2, int samples);
void drawn_draw(struct drawn *d);
void drawn_close(struct drawn *d);

#endif
