/* SPDX-License-Identifier: MIT
 *
 * linux/v4l2.h - a V4L2 camera as a source of live frames.
 *
 *     glint_v4l2_open(&camera, &wish, GLINT_V4L2_AUTO, 4, &error);
 *     camera.source.start(&camera.source, &error); when set up
 *     camera.source.next(&camera.source, &frame, &error); when readable
 *     camera.source.done(&camera.source, &frame);
 *     camera.source.close(&camera.source);
 *
 * Only the latest frame is used: older frames that wait are returned to the
 * driver, so latency never grows. Frames that the driver marks as damaged, or
 * that are too short, are counted and not shown. Frames arrive in mapped
 * buffers; if the device does not support these, in buffers of the application
 * (USERPTR), else by read(2).
 *
 * next() stops a broken stream and negotiates the format again. A stream is
 * broken after failed requests, a fatal error of the driver, a change of the
 * source, or 30 damaged frames in a row. It is also broken if no frame arrives
 * for two seconds and four frame times. start() or the next call of next() then
 * starts the stream again. If the stream does not work within a second, or the
 * device was removed, start() and next() return GLINT_E_DEVICE. */
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
    size_t bytes[3]; /* size of each block in mem, bytes */
    bool queued;     /* true: the buffer is queued in the driver */
    bool lent;       /* true: the application uses the buffer */
};

struct glint_v4l2 {
    struct glint_source source;
    struct glint_v4l2_device device;

    /* type of the buffers, for reports; set when buffers have been allocated */
    enum glint_v4l2_io io;
    int n_buffers;
    /* true: buffers lie in cached memory, so reading them is fast. */
    bool is_cached;
    bool exports_dmabuf; /* true: the driver can export buffers as DMABUF */

    /* Private members. */
    enum glint_v4l2_io wish_io;
    int wish_buffers;
    struct glint_v4l2_buffer buffer[GLINT_V4L2_MAX_BUFFERS];
    struct glint_mjpeg *jpeg; /* decoder of JPEG streams */
    bool streams;
    /* number of frames with a sequence number since the start of the stream;
     * stops counting at 2 */
    int n_numbered;
    uint32_t sequence; /* sequence number of the last frame that was dequeued */
    uint32_t n_read;   /* number of frames read by read(2), which gives no
                          sequence number */
    int64_t heard_us;  /* time from which a stall is measured, us: the last
                          frame, start or change of source */
    int64_t broken_us; /* time at which the stream failed, us; 0: the stream has
                          not failed */
    int n_useless;     /* number of damaged frames in a row */
};

/* Opens the camera that WISH names, negotiates a format and allocates buffers
 * of type IO. N_BUFFERS, 2 .. GLINT_V4L2_MAX_BUFFERS, is the requested number;
 * the driver may grant fewer. Afterwards no other program can change the
 * format. On failure CAMERA is closed. */
enum glint_status glint_v4l2_open(struct glint_v4l2 *camera,
                                  const struct glint_v4l2_config *wish,
                                  enum glint_v4l2_io io, int n_buffers,
                                  struct glint_error *error);

#endif
