/* SPDX-License-Identifier: MIT
 *
 * live_video.h - a y4m video as a source of live frames: a file at its own
 * rate, frames that are late left out as of a camera, or a pipe, each frame as
 * it comes. At its end next fails with GLINT_E_CLOSED.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_VIDEO_H
#define GLINT_TOOLS_LIVE_LIVE_VIDEO_H

#include "video/y4m.h"
#include "live/live_timed.h"

struct live_video {
    struct live_timed timed;
    struct glint_y4m_reader reader;
};

/* WISH, whose device is FILE.y4m or "-", may overrule rate and codes. On
 * failure VIDEO is closed. */
enum glint_status live_video_open(struct live_video *video,
                                  const struct glint_v4l2_config *wish,
                                  struct glint_error *error);

#endif
