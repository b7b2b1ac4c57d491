/* SPDX-License-Identifier: MIT
 *
 * steer.h - applies control lines to a scene and records the changes.
 *
 *     steer_open(&steer, &model);
 *     steer_execute_command(&steer, scene, &line, where, &error);  each line
 *     steer_apply_state(&steer, scene);          after the scene was placed
 *     steer_close(&steer);
 *
 * No change requires a bake: the next picture shows it.
 */
#ifndef GLINT_TOOLS_CONTROL_STEER_H
#define GLINT_TOOLS_CONTROL_STEER_H

#include "control/controls.h"
#include "glint/scene/scene.h"

/* Present properties of an object */
struct steer_thing {
    bool is_shown;
    int material;
    int32_t radius; /* radius of a ball, scene steps */
};

/* Present rotation and brightness of an environment */
struct steer_map {
    double turn_deg, scale;
};

/* Present properties of one type of objects of a recorded motion */
struct steer_kind {
    bool is_hidden;
    int32_t steps; /* radius or width, scene steps; 0: that of the scene file */
};

/* State of a camera that orbits a point */
struct steer_orbit {
    bool is_there;
    double middle[3], distance; /* centre and distance, scene steps */
    double yaw_deg, pitch_deg;
};

struct steer {
    /* Private. */
    struct glint_scene_model model;
    struct steer_thing *thing; /* state of each object, [n_objects] */
    /* appearance of each material, [n_materials] */
    struct glint_scene_look *look;
    struct steer_orbit orbit;
    /* camera of the scene or pose file, or as moved by the commands walk and
     * look; an orbit does not change it */
    struct glint_scene_camera camera;
    /* whether walk or look moved the camera; then poses no longer move it */
    bool is_free;
    struct steer_map environment[GLINT_SCENE_MAX_ENVIRONMENTS];
    int shown; /* index of the visible environment */
    struct steer_kind kind[GLINT_KINDS];
    /* index of the motion's sensor at which the camera is; -1: at none */
    int sensor;
};

/* Initialises STEER with a copy of MODEL; the data that MODEL points to must
 * outlive STEER. Returns GLINT_E_MEMORY on failure. */
enum glint_status steer_open(struct steer *steer,
                             const struct glint_scene_model *model);

void steer_close(struct steer *steer);

/* Records the pose AT, AXIS_Q30 of the camera. Returns whether to move the
 * camera to it: not if control lines have moved the camera. */
bool steer_record_camera_pose(struct steer *steer, const int32_t at[3],
                              const int32_t axis_q30[3][3]);

/* Checks that the scene has the objects, materials and environments that LINE
 * names. On GLINT_E_FORMAT, ERROR is "WHERE:COLUMN: cause". */
enum glint_status steer_check_line(const struct steer *steer,
                                   const struct control_line *line,
                                   const char *where,
                                   struct glint_error *error);

/* Executes LINE, any command except those of playback.h. If LINE is invalid,
 * changes nothing and returns GLINT_E_FORMAT like steer_check_line(). */
enum glint_status steer_execute_command(struct steer *steer,
                                        struct glint_scene *scene,
                                        const struct control_line *line,
                                        const char *where,
                                        struct glint_error *error);

/* Applies all recorded changes to SCENE, which must be as initialised from its
 * model. */
void steer_apply_state(const struct steer *steer, struct glint_scene *scene);

#endif
