/* SPDX-License-Identifier: MIT */
#include "overlay/over_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lamp_files/lamp_keys.h"
#include "motions/time_line.h"
#include "scenes/account.h"

/* ----------------------------------------------------------- control lines */

/* Checks that the command of LINE is valid, except for the value of a flare
 * option, which the lens may not support. */
static enum glint_status check_control_line(const struct over_scene *over,
                                            const struct control_line *line,
                                            const char *where,
                                            struct glint_error *error)
{
    if (line->verb == CONTROL_OPTION)
        return over->set_option ? GLINT_OK
                                : control_set_line_error(
                                      error, where, 1,
                                      "this command changes the flare, but "
                                      "--lens none draws no flare");
    return over->is_open ? steer_check_line(&over->steer, line, where, error)
                         : control_set_line_error(error, where, 1,
                                                  "this command needs --scene");
}

static int open_control_input(struct over_scene *over)
{
    struct glint_error error = {""};
    enum glint_status status;
    const struct control_line *line;

    status = controls_open(&over->control, over->control_file, over->is_live,
                           &error);
    for (int i = 0;
         status == GLINT_OK && (line = controls_get_line(&over->control, i));
         i++) {
        char where[CONTROL_WHERE];

        controls_format_location(&over->control, i, where);
        status = check_control_line(over, line, where, &error);
    }
    if (status != GLINT_OK)
        return tool_fail(over->tool, status, error.text);
    if (over->control.is_keys && !over->tool->quiet)
        fprintf(stderr, "%s\n", keyboard_help);
    return EXIT_OK;
}

static enum glint_status execute_control_line(struct over_scene *over,
                                              const struct control_line *line,
                                              struct glint_error *error)
{
    struct glint_error cause = {""};
    char where[CONTROL_WHERE];
    enum glint_status status;

    controls_format_location(&over->control, -1, where);
    if (line->verb == CONTROL_OPTION && over->set_option) {
        status =
            over->set_option(over->set_ctx, line->name[0], line->v[0], &cause);
        return status == GLINT_OK
                   ? status
                   : control_set_line_error(error, where, line->column,
                                            "%.120s", cause.text);
    }
    if (line->verb == CONTROL_OPTION || !over->is_open)
        return line->is_change ? GLINT_OK
                               : check_control_line(over, line, where, error);
    return playback_execute_command(&over->playback, line)
               ? GLINT_OK
               : steer_execute_command(&over->steer, over->frame.scene, line,
                                       where, error);
}

/* Errors do not end the run. At most one error is printed per picture. */
void over_scene_apply_control(struct over_scene *over, int frame)
{
    const long before = over->control.n_bad;
    const struct control_line *line;

    if (!over->control.is_open || (over->is_open && !over->is_sized))
        return;
    while ((line = controls_next_line(&over->control, frame))) {
        struct glint_error error;

        if (execute_control_line(over, line, &error) != GLINT_OK)
            controls_reject_line(&over->control, &error);
    }
    if (over->control.n_bad > before && !over->tool->quiet)
        fprintf(stderr, "glint %s: %s\n", over->tool->name,
                over->control.bad.text);
}

/* ----------------------------------------------------------------- opening */

static int count_scene_objects(const struct over_scene *over)
{
    return (int)over->baked.model.header->n_objects;
}

static int count_scene_lights(const struct over_scene *over)
{
    return (int)over->baked.model.header->n_lights;
}

/* Returns the index in over->poses.moved of THING: the index of an object,
 * n_objects + that of a light, or POSES_CAMERA. */
static int find_pose_index(const struct over_scene *over, int thing)
{
    return thing == POSES_CAMERA
               ? count_scene_objects(over) + count_scene_lights(over)
               : thing;
}

static int open_pose_file(struct over_scene *over)
{
    struct glint_error error = {""};
    const size_t n = (size_t)find_pose_index(over, POSES_CAMERA) + 1;
    const enum glint_status status =
        poses_open(&over->poses.file, over->pose_file, over->is_live,
                   &over->baked.model, &error);

    if (status != GLINT_OK)
        return tool_fail(over->tool, status, error.text);
    over->poses.moved = calloc(n, sizeof *over->poses.moved);
    if (!over->poses.moved)
        return tool_fail(over->tool, GLINT_E_MEMORY, NULL);
    for (int i = 0; i < count_scene_objects(over); i++)
        memcpy(over->poses.moved[i].turn_q30,
               over->baked.model.object[i].turn_q30,
               sizeof over->poses.moved[i].turn_q30);
    return EXIT_OK;
}

