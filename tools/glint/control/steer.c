/* SPDX-License-Identifier: MIT */
#include "control/steer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/scene/motion.h"
#include "options/suggest.h"

#define RADIAN 0.017453292519943295

/* Min and max factor on the light of an environment. Scene texts have the same
 * limits; without them keys could exceed the range. */
#define LEAST_SCALE 1e-6
#define MOST_SCALE  1e6

static int count_environments(const struct steer *s)
{
    return (int)s->model.header->n_environments;
}

static void open_environments(struct steer *steer)
{
    for (int i = 0; i < count_environments(steer); i++) {
        const struct glint_scene_environment *const e =
            &steer->model.environment[i];

        steer->environment[i] =
            (struct steer_map){atan2(e->turn_q30[1], e->turn_q30[0]) / RADIAN,
                               glint_real_value(e->scale)};
    }
}

/* Checks LINE, a command about environments: the scene must have an
 * environment, and if LINE names one, that environment. */
static enum glint_status
check_environment_command(const struct steer *steer,
                          const struct control_line *line, const char *where,
                          struct glint_error *error)
{
    struct suggest suggest;

    if (count_environments(steer) == 0)
        return control_set_line_error(error, where, line->column,
                                      "the scene has no environment");
    if (line->verb != CONTROL_MAP ||
        glint_scene_find_environment(&steer->model, line->name[0]) >= 0)
        return GLINT_OK;
    suggest_begin(&suggest, line->name[0]);
    for (int i = 0; i < count_environments(steer); i++) {
        const char *const name = steer->model.environment[i].name;

        suggest_add_candidate(&suggest, name, strlen(name));
    }
    return control_set_line_error(error, where, line->name_column[0],
                                  "the scene has no environment '%s'%s",
                                  line->name[0], suggest_from_words(&suggest));
}

/* Selects the current environment in SCENE and sets its rotation and scale. */
static enum glint_status show_environment(const struct steer *s,
                                          struct glint_scene *scene)
{
    const struct steer_map *const m = &s->environment[s->shown];
    const double turn = m->turn_deg * RADIAN;
    const int32_t turn_q30[2] = {(int32_t)lrint(0x1p30 * cos(turn)),
                                 (int32_t)lrint(0x1p30 * sin(turn))};
    enum glint_status status = glint_scene_set_environment(scene, s->shown);

    if (status == GLINT_OK)
        status = glint_scene_turn_environment(scene, turn_q30);
    if (status == GLINT_OK)
        status = glint_scene_scale_environment(scene, glint_real_of(m->scale));
    return status;
}

static enum glint_status change_environment(struct steer *steer,
                                            struct glint_scene *scene,
                                            const struct control_line *line)
{
    struct steer_map *const m = &steer->environment[steer->shown];
    const double v = line->v[0];

    if (line->verb == CONTROL_TURN)
        m->turn_deg = v + (line->is_change ? m->turn_deg : 0);
    else if (line->verb == CONTROL_SCALE)
        m->scale = fmax(LEAST_SCALE,
                        fmin(MOST_SCALE, line->is_change ? v * m->scale : v));
    else if (line->verb == CONTROL_MAP)
        steer->shown =
            glint_scene_find_environment(&steer->model, line->name[0]);
    else if (count_environments(steer) > 0)
        steer->shown = (steer->shown + 1) % count_environments(steer);
    return show_environment(steer, scene);
}

/* Sets KIND to the type that NAME denotes, such as "shells", of a recorded
 * motion's objects. Returns false if there is no motion, or if NAME is not a
 * type or is the name of an object. */
