/* SPDX-License-Identifier: MIT
 *
 * zoom_clip.h - "--zoom A-B": a smooth zoom over a whole video.
 *
 *     zoom_clip_parse(&clip, "60-140")               an option
 *     zoom_clip_open(tool, &clip, input, &line);
 *
 * If A and B are focal lengths, their ratio from frame to frame is constant, as
 * by a zoom ring that turns evenly. The zoom becomes key frames. */
#ifndef GLINT_TOOLS_OVERLAY_ZOOM_CLIP_H
#define GLINT_TOOLS_OVERLAY_ZOOM_CLIP_H

#include "overlay/drawing_line.h"

struct zoom_clip {
    bool is_asked;
    /* zoom in the first and last frame: both mm, or both 0 .. 1 */
    double from, to;
    char label[80]; /* "--zoom A-B", used in error messages */
    char *keys;
};

/* Parses TEXT, "A-B". Returns false if it is malformed. */
bool zoom_clip_parse(struct zoom_clip *clip, const char *text);

/* If --zoom A-B was given, stores its key frames for the video INPUT in LINE,
 * which must not be open yet. INPUT is NULL if the input is not a video; then
 * --zoom A-B is an error. Returns an exit code. */
int zoom_clip_open(struct tool *tool, struct zoom_clip *clip, const char *input,
                   struct drawing_line *line);

void zoom_clip_close(struct zoom_clip *clip);

#endif
