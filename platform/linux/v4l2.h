/* SPDX-License-Identifier: MIT
 *
 * linux/v4l2.h - a V4L2 camera as a source of live frames.
 *
 *     glint_v4l2_open(&camera, &wish, GLINT_V4L2_AUTO, 4, &error);
 *     camera.source.start(&camera.source, &error);           when set up
 *     camera.source.next(&camera.source, &frame, &error);    when readable
 *     camera.source.done(&camera.source, &frame);
 *     camera.source.close(&camera.source);
 *
 * The newest frame wins: what waited behind it goes back to the driver unseen,
 * so latency never grows. Frames that the driver marks as damaged or that are
 * shorter than a picture are counted and not shown. Buffers are mapped; else
 * the application's (USERPTR), else read(2), as the device allows.
 *
 * next stops a stream that breaks and agrees on whatever format the device has
 * then: after failed requests, a fatal error of the driver, another source, 30
 * damaged frames in a row, or silence for two seconds and four frames. The
 * caller starts it again; a call of next does so, too. When that does not help
 * within a second, or the device is gone, start and next fail with
 * GLINT_E_DEVICE.
 */
#ifndef GLINT_PLATFORM_LINUX_V4L2_H
#define GLINT_PLATFORM_LINUX_V4L2_H

#include "linux/v4l2_device.h"
#include "source_sink.h"

#define GLINT_V4L2_MAX_BUFFERS 32

enum glint_v4l2_io {
    GLINT_V4L2_AUTO,
    GLINT_V4L2_MMAP,
    GLINT_V4L2_USERPTR,
    GLINT_V4L2_READ
};

struct glint_v4l2_buffer {
    void *mem[3];
    size_t bytes[3]; /* size of each block in mem */
    bool queued;     /* The driver has the buffer. */
    bool lent;       /* The application has the buffer. */
};

struct glint_v4l2 {
    struct glint_source source;
    struct glint_v4l2_device device;

    /* Set when the buffers are there; for reports. */
    enum glint_v4l2_io io;
    int n_buffers;
    bool is_cached;      /* Buffers are read at the speed of memory. */
    bool exports_dmabuf; /* Buffers could be handed on without a copy. */

    /* Private. */
    enum glint_v4l2_io wish_io;
    int wish_buffers;
    struct glint_v4l2_buffer buffer[GLINT_V4L2_MAX_BUFFERS];
    struct glint_mjpeg *jpeg; /* decoder of JPEG streams */
    bool streams;
    int n_numbered;    /* frames since the start, counted up to 2 */
    uint32_t sequence; /* number of the last frame taken */
    uint32_t n_read;   /* frames read by read(2), which numbers none */
    int64_t heard_us;  /* time of the last frame */
    int64_t broken_us; /* time since which the stream has failed; 0: it works */
    int n_useless;     /* damaged frames in a row */
};

/* Opens the camera that WISH names, agrees on a format and gets N_BUFFERS
 * buffers for streaming by IO, 2 .. GLINT_V4L2_MAX_BUFFERS, or as many as the
 * driver gives; from then on no other program changes the format. On failure
 * CAMERA is closed. */
enum glint_status glint_v4l2_open(struct glint_v4l2 *camera,
                                  const struct glint_v4l2_config *wish,
                                  enum glint_v4l2_io io, int n_buffers,
                                  struct glint_error *error);

#endif
