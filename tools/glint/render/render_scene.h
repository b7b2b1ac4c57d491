/* SPDX-License-Identifier: MIT
 *
 * glint render for scenes. Its options differ from glint render for lenses. */
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
    bool linear;     /* the format of OUTPUT has floats */
    bool is_frames;  /* poses, frames or a lens are given: render_frames()
                        draws */
    bool is_lit;     /* an option of the flare was given */
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

/* Draws frames r->first to r->last of the scene PATH to r->output, with the
 * flare of the lens if there is one. Returns an exit code. */
int render_frames(struct tool *tool, struct render_scene *r, const char *path);

#endif
