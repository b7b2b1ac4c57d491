/* SPDX-License-Identifier: MIT
 *
 * panel/sinks.h - a sink that writes frames as YUV4MPEG2 (video/y4m.h), and a
 * sink that discards frames, for measuring the rest of the pipeline.
 *
 * The first frame opens the stream; all frames must have its size, format and
 * range. Formats that Y4M does not support are converted to planes; RGB is
 * written in limited range, as most readers expect. Y4M has no tag for the
 * matrix: readers assume BT.601 below 720 lines, else BT.709, and RGB is
 * converted with this matrix.
 *
 * Live frames do not queue: while the reader of a pipe has not read the last
 * frame, new frames are dropped and counted. A frame is written completely or
 * not at all.
 *
 * glint_convert_to_planes() converts any 8-bit picture to planes of Y', Cb, Cr.
 * Samples of packed and half-packed formats are copied, not computed. RGB
 * becomes GLINT_I444 by the matrix and range of the result, rounded to the
 * nearest code. */
#ifndef GLINT_PLATFORM_PANEL_SINKS_H
#define GLINT_PLATFORM_PANEL_SINKS_H

#include "panel/panel.h"
#include "video/y4m.h"

struct glint_null_sink {
    struct glint_sink sink;
    long n_frames; /* number of frames received so far */
};

struct glint_y4m_sink {
    struct glint_sink sink; /* closing the sink commits the file */
    long n_frames;          /* number of frames written */
    long n_dropped;         /* number of frames dropped because the reader was
                               too slow */

    /* Private members. */
    const char *path; /* target path; not owned */
    int fps_num, fps_den;
    bool is_open;
    struct glint_image like; /* format of the stream: the first frame, without
                                its memory */
    struct glint_image planes;
    struct glint_row_rgb row;
    void *mem; /* memory of planes and row; NULL: not needed */
    struct glint_y4m_writer writer;
};

void glint_null_sink_open(struct glint_null_sink *null);

/* Returns the planar format that preserves all samples of FORMAT: GLINT_GREY,
 * _I420, _I422 or _I444. FORMAT must not be GLINT_LINEAR_Q20. */
enum glint_pixel_format glint_get_planar_format(enum glint_pixel_format format);

/* Converts FROM to the planes of TO. TO must have the size of FROM and
 * glint_get_planar_format() of its format. ROW is work memory for that width.
 */
void glint_convert_to_planes(const struct glint_image *to,
                             const struct glint_image *from,
                             struct glint_row_rgb *row);

/* Prepares Y4M to write to PATH, which must outlive it; "-" is standard
 * output. The rate is as in video/y4m.h. Only the first frame opens PATH and
 * can fail. */
void glint_y4m_sink_open(struct glint_y4m_sink *y4m, const char *path,
                         int fps_num, int fps_den);

/* Closes Y4M. Returns GLINT_E_OUTPUT or GLINT_E_CLOSED if not all data were
 * written. */
enum glint_status glint_y4m_sink_finish(struct glint_y4m_sink *y4m,
                                        struct glint_error *error);

#endif
