/* SPDX-License-Identifier: MIT */
#include "lab/scene_trial.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linux/instructions.h"
#include "scenes/account.h"
#include "scenes/baked_scene.h"

/* Puts the first thing where it is. */
static void stir(void *ctx, struct glint_scene *scene)
{
    const struct scene_frame *const frame = ctx;
    const struct glint_scene_model *const model = frame->model;

    if (model->header->n_objects > 0)
        glint_scene_set_pose(scene, 0, model->object[0].at,
                             model->object[0].turn_q30);
}

static int open_frame(struct scene_trial *t, struct scene_frame *frame,
                      const struct glint_scene_model *model,
                      const struct scene_dials *dials)
{
    const int code = scene_frame_open(frame, &t->tool, model, dials);

    frame->pose = stir;
    frame->pose_ctx = frame;
    return code;
}

int scene_trial_open(struct scene_trial *trial, const struct tool *tool,
                     const struct glint_scene_model *model,
                     const struct glint_scene_model *bare,
                     const struct scene_dials *dials, struct canvas *canvas)
{
    int code;

    trial->tool = *tool;
    trial->canvas = canvas;
    trial->instructions = (double)NAN;
    code = open_frame(trial, &trial->frame, model, dials);
    return code == EXIT_OK && bare
               ? open_frame(trial, &trial->bare, bare, dials)
               : code;
}

void scene_trial_close(struct scene_trial *trial)
{
    scene_frame_close(&trial->frame);
    scene_frame_close(&trial->bare);
}

enum glint_status scene_trial_warm(struct scene_trial *trial)
{
    enum glint_status status = GLINT_OK;

    if (trial->bare.scene)
        status = scene_frame_try(&trial->bare, &trial->canvas->image);
    canvas_fresh(trial->canvas);
    if (status == GLINT_OK)
        status = scene_frame_try(&trial->frame, &trial->canvas->image);
    if (status == GLINT_OK)
        trial->covered_px = scene_covered_px(&trial->frame);
    return status;
}

/* Draws a frame. Notes the times at which stages begin, and the end. */
static void draw(struct scene_frame *frame, const struct glint_image *image,
                 double at_s[5])
{
    struct glint_scene_lamp lamps[GLINT_SCENE_MAX_LIGHTS];

    at_s[0] = tool_seconds();
    scene_frame_begin(frame);
    at_s[1] = tool_seconds();
    glint_scene_look_around(frame->scene, image);
    at_s[2] = tool_seconds();
    glint_scene_draw(frame->scene, image);
    at_s[3] = tool_seconds();
    glint_scene_lights(frame->scene, lamps);
    at_s[4] = tool_seconds();
}

void scene_trial_run(struct scene_trial *trial, int counter, int round)
{
    static const struct {
        enum scene_stage stage;
        int from, to;
    } spans[] = {{SCENE_PREPARE, 0, 1},
                 {SCENE_AROUND, 1, 2},
                 {SCENE_DRAW, 2, 3},
                 {SCENE_LIGHTS, 3, 4},
                 {SCENE_WHOLE, 0, 4}};
    double at_s[5];
    uint64_t before;

    canvas_fresh(trial->canvas);
    before = counter >= 0 ? glint_instructions_read(counter) : 0;
    draw(&trial->frame, &trial->canvas->image, at_s);
    if (counter >= 0)
        trial->instructions =
            (double)(glint_instructions_read(counter) - before);
    for (size_t i = 0; i < sizeof spans / sizeof *spans; i++)
        trial->ms[spans[i].stage][round] =
            1e3 * (at_s[spans[i].to] - at_s[spans[i].from]);
    trial->ms[SCENE_SHADOWS][round] = 0;
    if (!trial->bare.scene)
        return;
    canvas_fresh(trial->canvas);
    draw(&trial->bare, &trial->canvas->image, at_s);
    trial->ms[SCENE_SHADOWS][round] =
        trial->ms[SCENE_DRAW][round] - 1e3 * (at_s[3] - at_s[2]);
}

bool scene_trial_is_asked(int argc, char **argv)
{
    for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
        if (strcmp(argv[i], "--scene") == 0 ||
            strncmp(argv[i], "--scene=", 8) == 0)
            return true;
    return false;
}

int scene_trial_scene(const struct tool *tool, const char *file,
                      struct baked_scene *scene)
{
    const int code = baked_scene_open(tool, file, scene);

    if (code != EXIT_OK ||
        scene->model.header->camera.kind != GLINT_CAMERA_LENS)
        return code;
    baked_scene_close(scene);
    return tool_usage(tool,
                      "%s: 'camera lens' needs the lens of a flare; here it "
                      "takes 'camera fov'",
                      file);
}

enum glint_status scene_trial_bare(const struct baked_scene *scene,
                                   struct baked_scene *bare)
{
    const char *unsaid;
    struct glint_scene_header *header = malloc(scene->bytes);

    if (!header)
        return GLINT_E_MEMORY;
    *bare = (struct baked_scene){.data = header, .bytes = scene->bytes};
    memcpy(header, scene->data, scene->bytes);
    glint_scene_open(&bare->model, header, scene->bytes, &unsaid);
    header->shadow = 0; /* after its checksum was asked for */
    return GLINT_OK;
}