int over_scene_open(struct over_scene *over, const struct tool *tool)
{
    int code;

    over->tool = tool;
    if (!over->file && over->control_file && !over->set_option)
        return tool_usage(tool,
                          "--control needs the flare of a lens or a --scene");
    if (!over->file && over->pose_file)
        return tool_usage(tool,
                          "--pose moves objects of a scene; add --scene FILE");
    if (!over->file)
        return over->control_file ? open_control_input(over) : EXIT_OK;
    code = baked_scene_open(tool, over->file, &over->baked);
    if (code != EXIT_OK)
        return code;
    over->is_open = true;
    playback_init(&over->playback);
    /* Opening the scene has validated the recorded motion, so this succeeds. */
    if (over->baked.model.motion) {
        const char *reason;

        glint_motion_open(&over->motion, over->baked.model.motion + 1,
                          over->baked.model.motion->bytes, &reason);
        over->playback.last = (int)over->motion.header.n_frames - 1;
    }
    if (steer_open(&over->steer, &over->baked.model) != GLINT_OK)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    if (over->pose_file)
        code = open_pose_file(over);
    return code == EXIT_OK && over->control_file ? open_control_input(over)
                                                 : code;
}

bool over_scene_needs_lens(const struct over_scene *over)
{
    return over->is_open &&
           over->baked.model.header->camera.kind == GLINT_CAMERA_LENS;
}

bool over_scene_has_lights_without_flare(const struct over_scene *over)
{
    return over->is_open && count_scene_lights(over) > 0 &&
           !over->baked.model.header->flare;
}

void over_scene_close(struct over_scene *over)
{
    if (over->is_sized)
        scene_frame_close(&over->frame);
    if (over->poses.file.is_open)
        poses_close(&over->poses.file);
    free(over->poses.moved);
    over->poses.moved = NULL;
    controls_close(&over->control);
    glints_close(&over->glints);
    if (over->is_open)
        steer_close(&over->steer);
    if (over->is_open)
        baked_scene_close(&over->baked);
    over->is_open = over->is_sized = false;
}

/* ------------------------------------------------------------------- poses */

/* Sets AXIS to the camera's own axes rotated by the unit quaternion Q, Q30. */
static void rotate_axes_by_quaternion(const int32_t q_q30[4],
                                      int32_t axis_q30[3][3])
{
    double q[4], v[3];

    for (int i = 0; i < 4; i++)
        q[i] = q_q30[i] * 0x1p-30;
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;

        v[k] = 1 - 2 * (q[1 + a] * q[1 + a] + q[1 + b] * q[1 + b]);
        v[a] = 2 * (q[1 + k] * q[1 + a] + q[0] * q[1 + b]);
        v[b] = 2 * (q[1 + k] * q[1 + b] - q[0] * q[1 + a]);
        for (int i = 0; i < 3; i++)
            axis_q30[k][i] = (int32_t)lround(0x1p30 * v[i]);
    }
}

/* Moves the camera to the pose TO, unless control lines have moved it
 * before. */
static enum glint_status move_camera_to_pose(struct over_scene *over,
                                             struct glint_scene *scene,
                                             const struct scene_moved *to)
{
    int32_t axis_q30[3][3];

    if (to->turn_q30[0] || to->turn_q30[1] || to->turn_q30[2] ||
        to->turn_q30[3])
        rotate_axes_by_quaternion(to->turn_q30, axis_q30);
    else
        memcpy(axis_q30, over->baked.model.header->camera.axis_q30,
               sizeof axis_q30);
    return steer_record_camera_pose(&over->steer, to->at,
                                    (const int32_t(*)[3])axis_q30)
               ? glint_scene_set_camera(scene, to->at,
                                        (const int32_t(*)[3])axis_q30)
               : GLINT_OK;
}

static enum glint_status apply_pose(struct over_scene *over,
                                    struct glint_scene *scene, int i)
{
    const struct scene_moved *const to = &over->poses.moved[i];

    if (!to->is_moved)
        return GLINT_OK;
    if (i < count_scene_objects(over))
        return glint_scene_set_pose(scene, i, to->at, to->turn_q30);
    if (i < count_scene_objects(over) + count_scene_lights(over))
        return glint_scene_set_light(scene, i - count_scene_objects(over),
                                     to->at);
    return move_camera_to_pose(over, scene, to);
}

/* Applies all poses and recorded changes again, after SCENE was initialised in
 * new memory. */
static void apply_all_poses(void *ctx, struct glint_scene *scene)
{
    struct over_scene *const over = ctx;

    glint_scene_seek(scene, (uint32_t)over->shown);
    for (int i = 0;
         over->poses.moved && i <= find_pose_index(over, POSES_CAMERA); i++)
        apply_pose(over, scene, i);
    steer_apply_state(&over->steer, scene);
}

