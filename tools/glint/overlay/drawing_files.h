/* SPDX-License-Identifier: MIT
 *
 * The open files that the options of a drawing_line name: lens, scene, key
 * frames, list of lamps, mask that hides lamps, and the output file of lamps.
 */
#ifndef GLINT_TOOLS_OVERLAY_DRAWING_FILES_H
#define GLINT_TOOLS_OVERLAY_DRAWING_FILES_H

#include "desk/keys.h"
#include "desk/occlusion.h"
#include "lamp_files/lamp_list.h"
#include "lamp_files/lamp_save.h"
#include "model/opened_lens.h"
#include "overlay/drawing_line.h"
#include "overlay/over_scene.h"

struct drawing_files {
    bool has_lens; /* whether there is a lens; false with --lens none, which
                    * draws the scene only */
    struct opened_lens lens;
    /* true: --lights lists the lamps, so none are detected */
    bool is_listed;
    struct lamp_list list; /* lamps of --lights, --light-at and key frames */
    struct keys keys;
    char keys_line[224]; /* "FILE:LINE" of the key frame that sets the f-number
                          */
    struct occlusion occlusion; /* mask that hides lamps */
    struct over_scene scene;    /* objects over the picture */
    struct lamp_save save;
};

/* Opens the files that LINE names, and bakes the lens if needed. FILES must be
 * zeros except scene.set_option and scene.set_ctx, which control lines use.
 * Returns an exit code. */
int drawing_files_open(const struct tool *tool, struct drawing_line *line,
                       struct drawing_files *files);

void drawing_files_close(struct drawing_files *files);

#endif
