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
    double from, to; /* zoom at first and last frame, both mm or both 0 .. 1, as
                        --zoom */
    char label[80];  /* "--zoom A-B", used in error messages */
    char *keys;      /* text of the key frames */
};

/* Parses TEXT, "A-B". Returns false if it is malformed. */
bool zoom_clip_parse(struct zoom_clip *clip, const char *text);

/* If --zoom A-B was given, sets key frames in LINE over all frames of the video
 * INPUT; call it before the line is opened. INPUT is NULL if the input is not a
 * video, which is then an error. Returns an exit code. */
int zoom_clip_open(struct tool *tool, struct zoom_clip *clip, const char *input,
                   struct drawing_line *line);

void zoom_clip_close(struct zoom_clip *clip);

#endif
