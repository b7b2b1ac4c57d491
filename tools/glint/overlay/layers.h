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
    const char *path; /* output file, or NULL if no layers are requested */
    bool is_float;    /* 32-bit floats; else half floats */
};

/* Checks before drawing whether the LAYERS files can be written. IS_VIDEO: the
 * name must have a frame number. Returns an exit code. */
int layers_check_file_names(const struct tool *tool,
                            const struct layers *layers, bool is_video);

/* Calls file_conflicts_check_outputs() for FILES plus the output files of all
 * LAYERS. Returns its exit code. */
int layers_check_outputs(const struct tool *tool, const struct layers *layers,
                         const struct apart *files);

/* Draws and writes the layers of the current frame of DRAWING, whose lamps and
 * exposure must be set. No-op if no layers are requested. Returns an exit
 * code. */
int layers_write(const struct tool *tool, const struct layers *layers,
                 struct drawing *drawing);

#endif
