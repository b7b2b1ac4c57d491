/* SPDX-License-Identifier: MIT
 *
 * What is opened from a drawing_line: lens and scene, key frames, lists and
 * masks of lamps, and the file that lamps are saved to.
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
    bool has_lens; /* false: there is only a scene */
    struct opened_lens lens;
    bool is_listed;        /* no lamp is found: a list or none has all */
    struct lamp_list list; /* lamps of --lights, by pixel and of key frames */
    struct keys keys;
    char keys_line[224];        /* "FILE:LINE" of the requested f-number */
    struct occlusion occlusion; /* what hides lamps */
    struct over_scene scene;    /* objects over the picture */
    struct lamp_save save;
};

/* Opens what LINE names; bakes the lens if need be. FILES is zeros, but for
 * scene.set_option and its context, which serve lines of control.
 * Returns an exit code. */
int drawing_files_open(const struct tool *tool, struct drawing_line *line,
                       struct drawing_files *files);

void drawing_files_close(struct drawing_files *files);

#endif
