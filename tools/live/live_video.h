/* SPDX-License-Identifier: MIT
 *
 * live_video.h - a y4m video as a source of live frames: a file at its own
 * rate, with late frames left out as from a camera, or a pipe, each frame as it
 * comes. After the last frame next fails with GLINT_E_CLOSED.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_VIDEO_H
#define GLINT_TOOLS_LIVE_LIVE_VIDEO_H

#include "video/y4m.h"
#include "live/live_timed.h"

struct live_video {
    struct live_timed timed;
    struct glint_y4m_reader reader;
};

/* Opens the video that is the device of WISH, FILE.y4m or "-". WISH may
 * overrule rate, range and matrix. On failure VIDEO is closed. */
enum glint_status live_video_open(struct live_video *video,
                                  const struct glint_v4l2_config *wish,
                                  struct glint_error *error);

#endif
