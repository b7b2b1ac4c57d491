/* SPDX-License-Identifier: MIT
 *
 * panel/y4m_sink.h - frames as YUV4MPEG2 (video/y4m.h), as a sink.
 *
 * The stream is opened with the first frame, whose size, format and range all
 * must have. Formats that Y4M does not know are written as planes
 * (panel/planar.h); RGB is of limited range then, as most readers expect. The
 * matrix goes unsaid, for Y4M has no word for it: readers take BT.601 below 720
 * lines, and RGB is written so.
 *
 * A reader of a pipe that has not taken the last frame costs this one, which is
 * counted: what is live does not queue. Once begun, a frame is finished.
 */
#ifndef GLINT_PLATFORM_PANEL_Y4M_SINK_H
#define GLINT_PLATFORM_PANEL_Y4M_SINK_H

#include "panel/planar.h"
#include "video/y4m.h"
#include "source_sink.h"

struct glint_y4m_sink {
    struct glint_sink sink; /* close puts a file in place */
    long n_frames;          /* written */
    long n_dropped;         /* frames that the reader was too slow for */

    /* Private. */
    const char *path; /* kept */
    int fps_num, fps_den;
    bool is_open;
    struct glint_image like; /* the first frame, without its memory */
    struct glint_image planes;
    struct glint_row_rgb row;
    void *mem; /* memory of both; NULL: frames are written as they are */
    struct glint_y4m_writer writer;
};

/* PATH is kept; "-": standard output. Rate as in video/y4m.h. Nothing can
 * fail before the first frame. */
void glint_y4m_sink_open(struct glint_y4m_sink *y4m, const char *path,
                         int fps_num, int fps_den);

/* Closes Y4M and says whether all was written. GLINT_E_OUTPUT, _CLOSED. */
enum glint_status glint_y4m_sink_finish(struct glint_y4m_sink *y4m,
                                        struct glint_error *error);

#endif
