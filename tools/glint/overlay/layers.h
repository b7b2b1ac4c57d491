/* SPDX-License-Identifier: MIT
 *
 * layers.h - the flare as separate layers of linear light for compositing:
 * flare (the sum), ghosts, starburst, and veil if enabled.
 *
 * The layers are parts of one file, flare.exr, or single files if the name has
 * a %s: flare-%s.exr. A %d or %04d in the name stands for the frame number,
 * from 0. */
#ifndef GLINT_TOOLS_OVERLAY_LAYERS_H
#define GLINT_TOOLS_OVERLAY_LAYERS_H

#include "overlay/apart.h"
#include "overlay/drawing.h"

struct layers {
    const char *path; /* output file or pattern; NULL: no layers are written */
    /* whether files have 32-bit floats instead of half floats */
    bool is_float;
};

/* Checks before drawing that the files of LAYERS can be written. If IS_VIDEO,
 * their name must have a frame number. Returns an exit code. */
int layers_check_file_names(const struct tool *tool,
                            const struct layers *layers, bool is_video);

/* Checks by file_conflicts_check_outputs() the files of FILES and the output
 * files of LAYERS. Returns its exit code. */
int layers_check_outputs(const struct tool *tool, const struct layers *layers,
                         const struct apart *files);

/* Draws and writes the layers of the present frame of DRAWING, after the
 * exposure was set. Does nothing if no layers are requested. Returns an exit
 * code. */
int layers_write(const struct tool *tool, const struct layers *layers,
                 struct drawing *drawing);

#endif
