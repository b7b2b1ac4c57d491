/* SPDX-License-Identifier: MIT
 *
 * layers.h - the parts of a flare as layers of linear light, to be added to a
 * picture one by one: flare (their sum), ghosts, starburst, and veil where one
 * is requested.
 *
 * All in one file with a part for each, flare.exr, or a file for each where the
 * name has a %s, flare-%s.exr. A %d or %04d stands for the frame, from 0.
 */
#ifndef GLINT_TOOLS_OVERLAY_LAYERS_H
#define GLINT_TOOLS_OVERLAY_LAYERS_H

#include "overlay/apart.h"
#include "overlay/drawing.h"

struct layers {
    const char *path; /* NULL: no layers are requested */
    bool is_float;    /* else half */
};

/* Checks, before there is work, whether LAYERS can be written, with a name for
 * each frame of a video or sequence. Returns an exit code. */
int layers_check(const struct tool *tool, const struct layers *layers,
                 bool is_video);

/* Does as apart_check() for FILES and those of LAYERS, whose %s is each layer.
 */
int layers_check_apart(const struct tool *tool, const struct layers *layers,
                       const struct apart *files);

/* Draws the layers of DRAWING's frame, whose lamps and exposure are set, and
 * writes them. Does nothing if none are requested. Returns an exit code. */
int layers_write(const struct tool *tool, const struct layers *layers,
                 struct drawing *drawing);

#endif
