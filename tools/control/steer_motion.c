/* SPDX-License-Identifier: MIT
 *
 * Lines on recorded motion, and on a camera that goes where it likes. */
#include <math.h>
#include <string.h>

#include "control/steer.h"
#include "glint/scene/motion.h"

#define RADIAN 0.017453292519943295

/* Sets KIND to the kind of objects called NAME; returns false if there is none,
 * or an object has that name. */
static bool kind_of(const struct steer *steer, const char *name,
                    enum glint_scene_kind *kind)
{
    static const char *const kinds[GLINT_KINDS] = {"body",   "sensors", "foods",
                                                   "shells", "lines",   "box"};

    if (!steer->model.motion || glint_scene_find(&steer->model, name) >= 0)
        return false;
    for (int i = 0; i < GLINT_KINDS; i++)
        if (strcmp(name, kinds[i]) == 0) {
            *kind = (enum glint_scene_kind)i;
            return true;
        }
    return false;
}

static bool names_kind(const struct steer *s, const struct control_line *line,
                       enum glint_scene_kind *kind)
{
    return (line->verb == CONTROL_SHOW || line->verb == CONTROL_HIDE ||
            line->verb == CONTROL_SIZE) &&
           kind_of(s, line->name[0], kind);
}

bool steer_check_motion(const struct steer *steer,
                        const struct control_line *line, const char *where,
                        struct glint_error *error, enum glint_status *status)
{
    const struct glint_scene_motion *const m = steer->model.motion;
    enum glint_scene_kind kind;
    int n = 0;

    *status = GLINT_OK;
    if (m)
        n = (int)((const struct glint_motion_header *)(const void *)(m + 1))
                ->n_sensors;
    if (line->verb == CONTROL_SENSOR && line->v[0] > n)
        *status = control_fail(error, where, line->column,
                               "the scene's motion has %d sensors", n);
    return line->verb == CONTROL_SENSOR || line->verb == CONTROL_SCENE ||
           line->verb == CONTROL_WALK || line->verb == CONTROL_LOOK ||
           names_kind(steer, line, &kind);
}

/* -------------------------------------------------------------------- camera
 */

static enum glint_status set_camera(const struct steer *s,
                                    struct glint_scene *scene)
{
    return glint_scene_set_camera(scene, s->camera.at,
                                  (const int32_t(*)[3])s->camera.axis_q30);
}

/* Turns axis A of C towards axis B by DEG. */
static void turn(double axis[3][3], int a, int b, double deg)
{
    const double c = cos(deg * RADIAN), sine = sin(deg * RADIAN);

    for (int k = 0; k < 3; k++) {
        const double x = axis[a][k], y = axis[b][k];

        axis[a][k] = c * x + sine * y;
        axis[b][k] = c * y - sine * x;
    }
}

/* Sets FROM to where the camera is from the middle, a unit. */
static void set_from(const struct steer_orbit *o, double from[3])
{
    const double yaw = o->yaw_deg * RADIAN, pitch = o->pitch_deg * RADIAN;

    from[0] = cos(pitch) * sin(yaw);
    from[1] = sin(pitch);
    from[2] = -cos(pitch) * cos(yaw);
}

enum glint_status steer_orbit_camera(const struct steer *steer,
                                     struct glint_scene_camera *camera)
{
    const struct steer *const s = steer;
    const double yaw = s->orbit.yaw_deg * RADIAN;
    const double x = cos(yaw), z = sin(yaw);
    double from[3];

    set_from(&s->orbit, from);
    /* up is ahead x right, of axes whose z runs away */
    const double axis[3][3] = {
        {x, 0, z},
        {-from[1] * z, from[0] * z - from[2] * x, from[1] * x},
        {-from[0], -from[1], -from[2]},
    };
    for (int k = 0; k < 3; k++) {
        const double place = s->orbit.middle[k] + s->orbit.distance * from[k];

        if (!(fabs(place) < GLINT_SCENE_SPAN - 1))
            return GLINT_E_ARGUMENT;
        camera->at[k] = (int32_t)lround(place);
        for (int i = 0; i < 3; i++)
            camera->axis_q30[k][i] = (int32_t)lround(0x1p30 * axis[k][i]);
    }
    return GLINT_OK;
}

