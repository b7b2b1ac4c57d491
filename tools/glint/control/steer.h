/* SPDX-License-Identifier: MIT
 *
 * steer.h - what lines of control have changed of a scene.
 *
 *     steer_open(&steer, &model);
 *     steer_take(&steer, scene, &line, where, &error);    each line
 *     steer_apply(&steer, scene);               a scene that was placed again
 *     steer_close(&steer);
 *
 * Nothing is baked: what a line changes the next picture shows.
 */
#ifndef GLINT_TOOLS_CONTROL_STEER_H
#define GLINT_TOOLS_CONTROL_STEER_H

#include "control/controls.h"
#include "glint/scene/scene.h"

/* An object as it was changed. */
struct steer_thing {
    bool is_shown;
    int material;
    int32_t radius; /* of a ball, steps */
};

/* An environment as it was changed. */
struct steer_map {
    double turn_deg, scale;
};

/* A kind of objects of a motion as it was changed. */
struct steer_kind {
    bool is_hidden;
    int32_t steps; /* radius or width; 0: as the scene has it */
};

/* A camera that goes about a point. */
struct steer_orbit {
    bool is_there;
    double middle[3], distance; /* steps */
    double yaw_deg, pitch_deg;
};

struct steer {
    /* Private. */
    struct glint_scene_model model;
    struct steer_thing *thing;     /* [n_objects] */
    struct glint_scene_look *look; /* [n_materials] */
    struct steer_orbit orbit;
    /* Where the camera was before it went about a point. */
    struct glint_scene_camera camera;
    bool is_free; /* it has walked, and poses no longer move it */
    struct steer_map environment[GLINT_SCENE_MAX_ENVIRONMENTS];
    int shown; /* environment */
    struct steer_kind kind[GLINT_KINDS];
    int sensor; /* that the camera is in, or -1 */
};

/* MODEL is copied; the file that it points into must outlive STEER. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status steer_open(struct steer *steer,
                             const struct glint_scene_model *model);

void steer_close(struct steer *steer);

/* Notes that the camera was moved to AT, AXIS_Q30, by others. Returns false if
 * it goes about a point, and stays there. */
bool steer_camera(struct steer *steer, const int32_t at[3],
                  const int32_t axis_q30[3][3]);

/* Checks what LINE names. GLINT_E_FORMAT: ERROR states WHERE:COLUMN: cause. */
enum glint_status steer_check(const struct steer *steer,
                              const struct control_line *line,
                              const char *where, struct glint_error *error);

/* Obeys LINE, which is none of time. GLINT_E_FORMAT as steer_check(); all stays
 * as it was then. */
enum glint_status steer_take(struct steer *steer, struct glint_scene *scene,
                             const struct control_line *line, const char *where,
                             struct glint_error *error);

/* Changes SCENE, which has the look of its model, to what all lines left. */
void steer_apply(const struct steer *steer, struct glint_scene *scene);

#endif
