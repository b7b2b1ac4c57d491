/* SPDX-License-Identifier: MIT
 *
 * panel/sinks.h - a sink that writes frames as YUV4MPEG2 (video/y4m.h), and a
 * sink that discards frames, for measuring the rest of the pipeline.
 *
 * The stream is opened with the first frame; all frames must have its size,
 * format and range. Formats that Y4M does not know are written as planes; RGB
 * is of limited range then, as most readers expect. The matrix is not stated,
 * as Y4M has no tag for it: readers take BT.601 below 720 lines, else BT.709,
 * and RGB is written so.
 *
 * While the reader of a pipe has not read the last frame, new frames are
 * dropped and counted: live frames do not queue. A frame is never written
 * partly.
 *
 * glint_planar_write() converts any 8-bit picture to planes of Y', Cb, Cr.
 * Samples of packed and half-packed formats are copied, not computed. RGB
 * becomes GLINT_I444 by the matrix and range of the result, rounded to the
 * nearest code. */
#ifndef GLINT_PLATFORM_PANEL_SINKS_H
#define GLINT_PLATFORM_PANEL_SINKS_H

#include "panel/panel.h"
#include "video/y4m.h"

struct glint_null_sink {
    struct glint_sink sink;
    long n_frames; /* frames received so far */
};

struct glint_y4m_sink {
    struct glint_sink sink; /* closing it commits the file */
    long n_frames;          /* frames written */
    long n_dropped;         /* frames dropped because the reader was too slow */

    /* Private. */
    const char *path; /* target path; not owned */
    int fps_num, fps_den;
    bool is_open;
    struct glint_image like; /* the first frame, without its memory */
    struct glint_image planes;
    struct glint_row_rgb row;
    void *mem; /* memory of planes and row; NULL if unused */
    struct glint_y4m_writer writer;
};

void glint_null_sink_open(struct glint_null_sink *null);

/* Returns the planar format that preserves all samples of FORMAT: GLINT_GREY,
 * _I420, _I422 or _I444. FORMAT must not be GLINT_LINEAR_Q20. */
enum glint_pixel_format glint_planar_format(enum glint_pixel_format format);

/* Converts FROM to the planes of TO. TO must have the size of FROM and
 * glint_planar_format() of its format. ROW is work memory for that width. */
void glint_planar_write(const struct glint_image *to,
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
