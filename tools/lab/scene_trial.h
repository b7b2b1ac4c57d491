/* SPDX-License-Identifier: MIT
 *
 * A scene that is drawn onto a canvas again and again, with dials of its own,
 * and timed by stage.
 *
 *     scene_trial_open(&trial, tool, &model, &bare, &dials, &canvas);
 *     scene_trial_warm(&trial);
 *     scene_trial_run(&trial, counter, round);             0, 1, 2 ...
 *     scene_trial_close(&trial);
 *
 * Before each frame the first thing is put anew where it is, so that lists of
 * shadows are made as if it had moved. */
#ifndef GLINT_TOOLS_LAB_SCENE_TRIAL_H
#define GLINT_TOOLS_LAB_SCENE_TRIAL_H

#include "lab/canvas.h"
#include "scenes/baked_scene.h"
#include "scenes/scene_frame.h"

enum { SCENE_ROUNDS = 100 };

/* SHADOWS is a part of DRAW: what a scene without them does not take. */
enum scene_stage {
    SCENE_PREPARE, /* what may be seen, lists of shadows */
    SCENE_AROUND,  /* the picture, small, for mirrors and glass */
    SCENE_DRAW,
    SCENE_SHADOWS,
    SCENE_LIGHTS, /* what a lens is told of */
    SCENE_WHOLE,  /* all of these but SHADOWS, which is in DRAW */
    SCENE_STAGES
};

struct scene_trial {
    struct tool tool; /* the command's, or one with other threads and sets */
    struct canvas *canvas;
    struct scene_frame frame;

    struct scene_frame bare; /* without shadows; scene NULL: not asked for */

    double ms[SCENE_STAGES][SCENE_ROUNDS];
    double instructions; /* of the last frame; NAN: they are not counted */
    int covered_px;
};

/* Prepares TRIAL, of zeros, which must not be moved afterwards, for frames of
 * MODEL on CANVAS. BARE is the same without shadows, or NULL. All are kept, as
 * are the workers of TOOL. Returns an exit code. */
int scene_trial_open(struct scene_trial *trial, const struct tool *tool,
                     const struct glint_scene_model *model,
                     const struct glint_scene_model *bare,
                     const struct scene_dials *dials, struct canvas *canvas);
void scene_trial_close(struct scene_trial *trial);

/* Draws a frame that is not timed. */
enum glint_status scene_trial_warm(struct scene_trial *trial);

/* Draws a frame and notes its times as those of round ROUND, and its
 * instructions by COUNTER, unless that is -1. */
void scene_trial_run(struct scene_trial *trial, int counter, int round);

/* Returns whether "--scene" is in the line: a command that also does without a
 * scene takes other options then. */
bool scene_trial_is_asked(int argc, char **argv);

/* Opens the scene FILE, which has a camera of its own. Returns an exit code,
 * after printing the reason on failure. */
int scene_trial_scene(const struct tool *tool, const char *file,
                      struct baked_scene *scene);

/* Sets BARE to SCENE without shadows. GLINT_E_MEMORY. */
enum glint_status scene_trial_bare(const struct baked_scene *scene,
                                   struct baked_scene *bare);

#endif