/* Resets objects, lights and camera to their poses in the scene file. */
static void reset_all_poses(struct over_scene *over)
{
    const struct glint_scene_model *const m = &over->baked.model;
    struct glint_scene *const scene = over->frame.scene;

    for (int i = 0; i < count_scene_objects(over); i++)
        glint_scene_set_pose(scene, i, m->object[i].at, m->object[i].turn_q30);
    for (int i = 0; i < count_scene_lights(over); i++)
        glint_scene_set_light(scene, i,
                              m->light[i].kind == GLINT_LIGHT_SUN
                                  ? m->light[i].toward_q30
                                  : m->light[i].at);
    glint_scene_set_camera(scene, m->header->camera.at,
                           (const int32_t(*)[3])m->header->camera.axis_q30);
    steer_apply_state(&over->steer, scene);
    for (int i = 0; i <= find_pose_index(over, POSES_CAMERA); i++)
        over->poses.moved[i].is_moved = false;
}

/* Applies the poses of all frames up to FRAME. If FRAME is earlier than before,
 * starts again at the first line of the pose file. */
static void apply_poses_up_to_frame(struct over_scene *over, int frame)
{
    const struct pose *pose;

    if (frame < over->poses.frame && poses_rewind(&over->poses.file))
        reset_all_poses(over);
    over->poses.frame = frame;
    while ((pose = poses_next_pose(&over->poses.file, frame))) {
        const int i = find_pose_index(over, pose->thing);
        const struct scene_moved before = over->poses.moved[i];

        over->poses.moved[i].is_moved = true;
        memcpy(over->poses.moved[i].at, pose->at, sizeof pose->at);
        if (pose->has_turn)
            memcpy(over->poses.moved[i].turn_q30, pose->turn_q30,
                   sizeof pose->turn_q30);
        if (apply_pose(over, over->frame.scene, i) != GLINT_OK) {
            over->poses.moved[i] = before;
            poses_reject_line(&over->poses.file, pose);
        }
    }
    if (over->poses.file.n_bad > 0 && !over->poses.has_warned &&
        !over->tool->quiet)
        fprintf(stderr, "glint %s: %s; such lines are skipped\n",
                over->tool->name, over->poses.file.bad.text);
    over->poses.has_warned = over->poses.file.n_bad > 0;
}

/* ----------------------------------------------------------------- drawing */

static int allocate_scene_frame(struct over_scene *over,
                                const struct scene_dials *dials)
{
    int code;

    if (over->is_sized)
        scene_frame_close(&over->frame);
    code =
        scene_frame_open(&over->frame, over->tool, &over->baked.model, dials);
    over->is_sized = code == EXIT_OK;
    over->frame.pose = apply_all_poses;
    over->frame.pose_ctx = over;
    return code;
}

int over_scene_allocate(struct over_scene *over,
                        const struct scene_dials *dials)
{
    if (!over->is_open)
        return EXIT_OK;
    glints_close(&over->glints);
    if (glints_open(&over->glints, dials->width, dials->height) != GLINT_OK)
        return tool_fail(over->tool, GLINT_E_MEMORY, NULL);
    scene_budget_init(&over->budget, dials);
    return allocate_scene_frame(over, dials);
}

/* Draws the following frames with the quality parameters of LEVEL. */
static enum glint_status set_scene_quality_level(struct over_scene *over,
                                                 int level)
{
    const struct scene_dials dials =
        scene_budget_get_parameters(&over->budget, level);

    over->budget.level = level;
    return allocate_scene_frame(over, &dials) == EXIT_OK ? GLINT_OK
                                                         : GLINT_E_MEMORY;
}

enum glint_status over_scene_set_quality(struct over_scene *over,
                                         double quality)
{
    const int level = scene_budget_find_level_of_quality(quality);

    return over->is_sized && !(over->budget_ms > 0) &&
                   level != over->budget.level
               ? set_scene_quality_level(over, level)
               : GLINT_OK;
}

enum glint_status over_scene_draw(struct over_scene *over,
                                  const struct glint_image *image, int frame)
{
    const double start = tool_clock_s();
    enum glint_status status;

    over_scene_apply_control(over, frame);
    over->shown =
        over->control_file
            ? playback_next_frame(&over->playback, 1e-6 * over->elapsed_us)
            : frame;
    glint_scene_seek(over->frame.scene, (uint32_t)over->shown);
    if (over->poses.moved)
        apply_poses_up_to_frame(over, over->shown);
    status = over->budget_ms > 0 &&
                     scene_budget_update_level(&over->budget, over->ms,
                                               over->budget_ms)
                 ? set_scene_quality_level(over, over->budget.level)
                 : GLINT_OK;
    if (status == GLINT_OK)
        status = scene_frame_draw_once(&over->frame, image);
    over->ms = 1e3 * (tool_clock_s() - start);
    over->lamps_hidden = over->lights = 0;
    return status;
}

void over_scene_draw_time_line(const struct over_scene *over,
                               const struct glint_image *image)
{
    struct glint_motion motion = over->motion;

    if (over->is_open && over->baked.model.motion)
        draw_time_line(image, &motion, over->shown);
}