/* Moves or turns the camera by its own axes, from where it is. */
static enum glint_status take_free(struct steer *s, struct glint_scene *scene,
                                   const struct control_line *line)
{
    const struct steer before = *s;
    struct glint_scene_camera *const c = &s->camera;
    double axis[3][3] = {{0}};
    enum glint_status status = GLINT_OK;

    if (s->orbit.is_there)
        status = steer_orbit_camera(s, c);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            axis[k][i] = c->axis_q30[k][i] * 0x1p-30;
    for (int i = 0; i < 3 && line->verb == CONTROL_WALK; i++) {
        double at = c->at[i];

        for (int k = 0; k < 3; k++)
            at += axis[k][i] * ldexp(line->v[k], s->model.header->unit_log2);
        if (!(fabs(at) < GLINT_SCENE_SPAN - 1))
            status = GLINT_E_ARGUMENT;
        else
            c->at[i] = (int32_t)lround(at);
    }
    if (line->verb == CONTROL_LOOK) {
        turn(axis, 2, 0, line->v[0]); /* ahead to the right */
        turn(axis, 2, 1, line->v[1]); /* ahead up */
        turn(axis, 1, 0, line->v[2]); /* up to the right */
    }
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            c->axis_q30[k][i] = (int32_t)lround(0x1p30 * axis[k][i]);
    s->orbit.is_there = false;
    s->is_free = true;
    s->sensor = -1;
    if (status == GLINT_OK && s->model.motion)
        glint_scene_enter(scene, -1);
    if (status == GLINT_OK)
        status = set_camera(s, scene);
    if (status != GLINT_OK)
        *s = before;
    return status;
}

static enum glint_status take_sensor(struct steer *s, struct glint_scene *scene,
                                     const struct control_line *line)
{
    const int sensor = line->verb == CONTROL_SENSOR ? (int)line->v[0] - 1 : -1;
    enum glint_status status = GLINT_OK;

    if (s->model.motion)
        status = glint_scene_enter(scene, sensor);
    if (status != GLINT_OK)
        return status;
    s->sensor = sensor;
    s->orbit.is_there = s->is_free = false;
    if (sensor >= 0)
        return status;
    s->camera = s->model.header->camera;
    return set_camera(s, scene);
}

/* --------------------------------------------------------------------- kinds
 */

static enum glint_status take_kind(struct steer *s, struct glint_scene *scene,
                                   const struct control_line *line,
                                   enum glint_scene_kind kind)
{
    const double steps = rint(ldexp(line->v[0], s->model.header->unit_log2));
    enum glint_status status = GLINT_OK;

    if (line->verb != CONTROL_SIZE) {
        s->kind[kind].is_hidden = line->verb == CONTROL_HIDE;
        glint_scene_show_kind(scene, kind, line->verb == CONTROL_SHOW);
        return status;
    }
    status = glint_scene_size_kind(scene, kind,
                                   (int32_t)fmin(steps, GLINT_SCENE_SPAN));
    if (status == GLINT_OK)
        s->kind[kind].steps = (int32_t)steps;
    return status;
}

bool steer_take_motion(struct steer *steer, struct glint_scene *scene,
                       const struct control_line *line,
                       enum glint_status *status)
{
    enum glint_scene_kind kind;

    if (line->verb == CONTROL_SENSOR || line->verb == CONTROL_SCENE)
        *status = take_sensor(steer, scene, line);
    else if (line->verb == CONTROL_WALK || line->verb == CONTROL_LOOK)
        *status = take_free(steer, scene, line);
    else if (names_kind(steer, line, &kind))
        *status = take_kind(steer, scene, line, kind);
    else
        return false;
    return true;
}

void steer_apply_motion(const struct steer *steer, struct glint_scene *scene)
{
    for (int i = 0; steer->model.motion && i < GLINT_KINDS; i++) {
        const struct steer_kind *const k = &steer->kind[i];

        if (k->steps)
            glint_scene_size_kind(scene, (enum glint_scene_kind)i, k->steps);
        if (k->is_hidden)
            glint_scene_show_kind(scene, (enum glint_scene_kind)i, 0);
    }
    if (steer->model.motion)
        glint_scene_enter(scene, steer->sensor);
    if (steer->is_free)
        set_camera(steer, scene);
}
