/* SPDX-License-Identifier: MIT
 *
 * A recorded motion in a scene: play.c moves objects and finds visible foods,
 * layers.c draws overlays.
 *
 * Shells and lines are not objects: rays do not meet them. They are composited
 * from back to front over the shaded objects of a pixel, where no sample sees a
 * nearer object. */
#ifndef GLINT_SCENE_MOTION_PLAY_H
#define GLINT_SCENE_MOTION_PLAY_H

#include "glint/scene/motion.h"
#include "scene/visible.h"

enum { GLINT_BOX_EDGES = 12 };

/* A shell, or a line between two points of the picture. */
struct glint_motion_layer {
    struct glint_box box; /* pixels that the layer may touch */
    enum glint_scene_kind kind;
    int32_t z; /* z of its middle, the sort key of layers */
    uint32_t material;
    const struct glint_placed *ball; /* the shell's ball; NULL: this is a
                                        line */
    int32_t inner_q30;    /* shell: min cosine between normal and ray at which
                             all samples of a pixel see it */
    int32_t x_q8, y_q8;   /* start of the line, from the picture's middle */
    int32_t along_q14[2]; /* direction of the line */
    int32_t length_q8;
    int32_t half_q8[2],
        depth[2]; /* width and depth at both ends of the line; for a shell,
                     depth[0] is the depth of its farthest point */
};

struct glint_motion_state {
    struct glint_motion motion;
    struct glint_motion_frame frame;
    const struct glint_scene_motion *how;
    uint32_t now;                    /* the current frame */
    int sensor;                      /* the sensor that the camera is at, or
                                        -1 */
    uint32_t shown;                  /* a bit per shown kind */
    int32_t size, shell, line, edge; /* sizes of body, shells, lines and box
                                        edges; steps */
    /* Positions of objects, steps, and the sensors that see each food. */
    struct glint_scene_turn turn;
    int32_t body[3], sensor_at[GLINT_MOTION_MAX_SENSORS][3];
    int32_t axis_q30[GLINT_MOTION_MAX_SENSORS][3];
    int32_t food_at[GLINT_MOTION_MAX_FOODS][3];
    uint32_t seen_by[GLINT_MOTION_MAX_FOODS];
    int32_t low[3], high[3];
    struct glint_placed *ball;        /* [n_foods]: the shells */
    struct glint_motion_layer *layer; /* [max_layers], from back to front */
    int n_layers, max_layers;
};

/* Returns whether the angle between D, from a sensor to a food, and the
 * sensor's AXIS_Q30 is smaller than the angle of cosine COS_HALF_Q30; exact. D
 * must be within +-2^29. */
int glint_motion_sees(const int32_t axis_q30[3], int32_t cos_half_q30,
                      const int32_t d[3]);

/* Returns the max number of layers of the motion of HOW, for any motion
 * file. */
size_t glint_motion_layers(const struct glint_scene_motion *how);

struct glint_motion_state *glint_motion_carve(const struct glint_scene *scene,
                                              struct glint_arena *arena);
enum glint_status glint_motion_begin(struct glint_scene *scene);

static inline int glint_motion_shows(const struct glint_motion_state *m,
                                     enum glint_scene_kind kind)
{
    return m->shown >> kind & 1;
}

#endif
