/* SPDX-License-Identifier: MIT
 *
 * What a baker of motions has gathered. */
#ifndef GLINT_BAKE_MOTION_RECORDED_H
#define GLINT_BAKE_MOTION_RECORDED_H

#include "bake/motion/localise.h"
#include "glint/scene/motion_bake.h"

struct glint_recorded_pose {
    double at[3];
    float turn[4];
    float residual;
};

/* A food, from its first frame on. */
struct glint_recorded_food {
    uint32_t frame, slot;
    double at[3]; /* as it is known in the end */
};

struct glint_motion_baker {
    struct glint_motion_options options;
    struct glint_motion_body body;
    bool has_body;
    struct glint_localiser localiser;
    int n_foods, n_intensities;
    uint32_t n_frames, pose_room;
    struct glint_recorded_pose *pose; /* [n_frames] */
    uint32_t n_events, event_room;
    struct glint_recorded_food *event;      /* [n_events] */
    uint32_t lives[GLINT_MOTION_MAX_FOODS]; /* the event of each slot's food */
    size_t n_bytes, byte_room;
    uint8_t *intensity;        /* [n_frames][n_foods][n_intensities] */
    long long number;          /* of the last frame */
    struct glint_rigid sensed; /* what rv and tv sum up to */
    struct glint_motion_report report;
};

/* Writes the file; the boxes and counts of BAKER are whole. Returns false
 * without memory. */
bool glint_motion_write(const struct glint_motion_baker *baker,
                        const char *name, uint64_t key, unsigned char **data,
                        size_t *bytes);

/* Sets LOW and HIGH to the box of the body's places and foods. */
void glint_recorded_box(const struct glint_motion_baker *baker, double low[3],
                        double high[3]);

#endif
