/* SPDX-License-Identifier: MIT
 *
 * source_sink.h - interfaces of sources and sinks of live frames.
 *
 * A source or sink is a struct of functions, the first member of the struct
 * that implements it (linux/v4l2.h, linux/fbdev.h ...). All memory is allocated
 * when it is opened or its format changes; frames allocate nothing.
 *
 * Errors are GLINT_E_DEVICE for a device that failed or went away and
 * GLINT_E_OUTPUT for a file that cannot be written, with one line that names
 * the device or file.
 */
#ifndef GLINT_PLATFORM_SOURCE_SINK_H
#define GLINT_PLATFORM_SOURCE_SINK_H

#include <stdbool.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/status.h"

/* Most pixels on a side of a camera's or panel's picture; pictures of files may
 * have more. */
#define GLINT_PANEL_SIDE 8192

/* One frame of a source, its memory lent until done. */
struct glint_source_frame {
    struct glint_image image; /* plane[0] NULL: there is no frame yet */
    uint32_t sequence; /* number that the device gave the frame; it wraps */
    int64_t time_us;   /* CLOCK_MONOTONIC, when it was captured */
    /* The frame may be drawn on in place: its memory is fast, and nobody else
     * writes to it. */
    bool is_drawable;
    int n_late;    /* older frames given back unseen before this one */
    int n_dropped; /* frames missing in the sequence before this one */
    int n_corrupt; /* damaged frames thrown away */
    void *buffer;  /* private to the source */
};

/* The format of the frames that a source delivers. */
struct glint_source_format {
    struct glint_image image; /* format of a frame, without its memory */
    int fps_num, fps_den;     /* frames a second; 0: not known */
    char text[512];           /* one line about the source for a person */
    const char *detail;       /* a second line; NULL: none */
};

struct glint_source {
    int fd;          /* readable when there may be a frame, once SOURCE was
                        started; start and next may change it */
    int n_restarts;  /* restarts of the stream since it was opened; its format
                        may change with each */
    bool has_signal; /* false: frames show what the device makes of no signal */

    /* Begins to deliver frames, after SOURCE was opened and after each restart.
     * The caller first sets up for the format, as frames that come meanwhile
     * would be lost. GLINT_E_DEVICE: close SOURCE. */
    enum glint_status (*start)(struct glint_source *source,
                               struct glint_error *error);
    /* Sets FRAME to the newest frame and returns older ones to the device;
     * never waits. GLINT_E_DEVICE: the device is lost; close SOURCE.
     * GLINT_E_CLOSED: there are no more frames. */
    enum glint_status (*next)(struct glint_source *source,
                              struct glint_source_frame *frame,
                              struct glint_error *error);
    /* Gives FRAME back to SOURCE. */
    void (*done)(struct glint_source *source, struct glint_source_frame *frame);
    /* Sets FORMAT to what SOURCE delivers now. */
    void (*describe)(const struct glint_source *source,
                     struct glint_source_format *format);
    void (*close)(struct glint_source *source); /* idempotent */
};

struct glint_sink {
    /* Shows IMAGE, whose memory stays the caller's. Waits for slow readers no
     * longer than a frame, where the system allows that. */
    enum glint_status (*put)(struct glint_sink *sink,
                             const struct glint_image *image,
                             struct glint_error *error);
    void (*close)(struct glint_sink *sink); /* idempotent */
};

#endif
