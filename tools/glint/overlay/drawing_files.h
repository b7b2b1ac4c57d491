/* SPDX-License-Identifier: MIT
 *
 * Opens the files that the options of a drawing name: lens, scene, key frames,
 * list of lamps, mask that occludes lamps, and output file of lamps.
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
    /* whether there is a lens; --lens none draws the scene only */
    bool has_lens;
    struct opened_lens lens;
    /* whether --lights sets the lamps, so that none are detected */
    bool is_listed;
    struct lamp_list list; /* lamps of --lights, --light-at and key frames */
    int first_at;          /* index in LIST of the first lamp of --light-at */
    struct keys keys;
    /* "FILE:LINE" of the key frame that sets the f-number of the lens */
    char keys_line[224];
    struct occlusion occlusion; /* mask that occludes lamps */
    struct over_scene scene;
    struct lamp_save save;
};

/* Opens the files that LINE names, and bakes the lens if needed. FILES must be
 * zeros, except scene.set_option and scene.set_ctx, by which control lines set
 * options. Returns an exit code. */
int drawing_files_open(const struct tool *tool, struct drawing_line *line,
                       struct drawing_files *files);

void drawing_files_close(struct drawing_files *files);

#endif
