/* SPDX-License-Identifier: MIT
 *
 * glint render of scenes, which takes other options than that of lenses. */
#ifndef GLINT_TOOLS_COMMAND_RENDER_SCENE_H
#define GLINT_TOOLS_COMMAND_RENDER_SCENE_H

#include <stdbool.h>

#include "glint/measure.h"
#include "overlay/drawing.h"

struct render_scene {
    const char *output;
    int width, height;
    int samples; /* 0: the default */
    double exposure_ev;
    bool linear;     /* OUT takes floats */
    bool is_frames;  /* true: poses, frames or a lens are given, so that
                        render_frames() draws */
    bool is_lit;     /* there is an option of the flare */
    bool is_video;   /* --frames FIRST-LAST */
    int first, last; /* frames */
    double fps;
    struct drawing drawing;
    struct glint_float_image image;
};

/* Returns whether a scene, text or baked, is among the arguments. */
bool render_has_scene(int argc, char **argv);

/* As the commands of options/tool.h. */
int cmd_render_scene(int argc, char **argv);

/* Draws the frames FIRST to LAST of the scene PATH, with the flare of the lens
 * if there is one, into r->output. Returns an exit code. */
int render_frames(struct tool *tool, struct render_scene *r, const char *path);

#endif
