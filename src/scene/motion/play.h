/* SPDX-License-Identifier: MIT
 *
 * A recorded motion in a scene: play, which moves objects and finds visible
 * foods, and layers, which draws overlays.
 *
 * Shells and lines are not objects: rays do not meet them. After the objects of
 * a pixel are shaded they are composited over it from back to front, where no
 * sample sees a nearer object. */
#ifndef GLINT_SCENE_MOTION_PLAY_H
#define GLINT_SCENE_MOTION_PLAY_H

#include "glint/scene/motion.h"
#include "scene/visible.h"

enum { GLINT_BOX_EDGES = 12 };

/* A shell, or a line between two places of the picture. */
struct glint_motion_layer {
    struct glint_box box; /* pixels that it may touch */
    enum glint_scene_kind kind;
    int32_t z; /* of its middle, by which layers are sorted */
    uint32_t material;
    const struct glint_placed *ball; /* NULL: a line */
    int32_t inner_q30;    /* of a shell: its least cosine, between normal and
                             ray, where all samples of a pixel see it */
    int32_t x_q8, y_q8;   /* where the line begins, from the middle */
    int32_t along_q14[2]; /* its direction */
    int32_t length_q8;
    int32_t half_q8[2],
        depth[2]; /* width and depth where it begins, and ends; of a shell,
                     depth[0] is that of its farthest point */
};

struct glint_motion_state {
    struct glint_motion motion;
    struct glint_motion_frame frame;
    const struct glint_scene_motion *how;
    uint32_t now;                    /* the frame that is shown */
    int sensor;                      /* that the camera is in, or -1 */
    uint32_t shown;                  /* kinds, by bits */
    int32_t size, shell, line, edge; /* of body, shells, lines and box; steps */
    /* Where objects are, steps, and which sensors see each food. */
    struct glint_scene_turn turn;
    int32_t body[3], sensor_at[GLINT_MOTION_MAX_SENSORS][3];
    int32_t axis_q30[GLINT_MOTION_MAX_SENSORS][3];
    int32_t food_at[GLINT_MOTION_MAX_FOODS][3];
    uint32_t seen_by[GLINT_MOTION_MAX_FOODS];
    int32_t low[3], high[3];
    struct glint_placed *ball;        /* [n_foods]: shells */
    struct glint_motion_layer *layer; /* [max_layers], from back to front */
    int n_layers, max_layers;
};

/* Returns whether D, from a sensor of AXIS_Q30 to a food, is less than the
 * angle of COS_HALF_Q30 off the axis, exactly. D is within +-2^29. */
int glint_motion_sees(const int32_t axis_q30[3], int32_t cos_half_q30,
                      const int32_t d[3]);

/* Returns how many layers the motion of HOW may have, whatever its file says.
 */
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
