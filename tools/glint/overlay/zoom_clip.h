/* SPDX-License-Identifier: MIT
 *
 * zoom_clip.h - "--zoom A-B": a zoom over a whole video, evenly.
 *
 *     zoom_clip_take(&clip, "60-140")               an option
 *     zoom_clip_open(tool, &clip, input, &line);
 *
 * Of focal lengths each frame's is the same number of times the one before's,
 * as by a zoom ring that turns evenly. They become key frames. */
#ifndef GLINT_TOOLS_OVERLAY_ZOOM_CLIP_H
#define GLINT_TOOLS_OVERLAY_ZOOM_CLIP_H

#include "overlay/drawing_line.h"

struct zoom_clip {
    bool is_asked;
    double from, to; /* mm, or 0 to 1 along the way, both */
    char label[80];  /* "--zoom A-B", for errors */
    char *keys;      /* text of the key frames */
};

/* Takes TEXT, "A-B"; returns false for other texts. */
bool zoom_clip_take(struct zoom_clip *clip, const char *text);

/* Gives LINE, which is not open yet, key frames over all frames of the
 * video INPUT, if that was requested; NULL: it is no video. Returns an exit
 * code. */
int zoom_clip_open(struct tool *tool, struct zoom_clip *clip, const char *input,
                   struct drawing_line *line);

void zoom_clip_close(struct zoom_clip *clip);

#endif