static bool find_object_type(const struct steer *steer, const char *name,
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

static bool is_object_type_name(const struct steer *s,
                                const struct control_line *line,
                                enum glint_scene_kind *kind)
{
    return (line->verb == CONTROL_SHOW || line->verb == CONTROL_HIDE ||
            line->verb == CONTROL_SIZE) &&
           find_object_type(s, line->name[0], kind);
}

static enum glint_status check_motion_sensor(const struct steer *steer,
                                             const struct control_line *line,
                                             const char *where,
                                             struct glint_error *error)
{
    const struct glint_scene_motion *const m = steer->model.motion;
    int n = 0;

    if (m)
        n = (int)((const struct glint_motion_header *)(const void *)(m + 1))
                ->n_sensors;
    return line->v[0] > n
               ? control_set_line_error(
                     error, where, line->column,
                     "no such sensor: the scene's motion has %d, numbered "
                     "from 1",
                     n)
               : GLINT_OK;
}

/* ------------------------------------------------------------------ camera */

static enum glint_status set_scene_camera(const struct steer *s,
                                          struct glint_scene *scene)
{
    return glint_scene_set_camera(scene, s->camera.at,
                                  (const int32_t(*)[3])s->camera.axis_q30);
}

/* Rotates axis A towards axis B by DEG degrees. */
static void rotate_camera_axes(double axis[3][3], int a, int b, double deg)
{
    const double c = cos(deg * RADIAN), sine = sin(deg * RADIAN);

    for (int k = 0; k < 3; k++) {
        const double x = axis[a][k], y = axis[b][k];

        axis[a][k] = c * x + sine * y;
        axis[b][k] = c * y - sine * x;
    }
}

/* Sets FROM to the direction of the camera as seen from the centre of orbit O,
 * a unit vector. */
static void compute_orbit_direction(const struct steer_orbit *o, double from[3])
{
    const double yaw = o->yaw_deg * RADIAN, pitch = o->pitch_deg * RADIAN;

    from[0] = cos(pitch) * sin(yaw);
    from[1] = sin(pitch);
    from[2] = -cos(pitch) * cos(yaw);
}

/* Sets position and axes of CAMERA from the orbit. Returns GLINT_E_ARGUMENT
 * if the position is out of range. */
static enum glint_status orbit_camera(const struct steer *steer,
                                      struct glint_scene_camera *camera)
{
    const struct steer *const s = steer;
    const double yaw = s->orbit.yaw_deg * RADIAN;
    const double x = cos(yaw), z = sin(yaw);
    double from[3];

    compute_orbit_direction(&s->orbit, from);
    /* The axes are left-handed: z points away from the viewer. So up is the
     * cross product ahead x right. */
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

/* Moves or rotates the camera along its own axes. */
static enum glint_status move_camera(struct steer *s, struct glint_scene *scene,
                                     const struct control_line *line)
{
    const struct steer before = *s;
    struct glint_scene_camera *const c = &s->camera;
    double axis[3][3] = {{0}};
    enum glint_status status = GLINT_OK;

    if (s->orbit.is_there)
        status = orbit_camera(s, c);
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
        rotate_camera_axes(axis, 2, 0,
                           line->v[0]); /* rotates the view to the right */
        rotate_camera_axes(axis, 2, 1,
                           line->v[1]); /* rotates the view upwards */
        rotate_camera_axes(axis, 1, 0, line->v[2]); /* rolls clockwise */
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
        status = set_scene_camera(s, scene);
    if (status != GLINT_OK)
        *s = before;
    return status;
}

static enum glint_status move_camera_to_sensor(struct steer *s,
                                               struct glint_scene *scene,
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
    return set_scene_camera(s, scene);
}

/* ------------------------------------------------------------ object types */

static enum glint_status change_objects_of_type(struct steer *s,
                                                struct glint_scene *scene,
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

static void apply_object_type_changes(const struct steer *steer,
                                      struct glint_scene *scene)
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
        set_scene_camera(steer, scene);
}

/* Max pitch of an orbit, degrees. At 90 degrees the camera would look straight
 * down, and its right axis would be undefined. */
#define MOST_PITCH 89.0

/* Min and max alpha (roughness) of brushed metal; without them keys could
 * exceed the range. */
#define LEAST_ALPHA 0.001
#define MOST_ALPHA  1.0

/* ----------------------------------------------------------------- opening */

static int count_objects(const struct steer *s)
{
    return (int)s->model.header->n_objects;
}

static int count_materials(const struct steer *s)
{
    return (int)s->model.header->n_materials;
}

static void read_material_appearance(const struct glint_scene_model *m, int i,
                                     struct glint_scene_look *look)
{
    const struct glint_scene_material *const from = &m->material[i];

    memcpy(look->rgb_q15, from->rgb_q15, sizeof look->rgb_q15);
    if (from->ward != GLINT_SCENE_NONE) {
        const struct glint_scene_ward *const ward = &m->ward[from->ward];

        memcpy(look->specular_q15, ward->specular_q15,
               sizeof look->specular_q15);
        memcpy(look->alpha_q24, ward->alpha_q24, sizeof look->alpha_q24);
    }
}

enum glint_status steer_open(struct steer *steer,
                             const struct glint_scene_model *model)
{
    const struct glint_scene_header *const h = model->header;

    *steer = (struct steer){
        .model = *model,
        .thing = calloc(h->n_objects + 1, sizeof *steer->thing),
        .look = calloc(h->n_materials + 1, sizeof *steer->look),
        .camera = h->camera,
        .sensor = model->motion && model->motion->camera != GLINT_SCENE_NONE
                      ? (int)model->motion->camera
                      : -1};
    if (!steer->thing || !steer->look) {
        steer_close(steer);
        return GLINT_E_MEMORY;
    }
    open_environments(steer);
    for (int i = 0; i < count_objects(steer); i++)
        steer->thing[i] = (struct steer_thing){!model->object[i].hidden,
                                               (int)model->object[i].material,
                                               model->object[i].radius};
    for (int i = 0; i < count_materials(steer); i++)
        read_material_appearance(model, i, &steer->look[i]);
    return GLINT_OK;
}

void steer_close(struct steer *steer)
{
    free(steer->thing);
    free(steer->look);
    steer->thing = NULL;
    steer->look = NULL;
}

/* ----------------------------------------------- object and material names */

static const char *find_object_or_material_name(const struct steer *s,
                                                bool is_material, int i)
{
    return is_material ? s->model.material[i].name : s->model.object[i].name;
}

/* Sets INDEX to the index of the object, or material if IS_MATERIAL, that name
 * K of LINE denotes. Reports an error if there is none. */
static enum glint_status find_index_of_command_name(
    const struct steer *s, const struct control_line *line, int k,
    bool is_material, const char *where, struct glint_error *error, int *index)
{
    const char *const name = line->name[k];
    const int n = is_material ? count_materials(s) : count_objects(s);
    struct suggest suggest;

    *index = is_material ? glint_scene_find_material(&s->model, name)
                         : glint_scene_find(&s->model, name);
    if (*index >= 0)
        return GLINT_OK;
    suggest_begin(&suggest, name);
    for (int i = 0; i < n; i++) {
        const char *const known =
            find_object_or_material_name(s, is_material, i);

        suggest_add_candidate(&suggest, known, strlen(known));
    }
    return control_set_line_error(error, where, line->name_column[k],
                                  "the scene has no %s '%s'%s",
                                  is_material ? "material" : "object", name,
                                  suggest_from_words(&suggest));
}

/* Returns whether the first name of LINE must be a material. */
static bool is_command_for_material(const struct control_line *line)
{
    return line->verb == CONTROL_ALPHA || line->verb == CONTROL_COLOUR ||
           line->verb == CONTROL_DIFFUSE;
}

/* Sets INDEX[2] to the indices of the names of LINE, 0 for a missing name. */
static enum glint_status
find_name_indices(const struct steer *s, const struct control_line *line,
                  const char *where, struct glint_error *error, int index[2])
{
    enum glint_status status = GLINT_OK;

    index[0] = index[1] = 0;
    if (*line->name[0])
        status = find_index_of_command_name(
            s, line, 0, is_command_for_material(line), where, error, index);
    if (status == GLINT_OK && *line->name[1])
        status = find_index_of_command_name(s, line, 1, true, where, error,
                                            index + 1);
    return status;
}

static bool is_brushed_metal(const struct steer *s, int i)
{
    return s->model.material[i].ward != GLINT_SCENE_NONE;
}

enum glint_status steer_check_line(const struct steer *steer,
                                   const struct control_line *line,
                                   const char *where, struct glint_error *error)
{
    const bool is_set = is_command_for_material(line) && *line->name[0];
    enum glint_scene_kind kind;
    enum glint_status status;
    int index[2];

    switch (line->verb) {
    case CONTROL_SENSOR:
        return check_motion_sensor(steer, line, where, error);
    case CONTROL_TURN:
    case CONTROL_SCALE:
    case CONTROL_MAP:
    case CONTROL_NEXT_MAP:
        return check_environment_command(steer, line, where, error);
    default:
        break;
    }
    if (is_object_type_name(steer, line, &kind))
        return GLINT_OK;
    status = find_name_indices(steer, line, where, error, index);
    if (status != GLINT_OK)
        return status;
    if (is_set && line->verb != CONTROL_COLOUR &&
        !is_brushed_metal(steer, index[0]))
        return control_set_line_error(error, where, line->name_column[0],
                                      "'%s' is not brushed metal; use 'colour'",
                                      line->name[0]);
    if (line->verb == CONTROL_SIZE &&
        steer->model.object[index[0]].kind != GLINT_OBJECT_SPHERE)
        return control_set_line_error(
            error, where, line->name_column[0],
            "'%s' is not a sphere, so it has no radius", line->name[0]);
    return GLINT_OK;
}

/* ------------------------------------------------------------------ camera */

static enum glint_status apply_orbit_to_camera(const struct steer *s,
                                               struct glint_scene *scene)
{
    struct glint_scene_camera c;
    const enum glint_status status = orbit_camera(s, &c);

    return status == GLINT_OK
               ? glint_scene_set_camera(scene, c.at,
                                        (const int32_t(*)[3])c.axis_q30)
               : status;
}

/* Starts an orbit about the point in front of the camera that is as far away,
 * along the view direction, as the mean position of all visible objects except
 * planes. If that is behind the camera, the distance is one scene unit. */
static void begin_camera_orbit(struct steer *s)
{
    const struct glint_scene_camera *const c = &s->camera;
    double mean[3] = {0, 0, 0}, ahead[3], distance = 0;
    int n = 0;

    for (int i = 0; i < count_objects(s); i++) {
        const struct glint_scene_object *const o = &s->model.object[i];

        if (o->kind == GLINT_OBJECT_PLANE || o->hidden)
            continue;
        for (int k = 0; k < 3; k++)
            mean[k] += o->at[k];
        n++;
    }
    for (int k = 0; k < 3; k++) {
        ahead[k] = c->axis_q30[2][k] * 0x1p-30;
        distance += n ? (mean[k] / n - c->at[k]) * ahead[k] : 0;
    }
    if (!(distance > 0))
        distance = ldexp(1, s->model.header->unit_log2);
    s->orbit = (struct steer_orbit){
        .is_there = true,
        .distance = distance,
        .yaw_deg = atan2(-ahead[0], ahead[2]) / RADIAN,
        .pitch_deg = asin(fmax(-1, fmin(1, -ahead[1]))) / RADIAN};
    for (int k = 0; k < 3; k++)
        s->orbit.middle[k] = c->at[k] + distance * ahead[k];
}

bool steer_record_camera_pose(struct steer *steer, const int32_t at[3],
                              const int32_t axis_q30[3][3])
{
    if (steer->is_free)
        return false;
    memcpy(steer->camera.at, at, sizeof steer->camera.at);
    memcpy(steer->camera.axis_q30, axis_q30, sizeof steer->camera.axis_q30);
    return !steer->orbit.is_there && steer->sensor < 0;
}

static enum glint_status execute_camera_command(struct steer *s,
                                                struct glint_scene *scene,
                                                const struct control_line *line)
{
    const struct steer before = *s;
    const double *const v = line->v;
    enum glint_status status;

    if (!s->orbit.is_there)
        begin_camera_orbit(s);
    s->sensor = -1;
    s->is_free = false;
    if (line->verb == CONTROL_DISTANCE)
        s->orbit.distance = line->is_change
                                ? s->orbit.distance * v[0]
                                : ldexp(v[0], s->model.header->unit_log2);
    else {
        s->orbit.yaw_deg = v[0] + (line->is_change ? s->orbit.yaw_deg : 0);
        s->orbit.pitch_deg = v[1] + (line->is_change ? s->orbit.pitch_deg : 0);
        s->orbit.pitch_deg =
            fmax(-MOST_PITCH, fmin(MOST_PITCH, s->orbit.pitch_deg));
    }
    if (before.sensor >= 0)
        glint_scene_enter(scene, -1);
    status = apply_orbit_to_camera(s, scene);
    if (status == GLINT_OK)
        return status;
    *s = before;
    if (before.sensor >= 0)
        glint_scene_enter(scene, before.sensor);
    return status;
}

/* ----------------------------------------------------- material appearance */

static void change_material_appearance(const struct steer *s,
                                       const struct control_line *line, int i,
                                       struct glint_scene_look *look)
{
    const bool is_specular =
        line->verb == CONTROL_COLOUR && is_brushed_metal(s, i);
    int32_t *const rgb_q15 = is_specular ? look->specular_q15 : look->rgb_q15;

    if (line->verb != CONTROL_ALPHA) {
        for (int c = 0; c < 3; c++)
            rgb_q15[c] = (int32_t)lround(0x1p15 * line->v[c]);
        return;
    }
    for (int k = 0; k < 2; k++) {
        const double v = line->v[line->n == 2 ? k : 0];
        const double alpha =
            line->is_change ? v * look->alpha_q24[k] * 0x1p-24 : v;

        look->alpha_q24[k] =
            (int32_t)ceil(0x1p24 * fmax(LEAST_ALPHA, fmin(MOST_ALPHA, alpha)));
    }
}

/* Returns whether material I with the appearance LOOK reflects at most as much
 * light as it receives. Returns true for all but brushed metal. */
static bool conserves_energy(const struct steer *s, int i,
                             const struct glint_scene_look *look)
{
    bool is = true;

    for (int c = 0; c < 3 && is_brushed_metal(s, i); c++)
        is = is && look->rgb_q15[c] + look->specular_q15[c] <= (1 << 15) + 1;
    return is;
}

/* Changes the appearance of material INDEX, or of all brushed metals if LINE
 * names no material. Changes no material if the result would be invalid for
 * any. */
static enum glint_status
change_appearance_of_materials(struct steer *s, struct glint_scene *scene,
                               const struct control_line *line, int index)
{
    const bool all = !*line->name[0];
    const int end = all ? count_materials(s) : index + 1;
    enum glint_status status = GLINT_OK;
    int i = all ? 0 : index;

    for (; i < end && status == GLINT_OK; i++) {
        struct glint_scene_look look = s->look[i];

        if (all && !is_brushed_metal(s, i))
            continue;
        change_material_appearance(s, line, i, &look);
        status = conserves_energy(s, i, &look)
                     ? glint_scene_set_look(scene, i, &look)
                     : GLINT_E_ARGUMENT;
    }
    while (--i >= (all ? 0 : index)) {
        if (all && !is_brushed_metal(s, i))
            continue;
        if (status == GLINT_OK)
            change_material_appearance(s, line, i, &s->look[i]);
        else
            glint_scene_set_look(scene, i, &s->look[i]);
    }
    return status;
}

/* ----------------------------------------------------------------- objects */

/* Returns the index of the first visible object that is not a shadow catcher,
 * or -1 if there is none. */
static int find_first_object(const struct steer *s)
{
    for (int i = 0; i < count_objects(s); i++)
        if (s->thing[i].is_shown && s->model.object[i].catcher_q15 == 0)
            return i;
    return -1;
}

static enum glint_status change_object_material(struct steer *s,
                                                struct glint_scene *scene,
                                                const struct control_line *line,
                                                const int index[2])
{
    const int i = line->is_change ? find_first_object(s) : index[0];
    int material = index[1];
    enum glint_status status;

    if (i < 0)
        return GLINT_OK;
    if (line->is_change)
        material = s->thing[i].material + 1 < count_materials(s)
                       ? s->thing[i].material + 1
                       : 0;
    status = glint_scene_set_material(scene, i, material);
    if (status == GLINT_OK)
        s->thing[i].material = material;
    return status;
}

static enum glint_status change_object_size(struct steer *s,
                                            struct glint_scene *scene,
                                            const struct control_line *line,
                                            int i)
{
    const double radius = ldexp(line->v[0], s->model.header->unit_log2);
    const int32_t steps = (int32_t)lround(fmin(radius, GLINT_SCENE_SPAN));
    const enum glint_status status = glint_scene_set_radius(scene, i, steps);

    if (status == GLINT_OK)
        s->thing[i].radius = steps;
    return status;
}

/* ------------------------------------------------------------ control line */

static enum glint_status execute_control_line(struct steer *s,
                                              struct glint_scene *scene,
                                              const struct control_line *line,
                                              const char *where,
                                              struct glint_error *error)
{
    enum glint_scene_kind kind;
    enum glint_status status;
    int index[2];

    switch (line->verb) {
    case CONTROL_SENSOR:
    case CONTROL_SCENE:
        return move_camera_to_sensor(s, scene, line);
    case CONTROL_WALK:
    case CONTROL_LOOK:
        return move_camera(s, scene, line);
    case CONTROL_TURN:
    case CONTROL_SCALE:
    case CONTROL_MAP:
    case CONTROL_NEXT_MAP:
        return change_environment(s, scene, line);
    case CONTROL_ORBIT:
    case CONTROL_DISTANCE:
        return execute_camera_command(s, scene, line);
    default:
        break;
    }
    if (is_object_type_name(s, line, &kind))
        return change_objects_of_type(s, scene, line, kind);
    status = find_name_indices(s, line, where, error, index);
    if (status != GLINT_OK)
        return status;
    switch (line->verb) {
    case CONTROL_ALPHA:
    case CONTROL_COLOUR:
    case CONTROL_DIFFUSE:
        return change_appearance_of_materials(s, scene, line, index[0]);
    case CONTROL_MATERIAL:
        return change_object_material(s, scene, line, index);
    case CONTROL_SHOW:
    case CONTROL_HIDE:
        s->thing[index[0]].is_shown = line->verb == CONTROL_SHOW;
        glint_scene_show(scene, index[0], s->thing[index[0]].is_shown);
        return GLINT_OK;
    case CONTROL_SIZE:
        return change_object_size(s, scene, line, index[0]);
    default:
        return GLINT_OK;
    }
}

enum glint_status steer_execute_command(struct steer *steer,
                                        struct glint_scene *scene,
                                        const struct control_line *line,
                                        const char *where,
                                        struct glint_error *error)
{
    enum glint_status status = steer_check_line(steer, line, where, error);

    if (status != GLINT_OK)
        return line->is_change ? GLINT_OK : status;
    status = execute_control_line(steer, scene, line, where, error);
    if (line->is_change)
        return GLINT_OK;
    if (status == GLINT_E_ARGUMENT)
        status = control_set_line_error(
            error, where, line->column,
            is_command_for_material(line)
                ? "the specular and diffuse colours sum to more than 1"
                : "the value is out of the range that the scene was baked for");
    return status;
}

void steer_apply_state(const struct steer *steer, struct glint_scene *scene)
{
    for (int i = 0; i < count_objects(steer); i++) {
        const struct steer_thing *const t = &steer->thing[i];

        glint_scene_show(scene, i, t->is_shown);
        glint_scene_set_material(scene, i, t->material);
        if (t->radius)
            glint_scene_set_radius(scene, i, t->radius);
    }
    for (int i = 0; i < count_materials(steer); i++)
        glint_scene_set_look(scene, i, &steer->look[i]);
    if (count_environments(steer) > 0)
        show_environment(steer, scene);
    apply_object_type_changes(steer, scene);
    if (steer->orbit.is_there)
        apply_orbit_to_camera(steer, scene);
}