/* ------------------------------------------------------------------- layer */

void over_scene_layer_free(struct over_scene_layer *layer)
{
    free(layer->rgb);
    free(layer->cover_q8);
    *layer = (struct over_scene_layer){NULL, NULL};
}

/* Draws the scene over a uniform picture of LIGHT, Q20, into LINEAR_Q20[n]. */
static void draw_scene_over_light(struct over_scene *over, int32_t light,
                                  size_t n, int32_t *linear_q20)
{
    struct glint_image image = {.format = GLINT_LINEAR_Q20,
                                .width = over->frame.cfg.width,
                                .height = over->frame.cfg.height};

    for (size_t i = 0; i < n; i++)
        linear_q20[i] = light;
    glint_image_place(&image, linear_q20);
    glint_scene_draw(over->frame.scene, &image);
}

/* The coverage of a pixel is 1 + (scene over black) - (scene over white), where
 * white is 1. */
enum glint_status over_scene_make_layer(struct over_scene *over,
                                        struct over_scene_layer *layer)
{
    const size_t n =
        (size_t)over->frame.cfg.width * (size_t)over->frame.cfg.height;
    int32_t *const linear_q20 = calloc(3 * n, sizeof *linear_q20);

    layer->rgb = malloc(3 * n * sizeof *layer->rgb);
    layer->cover_q8 = malloc(n * sizeof *layer->cover_q8);
    if (!linear_q20 || !layer->rgb || !layer->cover_q8) {
        free(linear_q20);
        over_scene_layer_free(layer);
        return GLINT_E_MEMORY;
    }
    draw_scene_over_light(over, 0, 3 * n, linear_q20);
    for (size_t i = 0; i < n; i++)
        for (size_t c = 3 * i; c < 3 * i + 3; c++)
            layer->rgb[c] = (float)linear_q20[c] * 0x1p-20F;
    draw_scene_over_light(over, 1 << 20, 3 * n, linear_q20);
    for (size_t i = 0; i < n; i++)
        layer->cover_q8[i] =
            (uint16_t)lrintf(256 + 256 * layer->rgb[3 * i] -
                             0x1p-12F * (float)linear_q20[3 * i]);
    free(linear_q20);
    return GLINT_OK;
}

/* ------------------------------------------------------------------- lamps */

/* First id of highlights. Lamps with names have larger ids, from LAMP_ID_TEXT
 * on. Other lamps have smaller ids, unless a list sets very large ones. */
#define HIGHLIGHT_IDS UINT32_C(0x7ffe0000)

int over_scene_add_highlights(struct over_scene *over, bool follows,
                              const struct glint_view *view, double focal_mm,
                              struct glint_engine_lamp *lamps)
{
    struct glints *const g = &over->glints;
    const int n = glints_track_frame(g, over->frame.scene,
                                     follows ? over->elapsed_us : 0);

    for (int i = 0; i < n; i++) {
        struct glint_lamp lamp = {.power = 0};
        const double level = glints_get_lamp(g, i, view, focal_mm, &lamp);

        lamps[i] = glint_engine_lamp_of(&lamp, LAMP_ID_TEXT + HIGHLIGHT_IDS +
                                                   g->track[i].id % 65536);
        lamps[i].level = level;
        lamps[i].seen_px = g->track[i].size_q8 / 256.0;
    }
    return n;
}

/* ------------------------------------------------------------------ report */

size_t over_scene_count_memory_bytes(const struct over_scene *over)
{
    return over->is_sized ? over->frame.bytes : 0;
}

void over_scene_print_line(const struct over_scene *over, FILE *to)
{
    fprintf(to, "scene %s, %d of %d objects", over->baked.model.header->name,
            over->frame.stats.objects, count_scene_objects(over));
    if (over->lamps_hidden > 0)
        fprintf(to, " hiding %d light%s", over->lamps_hidden,
                over->lamps_hidden == 1 ? "" : "s");
    if (over->poses.file.n_bad > 0)
        fprintf(to, ", %ld line%s of poses skipped", over->poses.file.n_bad,
                over->poses.file.n_bad == 1 ? "" : "s");
}

void over_scene_write_json(struct json_writer *json,
                           const struct over_scene *over)
{
    if (!over->is_sized)
        return;
    json_write(json, "scene: {");
    scene_account_write_json(json, &over->frame, over->baked.bytes);
    json_write(json, "quality: %.3f, lights: %d",
               scene_budget_get_flare_quality(&over->budget), over->lights);
    scene_write_highlights_json(json, &over->frame);
    json_write(json, "lamps_hidden: %d, poses_bad: %ld, control_bad: %ld}",
               over->lamps_hidden, over->poses.file.n_bad, over->control.n_bad);
}
