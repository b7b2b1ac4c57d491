/* SPDX-License-Identifier: MIT
 *
 * source_sink.h - where live frames come from and where they go.
 *
 * A source or sink is a struct of functions, the first member of the struct
 * that implements it (linux/v4l2.h, linux/fbdev.h ...). All memory is taken
 * when it is opened or its format changes; a frame costs none.
 *
 * Errors are GLINT_E_DEVICE for a device that failed or went away and
 * GLINT_E_OUTPUT for what cannot be written, with one line that names it.
 */
#ifndef GLINT_PLATFORM_SOURCE_SINK_H
#define GLINT_PLATFORM_SOURCE_SINK_H

#include <stdbool.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/status.h"

/* Sides of cameras and panels, pixels, at most; pictures of files have more. */
#define GLINT_PANEL_SIDE 8192

/* One frame of a source, its memory lent until done. */
struct glint_source_frame {
    struct glint_image image; /* plane[0] NULL: there is no frame yet */
    uint32_t sequence; /* number that the device gave the frame; it wraps */
    int64_t time_us;   /* CLOCK_MONOTONIC, when it was captured */
    /* The frame may be drawn on in place: its memory is fast, and nobody else
     * writes to it. */
    bool is_drawable;
    int n_late;    /* frames given back unseen: it is the newest */
    int n_dropped; /* gap in sequence before it, without those */
    int n_corrupt; /* frames thrown away before it as damaged */
    void *buffer;  /* the source's own */
};

/* The format of the frames that a source delivers. */
struct glint_source_format {
    struct glint_image image; /* format of a frame, without its memory */
    int fps_num, fps_den;     /* frames a second; 0: not known */
    char text[512];           /* one line about it for a person */
    const char *detail;       /* a further one; NULL: none */
};

struct glint_source {
    int fd; /* readable when there may be a frame; may be another after next */
    int n_restarts;  /* since it was opened; its format may be another after
                        each */
    bool has_signal; /* false: its picture is what it makes of none */

    /* Gives the newest frame there is, and older ones back; never waits.
     * GLINT_E_DEVICE: the device is lost; close it. GLINT_E_CLOSED: there are
     * no more. */
    enum glint_status (*next)(struct glint_source *source,
                              struct glint_source_frame *frame,
                              struct glint_error *error);
    /* Gives FRAME back. */
    void (*done)(struct glint_source *source, struct glint_source_frame *frame);
    /* Says what it delivers now. */
    void (*describe)(const struct glint_source *source,
                     struct glint_source_format *format);
    void (*close)(struct glint_source *source); /* idempotent */
};

struct glint_sink {
    /* Shows IMAGE, which is the caller's. Does not wait for slow readers longer
     * than a frame where the system allows it. */
    enum glint_status (*put)(struct glint_sink *sink,
                             const struct glint_image *image,
                             struct glint_error *error);
    void (*close)(struct glint_sink *sink); /* idempotent */
};

#endif
