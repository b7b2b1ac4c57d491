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

/* Present state of an object */
struct steer_thing {
    bool is_shown;
    int material;
    int32_t radius; /* radius of a ball, scene steps */
};

/* Present state of an environment */
struct steer_map {
    double turn_deg, scale;
};

/* Present state of one type of objects in a motion */
struct steer_kind {
    bool is_hidden;
    int32_t steps; /* radius or width, scene steps; 0: as in the scene */
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
    /* Camera before the orbit began */
    struct glint_scene_camera camera;
    /* whether control lines moved the camera, so that poses no longer do */
    bool is_free;
    struct steer_map environment[GLINT_SCENE_MAX_ENVIRONMENTS];
    int shown; /* index of the visible environment */
    struct steer_kind kind[GLINT_KINDS];
    int sensor; /* sensor that the camera is at, or -1 */
};

/* Initialises STEER with a copy of MODEL; the data that MODEL points to must
 * outlive STEER. Returns GLINT_E_MEMORY on failure. */
enum glint_status steer_open(struct steer *steer,
                             const struct glint_scene_model *model);

void steer_close(struct steer *steer);

/* Records that a pose moved the camera to AT, AXIS_Q30. Returns false if the
 * camera ignores poses, because control lines have moved it. */
bool steer_record_camera_pose(struct steer *steer, const int32_t at[3],
                              const int32_t axis_q30[3][3]);

/* Checks that the names in LINE exist. On GLINT_E_FORMAT, ERROR is
 * "WHERE:COLUMN: cause". */
enum glint_status steer_check_line(const struct steer *steer,
                                   const struct control_line *line,
                                   const char *where,
                                   struct glint_error *error);

/* Executes LINE, any command except those of playback.h. Returns GLINT_E_FORMAT
 * like steer_check_line(), without a change. */
enum glint_status steer_execute_command(struct steer *steer,
                                        struct glint_scene *scene,
                                        const struct control_line *line,
                                        const char *where,
                                        struct glint_error *error);

/* Applies all recorded changes to SCENE, which must be in the state of its
 * model. */
void steer_apply_state(const struct steer *steer, struct glint_scene *scene);

#endif
