/* SPDX-License-Identifier: MIT
 *
 * Playback of a recorded motion in a scene. play.c moves objects and finds the
 * food items (landmarks) that sensors see; layers.c draws overlays.
 *
 * Shells and lines are overlays, not objects: rays do not hit them. They are
 * composited from back to front over the shaded objects of a pixel, at samples
 * where no object is nearer than the overlay. */
#ifndef GLINT_SCENE_MOTION_PLAY_H
#define GLINT_SCENE_MOTION_PLAY_H

#include "glint/scene/motion.h"
#include "scene/visible.h"

enum { GLINT_BOX_EDGES = 12 };

/* An overlay: a shell around a ball, or a line between two points. */
struct glint_motion_layer {
    struct glint_box box; /* pixels that the overlay may cover */
    enum glint_scene_kind kind;
    int32_t z; /* z of the overlay's middle in camera coordinates; overlays are
                  sorted by it */
    uint32_t material;
    const struct glint_placed *ball; /* the ball of a shell; NULL for a line */
    /* Shell: cosine between normal and ray above which all samples of a pixel
     * see the shell. */
    int32_t inner_q30;
    int32_t x_q8, y_q8;   /* start of the line, 1/256 pixel from the picture's
                             middle */
    int32_t along_q14[2]; /* direction of the line in the picture, a unit
                             vector */
    int32_t length_q8;
    int32_t half_q8[2],
        /* Half width (1/256 pixel) and depth at both ends of the line. For a
         * shell, depth[0] is the depth of the shell's far side. */
        depth[2];
};

struct glint_motion_state {
    struct glint_motion motion;
    struct glint_motion_frame frame;
    const struct glint_scene_motion *how;
    uint32_t now;   /* index of the current frame */
    int sensor;     /* index of the sensor that the camera is
                       attached to, or -1 */
    uint32_t shown; /* bit mask of the types (enum glint_scene_kind) that are
                       shown */
    /* Sizes of the body, shells, lines and edges of the box, steps. */
    int32_t size, shell, line, edge;
    /* Rotation of the body, positions of objects in steps, and for each food
     * item a bit mask of the sensors that see it. */
    struct glint_scene_turn turn;
    int32_t body[3], sensor_at[GLINT_MOTION_MAX_SENSORS][3];
    int32_t axis_q30[GLINT_MOTION_MAX_SENSORS][3];
    int32_t food_at[GLINT_MOTION_MAX_FOODS][3];
    uint32_t seen_by[GLINT_MOTION_MAX_FOODS];
    int32_t low[3], high[3];
    struct glint_placed *ball;        /* [n_foods]: ball of the shell around
                                         each food item */
    struct glint_motion_layer *layer; /* [max_layers], from back to front */
    int n_layers, max_layers;
};

/* Returns whether a food item is inside the view cone of a sensor. D is the
 * vector from the sensor to the item, within +-2^29, and AXIS_Q30 the sensor's
 * axis. The angle between them must be smaller than half the angle of view,
 * whose cosine is COS_HALF_Q30. The result is exact. */
int glint_motion_is_in_view_cone(const int32_t axis_q30[3],
                                 int32_t cos_half_q30, const int32_t d[3]);

/* Returns the max number of overlays that a recorded motion with parameters HOW
 * can have in any frame. */
size_t glint_motion_count_max_overlays(const struct glint_scene_motion *how);

struct glint_motion_state *
glint_motion_allocate(const struct glint_scene *scene,
                      struct glint_arena *arena);
enum glint_status glint_motion_start_playback(struct glint_scene *scene);

static inline int glint_motion_is_kind_shown(const struct glint_motion_state *m,
                                             enum glint_scene_kind kind)
{
    return m->shown >> kind & 1;
}

#endif
