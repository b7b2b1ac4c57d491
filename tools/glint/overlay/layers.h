/* SPDX-License-Identifier: MIT
 *
 * layers.h - the flare as separate layers of linear light for compositing:
 * flare (the sum), ghosts, starburst, and veil if it is requested.
 *
 * All layers are in one file with a part each, flare.exr, or, if the name has a
 * %s, in a file each, flare-%s.exr. A %d or %04d stands for the frame, from
 * 0. */
#ifndef GLINT_TOOLS_OVERLAY_LAYERS_H
#define GLINT_TOOLS_OVERLAY_LAYERS_H

#include "overlay/apart.h"
#include "overlay/drawing.h"

struct layers {
    const char *path; /* output file, or NULL if no layers are requested */
    bool is_float;    /* 32-bit floats; else half floats */
};

/* Checks early whether LAYERS can be written; for a video or sequence
 * (IS_VIDEO) the name must have the frame's number. Returns an exit code. */
int layers_check(const struct tool *tool, const struct layers *layers,
                 bool is_video);

/* Calls apart_check() for FILES and the files of all LAYERS. */
int layers_check_apart(const struct tool *tool, const struct layers *layers,
                       const struct apart *files);

/* Draws and writes the layers of DRAWING's frame, whose lamps and exposure must
 * be set. Does nothing if no layers are requested. Returns an exit code. */
int layers_write(const struct tool *tool, const struct layers *layers,
                 struct drawing *drawing);

#endif
