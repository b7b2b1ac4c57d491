/* SPDX-License-Identifier: MIT
 *
 * source_sink.h - interfaces of sources and sinks of live frames.
 *
 * A source or sink is a struct of function pointers, the first member of the
 * struct that implements it (linux/v4l2.h, linux/fbdev.h ...). Memory is
 * allocated when it is opened or its format changes; frames allocate nothing.
 *
 * Functions return GLINT_E_DEVICE if a device failed or was removed and
 * GLINT_E_OUTPUT if a file cannot be written. ERROR is then a line that names
 * the device or file. */
#ifndef GLINT_PLATFORM_SOURCE_SINK_H
#define GLINT_PLATFORM_SOURCE_SINK_H

#include <stdbool.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/status.h"

/* Max width and height of a camera's or panel's picture, pixels; pictures of
 * files may be larger. */
#define GLINT_PANEL_SIDE 8192

/* A frame of a source. The caller may use its memory until it calls done(). */
struct glint_source_frame {
    /* picture of the frame; plane[0] is NULL if there is no frame yet */
    struct glint_image image;
    uint32_t sequence; /* sequence number from the device; wraps
                          around */
    /* CLOCK_MONOTONIC time at which the frame was captured, us */
    int64_t time_us;
    /* true: the frame may be modified in place, because its memory is cached
     * and nobody else writes to it */
    bool is_drawable;
    /* Number of older frames that were returned to the device unused before
     * this frame. */
    int n_late;
    int n_dropped; /* number of frames missing in the sequence before this
                      frame */
    int n_corrupt; /* number of damaged frames discarded before this frame */
    void *buffer;  /* private to the source */
};

/* The format of the frames that a source delivers. */
struct glint_source_format {
    /* format and size of the frames; its planes are not set */
    struct glint_image image;
    int fps_num, fps_den; /* frames per second; 0: unknown */
    char text[512];       /* one line of text that describes the source to
                             users */
    const char *detail;   /* second line of text for users, or NULL */
};

struct glint_source {
    /* Descriptor to poll; readable when there may be a frame. Valid after
     * start(); start() and next() may change it. */
    int fd;
    /* Number of restarts of the stream since it was opened; each may change the
     * format. */
    int n_restarts;
    /* false: the device receives no signal, and frames show the device's own
     * substitute picture. */
    bool has_signal;

    /* Starts the delivery of frames, after SOURCE was opened and after each
     * restart. The caller should set itself up for the format before this call,
     * because frames that arrive during a later set-up are lost. After
     * GLINT_E_DEVICE, the caller must close SOURCE. */
    enum glint_status (*start)(struct glint_source *source,
                               struct glint_error *error);
    /* Sets FRAME to the latest frame and returns older frames to the device;
     * never waits. Returns GLINT_E_DEVICE if the device was removed (close
     * SOURCE), GLINT_E_CLOSED if there are no more frames. */
    enum glint_status (*next)(struct glint_source *source,
                              struct glint_source_frame *frame,
                              struct glint_error *error);
    /* Returns FRAME to SOURCE, which may then overwrite its memory. */
    void (*done)(struct glint_source *source, struct glint_source_frame *frame);
    /* Sets FORMAT to the current format of SOURCE's frames. */
    void (*describe)(const struct glint_source *source,
                     struct glint_source_format *format);
    void (*close)(struct glint_source *source); /* Closes SOURCE; may be called
                                                   again. */
};

struct glint_sink {
    /* Shows IMAGE and stores no pointer to its memory. Waits for slow readers
     * for at most one frame time, if the system can limit the wait. */
    enum glint_status (*put)(struct glint_sink *sink,
                             const struct glint_image *image,
                             struct glint_error *error);
    void (*close)(struct glint_sink *sink); /* Closes SINK; may be called
                                               again. */
    /* time that the last put() waited for the vertical blank, us */
    int64_t wait_us;
};

#endif
