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
    int samples; /* samples per pixel at outlines; 0: the default */
    double exposure_ev;
    bool linear; /* whether OUTPUT stores floats, and so linear light */
    /* whether --pose, --frame, --frames or --lens was given, so that
     * render_frames() draws */
    bool is_frames;
    bool is_lit;   /* whether an option of the flare was given */
    bool is_video; /* --frames FIRST-LAST */
    int first, last;
    double fps;
    struct drawing drawing;
    struct glint_float_image image;
};

/* Returns whether one of the arguments is a scene, as a text or baked. */
bool render_has_scene(int argc, char **argv);

/* Runs the command; see options/tool.h for the arguments and the result. */
int cmd_render_scene(int argc, char **argv);

/* Draws the frames r->first to r->last of the scene PATH to r->output, with the
 * flare of the lens if a lens was given. Returns an exit code. */
int render_frames(struct tool *tool, struct render_scene *r, const char *path);

#endif
